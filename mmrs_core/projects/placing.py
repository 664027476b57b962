"""Where an element stands: its positions, its height, and the coordinates that state both."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from mmrs_core.behaviour.earth import from_wgs84
from mmrs_core.drawings.drawing import Geometry, HeightReference, MapFeature
from mmrs_core.languages.element import Element, metaclass_of
from mmrs_core.languages.metaclass import Metaclass
from mmrs_core.projects.attributes import decided
from mmrs_core.projects.choosing import quoted, shape_of
from mmrs_core.projects.heights import Levels
from mmrs_core.projects.kinds import MISSION, Kind
from mmrs_core.projects.shapes import DECIMALS, DrawnShape, Floats, UnfitError, around, begin_of, shape

if TYPE_CHECKING:
    from mmrs_core.languages.registry import Registry

SHUT = ("forbiddenAreas", "obstacles")
"""Features of a context that hold what robots must not enter."""

RALLY_RADIUS = 10.0
"""Metres around a point that is to be an emergency area, of which clearances leave something."""


@dataclass(frozen=True, slots=True)
class Basis:
    """What all elements of an import share.

    Attributes:
        levels: what heights count from.
        altitude: height above the origin of tasks that are drawn without one, metres.
        flies: whether a robot of the team does; otherwise such tasks are on the ground.
        tolerance: of simplified borders, metres.
        home: latitude and longitude of the first robot's home; None without robots.
        crs: of the coordinates of the mission, and of the context.
    """

    levels: Levels
    altitude: float
    flies: bool
    tolerance: float | None
    home: Floats | None
    crs: Mapping[str, str]


class Placing:
    """Places elements.

    Attributes:
        closed: rings of what robots must not enter; tasks begin off these.
    """

    def __init__(self, registry: Registry, basis: Basis, closed: Sequence[Floats]) -> None:
        self.closed = [*closed]
        self._registry = registry
        self._basis = basis

    def coordinate(self, latitude: float, longitude: float, up: float = 0.0, of: str = "tasks") -> Element:
        """Return a coordinate in the crs of the mission, or of the context."""
        longitude, latitude = from_wgs84(self._basis.crs[of]).transform(longitude, latitude)
        altitude = self._basis.levels.altitude(up) if up else None
        return self._registry.create(
            MISSION,
            "GeoCoordinate",
            latitude=round(latitude, DECIMALS),
            longitude=round(longitude, DECIMALS),
            altitude=altitude,
        )

    def shape(self, feature: MapFeature, kind: Kind, attributes: dict[str, tuple[str, ...]]) -> DrawnShape:
        """Return the positions of the element; the attributes lose the radius around points and lines."""
        drawn = shape_of(feature)
        if not kind.surrounds or feature.geometry is Geometry.AREA:
            found = shape(
                feature,
                drawn if drawn in kind.shapes else feature.geometry,
                self._basis.tolerance,
                covering=kind.feature in SHUT,
            )
            if kind.surrounds and len(found.rings) > 1:
                if kind.feature == "emergencyAreas":
                    raise UnfitError("an emergency area cannot have holes: draw it without them")
                notes = (*found.notes, f"a {kind.name} has no holes: these are closed, too")
                return DrawnShape(found.geometry, found.rings[:1], found.heights, found.reference, notes)
            return found
        shape(feature, feature.geometry, None)  # is it on the Earth?
        texts = attributes.pop("radius", ()) or (str(feature.radius or feature.properties.get("radius", "")),)
        emergency = kind.feature == "emergencyAreas"
        if not texts[-1] and not emergency:
            word = "obstacle" if kind.name == "obstacle" else "forbidden"
            advice = f"--as {quoted(feature.name)}={word}:radius=METRES"
            raise UnfitError(f"a {feature.geometry.value} has no extent; {advice} gives it one")
        try:
            radius = float(texts[-1]) if texts[-1] else RALLY_RADIUS
        except ValueError:
            raise UnfitError(f"radius {texts[-1][:20]}: not a number of metres") from None
        ring = around(feature, radius, covering=not emergency)
        top = feature.heights[0].max().repeat(len(ring)) if feature.heights else None
        return DrawnShape(Geometry.AREA, (ring,), top, feature.reference, (f"{radius:g} m around it",))

    def heights(
        self,
        element: Element,
        kind: Kind,
        found: DrawnShape,
        given: Mapping[str, object],
        notes: list[str],
        *,
        usual: bool,
    ) -> Floats | None:
        """Set the height of an element; return the heights of its coordinates, if they have any.

        Args:
            usual: whether it has the usual height where it has none.
        """
        ups = self._settled(found, notes)
        usual = usual or (ups is None and found.heights is not None and bool(found.heights.any()))
        if kind.feature == "obstacles":
            if ups is not None and "maxHeight" not in given:
                element.maxHeight = round(float(ups.max()), 3)  # type: ignore[attr-defined]  # obstacles have one
            if getattr(element, "maxHeight", None) is None:
                notes.append("without a height, it is closed at every height")
            return None
        if kind.feature != "tasks":
            if ups is not None and kind.surrounds:
                notes.append(
                    "it is closed at every height"
                    if kind.name == "forbidden area"
                    else "its height is left out"
                )
            return None if kind.surrounds else ups
        name = kind.symbol.height if kind.symbol is not None else ""
        height = self._basis.altitude if self._basis.flies and usual else 0.0
        settled = name in decided(kind, given) or (ups is None and not usual)
        optional = not name or settled or not metaclass_of(element).feature(name).required
        has_own = found.geometry is not Geometry.AREA
        writable = self._basis.levels.altitude(height) is not None
        if has_own and ups is not None and optional and writable:
            return ups
        if name and not settled and getattr(element, name) is None:
            setattr(element, name, round(float(ups.max()), 3) if ups is not None else height)
        elif not name and has_own and (height or ups is not None):
            if writable:
                return np.full(len(found.rings[0]), height)
            notes.append("its height is left out: that of the origin is not known")
        return None

    def _settled(self, found: DrawnShape, notes: list[str]) -> Floats | None:
        """Return heights above the origin; None where there are none, or they are all on the ground."""
        if found.heights is None:
            return None
        base = self._basis.levels.above_origin(found.reference)
        if base is None:
            if found.heights.any():
                words = f"heights above {found.reference.value} are left out"
                notes.append(f"{words}: that of the origin is not known")
            return None
        ups = found.heights + base
        on_ground = found.reference in (HeightReference.GROUND, HeightReference.HOME) and not ups.any()
        return None if on_ground or not np.isfinite(ups).all() else ups

    def place(
        self, element: Element, kind: Kind, found: DrawnShape, ups: Floats | None, notes: list[str]
    ) -> None:
        """Give an element its coordinates, with heights above the origin where it has any."""
        metaclass = metaclass_of(element)
        at = kind.shapes[found.geometry]
        of = "tasks" if kind.feature == "tasks" else "context"
        outer = found.rings[0]
        made = [
            self.coordinate(float(latitude), float(longitude), 0.0 if ups is None else float(ups[number]), of)
            for number, (latitude, longitude) in enumerate(outer)
        ]
        if at.many and at.most > 0 and len(made) > at.most:
            notes.append(f"{kind.name} takes {at.most} positions, so only the first and the last are used")
            made = [made[0], made[-1]]
        setattr(element, at.attribute, made if at.many else made[0])
        if "initialPosition" in metaclass.by_name:
            first = begin_of(outer, self._basis.home, self.closed) if found.geometry is Geometry.AREA else 0
            up = 0.0 if ups is None else float(ups[first])
            element.initialPosition = self.coordinate(float(outer[first][0]), float(outer[first][1]), up, of)  # type: ignore[attr-defined]
        if len(found.rings) > 1 and "holes" in metaclass.by_name:
            holes = metaclass.by_name["holes"]
            assert isinstance(holes.type, Metaclass)  # rings
            for ring in found.rings[1:]:
                points = [self.coordinate(float(each[0]), float(each[1]), 0.0, of) for each in ring]
                getattr(element, holes.attribute).append(
                    self._registry.create(*holes.type.key, points=points)
                )
        elif len(found.rings) > 1:
            notes.append(f"{kind.name} has no holes: these are left out")
