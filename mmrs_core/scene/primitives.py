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
