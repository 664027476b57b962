"""Waypoints of missions as paths of a drawing, whatever frames their heights are in."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby
from typing import NamedTuple

import numpy as np

from mmrs_core.diagnostics import Place
from mmrs_core.drawings.drawing import Geometry, HeightReference, Role
from mmrs_core.drawings.sheet import DrawnSubject, FeatureTraits, Sheet
from mmrs_mavlink.plugin.plans.items import (
    ABSOLUTE,
    LAND,
    LOITER_TIME,
    LOITER_UNLIMITED,
    RELATIVE,
    TAKE_OFF,
    WAYPOINT,
)

AXES = "missions have the latitude first"
SPLINE, LOITER_TURNS, LOITER_TO_ALTITUDE, ARC, PLACE_PAYLOAD = 82, 18, 31, 36, 94
PASSED = frozenset(
    (*(WAYPOINT, SPLINE, ARC, LOITER_UNLIMITED, LOITER_TURNS, LOITER_TIME, LOITER_TO_ALTITUDE), PLACE_PAYLOAD)
)
"""Commands whose place a vehicle goes to; one at latitude and longitude 0 is where it is."""
WAITED = (LOITER_UNLIMITED, LOITER_TURNS, LOITER_TIME, PLACE_PAYLOAD)
LAUNCHED = frozenset((TAKE_OFF, LAND, 84, 85, 20))
"""Commands to take off, to land, and to return; the first two as multicopters and as VTOL do it."""
FRAMES = {
    **dict.fromkeys((ABSOLUTE, 5), HeightReference.SEA_LEVEL),
    **dict.fromkeys((RELATIVE, 6), HeightReference.HOME),
    **dict.fromkeys((10, 11), HeightReference.GROUND),
}


class DrawnItem(NamedTuple):
    """An item of a mission: `place` is latitude, longitude and height, `first` its first parameter."""

    command: int
    frame: int
    place: list[float]
    number: int
    line: int
    first: float = 0.0

    @property
    def reference(self) -> HeightReference:
        """Return what its height is measured from."""
        return FRAMES.get(self.frame, HeightReference.NONE)


class WaypointPath:
    """Adds the places that a vehicle goes to one after the other.

    Heights in several frames are counted from home, if its height is known, and the ground is taken to be
    level there. Otherwise another frame begins another path.

    Args:
        role: of the paths: those that MMRS planned, or waypoints that people drew.
        home: its height above mean sea level; None where it is not known.
    """

    def __init__(self, sheet: Sheet, role: Role, home: float | None) -> None:
        self._sheet, self._role, self._home = sheet, role, home
        self._part: list[DrawnItem] = []

    def add(self, row: DrawnItem) -> None:
        """Continue the path, or note why an item does not belong to one."""
        if row.command in LAUNCHED:
            reason = "robots take off, return and land without a task"
            self._sheet.leave_out(f"item {row.number}", reason, row.line)
        elif row.command not in PASSED or row.place[:2] == [0.0, 0.0]:
            what = "states no position" if row.command in PASSED else "does not move a vehicle to a place"
            self._sheet.leave_out(f"item {row.number}", f"{_command(row.command)} {what}", row.line)
        else:
            self._part.append(row)
            if row.command in WAITED or (row.command in (WAYPOINT, SPLINE) and row.first > 0.0):
                reason = "what a robot does there is a task of its own"
                self._sheet.leave_out(f"waiting at item {row.number}", reason, row.line)

    def end(self) -> None:
        """Add the path so far."""
        rows, self._part = self._part, []
        ups = {HeightReference.HOME: 0.0, HeightReference.GROUND: 0.0}
        if self._home is not None:
            ups[HeightReference.SEA_LEVEL] = -self._home
        if len({row.reference for row in rows}) > 1 and all(row.reference in ups for row in rows):
            add_items(
                self._sheet,
                [row._replace(place=[*row.place[:2], row.place[2] + ups[row.reference]]) for row in rows],
                self._role,
                HeightReference.HOME,
            )
            other = [row for row in rows if row.reference is not HeightReference.HOME]
            words = " and ".join(dict.fromkeys(f"above {row.reference.value}" for row in other))
            what = f"frames of items {', '.join(str(row.number) for row in other)}"
            self._sheet.leave_out(what, f"their heights {words} are counted from home instead", other[0].line)
            return
        last = None
        for reference, run in groupby(rows, key=lambda row: row.reference):
            part = list(run)
            if last is not None:
                what = f"line from item {last.number} to item {part[0].number}"
                reason = "their heights are in frames {} and {}, and that of home is not known"
                self._sheet.leave_out(what, reason.format(last.frame, part[0].frame), part[0].line)
            if reference is HeightReference.NONE:
                what = f"heights of {_called(part)}"
                self._sheet.leave_out(what, f"frame {part[0].frame} is not read", part[0].line)
            add_items(self._sheet, part, self._role, reference)
            last = part[-1]


def add_items(sheet: Sheet, rows: Sequence[DrawnItem], role: Role, reference: HeightReference) -> None:
    """Add the path of some items; one in the same place throughout is a point."""
    shape = Geometry.LINE if _is_line(rows) else Geometry.POINT
    add_shape(sheet, shape, rows if _is_line(rows) else rows[:1], _called(rows), role, reference)
    if shape is Geometry.POINT and len(rows) > 1:
        where = f"items {rows[1].number} to {rows[-1].number}"
        sheet.leave_out(where, f"at the same position as {_called(rows)}", rows[1].line)


def add_shape(
    sheet: Sheet,
    shape: Geometry,
    rows: Sequence[DrawnItem],
    what: str,
    role: Role,
    reference: HeightReference = HeightReference.NONE,
    radius: float | None = None,
) -> None:
    """Add a feature at the places of items."""
    traits: FeatureTraits = {"name": what, "role": role, "radius": radius}
    subject = DrawnSubject(what, Place(sheet.file, rows[0].line), traits)
    ring = np.array([row.place for row in rows], dtype=np.float64)
    sheet.add(shape, [ring if reference is not HeightReference.NONE else ring[:, :2]], subject, reference)


def _is_line(rows: Sequence[DrawnItem]) -> bool:
    return len({tuple(row.place[:2]) for row in rows}) > 1


def _called(rows: Sequence[DrawnItem]) -> str:
    first, last = rows[0].number, rows[-1].number
    return f"waypoints {first} to {last}" if _is_line(rows) else f"waypoint {first}"


def _command(number: int) -> str:
    from mmrs_mavlink.services.commands import name_of

    name = name_of(number)
    return name if str(number) in name else f"command {number} ({name})"
