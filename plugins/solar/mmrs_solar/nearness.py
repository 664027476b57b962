"""How near robots come to the panels that they look at."""

from __future__ import annotations

from math import ceil, cos, floor, hypot, radians, sin

from mmrs_core.diagnostics import lengths
from mmrs_core.errors import InfeasibleError
from mmrs_core.scene import Position, Robot
from mmrs_solar.groups import Group


def refuse_near(robot: Robot, group: Group, place: Position, what: str) -> None:
    """Check that a robot beside the rows of a group keeps its clearance from their panels.

    Args:
        place: of the robot; on a way along the rows, any place.
        what: its name, for messages.

    Raises:
        InfeasibleError: it does not; says by how much, and which row is too near.
    """
    for row in _rows_below(group, place, robot.clearance):
        short = robot.clearance - panel_distance(group, row, place)
        if short > 1e-6:
            raise InfeasibleError(f"{what} comes {lengths(short)[0]} too near to the panels of row {row}")


def _rows_below(group: Group, place: Position, clearance: float) -> range:
    """Return the rows that are, seen from above, so near to a place that they can matter."""
    facing, reach = radians(group.azimuth), clearance + group.width / 2.0
    behind = (group.begin[0] - place[0]) * sin(facing) + (group.begin[1] - place[1]) * cos(facing)
    pitch = hypot(*group.behind)
    if pitch == 0.0:
        return range(1, group.rows + 1)
    first, last = ceil((behind - reach) / pitch) + 1, floor((behind + reach) / pitch) + 1
    return range(max(1, first), min(group.rows, last) + 1)


def panel_distance(group: Group, row: int, place: Position) -> float:
    """Return how far a place beside a row is from its panels, seen along the row, metres.

    The row is taken to be endless: what it is seen as is a line from its lower to its upper edge.
    """
    (east, north, up), (far_east, far_north, far_up) = group.row(row)
    facing, slope = radians(group.azimuth), radians(group.tilt)
    length = hypot(far_east - east, far_north - north) or 1.0
    along = ((place[0] - east) * (far_east - east) + (place[1] - north) * (far_north - north)) / length
    before = (place[0] - east) * sin(facing) + (place[1] - north) * cos(facing)
    above = place[2] - up - along / length * (far_up - up)
    uphill = above * sin(slope) - before * cos(slope)
    over = above * cos(slope) + before * sin(slope)
    return hypot(max(abs(uphill) - group.width / 2.0, 0.0), over)
