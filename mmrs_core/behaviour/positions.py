"""Where the targets of a behaviour lie in its local metric frame."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from math import isfinite

from mmrs_core.diagnostics import Diagnostic
from mmrs_core.geometry.frames import LocalFrame, known_crs
from mmrs_core.languages import behaviour as bl
from mmrs_core.languages.element import Element
from mmrs_core.languages.grounding_frame import fault, height_of, is_geographic, is_relative, on_earth
from mmrs_core.languages.grounding_values import child, number
from mmrs_core.scene import Frame, Position

UNREADABLE = "BL000"
"""Code of the faults that keep a behaviour from being read at all."""

ORIGIN: Position = (0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Positions:
    """Where the coordinates of a behaviour lie.

    Attributes:
        frame: how the local frame lies on the Earth.
        by_coordinate: (east, north, up) in metres; coordinates with a fault are missing.
        faults: why they are.
    """

    frame: Frame
    by_coordinate: Mapping[Element, Position]
    faults: tuple[Diagnostic, ...]


def positions_of(behaviour: bl.Behaviour) -> Positions:
    """Lay all coordinates of a behaviour into the frame of its origin."""
    frame, origin = _frame(behaviour), _origin(behaviour)
    coordinates = [target for target in behaviour.targets if isinstance(target, bl.Coordinate)]
    positions: dict[Element, Position] = {}
    faults: list[Diagnostic] = []
    if origin is not None and is_relative(origin) and behaviour.origin is origin:
        positions[origin] = ORIGIN
    _place_geographic([c for c in coordinates if is_geographic(c)], behaviour, frame, positions, faults)
    _place_relative([c for c in coordinates if is_relative(c)], positions, faults)
    return Positions(frame, positions, tuple(faults))


def _origin(behaviour: bl.Behaviour) -> bl.Coordinate | None:
    """Return the behaviour's own origin, else the first home."""
    homes = (robot.home for robot in behaviour.robots if robot.home is not None)
    return behaviour.origin if behaviour.origin is not None else next(homes, None)


def _frame(behaviour: bl.Behaviour) -> Frame:
    origin = _origin(behaviour)
    placed = origin if origin is not None and is_geographic(origin) and on_earth(origin) else None
    reference = behaviour.altitudeReference
    height = number(placed, "altitude") if placed is not None else None
    return Frame(
        crs=behaviour.crs,
        latitude=number(placed, "latitude") if placed is not None else None,
        longitude=number(placed, "longitude") if placed is not None else None,
        altitude=0.0 if placed is not None and reference == "ORIGIN" else height,
        altitude_reference=reference,
        geoid_separation=behaviour.geoidSeparation,
        surface=behaviour.surfaceHeight,
    )


def _place_geographic(
    coordinates: list[bl.Coordinate],
    behaviour: bl.Behaviour,
    frame: Frame,
    positions: dict[Element, Position],
    faults: list[Diagnostic],
) -> None:
    if not coordinates:
        return
    if frame.latitude is None or frame.longitude is None:
        faults.append(_fault(coordinates[0], "is geographic, but the behaviour has no place on the Earth"))
        return
    if (unknown := known_crs(frame.crs)) is not None:
        faults.append(_fault(behaviour, f"cannot be placed: {unknown}"))
        return
    local = LocalFrame(frame.crs, frame.latitude, frame.longitude)
    placed = [each for each in coordinates if _is_placed(each, frame, faults)]
    latitudes = [number(each, "latitude") or 0.0 for each in placed]
    longitudes = [number(each, "longitude") or 0.0 for each in placed]
    try:
        flat = local.to_local(latitudes, longitudes) if placed else ()
    except ValueError as error:
        faults.append(_fault(behaviour, f"cannot be placed: {error}"))
        return
    for each, (east, north) in zip(placed, flat, strict=True):
        positions[each] = (float(east), float(north), float(height_of(each, frame)))


def _is_placed(coordinate: bl.Coordinate, frame: Frame, faults: list[Diagnostic]) -> bool:
    """Return whether it lies on the Earth at a known height; what keeps it from that becomes a fault."""
    height = height_of(coordinate, frame)
    if not on_earth(coordinate):
        faults.append(
            _fault(coordinate, "has no latitude from -90 to 90 and longitude from -180 to 180 degrees")
        )
    elif isinstance(height, str):
        faults.append(_fault(coordinate, height))
    else:
        return True
    return False


def _place_relative(
    coordinates: Iterable[bl.Coordinate], positions: dict[Element, Position], faults: list[Diagnostic]
) -> None:
    """Place each coordinate after the one that it counts from; what cannot be placed is said once."""
    hopeless: set[Element] = set()
    for coordinate in coordinates:
        chain: list[Element] = []
        current: Element | None = coordinate
        while current is not None and current not in positions and current not in hopeless:
            if current in chain:
                faults.append(_fault(current, "counts from itself in a circle"))
                hopeless.update(chain)
            elif not is_relative(current):
                hopeless.add(current)
            else:
                chain.append(current)
                current = child(current, "reference")
        if current in hopeless:
            hopeless.update(chain)
            continue
        _place_chain(chain, ORIGIN if current is None else positions[current], positions, faults, hopeless)


def _place_chain(
    chain: list[Element],
    base: Position,
    positions: dict[Element, Position],
    faults: list[Diagnostic],
    hopeless: set[Element],
) -> None:
    for index, each in reversed(list(enumerate(chain))):
        moved = [number(each, axis) for axis in ("x", "y", "z")]
        steps = [value for value in moved if value is not None and isfinite(value)]
        if len(steps) < 3:
            faults.append(_fault(each, "has no finite x, y and z"))
            hopeless.update(chain[: index + 1])
            return
        base = (base[0] + steps[0], base[1] + steps[1], base[2] + steps[2])
        positions[each] = base


def _fault(element: Element, message: str) -> Diagnostic:
    return fault(element, message, code=UNREADABLE)
