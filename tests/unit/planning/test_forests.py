"""The bound on the longest tour, beside best tours that are known by trying all."""

import numpy as np
import pytest
from best_tours import longest_of_best

from mmrs_core.planning.forests import least_longest, shared, spanning_tree


@pytest.mark.parametrize("back", [True, False])
@pytest.mark.parametrize("seed", range(12))
def test_no_tours_are_below_the_bound_nor_far_above_it(seed, back):
    random = np.random.default_rng(seed)
    robots, places = (1, 2, 3)[seed % 3], 5
    spots, homes = random.uniform(0, 100, (places, 2)), random.uniform(0, 100, (robots, 2))
    between = np.linalg.norm(spots[:, None] - spots, axis=2)
    there = np.linalg.norm(homes[:, None] - spots, axis=2)
    work = float(seed)
    best = longest_of_best(between, there, back, work)
    bound = least_longest(between, there, back, work * places)
    assert 0.55 * best < bound <= best + 1e-9
    edges, _ = spanning_tree(between.__getitem__, places)
    assert shared(edges, (1 + back) * there.min(axis=1), work * places).min() <= bound + 1e-9
