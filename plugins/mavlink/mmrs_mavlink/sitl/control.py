"""Control of an armed vehicle in each of its modes, step by step."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import hypot

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.sitl.autopilot import MANUAL, SimulatedAutopilot, bearing
from mmrs_mavlink.sitl.body import Vector
from mmrs_mavlink.sitl.items import RALLY
from mmrs_mavlink.sitl.missions import fly_mission
from mmrs_mavlink.sitl.sticks import follow_sticks

NEAR, CLIMBED = 1.0, 0.3
FINAL_HEIGHT = 10.0
"""Metres above ground below which it descends slowly."""

LEAST_DESCENT = 1.0
"""Slowest descent, metres per second: a realistic one would only make rehearsals longer."""

GROUND = 0.05
PILOT_TIMEOUT = 3.0
"""Seconds without MANUAL_CONTROL after which ArduSub disarms (FS_PILOT_INPUT)."""

RALLY_POINT = 1
"""RTL_TYPE of a PX4 that returns to a rally point rather than home."""


def decide(pilot: SimulatedAutopilot, seconds: float) -> None:
    """Set the next target of an armed vehicle."""
    if pilot.mode_name != "guided":
        pilot.body.driven = None
    if pilot.settings.kind == "sub" and pilot.mode_name in MANUAL:
        _follow_pilot(pilot, seconds)
    else:
        _BY_MODE.get(pilot.mode_name, _hold)(pilot, seconds)


def _follow_pilot(pilot: SimulatedAutopilot, seconds: float) -> None:
    sticks = pilot.sticks
    if sticks is not None and pilot.time - sticks.time > max(PILOT_TIMEOUT, pilot.link_timeout):
        pilot.say(mavlink.MAV_SEVERITY_CRITICAL, "Lost manual control")
        pilot.sticks = None
        pilot.disarm()
    else:
        follow_sticks(sticks, pilot.body, seconds)


def _hold(pilot: SimulatedAutopilot, seconds: float) -> None:
    pilot.body.target = pilot.body.onward = None


def _guided(pilot: SimulatedAutopilot, seconds: float) -> None:
    """Follow set-points; a rover stops within WP_RADIUS of one."""
    target = pilot.body.target
    if target is None or pilot.settings.kind != "rover":
        return
    if _distance(target, pilot.body.position) <= pilot.parameters["WP_RADIUS"]:
        pilot.body.target = None


def _take_off(pilot: SimulatedAutopilot, seconds: float) -> None:
    target = pilot.body.target
    if target is not None and pilot.body.distance_to(target) < CLIMBED:
        pilot.enter(*(("auto",) if pilot.parameters["COM_TAKEOFF_ACT"] == 1 else ()), "hold")


def _land(pilot: SimulatedAutopilot, seconds: float) -> None:
    body = pilot.body
    if not pilot.flies:
        _hold(pilot, seconds)
        return
    north, east, up = body.position
    slow = pilot.parameters.get("LAND_SPEED", 0.0) / 100.0 or pilot.parameters.get("MPC_LAND_SPEED", 0.5)
    body.target, body.onward = (north, east, -1.0), None
    body.speed = max(body.speed, 1.0) if up > FINAL_HEIGHT else max(slow, LEAST_DESCENT)
    if up <= GROUND:
        body.rest_at(0.0)
        pilot.disarm()


def _surface(pilot: SimulatedAutopilot, seconds: float) -> None:
    pilot.body.target = (*pilot.body.position[:2], 0.0)


def _return(pilot: SimulatedAutopilot, seconds: float) -> None:
    body, retraces = pilot.body, pilot.mode_name == "smart_return"
    if not pilot.return_path:
        crumbs = pilot.breadcrumbs
        pilot.return_path = [*reversed(crumbs[1:]), crumbs[0]] if retraces else _path_home(pilot)
    path = pilot.return_path
    while len(path) > 1 and body.distance_to(path[0]) < CLIMBED:
        path.pop(0)
    smooth = retraces and len(path) > 1
    goal = body.target = path[0]
    body.onward = path[1] if smooth else None
    if smooth and body.passes_target():
        goal = body.target = path.pop(0)
    if pilot.flies and len(path) == 1 and _distance(goal, body.position) < NEAR:
        _land(pilot, seconds)
        return
    wanted = bearing(body.position, pilot.roi or goal)
    if wanted is not None:
        body.wanted_heading = wanted


def _path_home(pilot: SimulatedAutopilot) -> list[Vector]:
    here, goal = pilot.body.position, _return_point(pilot)
    height = max(here[2], goal[2] + _return_height(pilot)) if pilot.flies else here[2]
    return [(here[0], here[1], height), (goal[0], goal[1], height)]


def _return_point(pilot: SimulatedAutopilot) -> Vector:
    """Return the nearest of home and the rally points that the parameters allow."""
    latitude, longitude, altitude = pilot.home
    home = pilot.local(latitude, longitude, altitude - pilot.settings.altitude)
    here = pilot.body.position
    limit = pilot.parameters.get("RALLY_LIMIT_KM", 0.0) * 1000.0
    points = [pilot.place_of(item) for item in pilot.stores[RALLY]]
    points = [point for point in points if not limit or _distance(point, here) <= limit]
    includes_home = pilot.parameters.get("RALLY_INCL_HOME", pilot.parameters.get("RTL_TYPE") != RALLY_POINT)
    if includes_home or not points:
        points.append(home)
    nearest = min(points, key=lambda point: _distance(point, here))
    return (nearest[0], nearest[1], home[2])


def _distance(a: Vector, b: Vector) -> float:
    return hypot(a[0] - b[0], a[1] - b[1])


def _return_height(pilot: SimulatedAutopilot) -> float:
    if "RTL_ALT_M" in pilot.parameters:
        return pilot.parameters["RTL_ALT_M"]
    centimetres = pilot.parameters.get("RTL_ALT")
    return pilot.parameters.get("RTL_RETURN_ALT", 15.0) if centimetres is None else centimetres / 100.0


def _auto(pilot: SimulatedAutopilot, seconds: float) -> None:
    required = fly_mission(pilot, seconds)
    if required == "land":
        _land(pilot, seconds)
    elif required == "return":
        _return(pilot, seconds)


_BY_MODE: Mapping[str, Callable[[SimulatedAutopilot, float], None]] = {
    "auto": _auto,
    "guided": _guided,
    "take_off": _take_off,
    "land": _land,
    "return": _return,
    "smart_return": _return,
    "surface": _surface,
}
