"""Tracks that were thinned out stay as near to the fixes as promised."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mmrs_core.pictures.flights import tracks
from mmrs_core.pictures.flights.tracks import NOWHERE, Track, pieces, thinned


def track(times, positions, broken=()):
    flags = np.zeros(len(times), dtype=bool)
    flags[list(broken)] = True
    laid = np.array(positions, dtype=float).reshape(-1, 3)
    return Track(np.array(times, dtype=float), laid, np.full(len(times), np.nan), flags)


def off(whole, thin):
    """Return the largest distance of a fix from the thinned track at its time, fix by fix."""
    each = [np.interp(whole.times, thin.times, thin.positions[:, axis]) for axis in range(3)]
    return float(np.linalg.norm(np.stack(each, axis=1) - whole.positions, axis=1).max())


steps = st.tuples(st.floats(0.01, 5.0), *(st.floats(-20.0, 20.0) for _ in range(3)))


@given(st.lists(steps, min_size=1, max_size=60), st.floats(0.05, 10.0))
def test_every_fix_that_is_left_out_is_within_the_tolerance(given_steps, tolerance):
    times = np.cumsum([step[0] for step in given_steps])
    positions = np.cumsum([step[1:] for step in given_steps], axis=0)
    whole = track(times, positions)
    thin, kept_to = thinned(whole, tolerance)
    assert kept_to == tolerance
    assert off(whole, thin) <= tolerance + 1e-9


def test_a_straight_flight_is_two_points():
    whole = track(range(1000), [(i * 2.0, 0.0, 5.0) for i in range(1000)])
    thin, _ = thinned(whole)
    assert thin.times.tolist() == [0.0, 999.0]


def test_a_corner_stays():
    positions = [(float(i), 0.0, 0.0) for i in range(50)] + [(49.0, float(i), 0.0) for i in range(1, 50)]
    thin, _ = thinned(track(range(99), positions), 0.01)
    assert [49.0, 0.0, 0.0] in thin.positions.tolist()
    assert len(thin.times) == 3


def test_both_ends_of_a_gap_stay_and_it_stays_a_gap():
    whole = track([*range(10), *range(30, 40)], [(i, 0.0, 0.0) for i in range(20)], broken=[9])
    thin, _ = thinned(whole)
    assert thin.gaps == whole.gaps == ((9.0, 30.0),)
    assert [piece[:, 0].tolist() for piece in pieces(thin)] == [[0.0, 9.0], [10.0, 19.0]]


def test_a_jump_in_no_time_keeps_both_places():
    thin, _ = thinned(track([0.0, 1.0, 1.0, 2.0], [(0, 0, 0), (1, 0, 0), (9, 0, 0), (10, 0, 0)]))
    assert thin.positions[:, 0].tolist() == [0.0, 1.0, 9.0, 10.0]


def test_the_tolerance_grows_until_few_points_are_left_and_is_told(monkeypatch):
    monkeypatch.setattr(tracks, "MOST_POINTS", 50)
    noise = np.random.default_rng(7).normal(0.0, 1.0, (500, 3))
    whole = track(range(500), noise)
    thin, tolerance = thinned(whole, 0.2)
    assert len(thin.times) <= 50
    assert 0.2 < tolerance < 30.0
    assert off(whole, thin) <= tolerance


@pytest.mark.parametrize("count", [0, 1, 2])
def test_the_shortest_tracks_stay_as_they_are(count):
    whole = track(range(count), [(i, i, i) for i in range(count)]) if count else NOWHERE
    assert thinned(whole)[0].times.tolist() == list(range(count))
