"""Execution of a mission, item by item."""

from __future__ import annotations

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.sitl.autopilot import CHANGE_SPEED, SimulatedAutopilot
from mmrs_mavlink.sitl.body import Vector
from mmrs_mavlink.sitl.items import MISSION, MOVING, StoredItem

CLOSE = 0.2
UNREPORTED = frozenset({203, 206, 2000, 2001, 2500, 2501})
"""Camera items, which are executed in order but never reported as reached."""

STOPPING = frozenset({19, 20, 21, 22})
"""Items before which the vehicle stops."""


def fly_mission(pilot: SimulatedAutopilot, seconds: float) -> str:
    """Execute the mission for that long; return ``land`` or ``return`` if an item requires that mode."""
    items = pilot.stores[MISSION]
    pilot.item = max(pilot.first_item, pilot.item)
    while not pilot.finished and pilot.item < len(items):
        item = items[pilot.item]
        if item.command == mavlink.MAV_CMD_NAV_RETURN_TO_LAUNCH:
            return "return"
        if item.command == mavlink.MAV_CMD_NAV_LAND and _arrives_to_land(pilot, item):
            return "land"
        if not _execute(pilot, item, seconds):
            return ""
        _complete(pilot, item)
    return ""


def jump(pilot: SimulatedAutopilot, number: int) -> None:
    """Continue with another item."""
    pilot.item, pilot.held, pilot.finished = number, 0.0, False
    pilot.return_path = []


def _complete(pilot: SimulatedAutopilot, item: StoredItem) -> None:
    """Continue with the next item, if there is one."""
    pilot.visited.append((pilot.time, pilot.item))
    if item.command not in UNREPORTED:
        pilot.pending = pilot.item
    if pilot.item + 1 < len(pilot.stores[MISSION]):
        jump(pilot, pilot.item + 1)
    else:
        pilot.finished, pilot.body.onward = True, None


def _execute(pilot: SimulatedAutopilot, item: StoredItem, seconds: float) -> bool:
    """Execute an item for that long; return whether it is completed."""
    if item.command in MOVING:
        return _go(pilot, item, seconds)
    if item.command == CHANGE_SPEED:
        pilot.body.change_speed(item.params[1])
    elif item.command == mavlink.MAV_CMD_CONDITION_YAW:
        pilot.body.wanted_heading = item.params[0]
    pilot.record(item.command, (*item.params, item.x, item.y, item.z))
    return True


def _go(pilot: SimulatedAutopilot, item: StoredItem, seconds: float) -> bool:
    body, takes_off = pilot.body, item.command == mavlink.MAV_CMD_NAV_TAKEOFF
    if pilot.flies and not pilot.airborne and not takes_off:
        return False
    place = pilot.place_of(item)
    if takes_off:
        place = (*body.position[:2], place[2])
        if not pilot.airborne and body.target is None:
            pilot.spin_up()
    body.target, body.onward = place, _onward(pilot, item)
    pilot.face(place)
    if body.onward is not None:
        return body.passes_target()
    if body.distance_to(place) > CLOSE and not pilot.held:
        return False
    pilot.held += seconds
    return item.command != mavlink.MAV_CMD_NAV_LOITER_UNLIM and pilot.held >= item.params[0]


def _onward(pilot: SimulatedAutopilot, item: StoredItem) -> Vector | None:
    """Return the position after an item at which it does not stop; None if it stops, or stays there."""
    if item.command != mavlink.MAV_CMD_NAV_WAYPOINT or item.params[0] >= 1.0:
        return None
    for following in pilot.stores[MISSION][pilot.item + 1 :]:
        if following.command in STOPPING:
            return None
        if following.command in MOVING and (following.x or following.y):
            place = pilot.place_of(following)
            return place if place != pilot.place_of(item) else None
    return None


def _arrives_to_land(pilot: SimulatedAutopilot, item: StoredItem) -> bool:
    """Fly above the position of a landing; return whether it is there."""
    if not (item.x or item.y) or pilot.held:
        return True
    place = pilot.place_of(item)
    above = (place[0], place[1], pilot.body.position[2])
    pilot.body.target, pilot.body.onward = above, None
    pilot.held = 1.0 if pilot.body.distance_to(above) <= CLOSE else 0.0
    return bool(pilot.held)
