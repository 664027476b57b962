"""The rule for surveys of an area by sonar at one depth, the strip that a sonar covers, and recording.

Keys of device properties, as text: ``sonar.swath``, metres, where the strip does not depend on the
height above the bottom. Otherwise ``sonar.aperture``, degrees across the track in which a sonar that looks
down sees, and ``sonar.range``, metres along its beams. At a height h above level ground the former
covers ``2 h tan(aperture / 2)``, the latter ``2 sqrt(range² - h²)``, both together the smaller of the two.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from itertools import pairwise
from math import dist, inf, radians, sqrt, tan

from mmrs_auv.names import APERTURE, DEPTH_HOLD_SURVEY_TASK, RANGE, SONAR_KEYS, SWATH
from mmrs_core.contributions.rules import Rule
from mmrs_core.errors import InfeasibleError
from mmrs_core.planning.devices import carried, device_for, figure
from mmrs_core.planning.positions import refuse_blocked, refuse_heights
from mmrs_core.scene import ActionAt, Device, Part, Robot, RobotType, Scene, Stroke, Task, Work
from mmrs_core.scene.attributes import holes, number, position, ring, text


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


def swath_at(properties: Mapping[str, str], height: float | None) -> float | None:
    """Return the width of the strip that a sonar covers, metres; None where that is not known.

    Args:
        height: above the bottom, metres; None where it is not known.

    >>> swath_at({"sonar.aperture": "90"}, 5.0)
    10.0
    >>> swath_at({"sonar.range": "13"}, 5.0)
    24.0
    """
    fixed = figure(properties, SWATH)
    if fixed is not None:
        return fixed
    aperture, reach = figure(properties, APERTURE), figure(properties, RANGE)
    if height is None or not height > 0.0 or (aperture is None and reach is None):
        return None
    seen = inf if aperture is None or aperture >= 180.0 else 2.0 * height * tan(radians(aperture / 2.0))
    reached = inf if reach is None else 2.0 * sqrt(max(0.0, reach**2 - height**2))
    least = min(seen, reached)
    return round(least, 9) if 0.0 < least < inf else None


def swath_of(part: Part, robot_type: RobotType) -> float:
    """Return the width of the strip that a survey covers in one line, metres, overlap not taken off.

    Raises:
        InfeasibleError: neither the task nor a device of the robot says it.
    """
    given = number(part, "swath")
    if given is not None:
        return given
    device = _sonar(robot_type, carried(robot_type, text(part, "deviceId")))
    found = swath_at(device.properties, height_of(number(part, "depth"), number(part, "bottomDepth")))
    if found is None:
        raise InfeasibleError(
            f"device '{device.id}' does not define the width of the strip it covers there: "
            f"give a swath, or a bottomDepth and {SWATH}, {APERTURE} or {RANGE}"
        )
    return found


def height_of(depth: float | None, bottom: float | None) -> float | None:
    """Return the height above the bottom, metres; None where one of both is not given."""
    return None if depth is None or bottom is None else bottom - depth


def _sonar(robot_type: RobotType, device_id: str) -> Device:
    if device_id:
        return robot_type.devices[device_id]
    able = [each for each in robot_type.devices.values() if any(key in each.properties for key in SONAR_KEYS)]
    if not able:
        raise InfeasibleError("has no device whose properties describe a sonar")
    if len(able) > 1:
        names = " and ".join(f"'{device.id}'" for device in able)
        raise InfeasibleError(f"devices {names} are both sonars, the task's deviceId names none")
    return able[0]


RULE = "depth_hold_survey"


def survey_work(task: Task, robot: Robot, scene: Scene) -> Work:
    """Return parallel lines at one depth whose swaths cover the area."""
    from mmrs_core.planning.coverage import Sweep, work_over  # validating needs no planner
    from mmrs_core.planning.patterns import pattern_of

    part = task.part
    depth, overlap = number(part, "depth"), number(part, "overlap") or 0.0
    if depth is None:
        raise InfeasibleError("depth is missing")
    width = swath_of(part, robot.type) * (1.0 - overlap)
    if not width > 0.0:
        raise InfeasibleError("swath and overlap leave no distance between lines")
    initial, up = position(part, "initialPosition"), scene.frame.surface - depth
    entry = (initial[0], initial[1], up)
    refuse_heights(robot, (entry,))
    refuse_blocked(robot, scene, (entry,), "the initial position")
    sweep = Sweep(altitude=up, width=width, rule=RULE, start=(entry[0], entry[1]), pattern=pattern_of(part))
    work = work_over(scene, robot, ring(part, "shell"), sweep, holes(part))
    return replace(work, strokes=tuple(recorded(part, robot, each) for each in work.strokes), entry=entry)


SURVEY_RULE = Rule(RULE, DEPTH_HOLD_SURVEY_TASK, survey_work)
