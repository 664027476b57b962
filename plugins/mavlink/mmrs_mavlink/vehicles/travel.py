"""Travel modes: a vehicle is as careful as the robot's travel mode asks, never less than its owner has set.

The positions of a mission count as passed within a radius (WPNAV_RADIUS in centimetres, WP_RADIUS_M
since ArduPilot 4.7, Rover's WP_RADIUS, PX4's NAV_ACC_RAD): it is reduced where the mode asks for
that. A Rover stops as soon as it is within that radius of its target, so that it is never more
than the acceptance radius. The vehicle keeps clear of what it perceives by AVOID_MARGIN, and
where it also plans its own path round by OA_MARGIN_MAX: these are increased. Whether it avoids anything
at all (AVOID_ENABLE, OA_TYPE) is its owner's business, since a vehicle that leaves its path leaves what
was verified.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import inf

from ..links.autopilots import is_px4
from ..links.link import Link
from ..program import Travel
from ..services import parameters

_CENTIMETRES = 100.0

RADII: Mapping[str, Mapping[str, float]] = {
    "copter": {"WP_RADIUS_M": 1.0, "WPNAV_RADIUS": _CENTIMETRES},
    "sub": {"WP_RADIUS_M": 1.0, "WPNAV_RADIUS": _CENTIMETRES},
    "rover": {"WP_RADIUS": 1.0},
}
"""Names of the radius in ArduPilot's versions, with their units in a metre, by vehicle class."""

PX4_RADIUS = "NAV_ACC_RAD"
MARGINS = ("AVOID_MARGIN", "OA_MARGIN_MAX")


def set_up(link: Link, kind: str, travel: Travel, acceptance: float = inf) -> Iterator[str]:
    """Set a vehicle up for a way of travelling; yield what was changed, and what was not confirmed.

    Args:
        link: to the vehicle.
        kind: ``copter``, ``sub`` or ``rover``.
        travel: how carefully it is to go.
        acceptance: metres from a place at which it counts as reached.
    """
    radius = min(travel.radius, acceptance) if kind == "rover" else travel.radius
    radii = {PX4_RADIUS: 1.0} if is_px4(link) else RADII[kind]
    margins = () if is_px4(link) else MARGINS
    found = parameters.read(link, [*radii, *margins])
    for name, value in found.items():
        if name in radii and value > (wanted := radius * radii[name]):
            yield _changed(link, name, value, wanted, travel)
        elif name in margins and value < travel.margin:
            yield _changed(link, name, value, travel.margin, travel)


def _changed(link: Link, name: str, was: float, wanted: float, travel: Travel) -> str:
    if parameters.write(link, name, wanted):
        return f"{name} = {wanted:g}, which was {was:g}: it travels {travel.mode}"
    return f"{name} = {was:g}: the vehicle does not confirm {wanted:g}, for travelling {travel.mode}"
