from importlib.util import find_spec

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mmrs_core.planning import sweep
from mmrs_core.planning.proximity import Pieces, Proximity

SPARE = 0.05


@st.composite
def fleets(draw):
    """Return pieces of some robots on a small lattice: many touch, are parallel, stay, or share times."""
    count = draw(st.integers(2, 24))
    rng = np.random.default_rng(draw(st.integers(0, 10**6)))
    lattice = draw(st.sampled_from([1.0, 0.37]))
    places = rng.integers(0, 9, (count, 2, 3)) * np.array([3.0, 3.0, 1.0]) * lattice
    stays = rng.random(count) < 0.25
    places[stays, 1] = places[stays, 0]
    twins = rng.random(count) < 0.2
    places[twins] = places[np.roll(np.arange(count), 1)][twins] + rng.integers(0, 2, (twins.sum(), 1, 3))
    least = np.linalg.norm(places[:, 1] - places[:, 0], axis=1) / rng.integers(1, 4, count)
    early = rng.integers(0, 8, count).astype(float)
    late = early + least + rng.integers(0, 3, count) * (rng.random(count) < 0.7)
    late[stays] += rng.integers(0, 4, stays.sum())
    early[stays & (rng.random(count) < 0.3)] = -np.inf
    late[stays & (rng.random(count) < 0.3)] = np.inf
    radii = rng.integers(0, 2, count) * (rng.random(count) < 0.3) * 1.0
    whole = np.zeros(count, np.intp)
    times = np.stack([early, late], axis=1)
    owners = rng.integers(0, draw(st.integers(2, 6)), count)
    return Pieces(owners, whole, whole, times, places, least, radii, whole)


def proximity(pieces):
    return Proximity(pieces, [(1e6 * k, 0.0, 0.0) for k in range(6)], 2.0)


def every_pair(pieces):
    i, j = np.triu_indices(len(pieces), 1)
    others = pieces.owners[i] != pieces.owners[j]
    return i[others], j[others]


@given(fleets())
def test_the_grid_finds_what_comparing_every_pair_finds(pieces):
    whole = proximity(pieces)
    i, j = every_pair(pieces)
    begin, end = whole.delays(i, j, SPARE)
    near = (begin < 0.0) & (end > 0.0)
    found = list(zip(*(each.tolist() for each in whole.meetings(SPARE)), strict=True))
    assert found == list(zip(i[near].tolist(), j[near].tolist(), strict=True))


@given(fleets(), st.integers(0, 10**6))
def test_only_pairs_of_which_one_has_moved_are_looked_at_again(pieces, seed):
    whole, moved = proximity(pieces), np.random.default_rng(seed).random(len(pieces)) < 0.3
    i, j = whole.meetings(SPARE)
    again = moved[i] | moved[j]
    found = whole.meetings(SPARE, moved)
    assert (i[again].tolist(), j[again].tolist()) == (found[0].tolist(), found[1].tolist())


@pytest.mark.skipif(find_spec("numba") is None, reason="needs the extra fast")
@given(fleets())
def test_compiled_loops_find_the_same(pieces):
    found = []
    for many in (0, 10**9):
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(sweep, "_MANY", many)
            found.append([each.tolist() for each in proximity(pieces).meetings(SPARE)])
    assert found[0] == found[1]


@given(fleets())
def test_robots_meet_where_places_at_one_time_are_too_near(pieces):
    """By samples of both pieces' shares: which may be taken at one time, and how near they then are."""
    whole, shares = proximity(pieces), np.linspace(0.0, 1.0, 31)
    i, j = every_pair(pieces)
    begin, end = whole.delays(i, j, 0.0)
    for one, two, meets in zip(i, j, (begin < 0.0) & (end > 0.0), strict=True):
        a, b = (_sampled(pieces, each, shares) for each in (one, two))
        together = np.maximum.outer(a[1], b[1]) < np.minimum.outer(a[2], b[2])
        gaps = np.linalg.norm(a[0][:, None] - b[0][None], axis=2)
        least = 2.0 + pieces.radii[one] + pieces.radii[two]
        if (together & (gaps < least - 1e-9)).any():
            assert meets
        step = sum(np.linalg.norm(each[0][1] - each[0][0]) for each in (a, b))
        apart = gaps[_nearly_together(pieces, one, two, a, b)]
        assert not meets or apart.min(initial=np.inf) < least + step


def _sampled(pieces, each, shares):
    """Return places, and from when to when each may be taken."""
    start, end = pieces.places[each]
    early, late = pieces.times[each]
    whole = pieces.least[each]
    return start + shares[:, None] * (end - start), early + shares * whole, late - (1.0 - shares) * whole


def _nearly_together(pieces, one, two, a, b):
    step = (pieces.least[one] + pieces.least[two]) / 30.0
    return np.maximum.outer(a[1], b[1]) <= np.minimum.outer(a[2], b[2]) + step
