"""Typed stubs of urn:mmrs:mission:1.0, made by "mmrs metamodel stubs"; not to be edited."""

from collections.abc import Iterable
from typing import Final, Literal, TypeAlias

from mmrs_core.languages import robot
from mmrs_core.languages.element import Element

NS_URI: Final[str]

StartCorner: TypeAlias = Literal["NEAREST", "NORTH_WEST", "NORTH_EAST", "SOUTH_EAST", "SOUTH_WEST"]
"""Where the first swath of an area begins."""

class NamedElement(Element):
    """An element that may have a name."""
    name: str | None
    """Name shown on maps and in messages; unique among its siblings where another element refers to it."""
    def __init__(
        self,
        *,
        name: str | None = ...,
    ) -> None: ...

class Mission(NamedElement):
    """A mission: tasks, their order, and the team that carries them out."""
    crs: str
    """Coordinate reference system of all geographic coordinates: an EPSG code, WKT, or the alias wgs84."""
    team: Team
    """The robots of the mission."""
    tasks: list[Task]
    """The tasks."""
    taskDependencies: list[TaskDependency]
    """Order of the tasks."""
    origin: Coordinate | None
    """The point (0, 0, 0) of the local metric frame; absent: the home of the first robot. A relative origin makes the mission a local one, without geographic coordinates."""
    altitudeReference: robot.AltitudeReference
    """Reference of the altitudes of geographic coordinates."""
    geoidSeparation: float | None
    """Height of mean sea level above the ellipsoid at the origin, in metres; absent: unknown."""
    transitAltitude: float | None
    """Height above the origin at which robots travel between tasks, in metres, where the robot kind can choose; absent: the height of the next task."""
    positionError: float
    """Largest error of a robot's position estimate, in metres; added to every clearance."""
    minimumSeparation: float | None
    """Smallest distance allowed between two robots, in metres; absent: not checked."""
    largestGap: float | None
    """Largest plausible distance from a position of the mission or its context to the nearest other one, in metres; absent: 100000. A position farther off is an error."""
    reserve: float
    """Fraction of a robot's lifetime and energy that a plan must leave unused, from 0 to 1."""
    policies: list[robot.Policy]
    """Responses to faults; they take precedence over the policies of robot types."""
    acceptedUnknowns: list[str]
    """Names of the properties that may remain unknown when the plan is verified, such as clearance or energy; any other unknown refuses the plan."""
    def __init__(
        self,
        *,
        name: str | None = ...,
        crs: str | None = ...,
        team: Team | None = ...,
        tasks: Iterable[Task] | None = ...,
        taskDependencies: Iterable[TaskDependency] | None = ...,
        origin: Coordinate | None = ...,
        altitudeReference: robot.AltitudeReference | None = ...,
        geoidSeparation: float | None = ...,
        transitAltitude: float | None = ...,
        positionError: float | None = ...,
        minimumSeparation: float | None = ...,
        largestGap: float | None = ...,
        reserve: float | None = ...,
        policies: Iterable[robot.Policy] | None = ...,
        acceptedUnknowns: Iterable[str] | None = ...,
    ) -> None: ...

class Team(Element):
    """The robots that carry out a mission."""
    robots: list[Robot]
    """The members of the team."""
    def __init__(
        self,
        *,
        robots: Iterable[Robot] | None = ...,
    ) -> None: ...

class Robot(NamedElement):
    """One robot of the team."""
    home: Coordinate
    """Position where the robot starts."""
    type: str
    """Name of the robot type in the Robot Language."""
    returnHome: bool
    """Whether the robot returns to its home at the end."""
    payload: float
    """Weight of the robot's payload in addition to its own devices, in kilograms."""
    travelMode: robot.TravelMode
    """Trade-off between speed and caution."""
    def __init__(
        self,
        *,
        name: str | None = ...,
        home: Coordinate | None = ...,
        type: str | None = ...,
        returnHome: bool | None = ...,
        payload: float | None = ...,
        travelMode: robot.TravelMode | None = ...,
    ) -> None: ...

class Coordinate(Element):
    """A position."""
    def __init__(
        self,
    ) -> None: ...

class GeoCoordinate(Coordinate):
    """A geographic position in the coordinate reference system of its model."""
    latitude: float
    """Geographic latitude, in degrees, north positive."""
    longitude: float
    """Geographic longitude, in degrees, east positive."""
    altitude: float | None
    """Height above the mission's altitude reference, in metres; absent: at the height of the origin. Not together with depth."""
    depth: float | None
    """Vertical distance below the surface of ground or water, in metres. Not together with altitude."""
    def __init__(
        self,
        *,
        latitude: float | None = ...,
        longitude: float | None = ...,
        altitude: float | None = ...,
        depth: float | None = ...,
    ) -> None: ...

class RelativeCoordinate(Coordinate):
    """A position relative to another one."""
    x: float
    """Metres to the east of the reference."""
    y: float
    """Metres to the north of the reference."""
    z: float
    """Metres above the reference."""
    reference: Coordinate | None
    """The coordinate that x, y and z count from; absent: the origin of the model."""
    def __init__(
        self,
        *,
        x: float | None = ...,
        y: float | None = ...,
        z: float | None = ...,
        reference: Coordinate | None = ...,
    ) -> None: ...

class Task(NamedElement):
    """A task. New task types extend PointTask, LineTask, PolygonTask, SweepTask or this class."""
    robotsWanted: int | None
    """Number of robots that share the task; absent: as many as shorten the mission."""
    requiredDevices: list[str]
    """Identifiers of devices that a robot must have to do the task."""
    requiredActions: list[str]
    """Names of device actions that a robot must support to do the task."""
    earliestStart: float | None
    """Earliest start of the task, in seconds after the mission's start."""
    deadline: float | None
    """Latest end of the task, in seconds after the mission's start."""
    maxDuration: float | None
    """Longest duration of the task, in seconds."""
    priority: int
    """Among tasks that could come next, the one of higher priority comes first."""
    def __init__(
        self,
        *,
        name: str | None = ...,
        robotsWanted: int | None = ...,
        requiredDevices: Iterable[str] | None = ...,
        requiredActions: Iterable[str] | None = ...,
        earliestStart: float | None = ...,
        deadline: float | None = ...,
        maxDuration: float | None = ...,
        priority: int | None = ...,
    ) -> None: ...

class PointTask(Task):
    """A task at a point."""
    point: Coordinate
    """Position of the task."""
    def __init__(
        self,
        *,
        name: str | None = ...,
        robotsWanted: int | None = ...,
        requiredDevices: Iterable[str] | None = ...,
        requiredActions: Iterable[str] | None = ...,
        earliestStart: float | None = ...,
        deadline: float | None = ...,
        maxDuration: float | None = ...,
        priority: int | None = ...,
        point: Coordinate | None = ...,
    ) -> None: ...

class LineTask(Task):
    """A task along a polyline."""
    initialPosition: Coordinate
    """Position where the robot begins the task; its path to the first point leads from here."""
    points: list[Coordinate]
    """The vertices of the polyline, in order."""
    def __init__(
        self,
        *,
        name: str | None = ...,
        robotsWanted: int | None = ...,
        requiredDevices: Iterable[str] | None = ...,
        requiredActions: Iterable[str] | None = ...,
        earliestStart: float | None = ...,
        deadline: float | None = ...,
        maxDuration: float | None = ...,
        priority: int | None = ...,
        initialPosition: Coordinate | None = ...,
        points: Iterable[Coordinate] | None = ...,
    ) -> None: ...

class PolygonTask(Task):
    """A task over an area."""
    initialPosition: Coordinate
    """Position where the robot with the first share begins the task."""
    shell: list[Coordinate]
    """The border of the area: its vertices in order, the last one joined to the first."""
    holes: list[Ring]
    """Parts inside the shell that do not belong to the area."""
    def __init__(
        self,
        *,
        name: str | None = ...,
        robotsWanted: int | None = ...,
        requiredDevices: Iterable[str] | None = ...,
        requiredActions: Iterable[str] | None = ...,
        earliestStart: float | None = ...,
        deadline: float | None = ...,
        maxDuration: float | None = ...,
        priority: int | None = ...,
        initialPosition: Coordinate | None = ...,
        shell: Iterable[Coordinate] | None = ...,
        holes: Iterable[Ring] | None = ...,
    ) -> None: ...

class SweepTask(PolygonTask):
    """A task that covers an area in parallel swaths."""
    swathAngle: float | None
    """Direction of the swaths, in degrees clockwise from north; absent: the one that is flown soonest."""
    crossHatch: bool
    """Whether the area is covered a second time, across the first swaths."""
    startCorner: StartCorner
    """Corner of the area at which the first swath begins."""
    turnaroundDistance: float
    """Distance by which each swath is extended beyond both ends, in metres; less where an area is in the way."""
    alternateSwaths: bool
    """Whether every other swath is skipped, and covered on the return, for robots with wide turns."""
    def __init__(
        self,
        *,
        name: str | None = ...,
        robotsWanted: int | None = ...,
        requiredDevices: Iterable[str] | None = ...,
        requiredActions: Iterable[str] | None = ...,
        earliestStart: float | None = ...,
        deadline: float | None = ...,
        maxDuration: float | None = ...,
        priority: int | None = ...,
        initialPosition: Coordinate | None = ...,
        shell: Iterable[Coordinate] | None = ...,
        holes: Iterable[Ring] | None = ...,
        swathAngle: float | None = ...,
        crossHatch: bool | None = ...,
        startCorner: StartCorner | None = ...,
        turnaroundDistance: float | None = ...,
        alternateSwaths: bool | None = ...,
    ) -> None: ...

class Ring(Element):
    """A closed border."""
    points: list[Coordinate]
    """Its vertices in order, the last one joined to the first."""
    def __init__(
        self,
        *,
        points: Iterable[Coordinate] | None = ...,
    ) -> None: ...

class ControlTask(Task):
    """A task that takes no time and controls when others begin."""
    def __init__(
        self,
        *,
        name: str | None = ...,
        robotsWanted: int | None = ...,
        requiredDevices: Iterable[str] | None = ...,
        requiredActions: Iterable[str] | None = ...,
        earliestStart: float | None = ...,
        deadline: float | None = ...,
        maxDuration: float | None = ...,
        priority: int | None = ...,
    ) -> None: ...

class Fork(ControlTask):
    """Releases all its successors when its predecessors have ended."""
    def __init__(
        self,
        *,
        name: str | None = ...,
        robotsWanted: int | None = ...,
        requiredDevices: Iterable[str] | None = ...,
        requiredActions: Iterable[str] | None = ...,
        earliestStart: float | None = ...,
        deadline: float | None = ...,
        maxDuration: float | None = ...,
        priority: int | None = ...,
    ) -> None: ...

class Join(ControlTask):
    """Ends when all its predecessors have ended."""
    def __init__(
        self,
        *,
        name: str | None = ...,
        robotsWanted: int | None = ...,
        requiredDevices: Iterable[str] | None = ...,
        requiredActions: Iterable[str] | None = ...,
        earliestStart: float | None = ...,
        deadline: float | None = ...,
        maxDuration: float | None = ...,
        priority: int | None = ...,
    ) -> None: ...

class TaskDependency(NamedElement):
    """No part of one task begins before the other has ended."""
    from_: Task
    """The task that must have ended."""
    to: Task
    """The task that begins afterwards."""
    condition: str | None
    """Identifier of the condition under which this outgoing branch of a Fork is taken; among the branches of such a Fork exactly one has none: it is taken when no other is."""
    def __init__(
        self,
        *,
        name: str | None = ...,
        from_: Task | None = ...,
        to: Task | None = ...,
        condition: str | None = ...,
    ) -> None: ...
