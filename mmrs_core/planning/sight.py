"""Shortest paths in the plane around grown areas, by lines of sight that are looked for where needed only.

A shortest path turns at corners that stick out, and touches the area there: with the area to its left
it can only continue between the directions of the two sides (Rohnert 1986: tangents are enough). So a node
is a corner and the side on which the area is, and from it only a narrow wedge is looked into: cell by
cell of a grid, outwards, until all of it is blocked (Hechenberger et al. 2020 scan rays likewise). What
was seen is kept for later paths. A* over these nodes is exact.

These are loops over columns of numbers, to be run as they are or compiled, see `compilation`.
"""

from __future__ import annotations

from collections.abc import MutableSequence, Sequence
from heapq import heappop, heappush
from math import asin, atan2, floor, inf, pi, sqrt
from typing import NamedTuple

LEFT, RIGHT = 0, 1
"""Side on which a corner's area is; corner k with its area there is node 2 k + side."""

START, UNKNOWN = -1, -1
NONE, FULL = -1.0, -2.0
"""What `search` returns instead of a length: there is no path; the memory has to be enlarged."""

DIRECTIONS, _BINS = 256, 8
"""Bins of directions all around a place, and within a corner's wedge."""

_TINY = 1e-9
_MARGIN = 1e-3
"""Metres by which a line must run into a grown area to be surely blocked by the smaller one."""


class Columns(NamedTuple):
    """Grown areas, by corner, by edge, by area and by cell of a grid.

    Corners (x, y, offsets to the neighbours before and after) are those of the larger shapes, edges
    (x1, y1) to (x2, y2) those of the smaller ones that block, walls those of the areas as drawn.
    """

    x: Sequence[float]
    y: Sequence[float]
    before_x: Sequence[float]
    before_y: Sequence[float]
    after_x: Sequence[float]
    after_y: Sequence[float]
    corners_from: Sequence[int]
    x1: Sequence[float]
    y1: Sequence[float]
    x2: Sequence[float]
    y2: Sequence[float]
    edges_from: Sequence[int]
    wall_x1: Sequence[float]
    wall_y1: Sequence[float]
    wall_x2: Sequence[float]
    wall_y2: Sequence[float]
    walls_from: Sequence[int]
    clearance: Sequence[float]
    west: Sequence[float]
    south: Sequence[float]
    east: Sequence[float]
    north: Sequence[float]
    cells_from: Sequence[int]
    in_cells: Sequence[int]
    origin_x: float
    origin_y: float
    cell: float
    columns: int
    rows: int


class Memory(NamedTuple):
    """What was seen from nodes among areas that block, and room for one search and its looks.

    Attributes:
        blocks: by area, whether it blocks.
        seen_from, seen: by node, and after all nodes by place where paths begin or end, where what it sees
            begins, and how many nodes; UNKNOWN: not looked yet.
        node, metres: what is seen: nodes, and how far away.
        used: (1,) how many of these there are.
        met: by area, the number of the look that met it last; the last item counts looks.
        blocked: by bin of directions, metres from which on a look finds it blocked.
        areas: that a look meets.
        look_node, look_metres: by node, what a look sees.
        best: by node, and for the goal last, metres from the start.
        came: likewise, the node before, START for the first.
    """

    blocks: Sequence[bool]
    seen_from: MutableSequence[int]
    seen: MutableSequence[int]
    node: MutableSequence[int]
    metres: MutableSequence[float]
    used: MutableSequence[int]
    met: MutableSequence[int]
    blocked: MutableSequence[float]
    areas: MutableSequence[int]
    look_node: MutableSequence[int]
    look_metres: MutableSequence[float]
    best: MutableSequence[float]
    came: MutableSequence[int]


def search(
    c: Columns,
    memory: Memory,
    start_x: float,
    start_y: float,
    goal_x: float,
    goal_y: float,
    longest: float,
    spare: float,
    begin: int,
    end: int,
) -> float:
    """Return the metres of the shortest path, left in the memory; NONE or FULL where there is none.

    Args:
        c: the areas.
        memory: of what was seen before.
        start_x, start_y, goal_x, goal_y: ends of the path.
        longest: metres beyond which a path is of no use.
        spare: metres to keep on top of clearances.
        begin, end: where it is kept what is seen from the ends of the path.
    """
    best, came = memory.best, memory.came
    goal = len(best) - 1
    for i in range(len(best)):
        best[i] = inf
    straight = sqrt((goal_x - start_x) ** 2 + (goal_y - start_y) ** 2)
    if straight > longest:
        return NONE
    areas = 0
    for area in range(len(memory.blocks)):
        if memory.blocks[area]:
            memory.areas[areas] = area
            areas += 1
    if _clear(c, memory, areas, start_x, start_y, goal_x, goal_y, spare):
        best[goal], came[goal] = straight, START
        return straight
    if _is_full(c, memory, goal_x, goal_y, -1, spare, end):
        return FULL
    if _is_full(c, memory, start_x, start_y, -1, spare, begin):
        return FULL
    to_goal = {-2: 0.0}
    for i in range(memory.seen_from[end], memory.seen_from[end] + memory.seen[end]):
        to_goal[memory.node[i] ^ 1] = memory.metres[i]
    queue = [(0.0, -2)]
    queue.pop()
    for i in range(memory.seen_from[begin], memory.seen_from[begin] + memory.seen[begin]):
        node, metres = memory.node[i], memory.metres[i]
        best[node], came[node] = metres, START
        k = node // 2
        heappush(queue, (metres + sqrt((goal_x - c.x[k]) ** 2 + (goal_y - c.y[k]) ** 2), node))
    while len(queue):
        bound, node = heappop(queue)
        if bound > longest:
            return NONE
        if node == goal:
            return best[goal]
        k = node // 2
        here = best[node]
        if bound > here + sqrt((goal_x - c.x[k]) ** 2 + (goal_y - c.y[k]) ** 2) + _TINY:
            continue
        if node in to_goal and here + to_goal[node] < best[goal]:
            best[goal], came[goal] = here + to_goal[node], node
            heappush(queue, (best[goal], goal))
        if _is_full(c, memory, c.x[k], c.y[k], node, spare, node):
            return FULL
        first = memory.seen_from[node]
        for i in range(first, first + memory.seen[node]):
            other = memory.node[i]
            reached = here + memory.metres[i]
            if reached < best[other] - 1e-12:
                j = other // 2
                rest = reached + sqrt((goal_x - c.x[j]) ** 2 + (goal_y - c.y[j]) ** 2)
                if rest <= longest:
                    best[other], came[other] = reached, node
                    heappush(queue, (rest, other))
    return NONE


def _is_full(c: Columns, memory: Memory, x: float, y: float, node: int, spare: float, place: int) -> bool:
    """Look from a place unless it is known what is seen there; return whether there is no room to keep it.

    Args:
        c, memory, x, y, node, spare: see `_look`.
        place: where it is kept.
    """
    if memory.seen[place] != UNKNOWN:
        return False
    found, used = _look(c, memory, x, y, node, spare), memory.used[0]
    if used + found > len(memory.node):
        return True
    memory.seen_from[place], memory.seen[place] = used, found
    for i in range(found):
        memory.node[used + i], memory.metres[used + i] = memory.look_node[i], memory.look_metres[i]
    memory.used[0] = used + found
    return False


def _look(c: Columns, memory: Memory, x: float, y: float, node: int, spare: float) -> int:
    """Look for the nodes seen from a place and how far away they are; return how many there are.

    What is looked into is cut into bins of directions. An area that takes up a bin as a whole blocks it
    from its furthest corner on; cells and areas all of whose bins are blocked before them are left out.

    Args:
        c: the areas.
        memory: of which areas block.
        x, y: where that is.
        node: which node that is; -1: none, all directions are looked into.
        spare: metres to keep on top of clearances.
    """
    bins, base_x, base_y, width = DIRECTIONS, 1.0, 0.0, 2.0 * pi / DIRECTIONS
    own, reach = node // 2, 0.75 * c.cell
    left_x = left_y = right_x = right_y = 0.0
    if node >= 0:
        base_x, base_y, to_x, to_y = -c.before_x[own], -c.before_y[own], c.after_x[own], c.after_y[own]
        if node % 2 == RIGHT:
            base_x, base_y = -base_x, -base_y
            to_x, to_y = -to_x, -to_y
        bins, width = _BINS, max(_angle(base_x, base_y, to_x, to_y) / _BINS, 1e-6)
        one, two = sqrt(base_x * base_x + base_y * base_y), sqrt(to_x * to_x + to_y * to_y)
        right_x, right_y, left_x, left_y = base_x / one, base_y / one, to_x / two, to_y / two
    blocked, blocks, met = memory.blocked, memory.blocks, memory.met
    for i in range(bins):
        blocked[i] = inf
    met[-1] += 1
    look, areas, seen = met[-1], 0, 0
    column, row = floor((x - c.origin_x) / c.cell), floor((y - c.origin_y) / c.cell)
    ring = max(0, -column, column - c.columns + 1, -row, row - c.rows + 1)
    last = max(column, c.columns - 1 - column, row, c.rows - 1 - row)
    while ring <= last and _open(blocked, bins, (ring - 1) * c.cell):
        for i in range(max(0, column - ring), min(c.columns - 1, column + ring) + 1):
            step = 1 if abs(i - column) == ring else max(1, 2 * ring)
            for j in range(row - ring, row + ring + 1, step):
                if j < 0 or j >= c.rows:
                    continue
                to_x, to_y = c.origin_x + (i + 0.5) * c.cell - x, c.origin_y + (j + 0.5) * c.cell - y
                beside = min(right_x * to_y - right_y * to_x, left_y * to_x - left_x * to_y) < -reach
                if beside or _hidden(blocked, bins, base_x, base_y, width, to_x, to_y, reach):
                    continue
                cell = j * c.columns + i
                for item in range(c.cells_from[cell], c.cells_from[cell + 1]):
                    area = c.in_cells[item]
                    if met[area] == look or not blocks[area]:
                        continue
                    met[area] = look
                    to_x = (c.west[area] + c.east[area]) / 2.0 - x
                    to_y = (c.south[area] + c.north[area]) / 2.0 - y
                    wide, high = c.east[area] - c.west[area], c.north[area] - c.south[area]
                    radius = sqrt(wide * wide + high * high) / 2.0
                    if not _hidden(blocked, bins, base_x, base_y, width, to_x, to_y, radius):
                        memory.areas[areas] = area
                        areas += 1
                        seen = _meet(c, memory, area, x, y, node, base_x, base_y, width, bins, seen)
        ring += 1
    found = 0
    for i in range(seen):
        k = memory.look_node[i] // 2
        if _hidden(blocked, bins, base_x, base_y, width, c.x[k] - x, c.y[k] - y, _MARGIN):
            continue
        if _clear(c, memory, areas, x, y, c.x[k], c.y[k], spare):
            memory.look_node[found], memory.look_metres[found] = memory.look_node[i], memory.look_metres[i]
            found += 1
    return found


def _open(blocked: Sequence[float], bins: int, metres: float) -> bool:
    """Return whether some bin is not blocked up to `metres`."""
    i = 0
    while i < bins and blocked[i] <= metres:
        i += 1
    return i < bins


def _angle(x: float, y: float, to_x: float, to_y: float) -> float:
    """Return the angle from one direction to another, radians to the left."""
    return atan2(x * to_y - y * to_x, x * to_x + y * to_y)


def _hidden(
    blocked: Sequence[float],
    bins: int,
    base_x: float,
    base_y: float,
    width: float,
    to_x: float,
    to_y: float,
    radius: float,
) -> bool:
    """Return whether a circle lies beyond what blocks all of its bins, or in none."""
    metres = sqrt(to_x * to_x + to_y * to_y)
    if metres <= radius:
        return False
    middle, spread = _angle(base_x, base_y, to_x, to_y), asin(radius / metres)
    first, last = floor((middle - spread) / width), floor((middle + spread) / width)
    if bins < DIRECTIONS:
        first, last = max(first, 0), min(last, bins - 1)
    i = first
    while i <= last and blocked[i % bins] <= metres - radius:
        i += 1
    return i > last


def _meet(
    c: Columns,
    memory: Memory,
    area: int,
    x: float,
    y: float,
    node: int,
    base_x: float,
    base_y: float,
    width: float,
    bins: int,
    seen: int,
) -> int:
    """Add the nodes at which lines from a place touch an area; return how many are seen.

    Note which bins the area blocks. An end of a path may lie in the rim between an area's two shapes; from
    there, lines to any corner count.
    """
    own, side = node // 2, node % 2
    inside = c.west[area] <= x <= c.east[area] and c.south[area] <= y <= c.north[area]
    in_rim = inside and node < 0
    low_x = low_y = high_x = high_y = furthest = 0.0
    corner_x, corner_y, before_x, before_y, after_x, after_y = c[:6]
    own_before_x, own_before_y, own_after_x, own_after_y = (
        before_x[own],
        before_y[own],
        after_x[own],
        after_y[own],
    )
    look_node, look_metres = memory.look_node, memory.look_metres
    for k in range(c.corners_from[area], c.corners_from[area + 1]):
        to_x, to_y = corner_x[k] - x, corner_y[k] - y
        squared = to_x * to_x + to_y * to_y
        if squared > furthest:
            furthest = squared
        if low_x * to_y - low_y * to_x <= 0.0:
            low_x, low_y = to_x, to_y
        if high_x * to_y - high_y * to_x >= 0.0:
            high_x, high_y = to_x, to_y
        one = to_x * before_y[k] - to_y * before_x[k]
        two = to_x * after_y[k] - to_y * after_x[k]
        metres = sqrt(squared)
        tiny = _TINY * metres
        apart = (one > tiny and two < -tiny) or (one < -tiny and two > tiny)
        if squared <= 1e-18 or (apart and not in_rim):
            continue
        if node >= 0:
            if base_x * to_x + base_y * to_y <= 0.0:
                continue
            from_one = to_x * own_before_y - to_y * own_before_x
            from_two = to_x * own_after_y - to_y * own_after_x
            if side == LEFT and (from_one < -tiny or from_two < -tiny):
                continue
            if side == RIGHT and (from_one > tiny or from_two > tiny):
                continue
        if in_rim or (one >= -tiny and two >= -tiny):
            look_node[seen], look_metres[seen] = 2 * k + LEFT, metres
            seen += 1
        if in_rim or (one <= tiny and two <= tiny):
            look_node[seen], look_metres[seen] = 2 * k + RIGHT, metres
            seen += 1
    if inside:
        return seen
    furthest = sqrt(furthest)
    low = _angle(base_x, base_y, low_x, low_y)
    high = low + _angle(low_x, low_y, high_x, high_y)
    low += _MARGIN / sqrt(low_x * low_x + low_y * low_y)
    high -= _MARGIN / sqrt(high_x * high_x + high_y * high_y)
    first, last = floor(low / width) + 1, floor(high / width) - 1
    if node >= 0:
        first, last = max(first, 0), min(last, bins - 1)
    for i in range(first, last + 1):
        memory.blocked[i % bins] = min(memory.blocked[i % bins], furthest)
    return seen


def _clear(
    c: Columns, memory: Memory, areas: int, x: float, y: float, to_x: float, to_y: float, spare: float
) -> bool:
    """Return whether none of the memory's first areas lies across a line."""
    west, east, south, north = min(x, to_x), max(x, to_x), min(y, to_y), max(y, to_y)
    along_x, along_y = to_x - x, to_y - y
    for i in range(areas):
        area = memory.areas[i]
        if east < c.west[area] or west > c.east[area] or north < c.south[area] or south > c.north[area]:
            continue
        aside = (c.south[area] + c.north[area] - 2.0 * y) * along_x - (
            c.west[area] + c.east[area] - 2.0 * x
        ) * along_y
        reach = abs(along_y) * (c.east[area] - c.west[area]) + abs(along_x) * (c.north[area] - c.south[area])
        if abs(aside) <= reach + 2.0 * _TINY and _crosses(c, area, x, y, to_x, to_y, spare):
            return False
    return True


def _crosses(c: Columns, area: int, x: float, y: float, to_x: float, to_y: float, spare: float) -> bool:
    """Return whether a line meets the smaller shape of an area whose box it may meet.

    Where it ends within that shape, only if the exact distance to the area as drawn is too small: growing
    gives a little away.
    """
    along_x, along_y = to_x - x, to_y - y
    meets = begins = ends = False
    x1, y1, x2, y2 = c.x1, c.y1, c.x2, c.y2
    first, last = c.edges_from[area], c.edges_from[area + 1]
    squared = along_x * along_x + along_y * along_y
    slack = 1e-6 / sqrt(squared) if squared > 1e-12 else 0.0
    for i in range(first, last):
        one = along_x * (y1[i] - y) - along_y * (x1[i] - x)
        two = along_x * (y2[i] - y) - along_y * (x2[i] - x)
        if (one > 0.0) != (two > 0.0):
            share = one / (one - two)
            at = (
                (x1[i] + share * (x2[i] - x1[i]) - x) * along_x
                + (y1[i] + share * (y2[i] - y1[i]) - y) * along_y
            ) / squared
            meets = meets or 0.0 <= at <= 1.0
            begins = begins != (at < 0.0)
            ends = ends != (at > 1.0)
            if -slack <= at <= slack or 1.0 - slack <= at <= 1.0 + slack:
                return _too_near(c, area, x, y, to_x, to_y, spare)
    if begins or ends:
        return _too_near(c, area, x, y, to_x, to_y, spare)
    return meets


def _too_near(c: Columns, area: int, x: float, y: float, to_x: float, to_y: float, spare: float) -> bool:
    """Return whether a line is nearer to an area as drawn than the clearance, and nearer than its ends."""
    at_ends = nearest = inf
    inside = False
    for i in range(c.walls_from[area], c.walls_from[area + 1]):
        x1, y1, x2, y2 = c.wall_x1[i], c.wall_y1[i], c.wall_x2[i], c.wall_y2[i]
        at_ends = min(at_ends, _distance(x, y, x1, y1, x2, y2), _distance(to_x, to_y, x1, y1, x2, y2))
        nearest = min(nearest, _distance(x1, y1, x, y, to_x, to_y))
        if (y1 > y) != (y2 > y) and x < x1 + (y - y1) / (y2 - y1) * (x2 - x1):
            inside = not inside
        one = (to_x - x) * (y1 - y) - (to_y - y) * (x1 - x)
        two = (to_x - x) * (y2 - y) - (to_y - y) * (x2 - x)
        three = (x2 - x1) * (y - y1) - (y2 - y1) * (x - x1)
        four = (x2 - x1) * (to_y - y1) - (y2 - y1) * (to_x - x1)
        if (one > 0.0) != (two > 0.0) and (three > 0.0) != (four > 0.0):
            return True
    needed = min(max(at_ends, c.clearance[area]), c.clearance[area] + spare)
    return inside or min(at_ends, nearest) < needed - _TINY


def _distance(x: float, y: float, x1: float, y1: float, x2: float, y2: float) -> float:
    """Return the distance of a place from a line between two others."""
    along_x, along_y = x2 - x1, y2 - y1
    squared = along_x * along_x + along_y * along_y
    share = 0.0
    if squared > 0.0:
        share = min(1.0, max(0.0, ((x - x1) * along_x + (y - y1) * along_y) / squared))
    return sqrt((x - x1 - share * along_x) ** 2 + (y - y1 - share * along_y) ** 2)
