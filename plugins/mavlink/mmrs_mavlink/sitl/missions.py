"""Execution of a mission, item by item, as ArduPilot was measured to do it."""

from __future__ import annotations

from collections.abc import Mapping

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.sitl.autopilot import CHANGE_SPEED, SimulatedAutopilot, bearing
from mmrs_mavlink.sitl.body import CUT, Vector
from mmrs_mavlink.sitl.items import MISSION, MOVING, StoredItem

CLOSE = 0.2
MEASURED_RADIUS = 2.0
"""Waypoint radius, metres, at which corners were measured; with another the cut is assumed proportional."""

RADII = (("WP_RADIUS_M", 1.0), ("WPNAV_RADIUS", 0.01), ("WP_RADIUS", 1.0), ("NAV_ACC_RAD", 1.0))
"""Parameters of the waypoint radius, with their units in metres."""

TURN_SECONDS = 10.0
"""Duration of a circle of LOITER_TURNS, which is flown on the spot."""

UNREPORTED = frozenset({203, 206, 2000, 2001, 2500, 2501})
"""Camera items, which are executed in order but never reported as reached."""

STOPPING = frozenset({20, 21, 22, 93, 112, 177})
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
        if not _execute(pilot, item, seconds) or not _complete(pilot, item):
            return ""
    return ""


def jump(pilot: SimulatedAutopilot, number: int) -> None:
    """Continue with another item."""
    pilot.item, pilot.held, pilot.finished = number, 0.0, False
    pilot.return_path = []


def _complete(pilot: SimulatedAutopilot, item: StoredItem) -> bool:
    """Continue with the next item; return whether there is one."""
    pilot.visited.append((pilot.time, pilot.item))
    if item.command not in UNREPORTED:
        pilot.pending = pilot.item
    if item.command == mavlink.MAV_CMD_DO_JUMP:
        made = pilot.jumps_made.get(pilot.item, 0)
        if not 0 <= item.params[1] <= made:
            pilot.jumps_made[pilot.item] = made + 1
            jump(pilot, int(item.params[0]))
            return True
    if item.command in MOVING:
        pilot.body.start_next_leg()
    if pilot.item + 1 >= len(pilot.stores[MISSION]):
        pilot.finished = True
        pilot.body.target = pilot.body.onward = pilot.body.origin = None
        return False
    jump(pilot, pilot.item + 1)
    return True


def _execute(pilot: SimulatedAutopilot, item: StoredItem, seconds: float) -> bool:
    """Execute an item for that long; return whether it is completed."""
    if item.command in MOVING:
        return _go(pilot, item, seconds)
    if item.command in (mavlink.MAV_CMD_NAV_DELAY, mavlink.MAV_CMD_CONDITION_DELAY):
        pilot.held += seconds
        return pilot.held >= item.params[0]
    if item.command == CHANGE_SPEED:
        pilot.body.speed = item.params[1]
    elif item.command == mavlink.MAV_CMD_CONDITION_YAW:
        pilot.body.wanted_heading = item.params[0]
    elif item.command in (mavlink.MAV_CMD_DO_SET_ROI, mavlink.MAV_CMD_DO_SET_ROI_LOCATION):
        pilot.roi = pilot.place_of(item)
    elif item.command == mavlink.MAV_CMD_DO_SET_ROI_NONE:
        pilot.roi = None
    elif item.command == mavlink.MAV_CMD_DO_FENCE_ENABLE:
        pilot.parameters["FENCE_ENABLE"] = item.params[0]
    pilot.record(item.command, (*item.params, item.x, item.y, item.z))
    return True


def _go(pilot: SimulatedAutopilot, item: StoredItem, seconds: float) -> bool:
    body, takes_off = pilot.body, item.command == mavlink.MAV_CMD_NAV_TAKEOFF
    if pilot.flies and not pilot.airborne and not takes_off:
        return False
    place = pilot.place_of(item)
    if takes_off:
        place = (*body.position[:2], place[2])
    body.target = place
    body.onward, body.cut = _onward(pilot, item), CUT * _radius(pilot.parameters) / MEASURED_RADIUS
    wanted = bearing(body.position, pilot.roi or place)
    if wanted is not None:
        body.wanted_heading = wanted
    if body.onward is not None:
        return body.passes_target()
    if body.distance_to(place) > CLOSE and not pilot.held:
        return False
    pilot.held += seconds
    return pilot.held >= _hold_of(item)


def _radius(values: Mapping[str, float]) -> float:
    return next((values[name] * unit for name, unit in RADII if name in values), MEASURED_RADIUS)


def _onward(pilot: SimulatedAutopilot, item: StoredItem) -> Vector | None:
    """Return the position after an item at which it does not stop; None if it stops."""
    if item.command not in (mavlink.MAV_CMD_NAV_WAYPOINT, 82) or item.params[0] >= 1.0:
        return None
    for following in pilot.stores[MISSION][pilot.item + 1 :]:
        if following.command in STOPPING:
            return None
        if following.command in MOVING and (following.x or following.y):
            return pilot.place_of(following)
    return None


def _hold_of(item: StoredItem) -> float:
    if item.command == mavlink.MAV_CMD_NAV_LOITER_UNLIM:
        return float("inf")
    turns = item.command == mavlink.MAV_CMD_NAV_LOITER_TURNS
    return item.params[0] * TURN_SECONDS if turns else item.params[0]


def _arrives_to_land(pilot: SimulatedAutopilot, item: StoredItem) -> bool:
    """Fly above the position of a landing; return whether it is there."""
    if not (item.x or item.y) or pilot.held:
        return True
    place = pilot.place_of(item)
    above = (place[0], place[1], pilot.body.position[2])
    pilot.body.target, pilot.body.onward = above, None
    pilot.held = 1.0 if pilot.body.distance_to(above) <= CLOSE else 0.0
    return bool(pilot.held)
