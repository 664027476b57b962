"""Words of the whole scene: positions, names of metaclasses, model elements as stages see them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal, TypeAlias

from mmrs_core.diagnostics import Place

Position: TypeAlias = tuple[float, float, float]
Point: TypeAlias = tuple[float, float]
Ring: TypeAlias = tuple[Point, ...]
Name: TypeAlias = tuple[str, str]
Metaclasses: TypeAlias = tuple[Name, ...]

TravelMode: TypeAlias = Literal["SAFE", "NORMAL", "AGGRESSIVE"]
AltitudeReference: TypeAlias = Literal["ELLIPSOID", "MSL", "ORIGIN"]
PolicyEvent: TypeAlias = Literal[
    "LINK_LOST",
    "PEER_LOST",
    "BATTERY_LOW",
    "WAIT_TOO_LONG",
    "DEVICE_SILENT",
    "POSITION_LOST",
    "OBSTACLE",
    "FENCE_BREACHED",
    "VEHICLE_RESTARTED",
    "LOG_FAILED",
    "GROUND_LOST",
]
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
