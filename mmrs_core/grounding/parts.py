"""Model elements as later stages see them: values without a model behind them."""

from __future__ import annotations

from collections.abc import Container, Iterable, Mapping
from itertools import chain
from math import inf
from typing import TypeVar, get_args

from mmrs_core.grounding.coordinates import Ground
from mmrs_core.grounding.features import children, literal, number, texts
from mmrs_core.grounding.frame import MISSION, is_geographic, is_relative
from mmrs_core.languages.element import Element, containing_feature, label_of, metaclass_of, path_of, place_of
from mmrs_core.languages.metaclass import Feature
from mmrs_core.scene import Area, AreaUse, Corridor, CorridorUse, Frame, Part, Position, Ring, Value

Vertex = TypeVar("Vertex")
NO_GROUND = Ground(Frame("EPSG:4326", None, None), {})
"""The ground of models without coordinates, such as robot types."""

_USES = {
    "forbiddenAreas": AreaUse.FORBIDDEN,
    "obstacles": AreaUse.OBSTACLE,
    "emergencyAreas": AreaUse.EMERGENCY,
}


def part_of(element: Element, ground: Ground) -> Part:
    """Return an element with all that it contains.

    A coordinate becomes its position, be it contained or referred to, and so does whatever else the ground
    has a position for. A reference to anything else
    becomes the name of what it leads to, or its path where it has none. Vertices of rings are given
    once: neither the first again at the end nor one directly after itself.

    Raises:
        ValueError: if its metamodel is not installed, or a coordinate has no position.
    """
    metaclass = metaclass_of(element)
    attributes = {
        feature.name: _value(element, feature, ground)
        for feature in metaclass.features
        if not feature.is_container
    }
    return Part(metaclass.ancestry, attributes, place_of(element))


def _value(element: Element, feature: Feature, ground: Ground) -> Value:
    found: object = getattr(element, feature.attribute)
    if not feature.many:
        return _single(found, feature, ground)
    values: tuple[Value, ...] = tuple(_single(each, feature, ground) for each in _listed(found))
    return tuple(without_repeats(values)) if _is_ring(feature) else values


def _listed(found: object) -> tuple[object, ...]:
    return tuple(found) if isinstance(found, Iterable) else ()


def _is_ring(feature: Feature) -> bool:
    return feature.name == "shell" or feature.owner.key == (MISSION, "Ring")


def _single(found: object, feature: Feature, ground: Ground) -> Value:
    if isinstance(found, Element):
        if found in ground.positions or is_geographic(found) or is_relative(found):
            return position_of(found, ground)
        return part_of(found, ground) if feature.containment else label_of(found) or path_of(found)
    return found if found is None or isinstance(found, (bool, int, float, str)) else str(found)


def position_of(coordinate: Element, ground: Ground) -> Position:
    """Return where a coordinate lies.

    Raises:
        ValueError: if it has no position.
    """
    try:
        return ground.positions[coordinate]
    except KeyError:
        raise ValueError(f"{place_of(coordinate).path}: has no position") from None


def ring_of(coordinates: Iterable[Element], positions: Mapping[Element, Position]) -> Ring:
    """Return (east, north) of the vertices that have a position, each once."""
    placed = (positions[each] for each in coordinates if each in positions)
    return tuple(without_repeats((east, north) for east, north, _ in placed))


def without_repeats(vertices: Iterable[Vertex]) -> list[Vertex]:
    """Return the vertices of a ring without those that only repeat the one before."""
    kept: list[Vertex] = []
    for vertex in vertices:
        if not kept or vertex != kept[-1]:
            kept.append(vertex)
    while len(kept) > 1 and kept[0] == kept[-1]:
        kept.pop()
    return kept


def use_of(area: Element) -> AreaUse:
    """Return what an area means, by the list of the context that it stands in.

    Raises:
        ValueError: if it stands in none of them.
    """
    feature = containing_feature(area)
    if feature is None or feature.name not in _USES:
        raise ValueError(f"{path_of(area)}: is neither a forbidden nor an emergency area nor an obstacle")
    return _USES[feature.name]


def heights_of(area: Element) -> tuple[float, float]:
    """Return the heights of the lower and upper side of an area or corridor.

    Metres above the origin; infinite if absent.
    """
    low, high = number(area, "minHeight"), number(area, "maxHeight")
    return -inf if low is None else low, inf if high is None else high


def area_of(area: Element, ground: Ground, name: str = "") -> Area:
    """Return an area of the context as drawn.

    Args:
        area: a context.Area inside a context.
        ground: of the context's coordinates.
        name: instead of its own; without either it is named after its place in the list.

    Raises:
        ValueError: if it stands in no list of areas, or a vertex has no position.
    """
    low, high = heights_of(area)
    use = use_of(area)
    part = part_of(area, ground)
    return Area(
        name=name or label_of(area) or path_of(area).lstrip("/"),
        use=use,
        shell=ring_of(children(area, "shell"), ground.positions),
        low=low,
        high=high,
        safety_distance=number(area, "safetyDistance") or 0.0,
        part=part,
    )


_CORRIDOR_USES: tuple[CorridorUse, ...] = get_args(CorridorUse)


def corridor_of(corridor: Element, ground: Ground, name: str = "") -> Corridor:
    """Return a corridor of the context as drawn.

    Args:
        corridor: a context.Corridor.
        ground: of the context's coordinates.
        name: instead of its own; without either it is named after its place in the list.

    Raises:
        ValueError: if a place of its line has no position.
    """
    low, high = heights_of(corridor)
    types = texts(corridor, "robotTypes")
    line = tuple(position_of(each, ground)[:2] for each in children(corridor, "points"))
    kept = tuple(place for i, place in enumerate(line) if i == 0 or place != line[i - 1])
    return Corridor(
        name=name or label_of(corridor) or path_of(corridor).lstrip("/"),
        line=kept if len(kept) > 1 else line,
        width=number(corridor, "width") or 0.0,
        low=low,
        high=high,
        use=literal(corridor, "use", _CORRIDOR_USES, "BOTH"),
        types=frozenset(types) if types else None,
        part=part_of(corridor, ground),
    )


def names_of(elements: Iterable[Element]) -> dict[Element, str]:
    """Return a name for each element, unique among them and the same each time.

    That is its own name; for one without, its feature and position, such as ``tasks[2]``; a number in
    brackets tells apart those that would have the same.
    """
    found = tuple(elements)
    names: dict[Element, str] = {}
    used = {label_of(each) for each in found}
    given: set[str] = set()
    for each in found:
        own = label_of(each)
        names[each] = own if own and own not in given else _free(own or _place_in_list(each), used)
        given.add(names[each])
        used.add(names[each])
    return names


def _place_in_list(element: Element) -> str:
    return path_of(element).rpartition("/")[2]


def _free(wish: str, used: Container[str]) -> str:
    counted = (f"{wish} ({count})" for count in range(2, 1_000_000))
    return next(name for name in chain((wish,), counted) if name not in used)
