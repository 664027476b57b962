"""What the local metric frame of a mission is, and the questions that coordinates answer about themselves."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from typing import TypeAlias, get_args

from mmrs_core.diagnostics import Diagnostic, Severity
from mmrs_core.grounding.features import child, children, literal, number, text
from mmrs_core.languages.codes import explained
from mmrs_core.languages.element import Element, Unknown, descendants, is_kind, label_of, path_of, place_of
from mmrs_core.languages.uris import BEHAVIOUR
from mmrs_core.languages.uris import MISSION as MISSION
from mmrs_core.scene import AltitudeReference, Frame

REFERENCES: tuple[AltitudeReference, ...] = get_args(AltitudeReference)
NOWHERE = "GND001"
"""Code of the faults that keep a coordinate from having a place."""

_GEOGRAPHIC = frozenset({(MISSION, "GeoCoordinate"), (BEHAVIOUR, "GeoCoordinate")})
_RELATIVE = frozenset({(MISSION, "RelativeCoordinate"), (BEHAVIOUR, "RelativeCoordinate")})

Reference: TypeAlias = Callable[[Element], Element | None]
"""The coordinate that a relative one counts from; None: the origin of the frame."""


def is_geographic(coordinate: Element) -> bool:
    """Return whether it is a GeoCoordinate of a mission, context or behaviour."""
    return _is_any(type(coordinate), _GEOGRAPHIC)


def is_relative(coordinate: Element) -> bool:
    """Return whether it is a RelativeCoordinate of a mission, context or behaviour."""
    return _is_any(type(coordinate), _RELATIVE)


def _is_any(kind: type[Element], names: frozenset[tuple[str, str]]) -> bool:
    return kind._mmrs_metaclass is not None and not names.isdisjoint(kind._mmrs_metaclass.ancestry)


def on_earth(coordinate: Element) -> bool:
    """Return whether its latitude and longitude are given and within their ranges."""
    latitude, longitude = number(coordinate, "latitude"), number(coordinate, "longitude")
    return latitude is not None and longitude is not None and abs(latitude) <= 90 and abs(longitude) <= 180


def coordinates_of(root: Element | None) -> Iterator[Element]:
    """Yield all coordinates inside an element, in document order."""
    known: dict[type[Element], bool] = {}
    for element in descendants(root) if root is not None else ():
        kind = type(element)
        if kind not in known:
            known[kind] = _is_any(kind, _GEOGRAPHIC | _RELATIVE)
        if known[kind]:
            yield element


def origin_of(model: Element | None) -> Element | None:
    """Return the frame's origin: the model's own, else the home of its first robot that has one.

    Args:
        model: a mission or a behaviour.
    """
    if model is None:
        return None
    explicit, team = child(model, "origin"), child(model, "team")
    homes = (child(robot, "home") for robot in children(model if team is None else team, "robots"))
    return explicit if explicit is not None else next((home for home in homes if home is not None), None)


def frame_of(model: Element | None, context: Element | None) -> Frame:
    """Return how the frame lies on the Earth; a local one where the origin is relative or has no place.

    Args:
        model: a mission or a behaviour; the latter says itself where the water surface is.
        context: of a mission.
    """
    if model is None:
        return Frame("EPSG:4326", None, None)
    origin = origin_of(model)
    placed = origin if origin is not None and is_geographic(origin) and on_earth(origin) else None
    reference = literal(model, "altitudeReference", REFERENCES, "ELLIPSOID")
    above = model if is_kind(model, BEHAVIOUR, "Behaviour") or context is None else context
    return Frame(
        crs=text(model, "crs") or "EPSG:4326",
        latitude=number(placed, "latitude") if placed is not None else None,
        longitude=number(placed, "longitude") if placed is not None else None,
        altitude=_altitude(placed, reference) if placed is not None else None,
        altitude_reference=reference,
        geoid_separation=number(model, "geoidSeparation"),
        surface=number(above, "surfaceHeight") or 0.0,
    )


def _altitude(origin: Element, reference: str) -> float | None:
    return 0.0 if reference == "ORIGIN" else number(origin, "altitude")


def height_of(coordinate: Element, frame: Frame) -> float | str:
    """Return the height of a geographic coordinate above the origin in metres, or why it has none."""
    altitude, depth = number(coordinate, "altitude"), number(coordinate, "depth")
    if altitude is not None and depth is not None:
        return "has both an altitude and a depth"
    if depth is not None:
        return frame.surface - depth
    if altitude is None or frame.altitude_reference == "ORIGIN":
        return altitude or 0.0
    if frame.altitude is None:
        return "has an altitude, but the origin has none to compare it with"
    return altitude - frame.altitude


def reference_in(context: Element | None) -> Reference:
    """Return what the relative coordinates of a mission or behaviour and of its context count from."""
    base = child(context, "origin") if context is not None else None
    inside = set(coordinates_of(context)) if base is not None else set()

    def reference(coordinate: Element) -> Element | None:
        named = child(coordinate, "reference")
        if named is not None:
            return named
        return base if coordinate in inside and coordinate is not base else None

    return reference


def cycles_among(coordinates: Iterable[Element], reference: Reference) -> Iterator[tuple[Element, ...]]:
    """Yield every circle of relative coordinates that count from each other, once; linear in their number."""
    done: set[Element] = set()
    for coordinate in coordinates:
        way: dict[Element, None] = {}
        current: Element | None = coordinate
        while current is not None and current not in done and current not in way:
            way[current] = None
            current = reference(current) if is_relative(current) else None
        if current is not None and current in way:
            ahead = tuple(way)
            yield ahead[ahead.index(current) :]
        done.update(way)


def origin_faults(model: Element, origin: Element, frame: Frame) -> Iterator[str]:
    """Yield what contradicts that the origin is at height 0, and at (0, 0, 0) where it is relative.

    A relative home that serves as origin for want of another only says that the frame is a local one; it
    counts from the frame's origin as all others do.
    """
    if is_relative(origin):
        moved = (
            any(number(origin, axis) for axis in ("x", "y", "z")) or child(origin, "reference") is not None
        )
        if moved and child(model, "origin") is origin:
            yield "is the origin, so it can only be at x = y = z = 0, without a reference"
        return
    if frame.altitude_reference == "ORIGIN" and number(origin, "altitude"):
        yield "is the origin that altitudes count from, so its own altitude must be 0"
    depth = number(origin, "depth")
    if depth is not None and abs(frame.surface - depth) > 1e-9:
        yield (f"is the origin at a depth of {depth:g} m, but the surface is {frame.surface:g} m above it")


def fault(element: Element, message: str, hint: str = "", code: str = NOWHERE) -> Diagnostic:
    """Return an error of an element, which the message does not name yet."""
    words = f"{_called(element)} {message}"
    return explained(Diagnostic(code, Severity.ERROR, words, place_of(element), hint))


def _called(element: Element) -> str:
    """Return class and name of an element, or where it stands in its model if it has no name."""
    kind = "element" if isinstance(element, Unknown) else type(element).__name__
    label = label_of(element)
    return f"{kind} {label!r}" if label else f"{kind} {path_of(element).lstrip('/')}".rstrip()
