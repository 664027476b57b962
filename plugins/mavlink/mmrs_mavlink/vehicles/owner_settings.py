"""Settings of the owner of a vehicle that a program depends on: checked, and changed where it needs that.

An ArduPilot whose fence is enabled obeys all of FENCE_TYPE, which by default includes a circle
of FENCE_RADIUS about home and a height of FENCE_ALT_MAX. If its owner had it disabled, only the areas of
the program are fenced; if it was enabled, the owner wants all of it, and a program that goes farther is
refused. A PX4 always obeys GF_MAX_HOR_DIST and GF_MAX_VER_DIST, where they are not 0.

A vehicle may count the heartbeats of one ground station, or of a range of them, and never misses one that
it has not received: if the program is not among them, its failsafe never answers a lost link.

It is as careful as the robot's travel mode asks, never less than its owner has set. The positions of a
mission count as passed within a radius, which is reduced where the mode asks for that; one that stops
within that radius of its target is given no more than the acceptance radius. What it keeps from what it
perceives is increased. Whether it avoids anything at all is its owner's business, since a vehicle that
leaves its path leaves what was verified. It climbs, descends and turns no faster than its type states: level
speeds are commanded with each target, but an ArduSub takes others from its parameters only. A Rover that
can turn on the spot does so before it goes to what is behind it: it steers by the acceleration to the side
that it wants, which is none straight ahead and none straight back.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from math import hypot, inf

from mmrs_runtime.controllers.geodesy import distance, offset
from mmrs_runtime.faults import RefusedError

from ..limits import limits_of
from ..links.link import Link
from ..links.ourselves import GROUND_SYSTEM
from ..profiles.autopilot import OwnFence
from ..program import Geographic, Place, Travel
from ..services import parameters
from ..services.items import Item

MARGIN = 2.0
"""Metres that a program must stay inside a fence of the vehicle's own (FENCE_MARGIN)."""


NEAR_FENCE = 0.1
"""Metres from the areas of its program at which a vehicle that drives halts; its legs keep 0.5 m or more."""


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
    if polygons and link.profile.drives:
        yield from _approach(link, fence.margin)
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


def _approach(link: Link, name: str) -> Iterator[str]:
    """Let a vehicle that drives come as near to the areas of its program as its path leads.

    An ArduPilot Rover halts in any mode where it would come nearer than the margin (``calc_throttle``), other
    vehicles only where a pilot flies them.
    """
    value = parameters.read(link, [name]).get(name, 0.0) if name else 0.0
    if value > NEAR_FENCE:
        if not parameters.write(link, name, NEAR_FENCE):
            raise RefusedError(f"the fence: the vehicle does not confirm {name} = {NEAR_FENCE:g}")
        yield f"{name} = {NEAR_FENCE:g}, which was {value:g}: its path leads nearer to its fence"


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


def end_exemption(link: Link) -> str:
    """Make the failsafe for a lost link act in all modes of programs; return what operators should know.

    Raises:
        RefusedError: it would continue, and does not confirm that it will not.
    """
    exemption = link.profile.lost_link.exemption
    if exemption is None:
        return ""
    name = exemption.parameter
    was = round(parameters.read(link, [name]).get(name, 0.0))
    wanted = was & ~exemption.bits
    if wanted == was:
        return ""
    if not parameters.write(link, name, wanted):
        raise RefusedError(f"response to a lost link: the vehicle does not confirm {name} = {wanted}")
    return f"{name} = {wanted}, which was {was}: it answers a lost link in {exemption.where}, too"


NOT_TOLD = (
    "the vehicle does not tell whose heartbeats it counts ({}, {}): it may not notice when this program falls"
    " silent"
)


def check_listening(link: Link) -> str:
    """Check that a vehicle's failsafe acts when this program falls silent.

    Returns:
        What operators should know, where the vehicle does not report it; otherwise nothing.

    Raises:
        RefusedError: it does not count this program's heartbeats.
    """
    stations = link.profile.autopilot.stations
    if not any(stations):
        return ""
    name, systems = _counted(stations, parameters.read(link, stations))
    if not name:
        return NOT_TOLD.format(*stations)
    if GROUND_SYSTEM in systems:
        return ""
    raise RefusedError(
        f"response to a lost link: the vehicle counts no heartbeats but those of system {_shown(systems)}"
        f" ({name}), and would not notice when this program falls silent: set {name} to {GROUND_SYSTEM},"
        " and give ground stations other systems"
    )


def _counted(stations: tuple[str, str, str], values: Mapping[str, float]) -> tuple[str, range]:
    """Return the parameter that defines which systems count, and these; an empty name: unknown."""
    single, from_, to = stations
    name = next((each for each in (from_, single) if each in values), "")
    first = round(values.get(name, 0.0))
    last = round(values.get(to, 0.0)) if name == from_ else 0
    return name, range(first, max(first, last) + 1)


def _shown(systems: range) -> str:
    return f"{systems[0]}" if len(systems) == 1 else f"{systems[0]} to {systems[-1]}"


LATE = "warning: it takes longer than planned"


def set_up(link: Link, travel: Travel, acceptance: float = inf, speed: float = 0.0) -> Iterator[str]:
    """Set a vehicle up for a way of travelling; yield what operators should know.

    That is what was changed, what was not confirmed, and where its owner lets it go more slowly than planned.

    Args:
        link: to the vehicle.
        travel: how carefully it is to go.
        acceptance: metres from a place at which it counts as reached.
        speed: metres per second, the largest that its program commands.
    """
    profile = link.profile
    limits = tuple(limits_of(profile, travel, acceptance))
    found = parameters.read(link, [*(each.name for each in limits), *profile.fastest])
    expected = min(speed, profile.pacing.step.speed)
    for name, units in profile.fastest.items():
        if (value := found.get(name)) is not None and value < expected * units:
            yield f"{name} = {value:g}: slower than the {speed:g} m/s of its program ({LATE})"
    for limit in limits:
        if (value := found.get(limit.name)) is not None and not limit.holds(value):
            yield _changed(link, limit.name, value, limit.value, limit.why)


def _changed(link: Link, name: str, was: float, wanted: float, why: str) -> str:
    if parameters.write(link, name, wanted):
        return f"{name} = {wanted:g}, which was {was:g}: {why}"
    return f"{name} = {was:g}: the vehicle does not confirm {wanted:g}, so that {why}"
