"""The scene itself: tasks, what comes before what, the robots and the place."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from mmrs_core.diagnostics import Place
from mmrs_core.scene.places import Area, AreaUse, Frame
from mmrs_core.scene.robots import Robot
from mmrs_core.scene.values import Part
from mmrs_core.scene.works import Work
from mmrs_runtime.policies import Policy


@dataclass(frozen=True, slots=True)
class Task:
    """A task of the mission, control tasks (Fork, Join) included.

    Attributes:
        wanted: how many robots share it; None: as many as help.
        devices: identifiers of devices a robot must have; actions: names of actions it must support.
        earliest, deadline: seconds after the mission's start; longest: seconds from begin to end.
        part: metaclasses and all grounded attributes (``point``, ``points``, ``shell``, ``holes`` …).
    """

    name: str
    part: Part
    wanted: int | None = None
    devices: tuple[str, ...] = ()
    actions: tuple[str, ...] = ()
    earliest: float | None = None
    deadline: float | None = None
    longest: float | None = None
    priority: int = 0


@dataclass(frozen=True, slots=True)
class Dependency:
    """No part of the second task begins before the first has ended; names of tasks."""

    before: str
    after: str
    condition: str | None = None
    place: Place = Place()


@dataclass(frozen=True, slots=True)
class Scene:
    """A whole mission in the local frame.

    Attributes:
        tasks: in the mission's order; control tasks included.
        areas: as drawn, forbidden areas, obstacles and emergency areas.
        elements: context elements of plug-ins.
        environment: by attribute name; absent where not known.
        works: by (task name, robot name): what the task is made of for that robot; filled when the
            scene is expanded. A pair that is missing means the robot cannot do the task; why is in
            `refusals`.
        refusals: by (task name, robot name): why that robot cannot do that task.
    """

    name: str
    frame: Frame
    tasks: tuple[Task, ...]
    dependencies: tuple[Dependency, ...]
    robots: tuple[Robot, ...]
    areas: tuple[Area, ...] = ()
    elements: tuple[Part, ...] = ()
    environment: Mapping[str, float] = field(default_factory=dict)
    transit_altitude: float | None = None
    minimum_separation: float | None = None
    reserve: float = 0.2
    position_error: float = 0.0
    policies: tuple[Policy, ...] = ()
    accepted_unknowns: tuple[str, ...] = ()
    works: Mapping[tuple[str, str], Work] = field(default_factory=dict)
    refusals: Mapping[tuple[str, str], str] = field(default_factory=dict)

    def task(self, name: str) -> Task:
        """Return the task of that name."""
        return next(task for task in self.tasks if task.name == name)

    def robot(self, name: str) -> Robot:
        """Return the robot of that name."""
        return next(robot for robot in self.robots if robot.name == name)

    def kept_from(self, robot: Robot) -> Iterator[Area]:
        """Yield the areas that a robot keeps away from: forbidden ones, obstacles, ground it cannot pass."""
        return (
            area
            for area in self.areas
            if area.use is not AreaUse.EMERGENCY and area.concerns(robot.type.name)
        )
