"""The bound on the longest tour by few of the places, beside best tours that are known by trying all."""

import numpy as np
import pytest
from best_tours import longest_of_best

from mmrs_core.planning import few_places
from mmrs_core.planning.few_places import longest_to_few


def drawn(robots, places, seed):
    random = np.random.default_rng((seed, robots, places))
    spots, homes = random.uniform(0, 100, (places, 2)), random.uniform(0, 100, (robots, 2))
    return np.linalg.norm(spots[:, None] - spots, axis=2), np.linalg.norm(homes[:, None] - spots, axis=2)


@pytest.mark.parametrize("back", [True, False])
@pytest.mark.parametrize("robots", [1, 2, 3])
def test_few_places_have_exactly_the_best_tours(robots, back):
    between, there = drawn(robots, 5, 1)
    assert longest_to_few(between, there, back) == pytest.approx(longest_of_best(between, there, back, 0.0))


@pytest.mark.parametrize("back", [True, False])
@pytest.mark.parametrize("seed", range(8))
def test_no_tours_to_many_places_are_below_the_bound_nor_far_above_it(seed, back, monkeypatch):
    monkeypatch.setattr(few_places, "_FEW", 3)
    between, there = drawn(2, 6, seed)
    best = longest_of_best(between, there, back, 0.0)
    assert 0.6 * best < longest_to_few(between, there, back) <= best + 1e-9


@pytest.mark.parametrize("seed", range(4))
def test_robots_that_are_far_away_may_count_as_nearer_but_never_as_further(seed, monkeypatch):
    between, there = drawn(8, 3, seed)
    exact = longest_to_few(between, there, True)
    monkeypatch.setattr(few_places, "_ROBOTS", 2)
    assert 0.8 * exact < longest_to_few(between, there, True) <= exact + 1e-9


def test_distant_places_far_apart_raise_the_bound_above_the_way_to_the_most_distant_one():
    spots, home = np.array([[100.0, 0.0], [-100.0, 0.0], [0.0, 100.0], [1.0, 1.0]]), np.zeros((2, 2))
    between = np.linalg.norm(spots[:, None] - spots, axis=2)
    there = np.linalg.norm(home[:, None] - spots, axis=2)
    assert longest_to_few(between, there, True) == pytest.approx(200.0 + 100.0 * 2.0**0.5, abs=3.0)
