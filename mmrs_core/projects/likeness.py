"""Whether elements are drawn alike: the same positions, from whichever corner an area begins at."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import isclose
from typing import TypeAlias

from mmrs_core.behaviour.earth import wgs84_of
from mmrs_core.grounding.coordinates import ground_of
from mmrs_core.grounding.features import number
from mmrs_core.grounding.frame import is_relative
from mmrs_core.languages.element import (
    Element,
    container_of,
    containing_feature,
    descendants,
    is_kind,
    label_of,
    metaclass_of,
)
from mmrs_core.projects.kinds import CONTEXT, MISSION
from mmrs_core.projects.shapes import DECIMALS

Position: TypeAlias = tuple[float | None, float | None]
_DRAWN = ((MISSION, "Task"), (CONTEXT, "Area"), (CONTEXT, "ContextElement"))
_EXPORTED = 9
"""Decimals of degrees in drawings that are exported."""
_ROUNDED = 1e-3
"""Metres by which heights that are the same may differ, as files round them."""


class DrawnElements:
    """The elements of a mission and its context that have positions."""

    def __init__(self, mission: Element, context: Element) -> None:
        self._places = dict(_relative_places(mission, context))
        self._known: dict[frozenset[Position], list[Element]] = {}
        for root in (mission, context):
            for each in descendants(root):
                if any(is_kind(each, *key) for key in _DRAWN):
                    self.add(each)

    def add(self, element: Element) -> None:
        """Note an element."""
        self._known.setdefault(frozenset(self.positions(element)), []).append(element)

    def alike(self, element: Element, name: str, *, area: bool) -> list[Element]:
        """Return those drawn as an element is: those of its class and its drawn name first."""
        sides = self._sides if area else self.positions
        drawn = sides(element)
        return sorted(
            (
                each
                for each in self._known.get(frozenset(self.positions(element)), ())
                if sides(each) == drawn
            ),
            key=lambda each: (metaclass_of(each) is not metaclass_of(element), label_of(each) != name),
        )

    def positions(self, element: Element) -> list[Position]:
        """Return latitude and longitude of everything in an element, except where robots begin."""
        return [self._places.get(each) or position_of(each) for each in _coordinates(element)]

    def _sides(self, element: Element) -> set[frozenset[Position]]:
        """Return the sides of rings, from whichever corner and whichever way round they are drawn."""
        rings: dict[Element | None, list[Position]] = {}
        for coordinate, position in zip(_coordinates(element), self.positions(element), strict=True):
            rings.setdefault(container_of(coordinate), []).append(position)
        return {
            frozenset(side)
            for ring in rings.values()
            for side in zip(ring, (*ring[1:], ring[0]), strict=True)
            if side[0] != side[1]
        }


def differences(element: Element, other: Element, stated: Mapping[str, object]) -> list[str]:
    """Return what another element that is drawn alike has instead of what is stated of an element.

    Heights are compared where both state altitudes.
    """
    there = {name: getattr(other, name, None) for name in stated}
    found = [
        f"{name} {there[name]} instead of {value}"
        for name, value in stated.items()
        if not _equal(there[name], value)
    ]
    heights = [[number(at, "altitude") or 0.0 for at in _coordinates(each)] for each in (element, other)]
    otherwise = any(is_relative(at) or number(at, "depth") is not None for at in _coordinates(other))
    if any(heights[0]) and not otherwise and not all(map(_equal, *heights)):
        found.append("other heights")
    return found


def position_of(coordinate: Element | None) -> Position:
    """Return latitude and longitude of a coordinate, as far as it has them."""
    if coordinate is None or not is_kind(coordinate, MISSION, "GeoCoordinate"):
        return None, None
    return number(coordinate, "latitude"), number(coordinate, "longitude")


def _relative_places(mission: Element, context: Element) -> Iterator[tuple[Element, Position]]:
    """Yield latitude and longitude of relative coordinates, as a drawing that is exported has them."""
    relative = [at for root in (mission, context) for at in descendants(root) if is_relative(at)]
    if not relative:
        return
    ground = ground_of(mission, context)
    placed = [at for at in relative if at in ground.positions and ground.frame.latitude is not None]
    degrees = wgs84_of([ground.positions[at][:2] for at in placed], ground.frame) if placed else ()
    for at, (latitude, longitude) in zip(placed, degrees, strict=True):
        yield at, (_as_drawn(float(latitude)), _as_drawn(float(longitude)))


def _as_drawn(degrees: float) -> float:
    return round(round(degrees, _EXPORTED), DECIMALS)


def _equal(one: object, two: object) -> bool:
    if isinstance(one, float) and isinstance(two, float):
        return isclose(one, two, abs_tol=_ROUNDED)
    return str(one) == str(two)


def _coordinates(element: Element) -> Iterator[Element]:
    for each in descendants(element):
        at = containing_feature(each)
        placed = is_kind(each, MISSION, "GeoCoordinate") or is_relative(each)
        if placed and at is not None and at.name != "initialPosition":
            yield each
