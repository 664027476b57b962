"""Where the rows and the panels of a group are."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, radians, sin

from mmrs_core.errors import InfeasibleError
from mmrs_core.scene import Part, Position, Ring, Scene
from mmrs_core.scene.attributes import number, positions, text
from mmrs_solar.names import PANEL_GROUP

MOST_DRAWN = 2_000
"""Rows at most that are drawn one by one."""


@dataclass(frozen=True, slots=True)
class Group:
    """A group of panels.

    Attributes:
        begin, end: of the middle of the first row's panels.
        behind: step from one row to the next, metres (east, north, up).
        uphill: unit vector in the panels' plane, square to the rows.
        azimuth, tilt: of the panels, degrees.
        width: of a row along the slope, metres.
        rows, columns, tiers: how many there are.
    """

    begin: Position
    end: Position
    behind: Position
    uphill: Position
    azimuth: float
    tilt: float
    width: float
    rows: int
    columns: int
    tiers: int

    def row(self, number: int, uphill: float = 0.0) -> tuple[Position, Position]:
        """Return both ends of a row, counted from 1, at a distance uphill of its middle."""
        step = tuple(
            (number - 1) * back + uphill * up for back, up in zip(self.behind, self.uphill, strict=True)
        )
        return _moved(self.begin, step), _moved(self.end, step)

    def panel(self, row: int, column: int, tier: int) -> Position:
        """Return the middle of a panel; all counted from 1.

        Raises:
            InfeasibleError: the group has no such panel.
        """
        known = zip((row, column, tier), (self.rows, self.columns, self.tiers), strict=True)
        if not all(1 <= asked <= there for asked, there in known):
            raise InfeasibleError(f"row {row}, column {column}, tier {tier} is not a panel of the group")
        height = self.width / self.tiers
        begin, end = self.row(row, (tier - 0.5) * height - self.width / 2.0)
        return between(begin, end, (column - 0.5) / self.columns)


def outlines_of(part: Part) -> tuple[Ring, ...]:
    """Return each row of a panel group as seen from above; none where figures are missing.

    Where there are too many to distinguish, it is one outline around all of them.
    """
    try:
        group = laid_out(part)
    except InfeasibleError:
        return ()
    if group.rows > MOST_DRAWN:
        return (_around(group, 1, group.rows),)
    return tuple(_around(group, number, number) for number in range(1, group.rows + 1))


def _around(group: Group, first: int, last: int) -> Ring:
    half = group.width / 2.0
    lower, upper = group.row(first, -half), group.row(last, half)
    return tuple((east, north) for east, north, _ in (*lower, *reversed(upper)))


def group_of(task: Part, scene: Scene) -> Group:
    """Return the group that a task is about.

    Raises:
        InfeasibleError: there is none of that name, or its figures are not complete.
    """
    name = text(task, "group")
    found = [each for each in scene.elements if each.is_a(PANEL_GROUP) and text(each, "name") == name]
    if len(found) != 1:
        raise InfeasibleError(f"{len(found) or 'no'} panel groups of the context are called '{name}'")
    return laid_out(found[0])


def laid_out(part: Part) -> Group:
    """Return a panel group with its rows laid out.

    Raises:
        InfeasibleError: its figures are not complete.
    """
    ends = positions(part, "points")
    if len(ends) != 2:
        raise InfeasibleError(f"panel group '{text(part, 'name')}' has no two points")
    azimuth, tilt, width = (_needed(part, name) for name in ("azimuth", "tilt", "rowWidth"))
    rows, columns, tiers = (whole(part, name, 1) for name in ("rows", "columns", "tiers"))
    pitch = _needed(part, "pitch") if rows > 1 else 0.0
    facing, slope = radians(azimuth), radians(tilt)
    east, north = -sin(facing), -cos(facing)
    rise = (0.0, 0.0, number(part, "height") or 0.0)
    return Group(
        begin=_moved(ends[0], rise),
        end=_moved(ends[1], rise),
        behind=(pitch * east, pitch * north, 0.0),
        uphill=(east * cos(slope), north * cos(slope), sin(slope)),
        azimuth=azimuth,
        tilt=tilt,
        width=width,
        rows=rows,
        columns=columns,
        tiers=tiers,
    )


def whole(part: Part, name: str, otherwise: int) -> int:
    """Return a whole number, or another where it is absent."""
    found = number(part, name)
    return otherwise if found is None else round(found)


def between(begin: Position, end: Position, share: float) -> Position:
    """Return the point at a share of the line between two points; below 0 it is before the first."""
    east, north, up = (a + share * (b - a) for a, b in zip(begin, end, strict=True))
    return (east, north, up)


def _needed(part: Part, name: str) -> float:
    found = number(part, name)
    if found is None:
        raise InfeasibleError(f"panel group '{text(part, 'name')}' does not state its {name}")
    return found


def _moved(place: Position, step: tuple[float, ...]) -> Position:
    east, north, up = (a + b for a, b in zip(place, step, strict=True))
    return (east, north, up)
