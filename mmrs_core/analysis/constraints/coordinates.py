"""Coordinates: on the Earth, in a known system, without contradiction."""

from __future__ import annotations

from collections.abc import Iterator
from math import isfinite

from mmrs_core.analysis.constraints.findings import BEHAVIOUR, CONTEXT, MISSION, finding
from mmrs_core.contributions.constraints import Constraint, Finding
from mmrs_core.geometry.frames import known_crs
from mmrs_core.grounding.features import child, children, number, text
from mmrs_core.grounding.frame import (
    coordinates_of,
    cycles_among,
    frame_of,
    is_geographic,
    is_relative,
    origin_faults,
    origin_of,
    reference_in,
)
from mmrs_core.languages.element import Element, path_of, root_of
from mmrs_core.languages.modelset import ModelSet


def _crs(root: Element, models: ModelSet) -> Iterator[Finding]:
    crs = text(root, "crs")
    reason = known_crs(crs) if crs else None
    if reason is not None:
        yield finding(root, reason)


def _on_earth(coordinate: Element, models: ModelSet) -> Iterator[Finding]:
    for feature, limit in (("latitude", 90), ("longitude", 180)):
        found = number(coordinate, feature)
        if found is not None and isfinite(found) and abs(found) > limit:
            yield finding(coordinate, f"{feature} {found:g} is not between -{limit} and {limit} degrees")


def _altitude_or_depth(coordinate: Element, models: ModelSet) -> Iterator[Finding]:
    altitude, depth = number(coordinate, "altitude"), number(coordinate, "depth")
    if altitude is not None and depth is not None:
        yield finding(coordinate, f"has both an altitude ({altitude:g} m) and a depth ({depth:g} m)")


def _altitude_of_origin(model: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield coordinates of a mission or behaviour, and of its context, that the origin has no height for."""
    yield from _without_base(model, origin_of(model), model)
    if models.context is not None:
        yield from _without_base(model, origin_of(model), models.context)


def _without_base(model: Element, origin: Element | None, root: Element) -> Iterator[Finding]:
    """Yield a finding for the first coordinate of a root that has an altitude, if the origin has none."""
    if origin is None or not is_geographic(origin) or text(model, "altitudeReference") == "ORIGIN":
        return
    if number(origin, "altitude") is not None:
        return
    given = [each for each in coordinates_of(root) if number(each, "altitude") is not None]
    if given:
        others = f", as {len(given) - 1} more here have" if len(given) > 1 else ""
        yield finding(given[0], f"has an altitude{others}, but the origin {path_of(origin)} has none")


def _circles(model: Element, models: ModelSet) -> Iterator[Finding]:
    coordinates = [*coordinates_of(model), *coordinates_of(models.context)]
    for circle in cycles_among(coordinates, reference_in(models.context)):
        path = " → ".join(path_of(each) for each in (*circle, circle[0]))
        yield finding(circle[0], f"counts from itself: {path}")


def _local_or_geographic(model: Element, models: ModelSet) -> Iterator[Finding]:
    origin = origin_of(model)
    if origin is None or not is_relative(origin):
        return
    coordinates = [*coordinates_of(model), *coordinates_of(models.context)]
    geographic = [each for each in coordinates if is_geographic(each)]
    if geographic:
        others = f", as {len(geographic) - 1} more are" if len(geographic) > 1 else ""
        yield finding(geographic[0], f"is geographic{others}, but the origin is relative")


def _origin(model: Element, models: ModelSet) -> Iterator[Finding]:
    origin = origin_of(model)
    if origin is not None:
        for message in origin_faults(model, origin, frame_of(model, models.context)):
            yield finding(origin, message)


def _somewhere(coordinate: Element, models: ModelSet) -> Iterator[Finding]:
    target = child(coordinate, "reference")
    if target is None:
        return
    known = [root for root in (models.mission, models.context) if root is not None]
    if root_of(target) not in known:
        yield finding(
            coordinate, f"counts from {path_of(target)}, which is in neither the mission nor its context"
        )


def _at_home(behaviour: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield homes, origin and targets that another model holds, where engines do not look."""
    for robot in children(behaviour, "robots"):
        home = child(robot, "home")
        if home is not None and root_of(home) is not root_of(behaviour):
            yield finding(robot, "its home is not among the targets of this behaviour")


_CRS_HINT = "name a geographic system in degrees, such as EPSG:4326"
_LOCAL_HINT = "give the mission a geographic origin, or make all coordinates relative"
_CIRCLE_HINT = "let one of them count from the origin: leave out its reference"
_ALTITUDE_HINT = "give the origin an altitude, or set altitudeReference to ORIGIN"

CONSTRAINTS = (
    *Constraint(
        "MML001", "The coordinate reference system is known.", (MISSION, "Mission"), _crs, _CRS_HINT
    ).also(("CTX001", (CONTEXT, "Context")), ("BL016", (BEHAVIOUR, "Behaviour"))),
    *Constraint(
        "MML020",
        "Latitudes and longitudes are on the Earth.",
        (MISSION, "GeoCoordinate"),
        _on_earth,
        "latitude comes first, in degrees north; longitude in degrees east",
    ).also(("BL017", (BEHAVIOUR, "GeoCoordinate"))),
    *Constraint(
        "MML021",
        "A coordinate has an altitude or a depth, not both.",
        (MISSION, "GeoCoordinate"),
        _altitude_or_depth,
        "keep depth for what is below the surface, altitude for what is above",
    ).also(("BL018", (BEHAVIOUR, "GeoCoordinate"))),
    *Constraint(
        "MML022",
        "Where coordinates have altitudes, the origin has one.",
        (MISSION, "Mission"),
        _altitude_of_origin,
        _ALTITUDE_HINT,
    ).also(("BL019", (BEHAVIOUR, "Behaviour"))),
    *Constraint(
        "MML023",
        "Relative coordinates do not count from themselves.",
        (MISSION, "Mission"),
        _circles,
        _CIRCLE_HINT,
    ).also(("BL020", (BEHAVIOUR, "Behaviour"))),
    Constraint(
        "MML024",
        "A mission with a relative origin has relative coordinates only.",
        (MISSION, "Mission"),
        _local_or_geographic,
        _LOCAL_HINT,
    ),
    Constraint(
        "MML025",
        "The origin is at height 0, and a relative one at x = y = z = 0.",
        (MISSION, "Mission"),
        _origin,
        "give the mission an origin of its own, or set surfaceHeight of the context",
    ),
    Constraint(
        "MML026",
        "A relative coordinate counts from one of the mission or its context.",
        (MISSION, "RelativeCoordinate"),
        _somewhere,
        "refer to a coordinate of these models, or leave the reference out",
    ),
    Constraint(
        "BL021",
        "A behaviour with a relative origin has relative coordinates only.",
        (BEHAVIOUR, "Behaviour"),
        _local_or_geographic,
        "give the behaviour a geographic origin, or make all coordinates relative",
    ),
    Constraint(
        "BL050",
        "The origin is at height 0, and a relative one at x = y = z = 0.",
        (BEHAVIOUR, "Behaviour"),
        _origin,
        "give the behaviour another origin, or set its surfaceHeight",
    ),
    Constraint(
        "BL022",
        "The home of a robot is among the targets of its behaviour.",
        (BEHAVIOUR, "Behaviour"),
        _at_home,
        "add the home to the behaviour's targets",
    ),
)
