"""Manual control of an underwater vehicle by a pilot's sticks, as ArduSub takes MANUAL_CONTROL.

The speeds at full stick are constants; those of a real vehicle depend on its thrusters.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, hypot, radians, sin
from typing import Any

from mmrs_mavlink.sitl.body import Body

FULL_SPEED, FULL_CLIMB, FULL_TURN = 1.0, 0.5, 45.0
"""At full stick: metres per second, horizontal and vertical, and degrees per second."""

DEAD = 0.05
"""Dead zone, as a fraction of full stick."""

AHEAD = 60.0
"""Seconds of motion ahead of the vehicle at which its target is set."""


@dataclass(frozen=True, slots=True)
class ManualControl:
    """Positions of the sticks, each from -1 to 1, and the time in seconds at which they were received."""

    time: float
    forward: float
    sideways: float
    up: float
    turn: float


def sticks_of(message: Any, time: float) -> ManualControl:
    """Return the sticks of a MANUAL_CONTROL: ArduSub's z ranges from 0 to 1000, neutral at 500."""
    forward, sideways, turn = (_within(each / 1000.0) for each in (message.x, message.y, message.r))
    return ManualControl(time, forward, sideways, _within((message.z - 500) / 500.0), turn)


def _within(part: float) -> float:
    return 0.0 if abs(part) < DEAD else max(-1.0, min(1.0, part))


def follow_sticks(sticks: ManualControl | None, body: Body, seconds: float) -> None:
    """Move a body as the sticks command; None or neutral sticks stop it."""
    body.target = body.onward = None
    if sticks is None:
        return
    body.heading = (body.heading + sticks.turn * FULL_TURN * seconds) % 360.0
    ahead, aside = radians(body.heading), radians(body.heading + 90.0)
    north = FULL_SPEED * (sticks.forward * cos(ahead) + sticks.sideways * cos(aside))
    east = FULL_SPEED * (sticks.forward * sin(ahead) + sticks.sideways * sin(aside))
    up = FULL_CLIMB * sticks.up
    if not (north or east or up):
        return
    here = body.position
    body.climb = body.descent = FULL_CLIMB
    body.speed = hypot(north, east, up)
    body.target = (here[0] + north * AHEAD, here[1] + east * AHEAD, min(0.0, here[2] + up * AHEAD))
    body.origin = body.wanted_heading = None
