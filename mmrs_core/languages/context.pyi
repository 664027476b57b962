"""Typed stubs of urn:mmrs:context:1.0, made by "mmrs metamodel stubs"; not to be edited."""

from collections.abc import Iterable
from typing import Final, Literal, TypeAlias

from mmrs_core.languages import mission
from mmrs_core.languages.element import Element

NS_URI: Final[str]

CorridorUse: TypeAlias = Literal["BOTH", "ENTRY", "EXIT"]
"""Directions in which robots may go through a corridor."""

class Context(mission.NamedElement):
    """The surroundings of a mission: areas to keep clear of, emergency areas, obstacles, and further elements."""
    crs: str | None
    """Coordinate reference system of the geographic coordinates of this model; absent: the mission's."""
    origin: mission.Coordinate | None
    """What relative coordinates of this model count from; absent: the mission's origin."""
    surfaceHeight: float
    """Height of the water surface above the mission's origin, in metres; depths count down from it."""
    forbiddenAreas: list[Area]
    """Areas that no robot may enter, at any height unless the area states heights."""
    emergencyAreas: list[Area]
    """Areas that robots may go to in an emergency."""
    obstacles: list[Obstacle]
    """Obstacles."""
    corridors: list[Corridor]
    """Corridors through which robots come from home to their tasks and go back; absent: they may take any path."""
    elements: list[ContextElement]
    """Further elements that missions refer to: relays of radios, and those of types that plug-ins add."""
    environment: Environment | None
    """Weather and water."""
    def __init__(
        self,
        *,
        name: str | None = ...,
        crs: str | None = ...,
        origin: mission.Coordinate | None = ...,
        surfaceHeight: float | None = ...,
        forbiddenAreas: Iterable[Area] | None = ...,
        emergencyAreas: Iterable[Area] | None = ...,
        obstacles: Iterable[Obstacle] | None = ...,
        corridors: Iterable[Corridor] | None = ...,
        elements: Iterable[ContextElement] | None = ...,
        environment: Environment | None = ...,
    ) -> None: ...

class Area(mission.NamedElement):
    """An area on the map."""
    shell: list[mission.Coordinate]
    """The border: its vertices in order, the last one joined to the first."""
    safetyDistance: float
    """Smallest distance between a robot and each side of the area, in metres."""
    def __init__(
        self,
        *,
        name: str | None = ...,
        shell: Iterable[mission.Coordinate] | None = ...,
        safetyDistance: float | None = ...,
    ) -> None: ...

class Obstacle(Area):
    """An area that is blocked between two heights."""
    minHeight: float | None
    """Height of its lower side above the mission's origin, in metres; absent: down to the ground and beyond."""
    maxHeight: float | None
    """Height of its upper side above the mission's origin, in metres; absent: unlimited."""
    def __init__(
        self,
        *,
        name: str | None = ...,
        shell: Iterable[mission.Coordinate] | None = ...,
        safetyDistance: float | None = ...,
        minHeight: float | None = ...,
        maxHeight: float | None = ...,
    ) -> None: ...

class Corridor(mission.NamedElement):
    """A passage between where robots start and where they work, such as an agreed piece of airspace, a harbour entrance or a gate. Every sortie leads through one whole corridor before its first task, and through one whole corridor back home after its last."""
    points: list[mission.Coordinate]
    """The centre line in the direction of entry, from outside to the field of work; heights of its positions do not count."""
    width: float
    """Distance between its two sides, in metres; robots keep their clearance from both."""
    minHeight: float | None
    """Height of its lower side above the mission's origin, in metres; absent: down to the ground and beyond."""
    maxHeight: float | None
    """Height of its upper side above the mission's origin, in metres; absent: unlimited."""
    use: CorridorUse
    """Directions in which robots may go through it."""
    robotTypes: list[str]
    """Names of the robot types that it is for; absent: all."""
    def __init__(
        self,
        *,
        name: str | None = ...,
        points: Iterable[mission.Coordinate] | None = ...,
        width: float | None = ...,
        minHeight: float | None = ...,
        maxHeight: float | None = ...,
        use: CorridorUse | None = ...,
        robotTypes: Iterable[str] | None = ...,
    ) -> None: ...

class ContextElement(mission.NamedElement):
    """An element of the surroundings; plug-ins extend it with panel groups, moorings, pipelines and the like."""
    def __init__(
        self,
        *,
        name: str | None = ...,
    ) -> None: ...

class Relay(ContextElement):
    """A relay that stands still, such as a mast, a moored boat or a parked vehicle: it passes on the radio between robots, other relays and the control station, which is at a robot's home. Two of them reach each other where their distance is at most the smaller of both ranges; the range of a robot, and of the control station for that robot, is the communicationRange of its type. A robot is in range where it reaches its home, or a relay from which a chain of relays leads there. A robot whose type has a relayRange is a relay, too, while it holds its position."""
    position: mission.Coordinate
    """Where its antenna is."""
    range: float
    """Maximum range of its radio, in metres."""
    def __init__(
        self,
        *,
        name: str | None = ...,
        position: mission.Coordinate | None = ...,
        range: float | None = ...,
    ) -> None: ...

class Environment(Element):
    """Weather and water during the mission; absent values are unknown."""
    windSpeed: float | None
    """Wind speed, in metres per second."""
    windDirection: float | None
    """Direction that the wind comes from, in degrees clockwise from north."""
    temperature: float | None
    """Temperature of the air or water, in degrees Celsius."""
    currentSpeed: float | None
    """Speed of the water current, in metres per second."""
    currentDirection: float | None
    """Direction that the current flows to, in degrees clockwise from north."""
    waterDensity: float | None
    """Density of the water, in kilograms per cubic metre: about 1025 for sea water, 1000 for fresh water."""
    irradiance: float | None
    """Solar irradiance, in watts per square metre."""
    def __init__(
        self,
        *,
        windSpeed: float | None = ...,
        windDirection: float | None = ...,
        temperature: float | None = ...,
        currentSpeed: float | None = ...,
        currentDirection: float | None = ...,
        waterDensity: float | None = ...,
        irradiance: float | None = ...,
    ) -> None: ...
