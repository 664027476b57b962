"""The rule for tasks along a road, river or line."""

from __future__ import annotations

from dataclasses import replace

from mmrs_core.contributions.rules import Rule
from mmrs_core.errors import InfeasibleError
from mmrs_core.planning.coverage import closed_at
from mmrs_core.planning.open_lines import open_lines
from mmrs_core.planning.positions import refuse_blocked, refuse_heights
from mmrs_core.planning.turnarounds import turned_around
from mmrs_core.scene import Robot, Scene, Task, Work
from mmrs_core.scene.attributes import flag, number, position, positions
from mmrs_survey.lines import at_altitude, lines_over, without_dense
from mmrs_survey.names import ROAD_TASK
from mmrs_survey.spacing import photographed, shots_of


def road_work(task: Task, robot: Robot, scene: Scene) -> Work:
    """Return one stroke along the line, or several beside each other over its width."""
    part = task.part
    line = tuple(without_dense(at_altitude(positions(part, "points"), number(part, "altitude"))))
    if not line:
        raise InfeasibleError("points are missing")
    turned = flag(part, "inverted")
    height = min(up for _, _, up in line)
    shots = shots_of(part, robot, height)
    lines = lines_over(line[::-1] if turned else line, number(part, "width"), shots.strip)
    entry = at_altitude((position(part, "initialPosition"),), number(part, "altitude"))[0]
    refuse_heights(robot, (entry, *(point for line in lines for point in line)))
    refuse_blocked(robot, scene, (entry,), "the initial position")
    free = len(lines) > 1
    called = [f"pass {number}" for number in range(1, len(lines) + 1)] if free else ["the line"]
    drawn = lines if free or not turned else [line[::-1] for line in lines]
    found = open_lines(robot, scene, zip(called, drawn, strict=True))
    ways = list(zip(found.parts, found.stretches, strict=True))
    if turned and not free:
        ways = [(line[::-1], (index, stretch[::-1])) for line, (index, stretch) in ways[::-1]]
    strokes = (
        replace(photographed(part, line, shots), reversible=free, part=called[index], stretch=stretch)
        for line, (index, stretch) in ways
    )
    turning, closed = number(part, "turnaroundDistance") or 0.0, closed_at(scene, robot, height)
    return Work(
        tuple(turned_around(strokes, turning, closed)),
        divisible=True,
        rule="road",
        ordered=not free,
        entry=entry,
        gaps=found.gaps,
        notes=shots.capture.notes,
    )


ROAD_RULE = Rule("road", ROAD_TASK, road_work)
