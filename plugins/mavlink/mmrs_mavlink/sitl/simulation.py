"""Simulation of a vehicle over time: its failsafes, its control in each mode and its missions, its motion."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import dist

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.sitl.autopilot import CHANGE_SPEED, MANUAL, SimulatedAutopilot
from mmrs_mavlink.sitl.body import Vector, course, turned
from mmrs_mavlink.sitl.failsafes import watch
from mmrs_mavlink.sitl.items import MISSION, MOVING, RALLY, StoredItem

CONTROL_SECONDS = 0.05
"""Longest time between two decisions."""

TRACK_SECONDS = 0.1
CRUMB_METRES = 3.0
"""Distance between two positions that SmartRTL remembers."""

FALL_SPEED, GRAVITY = 10.0, 9.81
NEAR, CLIMBED, GROUND = 1.0, 0.3, 0.05
PILOT_TIMEOUT = 3.0
"""Seconds without MANUAL_CONTROL after which ArduSub disarms (FS_PILOT_INPUT)."""

CLOSE = 0.2
HOLD = 1.0
"""Seconds of a hold that settling on missions includes."""
STOPPING = frozenset({19, 20, 21, 22})
"""Items before which the vehicle stops."""


def advance(pilot: SimulatedAutopilot, seconds: float) -> None:
    """Simulate that many seconds."""
    while seconds > 1e-9:
        step = min(seconds, CONTROL_SECONDS)
        seconds -= step
        pilot.time += step
        watch(pilot)
        if pilot.armed and not pilot.motor_failed:
            _decide(pilot, step)
        if pilot.armed and not pilot.motor_failed:
            _move(pilot, step)
        else:
            _fall_or_stand(pilot, step)
        _record(pilot)


def _move(pilot: SimulatedAutopilot, seconds: float) -> None:
    body = pilot.body
    if pilot.time >= pilot.climbs_at:
        body.advance(seconds)
    pilot.battery.drain(seconds)
    if not pilot.flies:
        body.position = (*body.position[:2], min(0.0, body.position[2]))
        return
    target = body.target
    climbs = target is not None and target[2] > 0.0
    if body.position[2] < 0.0:
        body.rest_at(0.0)
        body.target = target if climbs else None
    delay = pilot.parameters["COM_DISARM_PRFLT" if pilot.px4 else "DISARM_DELAY"]
    if pilot.airborne or climbs:
        pilot.grounded_since = pilot.time
    elif 0.0 < delay < pilot.time - pilot.grounded_since:
        pilot.disarm()


def _fall_or_stand(pilot: SimulatedAutopilot, seconds: float) -> None:
    """Move without motors; with one that has failed, a copter lies on the ground and the others run on."""
    body = pilot.body
    if not pilot.armed:
        pilot.battery.charge(seconds, pilot.settings.recharge)
        if pilot.uptime < pilot.settings.boot:
            pilot.start_mode()
    if pilot.airborne:
        (north, east, up), speed = body.position, min(FALL_SPEED, GRAVITY * seconds - body.velocity[2])
        body.position, body.velocity = (north, east, max(0.0, up - speed * seconds)), (0.0, 0.0, -speed)
    if not pilot.airborne:
        body.rest_at(0.0 if pilot.flies else body.position[2])


def _record(pilot: SimulatedAutopilot) -> None:
    moves = pilot.armed or pilot.airborne
    if moves and (not pilot.track or pilot.time - pilot.track[-1][0] >= TRACK_SECONDS - 1e-6):
        pilot.track.append((pilot.time, *pilot.body.position))
    position = pilot.body.position
    if 0.0 < pilot.trigger_distance <= dist(position[:2], pilot.triggered_at[:2]):
        pilot.take_photo()
    if pilot.armed and not pilot.return_path and dist(position, pilot.breadcrumbs[-1]) >= CRUMB_METRES:
        pilot.breadcrumbs.append(position)


def _decide(pilot: SimulatedAutopilot, seconds: float) -> None:
    """Set the next target of an armed vehicle."""
    piloted = pilot.settings.kind == "sub" and pilot.mode_name in MANUAL
    if not piloted and pilot.mode_name != "guided":
        pilot.body.driven = None
    if piloted:
        _await_sticks(pilot)
    elif pilot.mode_name == "auto":
        required = _fly_mission(pilot, seconds)
        if required:
            _BY_MODE[required](pilot)
    else:
        _BY_MODE.get(pilot.mode_name, _hold)(pilot)


def _await_sticks(pilot: SimulatedAutopilot) -> None:
    """Disarm a submarine whose pilot has let go of the sticks."""
    _hold(pilot)
    released = pilot.time - pilot.driven_at > max(PILOT_TIMEOUT, pilot.link_timeout)
    if pilot.body.driven is not None and released:
        pilot.say(mavlink.MAV_SEVERITY_CRITICAL, "Lost manual control")
        pilot.disarm()


def _hold(pilot: SimulatedAutopilot) -> None:
    pilot.body.target = pilot.body.onward = None


def _guided(pilot: SimulatedAutopilot) -> None:
    """Follow set-points; a rover stops within WP_RADIUS of one."""
    target = pilot.body.target
    early = target is not None and pilot.settings.profile.stops_early
    if early and target and dist(target[:2], pilot.body.position[:2]) <= pilot.parameters["WP_RADIUS"]:
        pilot.body.target = None


def _take_off(pilot: SimulatedAutopilot) -> None:
    target = pilot.body.target
    if target is not None and pilot.body.distance_to(target) < CLIMBED:
        pilot.enter(*(("auto",) if pilot.parameters["COM_TAKEOFF_ACT"] == 1 else ()), "hold")


def _land(pilot: SimulatedAutopilot) -> None:
    """Come down where it was to be, if that is near, and disarm when it has stood there."""
    body, pacing = pilot.body, pilot.settings.profile.pacing
    if not pilot.flies:
        _hold(pilot)
        return
    place, up = body.target or body.position, body.position[2]
    if dist(place[:2], body.position[:2]) > NEAR:
        place = body.position
    body.target, body.onward, body.curved = (*place[:2], -1.0), None, False
    body.descent = pacing.landing_rate if up < pacing.landing_height else pilot.usual_descent()
    if up > GROUND:
        pilot.grounded_since = pilot.time
    else:
        body.rest_at(0.0)
        if pilot.time - pilot.grounded_since >= (pacing.recovery or 0.0):
            pilot.disarm()


def _surface(pilot: SimulatedAutopilot) -> None:
    pilot.body.target = (*pilot.body.position[:2], 0.0)


def _return(pilot: SimulatedAutopilot) -> None:
    body, retraces = pilot.body, pilot.mode_name == "smart_return"
    if not pilot.return_path:
        crumbs = pilot.breadcrumbs
        pilot.return_path = [*reversed(crumbs[1:]), crumbs[0]] if retraces else _path_home(pilot)
    path = pilot.return_path
    while len(path) > 1 and (body.distance_to(path[0]) < CLIMBED or (retraces and body.passes_target())):
        path.pop(0)
        body.target = path[0]
    body.onward = path[1] if retraces and len(path) > 1 else None
    if pilot.flies and len(path) == 1 and dist(path[0][:2], body.position[:2]) < NEAR:
        _land(pilot)
        return
    body.target = path[0]
    pilot.face(path[0])


def _path_home(pilot: SimulatedAutopilot) -> list[Vector]:
    """Return the path to the nearest of home and the rally points, at the height of returns.

    A PX4 whose RTL_TYPE is 1 returns to a rally point rather than home.
    """
    here, values = pilot.body.position, pilot.parameters
    latitude, longitude, altitude = pilot.home
    home = pilot.local(latitude, longitude, altitude - pilot.settings.altitude)
    limit = values.get("RALLY_LIMIT_KM", 0.0) * 1000.0
    points = [pilot.place_of(item) for item in pilot.stores[RALLY]]
    points = [point for point in points if not limit or dist(point[:2], here[:2]) <= limit]
    if not points or values.get("RALLY_INCL_HOME", values.get("RTL_TYPE") != 1):
        points.append(home)
    goal = min(points, key=lambda point: dist(point[:2], here[:2]))
    above = values["RTL_RETURN_ALT"] if pilot.px4 else values.get("RTL_ALT", 0.0) / 100.0
    height = max(here[2], home[2] + above) if pilot.flies else here[2]
    return [(here[0], here[1], height), (goal[0], goal[1], height)]


def _fly_mission(pilot: SimulatedAutopilot, seconds: float) -> str:
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
    elif item.command == mavlink.MAV_CMD_DO_SET_ROI_LOCATION:
        pilot.interest = pilot.local(item.x * 1e-7, item.y * 1e-7, 0.0)
    elif item.command == mavlink.MAV_CMD_DO_SET_ROI_NONE:
        pilot.interest = None
    pilot.record(item.command, (*item.params, item.x, item.y, item.z))
    return True


def _go(pilot: SimulatedAutopilot, item: StoredItem, seconds: float) -> bool:
    body, takes_off = pilot.body, item.command == mavlink.MAV_CMD_NAV_TAKEOFF
    if pilot.flies and not pilot.airborne and not takes_off:
        return False
    place, pacing = pilot.place_of(item), pilot.settings.profile.pacing
    body.figures = (takes_off and pacing.upright) or pacing.mission or pacing.step
    if takes_off:
        place = (*body.position[:2], place[2])
        if not pilot.airborne and body.target is None:
            pilot.spin_up()
    body.target, body.onward = place, _onward(pilot, item)
    pilot.face(place)
    if body.onward is not None:
        return body.passes_target() or (body.rested >= 0.0 and body.distance_to(place) <= CLOSE)
    settles = body.figures.settling - body.figures.starting - HOLD
    if not pilot.held and (body.distance_to(place) > CLOSE or body.rested < settles):
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
            before, corner, after = pilot.body.position, pilot.place_of(item), pilot.place_of(following)
            sharp = abs(turned(course(before, corner), course(corner, after))) > pilot.body.pivots
            return None if sharp or after == corner else after
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


_BY_MODE: Mapping[str, Callable[[SimulatedAutopilot], None]] = {
    "guided": _guided,
    "take_off": _take_off,
    "land": _land,
    "return": _return,
    "smart_return": _return,
    "surface": _surface,
}
