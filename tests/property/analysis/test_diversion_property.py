"""Diversions around random boxes against the shortest paths that shapely's buffers leave."""

from heapq import heappop, heappush
from itertools import combinations
from math import dist, inf

import shapely
from checking import finding, given, square
from hypothesis import assume
from hypothesis import given as drawn
from hypothesis import strategies as st

from mmrs_core.contributions.checks import Status
from mmrs_core.scene import AreaUse
from mmrs_core.testing.small_programs import hold, robot

GOAL = (300.0, 0.0)
KEPT = 0.5
"""Metres that robots of tests keep from areas beside what these ask for: half their diagonal."""

BOXES = st.lists(
    st.tuples(st.floats(20.0, 260.0), st.floats(-60.0, 60.0), st.floats(2.0, 40.0), st.floats(0.0, 10.0)),
    max_size=3,
)


def shortest(boxes):
    """Return the metres of the shortest path around boxes grown by round corners; inf if there is none."""
    grown = [shapely.box(e - h, n - h, e + h, n + h).buffer(d + KEPT, quad_segs=6) for e, n, h, d in boxes]
    inside = shapely.union_all(grown).buffer(-1e-6) if grown else shapely.Polygon()
    places = [(0.0, 0.0), GOAL, *(point for each in grown for point in each.exterior.coords[:-1])]
    ways = {i: [] for i in range(len(places))}
    shapely.prepare(inside)
    for i, j in combinations(range(len(places)), 2):
        if not inside.intersects(shapely.LineString([places[i], places[j]])):
            ways[i].append(j)
            ways[j].append(i)
    away, pending = {}, [(0.0, 0)]
    while pending:
        length, here = heappop(pending)
        if here not in away:
            away[here] = length
            for there in ways[here]:
                heappush(pending, (length + dist(places[here], places[there]), there))
    return away.get(1, inf)


@drawn(boxes=BOXES)
def test_a_diversion_takes_little_longer_than_along_the_shortest_path(boxes):
    least = shortest(boxes)
    assume(least < inf)
    goal = square("meadow", GOAL, 10.0, use=AreaUse.EMERGENCY)
    walls = [square(f"wall {k}", (e, n), h, distance=d) for k, (e, n, h, d) in enumerate(boxes)]
    assume(all(max(abs(e - x), abs(n)) > h + d + KEPT + 1.0 for e, n, h, d in boxes for x in (0.0, 300.0)))
    verdict = finding(
        "diversion", given(robot("a", [hold("h", 1.0)]), areas=(goal, *walls), rally_points={"a": (GOAL,)})
    )
    # between boxes that leave a gap of hardly twice the distance, no path need be found
    if verdict.status is Status.SAFE:
        metres = 2.0 * (800.0 - 1.0 - verdict.margin)
        assert least - 0.1 <= metres
        assert metres <= 1.03 * least + 2.0 or tight(boxes)
    else:
        assert tight(boxes)


def tight(boxes):
    """Return whether two grown boxes are so near to each other that only one of the two may pass between."""
    grown = [shapely.box(e - h, n - h, e + h, n + h).buffer(d + KEPT) for e, n, h, d in boxes]
    return any(0.0 < one.distance(other) < 1.5 for one, other in combinations(grown, 2))
