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

from ..links.link import Link
from ..profiles.autopilot import OwnFence
from ..program import Geographic, Place
from ..services import parameters
from ..services.items import Item

MARGIN = 2.0
"""Metres that a program must stay inside a fence of the vehicle's own (FENCE_MARGIN)."""


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
    fence = link.profile.autopilot.fence
    names = (fence.enabled_by, fence.types, *(limit.parameter for limit in fence.limits), fence.rally_limit)
    values = parameters.read(link, [*filter(None, names)])
    obeyed = round(values.get(fence.types, 0.0))
    enabled = not fence.enabled_by or bool(values.get(fence.enabled_by))
    for limit in fence.limits:
        if enabled and (not fence.types or obeyed & limit.bit):
            check = _check_radius if limit.of == "radius" else _check_height
            check(home, places, values.get(limit.parameter, 0.0), limit.parameter)
    if polygons and fence.types in values:
        yield from _enable_polygons(link, fence, obeyed, enabled=enabled)
    yield from _far_from_rally(places, rally, values.get(fence.rally_limit, 0.0), fence.rally_limit)


def _enable_polygons(link: Link, fence: OwnFence, obeyed: int, *, enabled: bool) -> Iterator[str]:
    wanted = obeyed | fence.polygons if enabled else fence.polygons
    if obeyed == wanted:
        return
    if not parameters.write(link, fence.types, wanted):
        raise RefusedError(f"the fence: the vehicle does not confirm {fence.types} = {wanted}")
    alone = wanted == fence.polygons
    what = "is the areas of the program alone" if alone else "obeys the areas of the program, too"
    yield f"{fence.types} = {wanted}, which was {obeyed}: its fence {what}"


def _check_radius(home: Place, places: Sequence[Place], radius: float, name: str) -> None:
    farthest = max((hypot(*offset(home, place)[:2]) for place in places), default=0.0)
    if 0.0 < radius < farthest + MARGIN:
        ends = f"the vehicle's own fence ends {radius:g} m from home ({name})"
        raise RefusedError(f"{ends}, and its program goes {farthest:.0f} m")


def _check_height(home: Place, places: Sequence[Place], height: float, name: str) -> None:
    highest = max((place.height for place in places), default=0.0)
    if 0.0 < height < highest + MARGIN:
        ends = f"the vehicle's own fence ends {height:g} m above home ({name})"
        raise RefusedError(f"{ends}, and its program goes to {highest:.0f} m")


def _far_from_rally(
    places: Sequence[Place], rally: Sequence[Item], kilometres: float, name: str
) -> Iterator[str]:
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
        limit = f"{name} = {kilometres:g}: failsafe return"
        yield f"{limit}: (beware: from {farthest:.0f} m away it goes home, and not to a rally point)"
