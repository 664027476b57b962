"""What makes the vehicles of a run, and what they are made from; see `mmrs_runtime.vehicle` for these.

Times are seconds of the run's clock throughout.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Protocol, runtime_checkable

from mmrs_runtime.engine.connecting import Live as Live

if TYPE_CHECKING:
    from mmrs_core.behaviour.program import Action, Program, RobotProgram
    from mmrs_core.contributions.execution import Sample
    from mmrs_core.contributions.hooks import Extensions
    from mmrs_core.contributions.rules import MoveKind, RobotKind
    from mmrs_core.scene import Area, Name, Part, Policy, RobotType
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


@dataclass(frozen=True, slots=True)
class VehicleInput:
    """All that a vehicle may use.

    Attributes:
        options: as in ``--backend-option``, those of this robot; `read_options` of
            `mmrs_core.contributions.backend_options` reads them into a dataclass.
        policies: of the robot, in the order in which they go: the first for an event counts.
        areas: of the context as drawn, and those that its elements make; empty where none was given.
        live: of a run in real time; None in simulated time.
        extensions: what plug-ins contribute by hooks of plug-ins, by `Hook.sort`, then by key.
        types: of all robots, by name, as far as they are known.
        elements: context elements of plug-ins; empty where no context was given.
    """

    program: Program
    robot: RobotProgram
    type: RobotType
    robot_kinds: Mapping[Name, RobotKind]
    move_kinds: Mapping[Name, MoveKind]
    environment: Mapping[str, float]
    options: Mapping[str, str]
    policies: tuple[Policy, ...] = ()
    areas: tuple[Area, ...] = ()
    live: Live | None = None
    extensions: Extensions = field(default_factory=dict)
    types: Mapping[str, RobotType] = field(default_factory=dict)
    elements: tuple[Part, ...] = ()


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
