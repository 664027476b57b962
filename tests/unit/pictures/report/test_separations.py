"""How near robots came to each other."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mmrs_core.pictures.flights.flight import Flown
from mmrs_core.pictures.flights.planned import PlannedLeg
from mmrs_core.pictures.flights.positions import Locator
from mmrs_core.pictures.flights.tracks import Track
from mmrs_core.pictures.report.distances import in_motion, separations_of
from mmrs_core.scene import Frame
from mmrs_core.testing.programs import move

PLACES = Locator(Frame("EPSG:4326", None, None))


def told(*tracks, required=None, moving=((0.0, 1e6),)):
    ways = [(Flown(f"robot {i}", (), track), moving) for i, track in enumerate(tracks)]
    return list(separations_of(ways, required, PLACES.of))


def test_robots_that_cross_between_their_fixes_are_as_near_as_they_were(make):
    one = make.track([(0, 0, 0, 10), (10, 100, 0, 10)])
    other = make.track([(0, 100, 3, 10), (10, 0, 3, 10)])
    (found,) = told(one, other, required=5.0)
    assert found.kept == pytest.approx(3.0)
    assert found.time == pytest.approx(5.0)
    assert found.where.position == pytest.approx((50.0, 0.0, 10.0))
    assert found.too_near


def test_robots_at_one_place_at_other_times_are_not_near(make):
    one = make.track([(0, 0, 0, 0), (10, 100, 0, 0)])
    other = make.track([(0, 100, 0, 0), (10, 200, 0, 0)])
    assert told(one, other)[0].kept == pytest.approx(100.0)


def test_robots_whose_places_are_never_known_together_are_not_told(make):
    assert told(make.track([(0, 0, 0, 0), (1, 0, 0, 0)]), make.track([(5, 0, 0, 0), (6, 0, 0, 0)])) == []
    assert told(make.track([(0, 0, 0, 0), (1, 0, 0, 0)]), make.track([])) == []


def test_nobody_knows_how_near_they_were_in_a_gap(make):
    one = make.track([(0, 0, 0, 0), (1, 0, 0, 0), (9, 100, 0, 0), (10, 100, 0, 0)], broken=[1])
    other = make.track([(0, 50, 0, 0), (10, 50, 0, 0)])
    assert told(one, other)[0].kept == pytest.approx(50.0)


def test_every_two_robots_are_told(make):
    tracks = [make.track([(0, 10 * i, 0, 0), (1, 10 * i, 0, 0)]) for i in range(4)]
    assert len(told(*tracks)) == 6


def test_robots_that_stand_at_home_are_not_told(make):
    rows = [[(0, i, 0, 0), (10, i, 0, 0), (20, 50 * i, 0, 9), (30, 50 * i, 0, 9)] for i in (0, 1)]
    tracks = [make.track(each) for each in rows]
    assert told(*tracks, moving=((20.0, 30.0),))[0].kept == pytest.approx(50.0)
    assert told(*tracks, moving=()) == []


def test_a_robot_is_in_motion_from_its_first_way_to_its_last_and_not_while_it_charges(make):
    way = ((0.0, 0.0, 0.0), (9.0, 0.0, 0.0))
    legs = [
        PlannedLeg(move("start", "Start"), 0.0, 3.0, True, way[:1]),
        PlannedLeg(move("a", "GoTo"), 5.0, 10.0, True, way),
        PlannedLeg(move("load", "Recharge"), 12.0, 20.0, True, way[:1]),
        PlannedLeg(move("b", "GoTo"), 22.0, 30.0, True, way),
    ]
    flown = Flown("alpha", make.records("alpha", (0.0, "begin", "start"), (31.0, "end", "stop")))
    assert in_motion(flown, legs) == ((5.0, 12.0), (20.0, 30.0))
    assert in_motion(flown, legs[:1]) == ()


pace = st.floats(-9.0, 9.0)
steps = st.lists(st.tuples(st.floats(0.1, 3.0), pace, pace), min_size=2, max_size=9)


@given(steps, steps)
def test_no_sampled_distance_is_smaller(first, second):
    tracks = []
    for given_steps in (first, second):
        rows = np.array(given_steps)
        times, places = np.cumsum(rows[:, 0]), np.c_[np.cumsum(rows[:, 1:], axis=0), np.zeros(len(rows))]
        tracks.append(Track(times, places, np.full(len(rows), np.nan), np.zeros(len(rows), dtype=bool)))
    since = max(track.times[0] for track in tracks)
    until = min(track.times[-1] for track in tracks)
    if until <= since:
        assert told(*tracks) == []
        return
    times = np.linspace(since, until, 300)
    sampled = np.array([[np.interp(times, t.times, t.positions[:, i]) for i in (0, 1)] for t in tracks])
    distances = np.hypot(*(sampled[0] - sampled[1]))
    (found,) = told(*tracks)
    assert found.kept <= distances.min() + 1e-9
    paces = (np.linalg.norm(np.diff(t.positions, axis=0), axis=1) / np.diff(t.times) for t in tracks)
    assert found.kept >= distances.min() - sum(pace.max() for pace in paces) * (times[1] - times[0]) - 1e-9
