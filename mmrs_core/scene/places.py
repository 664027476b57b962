"""The frame of a scene, and the areas in it."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import Enum
from math import inf

from mmrs_core.scene.values import AltitudeReference, Part, Ring


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
        """Return whether robots of the type of that name must heed the area."""
        return self.types is None or robot_type in self.types


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
