"""What records on the way: begun before a stroke and ended after it."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from math import dist

from mmrs_core.planning.devices import device_for
from mmrs_core.scene import ActionAt, Part, Robot, Stroke
from mmrs_core.scene.attributes import number, text


def recorded(part: Part, robot: Robot, stroke: Stroke) -> Stroke:
    """Return a stroke with what the task records on it, at its speed.

    One that is recorded is followed as it is, from its first point to its last, in one go.

    Raises:
        InfeasibleError: the robot has no device for it.
    """
    speed = number(part, "speed")
    if speed is not None:
        stroke = replace(stroke, speed=speed, slow_down=1.0)
    actions = tuple(
        ActionAt(at, action, device_for(robot.type, action, text(part, "deviceId")).id)
        for at, action in ((0.0, text(part, "startAction")), (_length(stroke), text(part, "stopAction")))
        if action
    )
    return replace(stroke, actions=actions, cuts=(), reversible=False) if actions else stroke


def _length(stroke: Stroke) -> float:
    return sum(dist(one, other) for one, other in pairwise(stroke.points))
