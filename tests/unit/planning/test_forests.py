"""The bound on the longest tour, beside best tours that are known by trying all."""

from itertools import pairwise, permutations, product

import numpy as np
import pytest

from mmrs_core.planning.forests import least_longest, shared, spanning_tree


def longest_of_best(between, there, back, work):
    """Return the longest tour of the best tours, each at least with its works."""
    robots, places = there.shape
    tour = {}
    for robot in range(robots):
        for k in range(1 << places):
            some = [i for i in range(places) if k >> i & 1]
            whole = (
                there[robot, order[0]]
                + sum(between[pair] for pair in pairwise(order))
                + back * there[robot, order[-1]]
                for order in permutations(some)
                if order
            )
            tour[robot, k] = min(whole, default=0.0) + work * len(some)
    chosen = product(range(robots), repeat=places)
    masks = (
        [sum(1 << i for i, r in enumerate(each) if r == robot) for robot in range(robots)] for each in chosen
    )
    return min(max(tour[robot, k] for robot, k in enumerate(each)) for each in masks)


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
