"""What of a line a robot may follow: the parts that keep clear of all areas, and the gaps between them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import dist

from mmrs_core.errors import InfeasibleError
from mmrs_core.geometry.clearance import grow
from mmrs_core.geometry.stretches import LEAST, between, blocked_stretches, open_stretches, part_of, point_at
from mmrs_core.scene import Gap, Position, Robot, Scene


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

    Args:
        robot: for its clearance. scene: for its areas.
        line: to be followed.
        what: it is, for people.
        least: metres that a part is worth going to, where there are gaps.

    Raises:
        NothingLeftError: nothing is left of a line; says what it is too near to.
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
    if not blocked:
        return OpenLine((tuple(line),), (), ((0, (0.0, length)),))
    kept = open_stretches(blocked.values(), length, least)
    if not kept:
        names = _names(blocked)
        gap = Gap(what, 0.0, length, point_at(line, length / 2.0), names)
        raise NothingLeftError(f"nothing is left of {what}: it is too near to {names}", gap)
    gaps = tuple(
        Gap(
            what,
            begin,
            end - begin,
            point_at(line, (begin + end) / 2.0),
            _names(name for name, found in blocked.items() if any(a <= end and b >= begin for a, b in found)),
        )
        for begin, end in between(kept, length)
    )
    return OpenLine(tuple(part_of(line, *each) for each in kept), gaps, tuple((0, each) for each in kept))


def open_lines(
    robot: Robot, scene: Scene, lines: Iterable[tuple[str, Sequence[Position]]], *, least: float = LEAST
) -> OpenLine:
    """Return likewise what is left of the lines of one task, each with what it is.

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


def _names(names: Iterable[str]) -> str:
    return ", ".join(f"'{name}'" for name in names)
