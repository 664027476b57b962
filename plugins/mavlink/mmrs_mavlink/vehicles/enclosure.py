"""The vehicle's own fences, by radius and height: they must not stop it in the middle of its program.

An ArduPilot whose fence is enabled obeys all of FENCE_TYPE, which by default includes a circle
of FENCE_RADIUS about home and a height of FENCE_ALT_MAX. If its owner had it disabled, only the areas of
the program are fenced; if it was enabled, the owner wants all of it, and a program that goes farther is
refused. A PX4 always obeys GF_MAX_HOR_DIST and GF_MAX_VER_DIST, where they are not 0.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import hypot

from mmrs_runtime.controllers.geodesy import distance, offset
from mmrs_runtime.faults import RefusedError

from ..links.autopilots import is_px4
from ..links.link import Link
from ..program import Geographic, Place
from ..services import parameters
from ..services.items import Item

HEIGHT, CIRCLE, POLYGONS = 1, 2, 4
MARGIN = 2.0
"""Metres that a program must stay inside a fence of the vehicle's own (FENCE_MARGIN)."""

ARDUPILOT = ("FENCE_ENABLE", "FENCE_TYPE", "FENCE_RADIUS", "FENCE_ALT_MAX", "RALLY_LIMIT_KM")
PX4 = ("GF_MAX_HOR_DIST", "GF_MAX_VER_DIST")


def enclose(
    link: Link, home: Place, places: Sequence[Place], rally: Sequence[Item], *, polygons: bool
) -> Iterator[str]:
    """Check that the vehicle's own fences leave a program room; yield what operators should know.

    Args:
        link: to the vehicle.
        home: of the robot.
        places: that its program leads to.
        rally: its rally points.
        polygons: whether the program has areas to fence.

    Raises:
        RefusedError: a fence is in the way, or the vehicle does not confirm which fences it obeys.
    """
    if is_px4(link):
        values = parameters.read(link, PX4)
        _check_radius(home, places, values.get("GF_MAX_HOR_DIST", 0.0), "GF_MAX_HOR_DIST")
        _check_height(places, values.get("GF_MAX_VER_DIST", 0.0), "GF_MAX_VER_DIST")
        return
    values = parameters.read(link, ARDUPILOT)
    obeyed = round(values.get("FENCE_TYPE", 0.0))
    if values.get("FENCE_ENABLE"):
        if obeyed & CIRCLE:
            _check_radius(home, places, values.get("FENCE_RADIUS", 0.0), "FENCE_RADIUS")
        if obeyed & HEIGHT:
            _check_height(places, values.get("FENCE_ALT_MAX", 0.0), "FENCE_ALT_MAX")
    if polygons and "FENCE_TYPE" in values:
        yield from _enable_polygons(
            link, obeyed, obeyed | POLYGONS if values.get("FENCE_ENABLE") else POLYGONS
        )
    yield from _far_from_rally(places, rally, values.get("RALLY_LIMIT_KM", 0.0))


def _enable_polygons(link: Link, obeyed: int, wanted: int) -> Iterator[str]:
    if obeyed == wanted:
        return
    if not parameters.write(link, "FENCE_TYPE", wanted):
        raise RefusedError(f"the fence: the vehicle does not confirm FENCE_TYPE = {wanted}")
    alone = wanted == POLYGONS
    what = "is the areas of the program alone" if alone else "obeys the areas of the program, too"
    yield f"FENCE_TYPE = {wanted}, which was {obeyed}: its fence {what}"


def _check_radius(home: Place, places: Sequence[Place], radius: float, name: str) -> None:
    farthest = max((hypot(*offset(home, place)[:2]) for place in places), default=0.0)
    if 0.0 < radius < farthest + MARGIN:
        ends = f"the vehicle's own fence ends {radius:g} m from home ({name})"
        raise RefusedError(f"{ends}, and its program goes {farthest:.0f} m")


def _check_height(places: Sequence[Place], height: float, name: str) -> None:
    highest = max((place.height for place in places), default=0.0)
    if 0.0 < height < highest + MARGIN:
        ends = f"the vehicle's own fence ends {height:g} m above home ({name})"
        raise RefusedError(f"{ends}, and its program goes to {highest:.0f} m")


def _far_from_rally(places: Sequence[Place], rally: Sequence[Item], kilometres: float) -> Iterator[str]:
    points = [Geographic(item.x * 1e-7, item.y * 1e-7, item.z) for item in rally]
    if not points or kilometres <= 0.0:
        return
    farthest = max(
        (
            min(distance(place, point) for point in points)
            for place in places
            if isinstance(place, Geographic)
        ),
        default=0.0,
    )
    if farthest > kilometres * 1000.0:
        limit = f"RALLY_LIMIT_KM = {kilometres:g}: failsafe return"
        yield f"{limit}: (beware: from {farthest:.0f} m away it goes home, and not to a rally point)"
