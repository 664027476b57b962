"""Simulated vehicles keep to their legs in calm air, however steep these are."""

from __future__ import annotations

from itertools import pairwise
from math import dist

from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

from mmrs_mavlink.sitl.body import CUT, STEP, Body, Vector

level, height = st.floats(-60.0, 60.0), st.floats(3.0, 40.0)
places = st.tuples(level, level, height)
speeds = st.floats(1.0, 6.0)
LONG = 20.0
"""Metres in which a vehicle of that speed comes to a halt from it."""


def flown(places: list[Vector], speed: float) -> list[Vector]:
    """Return where a vehicle is at each step, from the first place to the last."""
    body = Body(position=places[0], origin=places[0], target=places[1], speed=speed)
    ahead = list(places[2:])
    body.onward = ahead.pop(0) if ahead else None
    track = [body.position]
    while len(track) < 20_000:
        body.advance(STEP)
        track.append(body.position)
        if body.onward is not None and body.passes_target():
            body.start_next_leg()
            body.target, body.onward = body.onward, ahead.pop(0) if ahead else None
        elif body.onward is None and dist(body.position, places[-1]) < 0.05:
            return track
    raise AssertionError("it does not arrive")


def off(place: Vector, a: Vector, b: Vector) -> float:
    """Return the metres from a place to a leg."""
    leg, way = [y - x for x, y in zip(a, b, strict=True)], [y - x for x, y in zip(a, place, strict=True)]
    part = sum(x * y for x, y in zip(leg, way, strict=True)) / sum(x * x for x in leg)
    part = min(1.0, max(0.0, part))
    return dist(way, [part * x for x in leg])


@given(places, places, speeds)
@example((30.0, -10.0, 8.0), (40.0, -20.0, 12.0), 6.0)
@settings(max_examples=25, deadline=None)
def test_a_vehicle_keeps_to_a_leg_that_climbs_or_descends(a, b, speed):
    assume(dist(a, b) > 1.0)
    assert max(off(place, a, b) for place in flown([a, b], speed)) < 0.05


@given(st.lists(places, min_size=3, max_size=5), speeds)
@settings(max_examples=15, deadline=None)
def test_a_vehicle_cuts_the_corners_of_steep_legs_no_more_than_those_of_level_ones(places, speed):
    legs = list(pairwise(places))
    assume(all(dist(a, b) > LONG for a, b in legs))
    assert max(min(off(place, a, b) for a, b in legs) for place in flown(places, speed)) < CUT + 0.1
