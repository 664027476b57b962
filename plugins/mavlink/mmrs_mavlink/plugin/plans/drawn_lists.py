"""Lists of waypoints, of fences and of rally points as drawings.

The format is described at https://mavlink.io/en/file_formats/.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from mmrs_core.drawings.drawing import Drawing, Geometry, HeightReference, Role
from mmrs_core.drawings.sheet import Sheet
from mmrs_mavlink.plugin.plans.items import FENCE_EXCLUSION, RALLY_POINT, WAYPOINT
from mmrs_mavlink.plugin.plans.waypoint_paths import AXES, FRAMES, DrawnItem, WaypointPath, add_shape

FENCE_INCLUSION, CIRCLE_INCLUSION, CIRCLE_EXCLUSION = 5001, 5003, 5004
FIELDS = 12
CIRCLES = (CIRCLE_INCLUSION, CIRCLE_EXCLUSION)
AROUND = {
    FENCE_INCLUSION: (Geometry.AREA, Role.INCLUSION),
    FENCE_EXCLUSION: (Geometry.AREA, Role.FORBIDDEN),
    CIRCLE_INCLUSION: (Geometry.POINT, Role.INCLUSION),
    CIRCLE_EXCLUSION: (Geometry.POINT, Role.FORBIDDEN),
    RALLY_POINT: (Geometry.POINT, Role.RALLY_POINT),
}
HEADER = "QGC WPL 110"
LARGEST = 1e6
"""Numbers of items, frames and commands are smaller."""


def recognise_list(data: bytes, file: str) -> bool:
    """Return whether it is a list of waypoints."""
    return data.removeprefix(b"\xef\xbb\xbf").startswith(b"QGC WPL")


def read_list(data: bytes, file: str) -> Drawing:
    """Return home (row 0, as ArduPilot has it), waypoints as a path, and fences and rally points.

    Raises:
        UnreadableError: with the line of the first fault.
    """
    sheet = Sheet(data, file, AXES)
    lines = data.decode("utf-8-sig", "replace").splitlines()
    if lines[0].strip() != HEADER:
        sheet.refuse(f"the first line is not '{HEADER}'", 1)
    rows = [_row_of(line, number, sheet) for number, line in enumerate(lines[1:], start=2) if _holds(line)]
    height = None
    if rows and rows[0].number == 0 and rows[0].command == WAYPOINT:
        home = rows.pop(0)
        _refuse_swapped(home, rows, sheet)
        height = home.place[2]
        add_shape(sheet, Geometry.POINT, [home], "home", Role.HOME, HeightReference.SEA_LEVEL)
    path = WaypointPath(sheet, Role.WAYPOINT, height)
    for row in rows:
        if row.command not in AROUND:
            path.add(row)
    path.end()
    around = [row for row in rows if row.command in AROUND]
    while around:
        row = around[0]
        shape, role = AROUND[row.command]
        what = f"{role.value} {row.number}"
        count = int(row.first) if shape is Geometry.AREA and 0 < row.first < 1e6 else 1
        corners, around = around[:count], around[count:]
        if len(corners) < count or any(
            (each.command, each.first) != (row.command, row.first) for each in corners
        ):
            sheet.refuse(f"{what}: {count} corners of it are expected one after the other", row.line)
        radius = row.first if row.command in CIRCLES and 0.0 < row.first < 1e6 else None
        rally = (
            FRAMES.get(row.frame, HeightReference.NONE) if role is Role.RALLY_POINT else HeightReference.NONE
        )
        add_shape(sheet, shape, corners, what, role, rally, radius)
    return sheet.drawing()


def _refuse_swapped(home: DrawnItem, rows: Sequence[DrawnItem], sheet: Sheet) -> None:
    """Refuse waypoints that are near home if latitude and longitude are exchanged."""
    at = np.array(home.place[:2])
    for row in rows:
        place = np.array(row.place[:2])
        if place.any() and np.abs(place - at).max() > 1.0 and np.abs(place[::-1] - at).max() < 0.1:
            sheet.refuse(
                f"item {row.number}: latitude and longitude seem to be swapped against home", row.line
            )


def _row_of(text: str, line: int, sheet: Sheet) -> DrawnItem:
    cells = text.split()
    if len(cells) != FIELDS:
        sheet.refuse(f"{len(cells)} values instead of {FIELDS}", line)
    values = []
    for cell in cells[: FIELDS - 1]:
        try:
            values.append(float(cell))
        except ValueError:
            sheet.refuse(f"{cell[:40]!r} is not a number", line)
    for value, cell in zip(values[:4], cells, strict=False):
        if not abs(value) < LARGEST:
            sheet.refuse(f"{cell[:40]} cannot be the number of an item, a frame or a command", line)
    number, _, frame, command = map(int, values[:4])
    return DrawnItem(command, frame, values[8:11], number, line, values[4])


def _holds(line: str) -> bool:
    return bool(line.strip()) and not line.startswith("#")
