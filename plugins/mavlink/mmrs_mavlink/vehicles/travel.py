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

from collections.abc import Iterator
from math import inf

from ..links.link import Link
from ..program import Travel
from ..services import parameters


def set_up(link: Link, travel: Travel, acceptance: float = inf) -> Iterator[str]:
    """Set a vehicle up for a way of travelling; yield what was changed, and what was not confirmed.

    Args:
        link: to the vehicle.
        travel: how carefully it is to go.
        acceptance: metres from a place at which it counts as reached.
    """
    radii, margins = link.profile.radii, link.profile.autopilot.margins
    radius = min(travel.radius, acceptance) if link.profile.stops_early else travel.radius
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
