"""What the vehicle does in each of its modes, step by step."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import hypot

from mmrs_mavlink.sitl.autopilot import Autopilot, bearing
from mmrs_mavlink.sitl.body import Vector
from mmrs_mavlink.sitl.items import RALLY
from mmrs_mavlink.sitl.missions import fly_mission
from mmrs_mavlink.sitl.modes import MANUAL
from mmrs_mavlink.sitl.sticks import go_by_hand

NEAR, CLIMBED = 1.0, 0.3
FINAL_HEIGHT = 10.0
"""Metres above ground below which it lands slowly."""

LEAST_DESCENT = 1.0
"""Slowest descent, metres per second: as slow as a real one would only make rehearsals longer."""

GROUND = 0.05
OTHER_THAN_HOME = 1
"""RTL_TYPE by which a PX4 goes to a rally point rather than home."""


def decide(pilot: Autopilot, seconds: float) -> None:
    """Give the body of an armed vehicle its next target."""
    if pilot.settings.kind == "sub" and pilot.mode_name in MANUAL:
        go_by_hand(pilot, seconds)
    else:
        _PILOTS.get(pilot.mode_name, _hold)(pilot, seconds)


def begin_return(pilot: Autopilot) -> None:
    """Choose where to go back to, and by which places, once."""
    if pilot.returning:
        return
    if pilot.mode_name == "smart_return":
        pilot.returning = [*reversed(pilot.crumbs[1:]), pilot.crumbs[0]]
        return
    here, goal = pilot.body.position, _haven(pilot)
    height = max(here[2], goal[2] + _return_height(pilot)) if pilot.flies else here[2]
    pilot.returning = [(here[0], here[1], height), (goal[0], goal[1], height)]


def _hold(pilot: Autopilot, seconds: float) -> None:
    pilot.body.target = pilot.body.onward = None


def _guided(pilot: Autopilot, seconds: float) -> None:
    """Go where commands say; a rover stops as soon as it is within WP_RADIUS of that."""
    target = pilot.body.target
    if target is None or pilot.settings.kind != "rover":
        return
    if _aside(target, pilot.body.position) <= pilot.parameters["WP_RADIUS"]:
        pilot.body.target = None


def _take_off(pilot: Autopilot, seconds: float) -> None:
    target = pilot.body.target
    if target is not None and pilot.body.distance_to(target) < CLIMBED:
        pilot.enter(*(("auto",) if pilot.parameters["COM_TAKEOFF_ACT"] == 1 else ()), "loiter")


def _land(pilot: Autopilot, seconds: float) -> None:
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


def _surface(pilot: Autopilot, seconds: float) -> None:
    pilot.body.target = (pilot.body.position[0], pilot.body.position[1], 0.0)


def _return(pilot: Autopilot, seconds: float) -> None:
    begin_return(pilot)
    body = pilot.body
    while len(pilot.returning) > 1 and body.distance_to(pilot.returning[0]) < CLIMBED:
        pilot.returning.pop(0)
    smooth = pilot.mode_name == "smart_return" and len(pilot.returning) > 1
    goal = body.target = pilot.returning[0]
    body.onward = pilot.returning[1] if smooth else None
    if smooth and body.goes_by():
        goal = body.target = pilot.returning.pop(0)
    aside = hypot(goal[0] - body.position[0], goal[1] - body.position[1])
    if pilot.flies and len(pilot.returning) == 1 and aside < NEAR:
        _land(pilot, seconds)
        return
    face(pilot, goal)


def face(pilot: Autopilot, place: Vector) -> None:
    """Look where it goes, or at the region of interest."""
    wanted = bearing(pilot.body.position, pilot.roi or place)
    if wanted is not None:
        pilot.body.wanted_heading = wanted


def _haven(pilot: Autopilot) -> Vector:
    """Return where it goes back to: the nearest of home and the rally points, as its parameters have it."""
    latitude, longitude, altitude = pilot.home
    home = pilot.local(latitude, longitude, altitude - pilot.settings.altitude)
    here = pilot.body.position
    limit = pilot.parameters.get("RALLY_LIMIT_KM", 0.0) * 1000.0
    points = [pilot.place_of(item) for item in pilot.stores[RALLY]]
    points = [point for point in points if not limit or _aside(point, here) <= limit]
    elsewhere = pilot.parameters.get("RTL_TYPE") == OTHER_THAN_HOME
    if pilot.parameters.get("RALLY_INCL_HOME", not elsewhere) or not points:
        points.append(home)
    nearest = min(points, key=lambda point: _aside(point, here))
    return (nearest[0], nearest[1], home[2])


def _aside(a: Vector, b: Vector) -> float:
    return hypot(a[0] - b[0], a[1] - b[1])


def _return_height(pilot: Autopilot) -> float:
    if "RTL_ALT_M" in pilot.parameters:
        return pilot.parameters["RTL_ALT_M"]
    centimetres = pilot.parameters.get("RTL_ALT")
    return pilot.parameters.get("RTL_RETURN_ALT", 15.0) if centimetres is None else centimetres / 100.0


def _auto(pilot: Autopilot, seconds: float) -> None:
    done = fly_mission(pilot, seconds)
    if done == "land":
        _land(pilot, seconds)
    elif done == "return":
        _return(pilot, seconds)


_PILOTS: Mapping[str, Callable[[Autopilot, float], None]] = {
    "auto": _auto,
    "guided": _guided,
    "take_off": _take_off,
    "land": _land,
    "return": _return,
    "smart_return": _return,
    "surface": _surface,
}
