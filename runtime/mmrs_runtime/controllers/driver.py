"""What a driver supplies, so that controllers of its vehicles run."""

from __future__ import annotations

from abc import ABC, abstractmethod
from argparse import ArgumentParser, Namespace
from collections.abc import Collection, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ..engine.connecting import Live
from ..injection import Rehearsal
from ..records.blackbox import BlackBox
from ..vehicle import Vehicle
from .user_functions import Locator
from .vocabulary import Robot

if TYPE_CHECKING:
    from .options import Options


@dataclass(frozen=True, slots=True)
class DriverInput:
    """What drivers make vehicles with, in addition to the robots' programs.

    Attributes:
        rehearsal: of injected faults.
        locators: find objects, by description.
        stack: closes what vehicles share, at the end.
    """

    options: Options
    rehearsal: Rehearsal
    locators: Mapping[str, Locator]
    stack: ExitStack


class Driver(ABC):
    """Reaches vehicles of one kind; made for one run of controllers.

    Attributes:
        rehearses: faults of vehicles, and of ground stations, that it can inject.
    """

    rehearses: Collection[str] = ()

    def add_options(self, parser: ArgumentParser) -> None:  # noqa: B027
        """Add the options of its own to a command line."""

    def settle(self, parser: ArgumentParser, robots: Sequence[Robot], given: Namespace) -> Mapping[str, str]:
        """Keep what a command line says; return how each robot is reached: those with equal words share it.

        Exits with a usage error, by `parser.error`, where it makes no sense.
        """
        return {robot.id: robot.id for robot in robots}

    def sees(self, robot: Robot) -> Collection[str]:
        """Return the objects that a robot's vehicle finds, so that no function of the user has to."""
        return ()

    def open(self, outfit: DriverInput) -> None:  # noqa: B027
        """Open what vehicles share, before any is connected."""

    @abstractmethod
    def connect(self, robot: Robot, live: Live, box: BlackBox) -> Vehicle:
        """Return a robot's vehicle, possibly before its first message; it closes the box.

        Raises:
            FaultError: it cannot be reached.
        """
