"""The check of separation against robots sampled on their ways."""

from itertools import combinations, pairwise
from math import dist, inf
from random import Random

import numpy as np
import pytest
from checking import findings, given, uneven
from counts import many
from hypothesis import assume, settings
from hypothesis import given as for_all
from hypothesis import strategies as st

from mmrs_core.analysis import nearness
from mmrs_core.analysis.encounters import nearest_encounter
from mmrs_core.analysis.nearness import Legs, legs_of, near_pairs, nearest_at_once
from mmrs_core.analysis.occupations import Occupation
from mmrs_core.contributions.checks import Status
from mmrs_core.testing.small_programs import go, hold, notify, robot

LENGTHS = st.floats(-20.0, 20.0).map(lambda x: round(x, 1))
POINTS = st.tuples(LENGTHS, LENGTHS)
SPEED = 2.0
STEP = 0.02


@st.composite
def tours(draw):
    """Draw the places of a robot, all at one height, with how long it stays at each.

    None but the first is so near to it that the robot counts as at home.
    """
    up = draw(st.sampled_from([0.0, 2.0]))
    places = [(e, n, up) for e, n in draw(st.lists(POINTS, min_size=2, max_size=5, unique=True))]
    assume(all(dist(places[0], place) > 0.2 for place in places[1:]))
    return places, draw(st.lists(st.floats(0.0, 5.0), min_size=len(places), max_size=len(places)))


def made(name, tour, tells=None, **more):
    """Return the robot; it notifies after the last move to the place of that number."""
    places, stays = tour
    moves = []
    for i, (place, seconds) in enumerate(zip(places[1:], stays[1:], strict=True)):
        after = (notify("b.go"),) if i == tells else ()
        moves += [go(f"go {i}", place), hold(f"hold {i}", seconds, after=after)]
    return robot(name, moves, home=places[0], **more)


def timed(tour, factor=lambda: 1.0, waits=None, until=0.0):
    """Return (times, corners) of a robot; after the stay of number `waits` it waits until a time."""
    places, stays = tour
    corners, when = [places[0]], [0.0]
    for i, ((a, b), seconds) in enumerate(zip(pairwise(places), stays[1:], strict=True)):
        for place, duration in ((b, dist(a, b) / SPEED), (b, seconds)):
            corners.append(place)
            when.append(when[-1] + factor() * duration)
        if i == waits:
            corners.append(b)
            when.append(max(when[-1], until))
    return when, corners


def sampled(tour, times, **more):
    """Return where a robot is at these times."""
    when, corners = timed(tour, **more)
    return np.stack([np.interp(times, when, [corner[i] for corner in corners]) for i in range(3)], axis=1)


def excused(first, second, one, other, least):
    """Return when two robots both stand at their homes, if these are nearer to each other than needed."""
    if dist(first[0][0], second[0][0]) >= least:
        return np.zeros(len(one), dtype=bool)
    return (one == first[0][0]).all(axis=1) & (other == second[0][0]).all(axis=1)


@settings(max_examples=many(300))
@for_all(tours(), tours(), st.floats(0.5, 6.0))
def test_robots_with_certain_times_are_too_near_exactly_if_they_ever_are(first, second, least):
    times = np.arange(0.0, 200.0, STEP)
    one, other = sampled(first, times), sampled(second, times)
    counts = ~excused(first, second, one, other, least)
    apart = float(np.linalg.norm(one - other, axis=1)[counts].min(initial=np.inf))
    input = given(made("a", first), made("b", second), minimum_separation=least)
    (verdict,) = findings("separation", input)
    if apart < least - 1e-3:
        assert verdict.status is Status.VIOLATED
        assert verdict.margin <= apart - least + 1e-3
    elif apart > least + 2 * SPEED * STEP:
        assert verdict.status is Status.SAFE


@settings(max_examples=many(300))
@for_all(tours(), tours(), st.floats(0.5, 4.0), st.integers(0, 10**6))
def test_robots_called_safe_keep_apart_however_long_their_moves_take(first, second, least, seed):
    random = Random(seed)
    tells, waits = random.randrange(len(first[0]) - 1), random.randrange(len(second[0]) - 1)
    robots = (made("a", first, tells), made("b", second, waits={f"hold {waits}": ["go"]}))
    found = findings("separation", given(*robots, minimum_separation=least, moves=uneven()))
    if [verdict.status for verdict in found] == [Status.SAFE]:
        times = np.arange(0.0, 400.0, STEP)

        def factor():
            return random.uniform(0.5, 2.0)

        when, corners = timed(first, factor)
        told = when[2 * (tells + 1)]
        one = np.stack([np.interp(times, when, [c[i] for c in corners]) for i in range(3)], axis=1)
        other = sampled(second, times, factor=factor, waits=waits, until=told)
        near = np.linalg.norm(one - other, axis=1) < least - 1e-3
        assert not (near & ~excused(first, second, one, other, least)).any()


@settings(max_examples=many(300))
@for_all(tours(), POINTS, st.floats(0.5, 4.0), st.integers(0, 10**6))
def test_robots_called_violated_beside_one_that_stands_come_too_near_however_long_their_moves_take(
    tour, place, least, seed
):
    random = Random(seed)
    stand = [hold("late", random.uniform(0.0, 60.0)), go("off", (500.0, 500.0, 0.0))]
    robots = (made("a", tour), robot("b", stand, home=(*place, 0.0)))
    found = findings("separation", given(*robots, minimum_separation=least, moves=uneven()))
    if [verdict.status for verdict in found] == [Status.VIOLATED]:
        times = np.arange(0.0, 400.0, STEP)

        def factor():
            return random.uniform(0.5, 2.0)

        one = sampled(tour, times, factor=factor)
        late, off = stand[0].attributes["duration"] * factor(), dist((*place, 0.0), (500.0, 500.0, 0.0))
        when, corners = (
            [0.0, late, late + factor() * off / SPEED],
            [(*place, 0.0)] * 2 + [(500.0, 500.0, 0.0)],
        )
        other = np.stack([np.interp(times, when, [c[i] for c in corners]) for i in range(3)], axis=1)
        assert np.linalg.norm(one - other, axis=1).min() < least + 4 * SPEED * STEP


@st.composite
def shuttles(draw):
    """Draw a tour along a line, a little beside it."""
    aside = st.floats(-0.5, 0.5).map(lambda x: round(x, 1))
    places = draw(st.lists(st.tuples(LENGTHS, aside), min_size=2, max_size=4, unique=True))
    return [(*place, 0.0) for place in places], [draw(st.floats(0.0, 5.0)) for _ in places]


@settings(max_examples=many(150))
@for_all(shuttles(), shuttles(), st.floats(1.5, 4.0), st.integers(0, 10**6))
def test_robots_called_violated_on_one_line_come_too_near_however_long_their_moves_take(
    first, second, least, seed
):
    random = Random(seed)
    robots = (made("a", first), made("b", second))
    found = findings("separation", given(*robots, minimum_separation=least, moves=uneven()))
    if [verdict.status for verdict in found] == [Status.VIOLATED]:
        times = np.arange(0.0, 400.0, STEP)
        factors = [random.uniform(0.5, 2.0) for _ in range(2)] if seed % 2 else None

        def factor(robot):
            return factors[robot] if factors else random.uniform(0.5, 2.0)

        one, other = (
            sampled(tour, times, factor=lambda robot=robot: factor(robot))
            for robot, tour in enumerate((first, second))
        )
        assert np.linalg.norm(one - other, axis=1).min() < least + 4 * SPEED * STEP


def occupation(rng, owners):
    """Return a path, or a stand, of a random robot at some time; some have no end, some robots no haste."""
    begin = float(rng.uniform(0.0, 100.0))
    points = [tuple(each) for each in rng.uniform(0.0, 60.0, (int(rng.integers(1, 4)), 3)).tolist()]
    least = tuple(rng.uniform(4.0, 10.0, len(points) - 1).tolist())
    end = inf if rng.random() < 0.1 else begin + sum(least) + float(rng.choice([0.0, 1.0, 20.0]))
    radius = float(rng.choice([0.0, 3.0]))
    robot = f"r{rng.integers(owners)}"
    return Occupation(robot, 0, False, tuple(points), radius, begin, end, least, (inf, -inf), None)


@settings(max_examples=many(40))
@for_all(
    st.integers(0, 2**32), st.integers(0, 40), st.sampled_from([(1, 1), (1000, 1), (1000, 7), (1000, 2000)])
)
def test_near_pairs_are_all_those_on_which_robots_may_be_too_near_at_one_time(seed, count, sizes):
    rng = np.random.default_rng(seed)
    known = [occupation(rng, 4) for _ in range(count)]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(nearness, "_MANY", sizes[0])
        patch.setattr(nearness, "_A_SLICE", sizes[1])
        found = [tuple(each) for each in near_pairs(legs_of(known), 8.0).tolist()]

    def met(needed):
        return {
            (i, j)
            for i, j in combinations(range(count), 2)
            if known[i].robot != known[j].robot
            and max(known[i].begin, known[j].begin) < min(known[i].end, known[j].end)
            and nearest_encounter(known[i], known[j], needed) is not None
        }

    # Robots make at most 26 m/s, and an encounter is told to 0.01 s.
    assert met(8.0 - 0.6) <= set(found) <= met(8.0)
    assert found == sorted(set(found))


@settings(max_examples=many(100))
@for_all(st.integers(0, 2**32))
def test_robots_are_as_near_as_on_those_shares_of_their_legs_on_which_they_may_be_at_one_time(seed):
    rng = np.random.default_rng(seed)
    ends = rng.uniform(0.0, 20.0, (2, 2, 3)) * rng.choice([0.0, 1.0], (2, 1, 3))
    if rng.random() < 0.3:
        ends[:, 1] = ends[:, 0] + rng.uniform(-9.0, 9.0, 3)
    if rng.random() < 0.2:
        ends[0, 1] = ends[0, 0]
    begins, least = rng.uniform(0.0, 5.0, 2), rng.choice([0.0, 4.0, 9.0], 2)
    times = np.stack([begins, begins + least + rng.choice([0.0, 2.0, 20.0, inf], 2)], axis=1)
    assume(max(times[:, 0]) < min(times[:, 1]) - 1e-6)
    numbers = np.arange(2)
    legs = Legs(numbers, numbers, ends, times, least, np.zeros(2))
    (nearest,) = nearest_at_once(legs, numbers[:1], numbers[1:])
    s, r = np.meshgrid(np.linspace(0.0, 1.0, 201), np.linspace(0.0, 1.0, 201), indexing="ij")
    shares, step = (s, r), np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).sum() / 200
    soonest = [times[k, 0] + shares[k] * least[k] for k in (0, 1)]
    latest = [times[k, 1] - (1.0 - shares[k]) * least[k] for k in (0, 1)]
    # Shares within one step of such at which they may be at one time, and those at which they surely may.
    spare = max(least) / 100
    places = [ends[k, 0] + shares[k][..., None] * (ends[k, 1] - ends[k, 0]) for k in (0, 1)]
    apart_at = np.linalg.norm(places[0] - places[1], axis=2)
    late = np.maximum(*soonest) - np.minimum(*latest)
    assert nearest <= apart_at[late <= -1e-6].min(initial=inf) + 1e-6
    assert nearest >= apart_at[late <= spare].min() - step
