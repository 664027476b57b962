"""Simulation of a vehicle over time: its failsafes, its control, its motion and its battery."""

from __future__ import annotations

from math import dist

from mmrs_mavlink.sitl.autopilot import SimulatedAutopilot
from mmrs_mavlink.sitl.control import decide
from mmrs_mavlink.sitl.failsafes import watch

CONTROL_SECONDS = 0.05
"""Longest time between two decisions."""

TRACK_SECONDS = 0.1
CRUMB_METRES = 3.0
"""Distance between two positions that SmartRTL remembers."""

FALL_SPEED = 10.0
GRAVITY = 9.81


def advance(pilot: SimulatedAutopilot, seconds: float) -> None:
    """Simulate that many seconds."""
    while seconds > 1e-9:
        step = min(seconds, CONTROL_SECONDS)
        seconds -= step
        pilot.time += step
        watch(pilot)
        if pilot.armed and not pilot.motor_failed:
            decide(pilot, step)
        if pilot.armed:
            _move(pilot, step)
        else:
            _idle(pilot, step)


def _move(pilot: SimulatedAutopilot, seconds: float) -> None:
    if pilot.motor_failed:
        _fall(pilot, seconds)
        return
    body = pilot.body
    if pilot.time >= pilot.climbs_at:
        body.advance(seconds)
    pilot.battery.drain(seconds)
    pilot.camera.move(body)
    if pilot.flies:
        _touch_ground(pilot)
    elif body.position[2] > 0.0:
        body.position = (*body.position[:2], 0.0)
    _record_track(pilot)


def _fall(pilot: SimulatedAutopilot, seconds: float) -> None:
    """Fall, and lie on the ground with running motors, as a quadcopter without one of its motors does."""
    body = pilot.body
    if pilot.airborne:
        (north, east, up), speed = body.position, min(FALL_SPEED, GRAVITY * seconds - body.velocity[2])
        body.position, body.velocity = (north, east, max(0.0, up - speed * seconds)), (0.0, 0.0, -speed)
    if not pilot.airborne:
        body.rest_at(0.0)
    _record_track(pilot)


def _idle(pilot: SimulatedAutopilot, seconds: float) -> None:
    pilot.battery.charge(seconds, pilot.settings.recharge)
    north, east, up = pilot.body.position
    if pilot.airborne:
        pilot.body.position = (north, east, max(0.0, up - FALL_SPEED * seconds))
        pilot.body.velocity = (0.0, 0.0, -FALL_SPEED)
        _record_track(pilot)
    else:
        pilot.body.rest_at(0.0 if pilot.flies else up)
    if pilot.uptime < pilot.settings.boot:
        pilot.start_mode()


def _touch_ground(pilot: SimulatedAutopilot) -> None:
    target = pilot.body.target
    climbs = target is not None and target[2] > 0.0
    if pilot.body.position[2] < 0.0:
        pilot.body.rest_at(0.0)
        pilot.body.target = target if climbs else None
    delay = pilot.parameters["COM_DISARM_PRFLT" if pilot.px4 else "DISARM_DELAY"]
    if pilot.airborne or climbs:
        pilot.grounded_since = pilot.time
    elif 0.0 < delay < pilot.time - pilot.grounded_since:
        pilot.disarm()


def _record_track(pilot: SimulatedAutopilot) -> None:
    position = pilot.body.position
    if not pilot.track or pilot.time - pilot.track[-1][0] >= TRACK_SECONDS - 1e-6:
        pilot.track.append((pilot.time, *pilot.body.place))
    if pilot.armed and not pilot.return_path and dist(position, pilot.breadcrumbs[-1]) >= CRUMB_METRES:
        pilot.breadcrumbs.append(position)
