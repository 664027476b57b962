"""What of a line a robot may follow: the parts that keep clear of all areas, and the gaps between them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from math import dist

from shapely.geometry import Point, Polygon

from mmrs_core.errors import InfeasibleError
from mmrs_core.geometry.clearance import grow
from mmrs_core.geometry.stretches import LEAST, between, blocked_stretches, open_stretches, part_of, point_at
from mmrs_core.planning.pockets import pockets_of
from mmrs_core.scene import Gap, Position, Robot, Scene, Stroke, Work


@dataclass(frozen=True, slots=True)
class OpenLine:
    """What is left of a line.

    Attributes:
        parts: in its direction.
        gaps: between them.
        stretches: of each part: index of its line, and from where to where along it, metres.
    """

    parts: tuple[tuple[Position, ...], ...]
    gaps: tuple[Gap, ...]
    stretches: tuple[tuple[int, tuple[float, float]], ...]


class NothingLeftError(InfeasibleError):
    """A line that a robot can follow nowhere; `gap` is all of it."""

    def __init__(self, message: str, gap: Gap) -> None:
        super().__init__(message)
        self.gap = gap


def open_line(
    robot: Robot, scene: Scene, line: Sequence[Position], what: str, *, least: float = LEAST
) -> OpenLine:
    """Return the parts of a line that keep the robot's clearance from every area, and the gaps.

    Parts that areas close in and make unreachable are gaps, too.

    Args:
        robot: for its clearance. scene: for its areas.
        line: to be followed.
        what: name of the line, for messages.
        least: metres that a part is worth going to, where there are gaps.

    Raises:
        NothingLeftError: nothing is left of the line; names the areas that are too near or close it in.
    """
    blocked = {
        area.name: stretches
        for area in scene.kept_from(robot)
        if (
            stretches := blocked_stretches(
                line, area.shell, area.low, area.high, area.safety_distance + robot.clearance, grow
            )
        )
    }
    length = sum(dist(a, b) for a, b in pairwise(line))
    pockets = pockets_of(robot, scene)
    free = open_stretches(blocked.values(), length, least) if blocked else [(0.0, length)]
    closed = {each: walls for each in free if (walls := _walls_around(_middle(line, each), pockets))}
    if not blocked and not closed:
        return OpenLine((tuple(line),), (), ((0, (0.0, length)),))
    kept = [each for each in free if each not in closed]
    if closed and not kept:
        (begin, end), walls = next(iter(closed.items()))
        gap = Gap(what, begin, end - begin, _middle(line, (begin, end)), _names(walls), closed_in=True)
        raise NothingLeftError(f"nothing is left of {what}: {_names(walls)} close it in", gap)
    if not kept:
        names = _names(blocked)
        gap = Gap(what, 0.0, length, point_at(line, length / 2.0), names)
        raise NothingLeftError(f"nothing is left of {what}: it is too near to {names}", gap)
    gaps = [
        Gap(
            what,
            begin,
            end - begin,
            point_at(line, (begin + end) / 2.0),
            _names(name for name, found in blocked.items() if any(a <= end and b >= begin for a, b in found)),
        )
        for begin, end in (between(free, length) if blocked else ())
    ]
    gaps += (
        Gap(what, begin, end - begin, _middle(line, (begin, end)), _names(walls), closed_in=True)
        for (begin, end), walls in closed.items()
    )
    gaps.sort(key=lambda gap: gap.begin)
    return OpenLine(
        tuple(part_of(line, *each) for each in kept), tuple(gaps), tuple((0, each) for each in kept)
    )


def open_lines(
    robot: Robot, scene: Scene, lines: Iterable[tuple[str, Sequence[Position]]], *, least: float = LEAST
) -> OpenLine:
    """Return the same for all lines of one task, each with its name.

    Raises:
        NothingLeftError: nothing is left of all of them.
    """
    parts, gaps, refusals = list[tuple[Position, ...]](), list[Gap](), list[NothingLeftError]()
    stretches = list[tuple[int, tuple[float, float]]]()
    for index, (what, line) in enumerate(lines):
        try:
            found = open_line(robot, scene, line, what, least=least)
        except NothingLeftError as error:
            refusals.append(error)
            gaps.append(error.gap)
            continue
        parts += found.parts
        gaps += found.gaps
        stretches += ((index, stretch) for _, stretch in found.stretches)
    if refusals and not parts:
        raise refusals[0]
    return OpenLine(tuple(parts), tuple(gaps), tuple(stretches))


def work_along(
    scene: Scene,
    robot: Robot,
    lines: Iterable[tuple[str, Sequence[Position]]],
    stroke: Callable[[str, tuple[Position, ...]], Stroke],
    *,
    rule: str,
    ordered: bool = True,
) -> Work:
    """Return the work along lines that areas may block in part: a stroke for each open part, and the gaps.

    A robot keeps its clearance from every area; what comes nearer, and what areas close in, is left out and
    reported as `Work.gaps`. The planner leads robots around the gaps. Robots of other clearances share the
    work: each stroke gets the name of its line as `part`, and its `stretch`.

    Args:
        scene: for its areas.
        robot: for its clearance.
        lines: each with its name, such as "row 3"; positions are (east, north, up), metres.
        stroke: makes a stroke of the name of a line and of the positions of one open part.
        rule: name of the rule that asks.
        ordered: whether the strokes must be done in this order.

    Raises:
        InfeasibleError: nothing is left of all lines; names the areas that are too near.
    """
    named = tuple((name, tuple(line)) for name, line in lines)
    found = open_lines(robot, scene, named)
    strokes = (
        replace(stroke(named[index][0], part), part=named[index][0], stretch=stretch)
        for part, (index, stretch) in zip(found.parts, found.stretches, strict=True)
    )
    return Work(tuple(strokes), divisible=True, rule=rule, ordered=ordered, gaps=found.gaps)


def _middle(line: Sequence[Position], stretch: tuple[float, float]) -> Position:
    return point_at(line, sum(stretch) / 2.0) if len(line) > 1 else line[0]


def _walls_around(at: Position, pockets: Iterable[tuple[Polygon, tuple[str, ...]]]) -> tuple[str, ...]:
    return next((walls for pocket, walls in pockets if pocket.covers(Point(at[:2]))), ())


def _names(names: Iterable[str]) -> str:
    return ", ".join(f"'{name}'" for name in names)
