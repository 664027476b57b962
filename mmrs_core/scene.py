"""What stands between the stages from models to plans: plain frozen values in one local frame.

Positions are (east, north, up) in metres from the mission's origin; speeds are metres per second,
times and durations seconds, energies joules, masses kilograms. Angles keep the unit of the model
(degrees) only inside `attributes`, under the model's own names. Every task, robot type and area
carries its metaclasses as ((nsURI, name), ...), most specific first, so that plug-ins choose by
metaclass without seeing a model.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from enum import Enum
from math import inf
from typing import Literal, TypeAlias

from mmrs_core.diagnostics import Place

Position: TypeAlias = tuple[float, float, float]
Point: TypeAlias = tuple[float, float]
Ring: TypeAlias = tuple[Point, ...]
Name: TypeAlias = tuple[str, str]
Metaclasses: TypeAlias = tuple[Name, ...]

TravelMode: TypeAlias = Literal["SAFE", "NORMAL", "AGGRESSIVE"]
AltitudeReference: TypeAlias = Literal["ELLIPSOID", "MSL", "ORIGIN"]
PolicyEvent: TypeAlias = Literal["LINK_LOST", "PEER_LOST", "BATTERY_LOW", "WAIT_TOO_LONG", "DEVICE_SILENT"]
PolicyResponse: TypeAlias = Literal[
    "HOLD", "RETURN", "EMERGENCY_AREA", "LAND", "SURFACE", "STOP_THRUST", "CONTINUE"
]


@dataclass(frozen=True, slots=True)
class Part:
    """A model element as stages see it: what it is, its attributes, where it stands.

    Attributes:
        metaclasses: (nsURI, name), most specific first.
        attributes: by the feature's name in the metamodel. Coordinates are grounded to `Position`
            (an absent height is the origin's); other contained elements are `Part`;
            many-valued features are tuples; enumerations are literal names; absent values are None.
        place: where the element stands in the user's files.
    """

    metaclasses: Metaclasses
    attributes: Mapping[str, Value]
    place: Place = Place()

    def is_a(self, name: Name) -> bool:
        """Return whether the element is of that metaclass or a subclass of it."""
        return name in self.metaclasses


Value: TypeAlias = "bool | int | float | str | Position | Part | tuple[Value, ...] | None"


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
    """

    name: str
    use: AreaUse
    shell: Ring
    low: float = -inf
    high: float = inf
    safety_distance: float = 0.0
    part: Part = field(default_factory=lambda: Part((), {}))


@dataclass(frozen=True, slots=True)
class Capability:
    """How a type of robot moves with a payload of one weight; None is not known.

    Attributes:
        payload: kilograms that the figures hold for.
        lifetime: seconds on full batteries.
        speed: (smallest, largest), metres per second.
        acceleration: largest, metres per second squared.
        climb_rate, descent_rate: largest, metres per second.
        turn_rate: largest, degrees per second.
    """

    payload: float
    lifetime: float | None
    speed: tuple[float, float]
    acceleration: float | None = None
    climb_rate: float | None = None
    descent_rate: float | None = None
    turn_rate: float | None = None
    part: Part = field(default_factory=lambda: Part((), {}))


@dataclass(frozen=True, slots=True)
class Battery:
    """A battery: joules when full, seconds to recharge or None where that is impossible."""

    energy: float
    recharge_time: float | None


@dataclass(frozen=True, slots=True)
class DeviceAction:
    """An action that a device supports: its name, seconds it takes, and its parameters' keys."""

    name: str
    duration: float
    parameters: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Device:
    """A device of a robot type."""

    id: str
    actions: Mapping[str, DeviceAction]
    properties: Mapping[str, str]


@dataclass(frozen=True, slots=True)
class RobotType:
    """A type of robot.

    Attributes:
        name: as missions refer to it.
        metaclasses: of the robot type itself, most specific first.
        capability_metaclasses: of its movement capabilities (the first one's), most specific first.
        half_diagonal: half the diagonal of the robot's outer dimensions, metres.
        capabilities: sorted by payload, at least one.
        part: the whole type, with all attributes that plug-ins add.
    """

    name: str
    metaclasses: Metaclasses
    capability_metaclasses: Metaclasses
    half_diagonal: float
    max_payload: float | None
    capabilities: tuple[Capability, ...]
    batteries: tuple[Battery, ...]
    devices: Mapping[str, Device]
    part: Part


@dataclass(frozen=True, slots=True)
class Kinematics:
    """What a robot can do on this mission, after payload and travel mode; made by its robot kind.

    Attributes:
        cruise: metres per second by travel mode, within the capability's limits.
        slowest, fastest: limits of commanded speed over ground, metres per second.
        climb, descent: metres per second, vertical.
        acceleration: metres per second squared; inf where it does not matter.
        turn_rate: degrees per second.
        floor, ceiling: heights above the origin between which the robot may move, metres.
        launch: seconds that launching takes beside the climb; recovery: likewise for landing.
        endurance: usable seconds of one sortie, reserve taken off; inf for wired robots.
        energy: usable joules of one sortie, reserve taken off; inf for wired robots.
        power: mean power in watts; 0 where nothing is known of energy.
        draw: by how much the power may exceed the mean for long, as a factor of one or more: what it
            takes to travel against the wind or current all the time.
        recharge: seconds from empty to full at home; None where impossible.
        launches: whether the robot climbs from its home before it travels and descends onto it
            at the end (a drone does; an underwater vehicle or rover does not).
        own_speed: largest speed through the air or the water that it moves in, metres per second;
            `fastest` is what is left of it against the wind or the current. None: nothing is lost.
    """

    cruise: float
    slowest: float
    fastest: float
    climb: float
    descent: float
    acceleration: float = inf
    turn_rate: float = 90.0
    floor: float = -inf
    ceiling: float = inf
    launch: float = 0.0
    recovery: float = 0.0
    endurance: float = inf
    energy: float = inf
    power: float = 0.0
    draw: float = 1.0
    recharge: float | None = None
    launches: bool = False
    own_speed: float | None = None


@dataclass(frozen=True, slots=True)
class Robot:
    """A robot of the team.

    Attributes:
        name: unique in the team.
        kind: name of its robot kind; empty until the scene is expanded.
        clearance: half the robot's diagonal plus the mission's position error, metres; the safety
            distance of each area comes on top.
        kinematics: None until the scene is expanded.
    """

    name: str
    type: RobotType
    home: Position
    return_home: bool
    payload: float
    travel_mode: TravelMode
    clearance: float
    kind: str = ""
    kinematics: Kinematics | None = None
    place: Place = Place()


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
class Policy:
    """What a robot does about a fault, once it has lasted `after` seconds (None: the platform's default)."""

    event: PolicyEvent
    response: PolicyResponse
    after: float | None = None


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


@dataclass(frozen=True, slots=True)
class ActionAt:
    """A device action along a stroke.

    Attributes:
        at: arc length from the stroke's first point, metres.
        device: identifier of the device; empty: the only one of the robot that supports the action.
        parameters: (key, value) pairs.
    """

    at: float
    action: str
    device: str = ""
    parameters: tuple[tuple[str, str], ...] = ()


@dataclass(frozen=True, slots=True)
class Look:
    """What a device points at on the way: a position, with the angle of BL's Heading in degrees."""

    at: Position
    device: str = ""
    angle_degrees: float = 0.0


@dataclass(frozen=True, slots=True)
class Stroke:
    """A stretch of work that is done in one go, in this direction unless reversible.

    Attributes:
        points: (east, north, up), at least one; consecutive points are joined by straight lines.
        actions: ordered by arc length.
        look: orientation on the way and while holding; None: the way the robot goes.
        speed: largest speed on it, metres per second; None: the robot's cruise.
        slow_down: factor on the robot's cruise speed, 0 to 1; None: 1. QUICK work has speed=inf.
        hold: seconds to hold at the last point, after which actions there are done.
        cuts: arc lengths inside the stroke at which the work may be split, ascending.
        reversible: whether it may be done from its last point to its first.
        object: description of an object to go up to after the last point; None: none.
        object_distance: metres from it at the end; object_tolerance: how far it may be from the
            last point, metres, None where unknown.
    """

    points: tuple[Position, ...]
    actions: tuple[ActionAt, ...] = ()
    look: Look | None = None
    speed: float | None = None
    slow_down: float | None = None
    hold: float = 0.0
    cuts: tuple[float, ...] = ()
    reversible: bool = False
    object: str | None = None
    object_distance: float = 0.0
    object_tolerance: float | None = None


@dataclass(frozen=True, slots=True)
class Coverage:
    """What area a work covers, for checks and reports.

    Attributes:
        shell, holes: the polygon asked for, (east, north).
        target: the parts of it that the robot's clearance leaves, as (shell, holes) polygons.
        width: of the strip that a stroke covers, metres, centred on the stroke; length: of what one
            action covers along the way, centred on the action's point; 0 where actions do not matter.
        unreachable: square metres of the polygon asked for that are outside the target.
    """

    shell: Ring
    holes: tuple[Ring, ...]
    target: tuple[tuple[Ring, tuple[Ring, ...]], ...]
    width: float
    length: float
    unreachable: float


@dataclass(frozen=True, slots=True)
class Work:
    """What a task is made of for one kind of robot; says nothing of who, when, or how to get there.

    Attributes:
        strokes: in an order that is good to follow; hops between them are routed by the planner.
        divisible: whether several robots, or several sorties, may share the strokes.
        ordered: whether the strokes must be done in this order.
        rule: name of the rule that made it.
        entry: where the first share begins before its first stroke; None: at the first stroke.
        coverage: for works over an area.
    """

    strokes: tuple[Stroke, ...]
    divisible: bool
    rule: str
    ordered: bool = True
    entry: Position | None = None
    coverage: Coverage | None = None


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

    def kept_from(self) -> Iterator[Area]:
        """Yield the areas that robots keep away from: forbidden ones and obstacles."""
        return (area for area in self.areas if area.use is not AreaUse.EMERGENCY)


@dataclass(frozen=True, slots=True)
class Step:
    """One item of a robot's plan, with the estimated times at which it begins and ends.

    Attributes:
        begin, end: seconds after the mission's start.
        task: the task that it serves or leads to; empty: none in particular.
    """

    begin: float
    end: float
    task: str


@dataclass(frozen=True, slots=True)
class Launch(Step):
    """Leaves home: from `at` on the ground straight up to the height `up`."""

    at: Position
    up: float


@dataclass(frozen=True, slots=True)
class Transit(Step):
    """Travels along straight legs; `route` begins where the robot is, at least two points.

    `speed`: commanded, metres per second; None: the robot's cruise.
    """

    route: tuple[Position, ...]
    speed: float | None = None


@dataclass(frozen=True, slots=True)
class Serve(Step):
    """Does a stroke; the robot is at its first point. `speed`: commanded, metres per second.

    `first` and `last` tell the robot's first and last stroke of this task.
    """

    stroke: Stroke
    speed: float
    rule: str
    first: bool = False
    last: bool = False


@dataclass(frozen=True, slots=True)
class Await(Step):
    """Waits, where it is, until every one of these signals was given.

    `until` is an earliest time that a clock, not a robot, ends the wait at; None: none.
    """

    signals: tuple[str, ...]
    until: float | None = None


@dataclass(frozen=True, slots=True)
class Signal(Step):
    """Tells other robots that this one's part of `task` has ended.

    Attributes:
        signal: unique in the plan.
        receivers: names of the robots that await it, at least one, not this one.
    """

    signal: str
    receivers: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Recover(Step):
    """Comes down where it is, from `at` to the height `up` of the ground there."""

    at: Position
    up: float


@dataclass(frozen=True, slots=True)
class Recharge(Step):
    """Waits at home for full batteries, after a recovery and before the next launch."""


@dataclass(frozen=True, slots=True)
class Branch(Step):
    """Does one of several sequences of steps, by conditions tested in order.

    Attributes:
        arms: (condition, steps); the condition of the last arm is None: the else arm. Every arm
            begins where the robot is and ends at `exit`.
    """

    arms: tuple[tuple[str | None, tuple[Step, ...]], ...]
    exit: Position


@dataclass(frozen=True, slots=True)
class RobotPlan:
    """What one robot does.

    Attributes:
        steps: in order; empty for a robot that is not needed.
        length: metres travelled; busy: seconds from launch to the last recovery; energy: joules;
            sorties: how many times it leaves home.
    """

    robot: str
    steps: tuple[Step, ...]
    length: float = 0.0
    busy: float = 0.0
    energy: float = 0.0
    sorties: int = 0


@dataclass(frozen=True, slots=True)
class Plan:
    """Who does what, when, and by which way.

    Attributes:
        robots: in the scene's order, robots without work included.
        makespan: seconds until the last robot has finished.
        begins, ends: by task, seconds after the mission's start.
        notes: assumptions that people must know, such as flat terrain.
    """

    robots: tuple[RobotPlan, ...]
    makespan: float
    begins: Mapping[str, float]
    ends: Mapping[str, float]
    notes: tuple[str, ...] = ()
