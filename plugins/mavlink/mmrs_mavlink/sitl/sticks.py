"""A pilot's sticks: how an underwater vehicle goes by hand, without knowing where it is.

As ArduSub takes MANUAL_CONTROL: forward and sideways, up and down, and a turn; in depth hold the depth
stays where the stick is let go. When nothing has come for a while, ArduSub disarms (FS_PILOT_INPUT).
How fast a vehicle is at full stick depends on its thrusters; here it is always the same.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, hypot, radians, sin
from typing import Any

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.sitl.autopilot import Autopilot

FULL_SPEED, FULL_CLIMB, FULL_TURN = 1.0, 0.5, 45.0
"""At full stick: metres per second, level and upright, and degrees per second."""

DEAD = 0.05
"""Part of a stick's way that counts as none."""

PILOT_TIMEOUT = 3.0
AHEAD = 60.0


@dataclass(frozen=True, slots=True)
class Sticks:
    """Where the sticks are, each from -1 to 1, and since when, seconds."""

    time: float
    forward: float
    sideways: float
    up: float
    turn: float


def sticks_of(message: Any, time: float) -> Sticks:
    """Return the sticks of a MANUAL_CONTROL: ArduSub's z is from 0 to 1000, and rests at 500."""
    forward, sideways, turn = (_within(each / 1000.0) for each in (message.x, message.y, message.r))
    return Sticks(time, forward, sideways, _within((message.z - 500) / 500.0), turn)


def _within(part: float) -> float:
    return 0.0 if abs(part) < DEAD else max(-1.0, min(1.0, part))


def go_by_hand(pilot: Autopilot, seconds: float) -> None:
    """Give the body of an underwater vehicle the way that the sticks say."""
    sticks, body = pilot.sticks, pilot.body
    if sticks is not None and pilot.time - sticks.time > max(PILOT_TIMEOUT, pilot.patience):
        pilot.say(mavlink.MAV_SEVERITY_CRITICAL, "Lost manual control")
        pilot.sticks = None
        pilot.disarm()
        return
    if sticks is None:
        body.target = body.onward = None
        return
    body.heading = (body.heading + sticks.turn * FULL_TURN * seconds) % 360.0
    ahead, aside = radians(body.heading), radians(body.heading + 90.0)
    north = FULL_SPEED * (sticks.forward * cos(ahead) + sticks.sideways * cos(aside))
    east = FULL_SPEED * (sticks.forward * sin(ahead) + sticks.sideways * sin(aside))
    up = FULL_CLIMB * sticks.up
    here = body.position
    if not (north or east or up):
        body.target = body.onward = None
        return
    body.climb = body.descent = FULL_CLIMB
    body.speed = hypot(north, east, up)
    body.target = (here[0] + north * AHEAD, here[1] + east * AHEAD, min(0.0, here[2] + up * AHEAD))
    body.onward = body.origin = body.wanted_heading = None
