"""The check of separation against robots sampled on their ways."""

from itertools import pairwise
from math import dist

import numpy as np
from checking import findings, given
from hypothesis import given as for_all
from hypothesis import settings
from hypothesis import strategies as st
from small_behaviours import go, hold, robot

from mmrs_core.contributions.checks import Status

LENGTHS = st.floats(-20.0, 20.0).map(lambda x: round(x, 1))
POINTS = st.tuples(LENGTHS, LENGTHS)
SPEED = 2.0
STEP = 0.02


@st.composite
def tours(draw):
    """Draw the places of a robot, all at one height, with how long it stays at each."""
    up = draw(st.sampled_from([0.0, 2.0]))
    places = [(e, n, up) for e, n in draw(st.lists(POINTS, min_size=2, max_size=5, unique=True))]
    return places, draw(st.lists(st.floats(0.0, 5.0), min_size=len(places), max_size=len(places)))


def made(name, tour):
    places, stays = tour
    moves = []
    for i, (place, seconds) in enumerate(zip(places[1:], stays[1:], strict=True)):
        moves += [go(f"go {i}", place), hold(f"hold {i}", seconds)]
    return robot(name, moves, home=places[0])


def sampled(tour, times):
    """Return where a robot is at these times."""
    places, stays = tour
    corners, when = [places[0]], [0.0]
    for (a, b), seconds in zip(pairwise(places), stays[1:], strict=True):
        for place, duration in ((b, dist(a, b) / SPEED), (b, seconds)):
            corners.append(place)
            when.append(when[-1] + duration)
    return np.stack([np.interp(times, when, [corner[i] for corner in corners]) for i in range(3)], axis=1)


@settings(max_examples=60, deadline=None)
@for_all(tours(), tours(), st.floats(0.5, 6.0))
def test_robots_with_certain_times_are_too_near_exactly_if_they_ever_are(first, second, least):
    times = np.arange(0.0, 200.0, STEP)
    apart = float(np.linalg.norm(sampled(first, times) - sampled(second, times), axis=1).min())
    input = given(made("a", first), made("b", second), minimum_separation=least)
    (verdict,) = findings("separation", input)
    if apart < least - 1e-3:
        assert verdict.status is Status.VIOLATED
        assert verdict.margin <= apart - least + 1e-3
    elif apart > least + 2 * SPEED * STEP:
        assert verdict.status is Status.SAFE
