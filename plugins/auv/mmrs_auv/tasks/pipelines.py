"""The rule for following a pipeline."""

from __future__ import annotations

from itertools import pairwise
from math import ceil, dist, hypot

from mmrs_auv.names import FOLLOW_PIPELINE_TASK, PIPELINE
from mmrs_auv.tasks.surveys import recorded
from mmrs_core.contributions.rules import Rule
from mmrs_core.errors import InfeasibleError
from mmrs_core.planning.open_lines import open_line
from mmrs_core.planning.positions import refuse_heights
from mmrs_core.scene import Part, Point, Position, Robot, Scene, Stroke, Task, Work
from mmrs_core.scene.attributes import flag, number, positions, text

RULE = "follow_pipeline"

LONGEST_SHARE = 50.0
"""Metres after which a pipeline may be left to another robot or sortie."""

SHARPEST = 0.5
"""Cosine of half the sharpest bend beside which a way with an offset leads."""


def pipeline_work(task: Task, robot: Robot, scene: Scene) -> Work:
    """Return one stroke above a pipeline, or beside it; several where it is too near to something."""
    part = task.part
    height, offset = number(part, "height") or 0.0, number(part, "offset") or 0.0
    if hypot(height, offset) < robot.clearance:
        raise InfeasibleError(
            f"comes {hypot(height, offset):.2f} m near to the pipeline, its clearance is "
            f"{robot.clearance:.2f} m"
        )
    line = way_along(_route(part, scene), height, offset)
    refuse_heights(robot, line)
    found = open_line(robot, scene, line, "the pipeline")
    ways = [(way, stretch) for way, (_, stretch) in zip(found.parts, found.stretches, strict=True)]
    if flag(part, "inverted"):
        ways = [(way[::-1], stretch[::-1]) for way, stretch in ways[::-1]]
    strokes = (
        Stroke(way, cuts=_cuts(way), reversible=True, part="the pipeline", stretch=stretch)
        for way, stretch in ways
    )
    recording = tuple(recorded(part, robot, stroke) for stroke in strokes)
    return Work(recording, divisible=True, rule=RULE, gaps=found.gaps)


def _route(task: Part, scene: Scene) -> tuple[Position, ...]:
    name = text(task, "pipeline")
    found = [each for each in scene.elements if each.is_a(PIPELINE) and text(each, "name") == name]
    if len(found) != 1:
        raise InfeasibleError(f"{len(found) or 'no'} pipelines of the context are called '{name}'")
    return positions(found[0], "points")


def way_along(points: tuple[Position, ...], height: float, offset: float) -> tuple[Position, ...]:
    """Return the path `height` metres above a pipeline and `offset` metres to the right of it.

    Raises:
        InfeasibleError: it has no length, or bends too sharply for that.
    """
    line = (*points[:1], *(b for a, b in pairwise(points) if dist(a[:2], b[:2]) > 1e-6))
    if len(line) < 2:
        raise InfeasibleError("the pipeline has no length")
    return tuple((east, north, up + height) for east, north, up in beside(line, offset))


def beside(line: tuple[Position, ...], offset: float) -> tuple[Position, ...]:
    """Return a line `metres` to the right of another, as seen from above, at its heights.

    Raises:
        InfeasibleError: the line bends too sharply for that.

    >>> beside(((0.0, 0.0, -5.0), (10.0, 0.0, -5.0), (10.0, 10.0, -6.0)), 1.0)
    ((0.0, -1.0, -5.0), (11.0, -1.0, -5.0), (11.0, 10.0, -6.0))
    """
    if offset == 0.0:
        return line
    right = [_to_the_right(a, b) for a, b in pairwise(line)]
    found = []
    for point, before, after in zip(line, (right[0], *right), (*right, right[-1]), strict=True):
        cosine = (1.0 + before[0] * after[0] + before[1] * after[1]) / 2.0  # of half the bend, squared
        if cosine < SHARPEST**2:
            raise InfeasibleError(
                f"the pipeline bends too sharply to be followed {abs(offset):g} m beside it"
            )
        east, north = (offset * (a + b) / (2.0 * cosine) for a, b in zip(before, after, strict=True))
        found.append((point[0] + east, point[1] + north, point[2]))
    return tuple(found)


def _to_the_right(begin: Position, end: Position) -> Point:
    east, north = end[0] - begin[0], end[1] - begin[1]
    length = hypot(east, north)
    return (north / length, -east / length)


def _cuts(line: tuple[Position, ...]) -> tuple[float, ...]:
    length = sum(dist(a, b) for a, b in pairwise(line))
    parts = ceil(length / LONGEST_SHARE)
    return tuple(length * part / parts for part in range(1, parts))


PIPELINE_RULE = Rule(RULE, FOLLOW_PIPELINE_TASK, pipeline_work)
