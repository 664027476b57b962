"""Typed stubs of urn:mmrs:mission:1.0, made by "mmrs metamodel stubs"; not to be edited."""

from collections.abc import Iterable
from typing import Final

from mmrs_core.languages import robot
from mmrs_core.languages.element import Element

NS_URI: Final[str]

class NamedElement(Element):
    """Anything that may have a name."""
    name: str | None
    """Name for people and messages; unique among its siblings where another element refers to it."""
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
    """What is to be done."""
    taskDependencies: list[TaskDependency]
    """Which task begins only after which other has ended."""
    origin: Coordinate | None
    """The point (0, 0, 0) of the local metric frame; absent: the home of the first robot. A relative origin makes the mission a local one, without geographic coordinates."""
    altitudeReference: robot.AltitudeReference
    """What the altitudes of geographic coordinates are measured from."""
    geoidSeparation: float | None
    """Height of mean sea level above the ellipsoid at the origin, in metres; absent: not known."""
    transitAltitude: float | None
    """Height above the origin at which robots travel between tasks, in metres, where the robot kind can choose; absent: the height of the next task."""
    positionError: float
    """How far a robot may be from where it believes to be, in metres; added to every clearance."""
    minimumSeparation: float | None
    """Smallest distance allowed between two robots, in metres; absent: not checked."""
    largestGap: float | None
    """Largest distance that is meant from a place of the mission or its context to the next one, in metres; absent: 100000. What lies farther off is an error."""
    reserve: float
    """Part of a robot's lifetime and energy that a plan must leave unused, from 0 to 1."""
    policies: list[robot.Policy]
    """What robots do when something goes wrong; goes before the policies of their types."""
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
    """Where the robot starts."""
    type: str
    """Name of the robot's type in the Robot Language."""
    returnHome: bool
    """Whether the robot goes back to its home at the end."""
    payload: float
    """Weight of what the robot carries beside its own devices, in kilograms."""
    travelMode: robot.TravelMode
    """How the robot trades speed against caution."""
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
    """Something to be done. Task types are added by extending PointTask, LineTask, PolygonTask or this class."""
    robotsWanted: int | None
    """How many robots share the task; absent: as many as help to end early."""
    requiredDevices: list[str]
    """Identifiers of devices that a robot must have to do the task."""
    requiredActions: list[str]
    """Names of device actions that a robot must support to do the task."""
    earliestStart: float | None
    """The task begins no sooner than so many seconds after the mission's start."""
    deadline: float | None
    """The task ends no later than so many seconds after the mission's start."""
    maxDuration: float | None
    """The task takes no longer than so many seconds from its begin to its end."""
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
    """Where the task is done."""
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
    """Where the robot begins the task; the way to the first point leads from here."""
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
    """Where the robot that takes the first share begins the task."""
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
    """A task that takes no time and controls when others are done."""
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
    """Identifier of the condition under which this way out of a Fork is taken; among the ways out of such a Fork exactly one has none: it is taken when no other is."""
    def __init__(
        self,
        *,
        name: str | None = ...,
        from_: Task | None = ...,
        to: Task | None = ...,
        condition: str | None = ...,
    ) -> None: ...
