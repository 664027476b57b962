"""The rule for thermal images along rows of panels."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import pairwise
from math import ceil, dist

from mmrs_core.contributions.rules import Rule
from mmrs_core.errors import InfeasibleError
from mmrs_core.geometry.stretches import LEAST
from mmrs_core.planning.in_passing import passing_speed
from mmrs_core.planning.open_lines import open_lines
from mmrs_core.planning.positions import refuse_heights
from mmrs_core.scene import Device, Look, Part, Position, Robot, Scene, Stroke, Task, Work
from mmrs_core.scene.attributes import number, text
from mmrs_solar.camera import RECORDING_KEYS, figures, optics_of
from mmrs_solar.groups import Group, between, group_of, whole
from mmrs_solar.names import THERMAL_ROW_TASK
from mmrs_solar.nearness import refuse_near
from mmrs_solar.recording import camera_for, distance_for, recorded
from mmrs_solar.views import View, aim_beyond, before, view_of

RULE = "row_inspection"

LONGEST = 150.0
"""Metres of a row that are recorded in one go, so that robots can share long rows."""

MOST_PASSES = 1_000
"""Passes at most over one row: more are taken for a mistake."""

MOST_WAYS = 20_000
"""Passes at most along the rows of one task: more take too long to plan."""


@dataclass(frozen=True, slots=True)
class Pass:
    """How a robot goes along rows.

    Attributes:
        camera: that records. view: of the camera. distance: from the panels, metres.
        speed: largest, metres per second.
        lead_in: metres on which the robot turns before it records.
        uphill: where the passes over one row look, metres from its middle.
    """

    camera: Device
    view: View
    distance: float
    speed: float
    lead_in: float
    uphill: tuple[float, ...]


def row_inspection_work(task: Task, robot: Robot, scene: Scene) -> Work:
    """Return a stroke along each row, or several where the camera does not see the whole row.

    The camera records from the beginning of a row to its end, and faces it squarely all the way; the
    robot looks into the same direction, whichever way it goes.
    """
    part, group = task.part, group_of(task.part, scene)
    how = _pass_of(part, group, robot)
    ways, stretches = [], []
    for index, (row, share, *ends) in enumerate(_ways(part, group, how)):
        begin, end = ends if index % 2 == 0 else ends[::-1]
        stretches.append((f"row {row}, stretch {share}", dist(begin, end), index % 2 == 0))
        points = (between(begin, end, -how.lead_in / dist(begin, end)), begin, end)
        refuse_heights(robot, points)
        refuse_near(robot, group, end, f"the way along row {row}")
        ways.append((f"the way along row {row}", points))
    found = open_lines(robot, scene, ways, least=how.lead_in + LEAST)
    strokes = []
    for way, (index, (first, last)) in zip(found.parts, found.stretches, strict=True):
        name, length, ahead = stretches[index]
        recording = (first, last - how.lead_in) if ahead else (length - first, length + how.lead_in - last)
        strokes.append(replace(_stroke(part, how, way[0], way[-1]), part=name, stretch=recording))
    return Work(tuple(strokes), divisible=True, rule=RULE, ordered=False, gaps=found.gaps)


def _stroke(part: Part, how: Pass, start: Position, end: Position) -> Stroke:
    begin = between(start, end, how.lead_in / dist(start, end))
    length = dist(begin, end)
    actions = (
        recorded(part, how.camera, text(part, "startAction"), how.lead_in),
        recorded(part, how.camera, text(part, "stopAction"), how.lead_in + length),
    )
    look = Look(aim_beyond(between(begin, end, 0.5), how.view, length), how.camera.id)
    return Stroke((start, begin, end), actions, look, speed=how.speed)


def _pass_of(part: Part, group: Group, robot: Robot) -> Pass:
    camera = camera_for(part, robot, text(part, "startAction"), text(part, "stopAction"))
    optics = optics_of(camera)
    view = view_of(group.azimuth, group.tilt, optics.lowest, optics.highest)
    distance = distance_for(part, camera.id, optics, view)
    figures(camera, RECORDING_KEYS)
    spacing = distance * optics.width * (1.0 - (number(part, "frontOverlap") or 0.0))
    pixel, blur = distance * optics.pixel * view.stretch, number(part, "blur") or 0.0
    speed = passing_speed(camera, robot, spacing, pixel, blur, number(part, "speed") or 0.0)
    strip = distance * optics.height * view.stretch
    offsets = passes_over(group.width, strip, number(part, "sideOverlap") or 0.0)
    return Pass(camera, view, distance, speed, _turning(robot, speed), offsets)


def _turning(robot: Robot, speed: float) -> float:
    """Return the metres on which a robot turns by half a circle at that speed, one at least."""
    rate = robot.kinematics.turn_rate if robot.kinematics is not None else 0.0
    return max(1.0, speed * 180.0 / rate) if rate > 0.0 else 1.0


def passes_over(width: float, strip: float, overlap: float) -> tuple[float, ...]:
    """Return where passes over a row look, metres uphill of its middle.

    Args:
        width: of the row, metres. strip: what is seen of it at once.
        overlap: part of a strip that the next one shows again; one strip over all needs no other.

    Raises:
        InfeasibleError: these are too many to be planned.

    >>> passes_over(4.0, 5.0, 0.6)
    (0.0,)
    >>> passes_over(6.0, 4.0, 0.5)
    (-1.0, 1.0)
    """
    if strip >= width:
        return (0.0,)
    wanted = (width - strip) / (strip * (1.0 - overlap))
    if not wanted < MOST_PASSES:
        raise InfeasibleError(
            f"a row takes about {wanted:,.0f} passes, of which {MOST_PASSES:,} can be planned"
        )
    steps = max(1, ceil(wanted - 1e-9))
    step = (width - strip) / steps
    return tuple(index * step - (width - strip) / 2.0 for index in range(steps + 1))


def _ways(part: Part, group: Group, how: Pass) -> Iterator[tuple[int, int, Position, Position]]:
    """Yield (row, stretch, begin, end) of each way of the camera, in the direction of the group's points."""
    first, last = whole(part, "firstRow", 1), whole(part, "lastRow", group.rows)
    if not 1 <= first <= last <= group.rows:
        raise InfeasibleError(f"rows {first} to {last} are asked for, the group has {group.rows}")
    parts = max(1, ceil(dist(group.begin, group.end) / LONGEST))
    wanted = (last - first + 1) * len(how.uphill) * parts
    if wanted > MOST_WAYS:
        raise InfeasibleError(
            f"takes {wanted:,} ways along rows, of which {MOST_WAYS:,} can be planned: "
            "divide it by firstRow and lastRow"
        )
    for row in range(first, last + 1):
        for uphill in how.uphill:
            begin, end = (before(each, how.view, how.distance) for each in group.row(row, uphill))
            stops = [between(begin, end, index / parts) for index in range(parts + 1)]
            yield from ((row, share, *ends) for share, ends in enumerate(pairwise(stops), 1))


ROW_INSPECTION_RULE = Rule(RULE, THERMAL_ROW_TASK, row_inspection_work)
