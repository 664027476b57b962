"""Heights of drawings as heights above the origin of a mission, and as altitudes in its models."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from mmrs_core.drawings.drawing import HeightReference

if TYPE_CHECKING:
    from mmrs_core.scene import AltitudeReference

MILLIMETRES = 3


@dataclass(frozen=True, slots=True)
class Levels:
    """What altitudes count from.

    Attributes:
        reference: of the altitudes in the models.
        origin: altitude of the origin; None where it is not known.
        separation: of mean sea level from the ellipsoid, metres; None where it is not known.
    """

    reference: AltitudeReference = "ORIGIN"
    origin: float | None = 0.0
    separation: float | None = None

    def above_origin(self, reference: HeightReference) -> float | None:
        """Return what is to be added to heights to get heights above the origin; None where that is unknown.

        The ground is taken to be level, at the height of the origin, and so are homes.
        """
        if reference in (HeightReference.GROUND, HeightReference.HOME):
            return 0.0
        if self.origin is None or self.reference == "ORIGIN" or reference is HeightReference.NONE:
            return None
        own = HeightReference.SEA_LEVEL if self.reference == "MSL" else HeightReference.ELLIPSOID
        if reference is own:
            return -self.origin
        if self.separation is None:
            return None
        sea_level = self.origin - (self.separation if self.reference == "ELLIPSOID" else 0.0)
        return -sea_level if reference is HeightReference.SEA_LEVEL else -(sea_level + self.separation)

    def altitude(self, up: float) -> float | None:
        """Return the altitude at a height above the origin; None where it cannot be given."""
        if self.reference == "ORIGIN":
            return round(up, MILLIMETRES)
        return None if self.origin is None else round(self.origin + up, MILLIMETRES)


def levels_at(reference: HeightReference, height: float | None) -> Levels:
    """Return the levels of a new mission, by the height of the home that is its origin."""
    if height is not None and reference is HeightReference.SEA_LEVEL:
        return Levels("MSL", height)
    if height is not None and reference is HeightReference.ELLIPSOID:
        return Levels("ELLIPSOID", height)
    return Levels()
