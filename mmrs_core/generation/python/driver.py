"""What a sort of vehicle needs, so that programs in Python drive it."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any, ClassVar, Generic, TypeVar

from mmrs_core.behaviour.program import Action, Heading, Move, RobotProgram
from mmrs_core.contributions.samples import SampleWiring
from mmrs_core.contributions.targets import FileSpec, TargetInput
from mmrs_core.generation.context import RobotContext
from mmrs_core.generation.escaping import Call
from mmrs_core.generation.python.moves import MOVEMENTS, look_of, unturnable
from mmrs_core.scene import Name, Policy

C = TypeVar("C", bound=RobotContext)

Movement = Callable[[Move, Any, Any], Call]
"""Returns the movement of a move, given its robot's context and the driver."""


class PythonDriver(ABC, Generic[C]):
    """How programs in Python drive one sort of vehicle; `python_target` makes a target of it.

    Attributes:
        name, description: of the target.
        module: what programs import their words and ``main`` from, where they run.
        requires: distributions that hold it; the runtime comes beside them.
        templates: folder with ``README.md.jinja``, and with those that extend the core's as ``python/NAME``.
        movements: what is said for a move, by its own metaclass: one that extends it may move otherwise.
        capabilities: how elements of behaviours are expressed, as in `Target`.
        tried_with, wirings: as in `Target`.
    """

    name: ClassVar[str]
    description: ClassVar[str]
    module: ClassVar[str]
    requires: ClassVar[tuple[str, ...]]
    templates: ClassVar[Path]
    movements: ClassVar[Mapping[Name, Movement]] = MOVEMENTS
    capabilities: ClassVar[Mapping[str, str]] = {}
    tried_with: ClassVar[str] = "ground"
    wirings: ClassVar[tuple[SampleWiring, ...]] = ()

    @abstractmethod
    def undriven(self, robot: RobotProgram, input: TargetInput) -> str:
        """Return why no vehicle of this sort carries a robot; empty where one does."""

    @abstractmethod
    def context(self, robot: RobotProgram, input: TargetInput) -> C:
        """Return what there is to know of a robot that it drives; in metres where its frame is local."""

    @abstractmethod
    def vehicle(self, context: C) -> str:
        """Return the word for a robot's vehicle."""

    @abstractmethod
    def device(self, action: Action, context: C) -> Call | str:
        """Return how a device carries out an action, or the reason why it cannot."""

    def movements_of(self, context: C) -> Mapping[Name, Movement]:
        """Return what moves of a robot become, by metaclass; by default `movements`."""
        return self.movements

    def look(self, heading: Heading, context: C) -> Call | None:
        """Return how a device is pointed; None where it cannot be, and `unseen` says why."""
        return look_of(heading, context)

    def unseen(self, heading: Heading, context: C) -> Iterable[str]:
        """Return why a device cannot be pointed as a heading says."""
        return unturnable(heading, context)

    def head(self, context: C, input: TargetInput) -> Iterable[tuple[str, object]]:
        """Return what its own ``Robot`` takes beside what all do, by name; empty tuples are left out."""
        return ()

    def unanswerable(self, policy: Policy, context: C) -> str:
        """Return why a vehicle cannot answer an event as a policy says; empty where it can."""
        return ""

    def unsaid(self, move: Move, context: C) -> Iterable[str]:
        """Return what else of a move it cannot express."""
        return ()

    def refusals(self, context: C, input: TargetInput) -> Iterable[str]:
        """Return what else of a robot it cannot express, each beginning with the robot."""
        return ()

    def files(self, module: str, context: C, input: TargetInput) -> Iterable[FileSpec]:
        """Return files that lie beside the module of a robot."""
        return ()
