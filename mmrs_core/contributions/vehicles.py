"""What makes the vehicles of a run, and what they are made from; see `mmrs_runtime.vehicle` for these.

Times are seconds of the run's clock throughout.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Protocol, runtime_checkable

from mmrs_core.contributions.targets import TargetInput
from mmrs_runtime.engine.connecting import Live as Live

if TYPE_CHECKING:
    from mmrs_core.behaviour.program import Action, RobotProgram
    from mmrs_core.contributions.execution import Sample
    from mmrs_core.scene import Policy, RobotType
    from mmrs_runtime.vehicle import Vehicle


@runtime_checkable
class Recorder(Protocol):
    """A vehicle that records the track of its robot."""

    @property
    def notes(self) -> Sequence[str]:
        """Return what was taken for granted, each line without the robot's name."""
        ...

    def track(self) -> tuple[Sample, ...]:
        """Return the robot's track."""
        ...


@dataclass(frozen=True, slots=True, kw_only=True)
class VehicleInput(TargetInput):
    """All that a vehicle may use: what a target may, and what is of its robot.

    Attributes:
        options: as in ``--backend-option``, those of this robot; `read_options` of
            `mmrs_core.contributions.backend_options` reads them into a dataclass.
        policies: of the robot, in the order in which they go: the first for an event counts.
        live: of a run in real time; None in simulated time.
    """

    robot: RobotProgram
    type: RobotType
    options: Mapping[str, str] = field(default_factory=dict)
    policies: tuple[Policy, ...] = ()
    live: Live | None = None


Check = Callable[[Mapping[str, Mapping[str, str]], Mapping[str, str]], Iterable[str]]


@dataclass(frozen=True, slots=True)
class VehicleFactory:
    """What makes vehicles of one sort.

    Attributes:
        name: as in ``--backend``.
        description: one line.
        connect: a vehicle for one robot. Raises LinkLostError where the robot does not answer,
            UnsupportedError for an option that it does not know and for what it cannot do.
        simulated: whether its time is simulated, so that a run jumps from event to event;
            ``mmrs simulate`` takes no other.
        check: yields what is wrong with the options of its robots and with the links of all robots, each by
            robot, as far as the command line alone shows it, such as ``--connect udp: is no address``. Raises
            OSError where a file that they name cannot be read.
        default: whether ``mmrs run`` uses it where no backend is named; two such are an error.
        signs: whether ``--signing-key`` is for its links.
        takes_photo: whether an action of a device takes photos, by what the robot's type states; None
            where the type does not state it for these vehicles.
    """

    name: str
    description: str
    connect: Callable[[VehicleInput], Vehicle]
    simulated: bool = False
    check: Check = lambda options, links: ()
    default: bool = False
    signs: bool = False
    takes_photo: Callable[[Action, RobotType], bool | None] = lambda action, robot_type: None
