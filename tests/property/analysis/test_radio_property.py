"""Range along whole paths, with random relays, against densely sampled points."""

from itertools import pairwise
from math import dist

import numpy as np
from checking import finding, given, rover
from hypothesis import given as drawn
from hypothesis import strategies as st

from mmrs_core.contributions.checks import Status
from mmrs_core.scene import Part
from mmrs_core.scene.relays import RELAY
from mmrs_core.testing.small_programs import go, robot

SAMPLES = 400
"""Places along each leg."""

HOME = (0.0, 0.0, 0.0)
PLACES = st.tuples(st.floats(-300.0, 300.0), st.floats(-300.0, 300.0), st.floats(0.0, 120.0))
RANGES = st.floats(20.0, 200.0)


def chained(reach, relays):
    """Return the balls that a robot is in range in: of home, and of relays reached step by step."""
    known = {None: (HOME, reach)}
    while True:
        more = {
            i: each
            for i, each in enumerate(relays)
            if i not in known and any(dist(each[0], at) <= min(each[1], far) for at, far in known.values())
        }
        if not more:
            return [(at, min(far, reach)) for at, far in known.values()]
        known |= more


@drawn(
    corners=st.lists(PLACES, min_size=1, max_size=3),
    reach=RANGES,
    relays=st.lists(st.tuples(PLACES, RANGES), max_size=8),
)
def test_the_least_margin_is_that_of_the_worst_of_many_places(corners, reach, relays):
    elements = [
        Part((RELAY,), {"name": f"r{i}", "position": p, "range": r}) for i, (p, r) in enumerate(relays)
    ]
    verdict = finding(
        "range",
        given(
            robot("a", [go(f"m{i}", place) for i, place in enumerate(corners)]),
            type=rover(attributes={"communicationRange": reach}),
            elements=elements,
        ),
    )
    path = np.array([HOME, *corners])
    shares = np.linspace(0.0, 1.0, SAMPLES)[:, None]
    places = np.concatenate([a + shares * (b - a) for a, b in pairwise(path)])
    inside = np.max([far - np.linalg.norm(places - at, axis=1) for at, far in chained(reach, relays)], axis=0)
    longest = max(dist(a, b) for a, b in pairwise(path))
    worst = float(inside.min())
    # between two sampled places, distances change by half their spacing at most
    assert worst - longest / SAMPLES <= verdict.margin <= worst + 1e-6
    assert (verdict.status is Status.VIOLATED) is (verdict.margin < -1e-6)
