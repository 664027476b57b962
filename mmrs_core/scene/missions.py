"""The scene: frame, areas, tasks and their dependencies, robots."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from enum import Enum
from math import inf
from typing import Literal, TypeAlias

from mmrs_core.diagnostics import Place
from mmrs_core.scene.primitives import AltitudeReference, Part, Point, Ring
from mmrs_core.scene.relays import Relay
from mmrs_core.scene.robots import Robot
from mmrs_core.scene.works import Work
from mmrs_runtime.faults import BATTERY_LOW
from mmrs_runtime.policies import LAND, Policy, in_precedence


class AreaUse(Enum):
    """What an area means to a robot."""

    FORBIDDEN = "forbidden"
    OBSTACLE = "obstacle"
    EMERGENCY = "emergency"


@dataclass(frozen=True, slots=True)
class Area:
    """An area as drawn: a vertical prism over a polygon.

    Attributes:
        name: as in the context, or made from its place in the list.
        use: what it means.
        shell: vertices (east, north), metres, not closed, simple.
        low: height of its lower side above the origin, metres; -inf where unlimited.
        high: height of its upper side; inf where unlimited.
        safety_distance: distance to keep from each side, metres, zero or more.
        types: names of the robot types that it concerns; None: all.
    """

    name: str
    use: AreaUse
    shell: Ring
    low: float = -inf
    high: float = inf
    safety_distance: float = 0.0
    part: Part = field(default_factory=lambda: Part((), {}))
    types: frozenset[str] | None = None

    def concerns(self, robot_type: str) -> bool:
        """Return whether robots of the type of that name must respect the area."""
        return self.types is None or robot_type in self.types


CorridorUse: TypeAlias = Literal["BOTH", "ENTRY", "EXIT"]


@dataclass(frozen=True, slots=True)
class Corridor:
    """A corridor as drawn: a line with a width, between two heights.

    Attributes:
        name: as in the context, or made from its place in the list.
        line: (east, north) of its centre line in the direction of entry: two places or more, each different
            from the one before.
        width: metres between its two sides.
        low: height of its lower side above the origin, metres; -inf where unlimited.
        high: height of its upper side; inf where unlimited.
        use: directions in which robots may go through it.
        types: names of the robot types that it is for; None: all.
    """

    name: str
    line: tuple[Point, ...]
    width: float
    low: float = -inf
    high: float = inf
    use: CorridorUse = "BOTH"
    types: frozenset[str] | None = None
    part: Part = field(default_factory=lambda: Part((), {}))

    def concerns(self, robot_type: str) -> bool:
        """Return whether it is for robots of the type of that name."""
        return self.types is None or robot_type in self.types

    @property
    def way_in(self) -> tuple[Point, ...]:
        """Return the line on which robots come in; empty where they may not."""
        return self.line if self.use != "EXIT" else ()

    @property
    def way_out(self) -> tuple[Point, ...]:
        """Return the line on which robots go out, which is the reverse; empty where they may not."""
        return self.line[::-1] if self.use != "ENTRY" else ()


@dataclass(frozen=True, slots=True)
class Frame:
    """How the local frame lies on the Earth.

    Attributes:
        crs: of the geographic coordinates of mission and behaviour.
        latitude, longitude: of the origin, degrees in that crs; None for a local mission.
        altitude: of the origin above the altitude reference, metres; None where it has none.
        altitude_reference: ELLIPSOID, MSL or ORIGIN.
        geoid_separation: mean sea level above the ellipsoid, metres; None where not known.
        surface: height of the water surface above the origin, metres.
    """

    crs: str
    latitude: float | None
    longitude: float | None
    altitude: float | None = None
    altitude_reference: AltitudeReference = "ELLIPSOID"
    geoid_separation: float | None = None
    surface: float = 0.0

    @property
    def is_local(self) -> bool:
        """Return whether the mission has no place on the Earth."""
        return self.latitude is None

    def agrees_with(self, other: Frame) -> bool:
        """Return whether positions mean the same in both; how they are stated may differ.

        Heights are above the origin where it has no altitude, whatever the reference is.
        """
        return (self.crs, self.latitude, self.longitude, self.surface, self._level) == (
            other.crs,
            other.latitude,
            other.longitude,
            other.surface,
            other._level,
        )

    @property
    def _level(self) -> tuple[float, str, float | None] | None:
        if self.altitude is None or self.altitude_reference == "ORIGIN":
            return None
        return self.altitude, self.altitude_reference, self.geoid_separation


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
        corridors: through which robots come from home to their tasks and go back.
        environment: by attribute name; absent where not known.
        works: by (task name, robot name): what the task is made of for that robot; filled when the
            scene is expanded. A pair that is missing means the robot cannot do the task; why is in
            `refusals`.
        refusals: by (task name, robot name): why that robot cannot do that task.
        stations: other robots that are relays at their places while those of the scene do their tasks.
        timed: whether robots stop at every corner, so that it is certain when they are where: they are
            several, and keep apart. False until the scene is expanded.
    """

    name: str
    frame: Frame
    tasks: tuple[Task, ...]
    dependencies: tuple[Dependency, ...]
    robots: tuple[Robot, ...]
    areas: tuple[Area, ...] = ()
    elements: tuple[Part, ...] = ()
    corridors: tuple[Corridor, ...] = ()
    environment: Mapping[str, float] = field(default_factory=dict)
    transit_altitude: float | None = None
    minimum_separation: float | None = None
    reserve: float = 0.2
    position_error: float = 0.0
    policies: tuple[Policy, ...] = ()
    accepted_unknowns: tuple[str, ...] = ()
    works: Mapping[tuple[str, str], Work] = field(default_factory=dict)
    refusals: Mapping[tuple[str, str], str] = field(default_factory=dict)
    stations: tuple[Relay, ...] = ()
    timed: bool = False

    def task(self, name: str) -> Task:
        """Return the task of that name."""
        return next(task for task in self.tasks if task.name == name)

    def robot(self, name: str) -> Robot:
        """Return the robot of that name."""
        return next(robot for robot in self.robots if robot.name == name)

    def stated_policies(self, robot: Robot) -> tuple[Policy, ...]:
        """Return the policies of the robot's behaviour, which go before those of its type and kind.

        They are the mission's. A robot that is not to come home does not go there for want of energy, unless
        mission or type say so: it lands where it is.
        """
        events = {policy.event for policy in (*self.policies, *robot.type.policies)}
        if robot.return_home or BATTERY_LOW in events:
            return self.policies
        return (*self.policies, Policy(BATTERY_LOW, LAND))

    def responses(self, robot: Robot) -> dict[str, str]:
        """Return what a robot of the expanded scene does, by event."""
        stated = self.stated_policies(robot)
        found: dict[str, str] = {}
        for policy in (*in_precedence((), stated, robot.type.policies), *robot.policies):
            found.setdefault(policy.event, policy.response)
        return found

    def kept_from(self, robot: Robot) -> Iterator[Area]:
        """Yield the areas that a robot keeps away from: forbidden ones, obstacles, ground it cannot pass."""
        return (
            area
            for area in self.areas
            if area.use is not AreaUse.EMERGENCY and area.concerns(robot.type.name)
        )

    def corridors_of(self, robot: Robot) -> tuple[Corridor, ...]:
        """Return the corridors that are for a robot."""
        return tuple(each for each in self.corridors if each.concerns(robot.type.name))
