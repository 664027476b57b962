"""Where the coordinates of a mission or behaviour and its context lie in one local metric frame."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import isfinite
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mmrs_core.geometry.frames import LocalFrame, known_crs
from mmrs_core.grounding.features import child, children, number, text
from mmrs_core.grounding.frame import (
    Reference,
    coordinates_of,
    fault,
    frame_of,
    height_of,
    is_geographic,
    is_relative,
    on_earth,
    origin_faults,
    origin_of,
    reference_in,
)
from mmrs_core.languages.element import Element, place_of

if TYPE_CHECKING:
    from mmrs_core.diagnostics import Diagnostic
    from mmrs_core.scene import Frame, Point, Position


@dataclass(frozen=True, slots=True)
class Ground:
    """Where everything lies.

    Attributes:
        frame: how the local frame lies on the Earth.
        positions: (east, north, up) in metres, by coordinate; those with a fault are missing.
        faults: what keeps coordinates from having a position.
    """

    frame: Frame
    positions: Mapping[Element, Position]
    faults: tuple[Diagnostic, ...] = ()


def ground_of(model: Element | None, context: Element | None) -> Ground:
    """Lay all coordinates of a mission or behaviour, and of its context, into the frame of the origin.

    Never raises: coordinates that cannot be placed are left out, and why is among the faults.
    """
    frame, origin = frame_of(model, context), origin_of(model)
    faults: list[Diagnostic] = []
    positions: dict[Element, Position] = {}
    if model is not None and origin is not None:
        faults.extend(fault(origin, message) for message in origin_faults(model, origin, frame))
        if is_relative(origin) and child(model, "origin") is origin:
            positions[origin] = (0.0, 0.0, 0.0)
    crs = (text(context, "crs") if context is not None else "") or frame.crs
    for root, own_crs in ((model, frame.crs), (context, crs)):
        _place_geographic(root, own_crs, frame, positions, faults)
    relative = [each for root in (model, context) for each in coordinates_of(root) if is_relative(each)]
    _place_relative(relative, reference_in(context), positions, faults)
    return Ground(frame, positions, tuple(faults))


def _place_geographic(
    root: Element | None, crs: str, frame: Frame, positions: dict[Element, Position], faults: list[Diagnostic]
) -> None:
    found = [each for each in coordinates_of(root) if is_geographic(each)]
    local = _local(root, found, crs, frame, faults)
    for each, (east, north) in _flat(local, crs, found, faults).items() if local else ():
        up = height_of(each, frame)
        if isinstance(up, str):
            faults.append(fault(each, up))
        else:
            positions[each] = (east, north, up)


def _local(
    root: Element | None, found: Sequence[Element], crs: str, frame: Frame, faults: list[Diagnostic]
) -> LocalFrame | None:
    """Return the projection, or None where there is nothing to project or it is impossible."""
    if root is None or not found:
        return None
    if frame.latitude is None or frame.longitude is None:
        others = f", as are {len(found) - 1} more" if len(found) > 1 else ""
        message = f"is geographic{others}, but the mission is a local one"
        hint = "give the mission a geographic origin, or make all coordinates relative"
        faults.append(fault(found[0], message, hint))
        return None
    unknown = known_crs(frame.crs) or known_crs(crs)
    if unknown is not None:
        faults.append(fault(root, f"cannot be placed: {unknown}"))
        return None
    return LocalFrame(frame.crs, frame.latitude, frame.longitude)


def _flat(
    local: LocalFrame, crs: str, found: Sequence[Element], faults: list[Diagnostic]
) -> dict[Element, Point]:
    """Return (east, north) of the geographic coordinates that have one, projected all at once."""
    astray = [each for each in found if not on_earth(each)]
    faults.extend(
        fault(each, "has no latitude from -90 to 90 and longitude from -180 to 180 degrees")
        for each in astray
    )
    placed = [each for each in found if on_earth(each)]
    try:
        return _projected(local, crs, placed)
    except ValueError:
        return _one_by_one(local, crs, placed, faults)


def _one_by_one(
    local: LocalFrame, crs: str, placed: Sequence[Element], faults: list[Diagnostic]
) -> dict[Element, Point]:
    flat: dict[Element, Point] = {}
    for each in placed:
        try:
            flat.update(_projected(local, crs, [each]))
        except ValueError as error:
            faults.append(fault(each, f"cannot be placed: {error}"))
    return flat


def _projected(local: LocalFrame, crs: str, placed: Sequence[Element]) -> dict[Element, Point]:
    if not placed:
        return {}
    degrees = np.array([(number(each, "latitude"), number(each, "longitude")) for each in placed], float)
    metres = local.to_local(*_in_crs(degrees, crs, local.crs))
    return {each: (float(east), float(north)) for each, (east, north) in zip(placed, metres, strict=True)}


def _in_crs(
    degrees: NDArray[np.float64], source: str, target: str
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    if source.strip().lower() == target.strip().lower():
        return degrees[:, 0], degrees[:, 1]
    from pyproj import Transformer

    change = Transformer.from_crs(source, target, always_xy=True)
    longitudes, latitudes = change.transform(degrees[:, 1], degrees[:, 0])
    return np.asarray(latitudes, float), np.asarray(longitudes, float)


def _place_relative(
    coordinates: Sequence[Element],
    reference: Reference,
    positions: dict[Element, Position],
    faults: list[Diagnostic],
) -> None:
    """Add the positions of relative coordinates, each after the one that it counts from."""
    hopeless: set[Element] = set()
    for coordinate in coordinates:
        if coordinate in positions or coordinate in hopeless:
            continue
        chain, base = _chain(coordinate, reference, positions)
        for each in reversed(chain):
            base = base if isinstance(base, str) else _moved(base, each)
            if not isinstance(base, str):
                positions[each] = base
                continue
            if each not in hopeless:
                faults.append(fault(each, base))
            hopeless.add(each)
            base = f"counts from {place_of(each).path}, which has no position"


def _chain(
    coordinate: Element, reference: Reference, positions: Mapping[Element, Position]
) -> tuple[tuple[Element, ...], Position | str]:
    """Return the relative coordinates from this one to what has a position, and that position."""
    chain: dict[Element, None] = {}
    current: Element | None = coordinate
    while current is not None and current not in positions:
        if current in chain:
            return tuple(chain), "counts from itself in a cycle"
        if not is_relative(current):
            return tuple(chain), f"counts from {place_of(current).path}, which has no position"
        chain[current] = None
        current = reference(current)
    return tuple(chain), (0.0, 0.0, 0.0) if current is None else positions[current]


def _moved(base: Position, coordinate: Element) -> Position | str:
    x, y, z = (number(coordinate, axis) for axis in ("x", "y", "z"))
    if x is None or y is None or z is None or not all(isfinite(axis) for axis in (x, y, z)):
        return "has no finite x, y and z"
    return base[0] + x, base[1] + y, base[2] + z


_PLACES = ("points", "shell")


def heights_of_task(task: Element, ground: Ground) -> tuple[float, ...]:
    """Return at which heights a task is done, metres above the origin; empty where that is not known.

    Its altitude or depth goes before the heights of its places.
    """
    altitude, depth = number(task, "altitude"), number(task, "depth")
    if altitude is not None:
        return (altitude,)
    if depth is not None:
        return (ground.frame.surface - depth,)
    return tuple(ground.positions[each][2] for each in _places(task) if each in ground.positions)


def _places(task: Element) -> Iterator[Element]:
    point = child(task, "point")
    yield from (point,) if point is not None else ()
    yield from (each for name in _PLACES for each in children(task, name))
