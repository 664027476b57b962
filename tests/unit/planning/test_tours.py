import numpy as np
import pytest

from mmrs_core.planning.tours import hop_length, tour


def rows(count):
    ys = 10.0 * np.arange(count)
    return np.c_[np.zeros(count), ys], np.c_[np.full(count, 100.0), ys]


def test_rows_are_done_to_and_fro():
    begins, ends = rows(6)
    order = tour(begins, ends)
    assert hop_length(begins, ends, order) == pytest.approx(50.0)
    assert [back for _, back in order] in ([False, True] * 3, [True, False] * 3)


def test_the_tour_begins_near_the_start():
    begins, ends = rows(5)
    assert tour(begins, ends, (100.0, 45.0))[0] == (4, True)


def test_every_stroke_comes_once():
    rng = np.random.default_rng(3)
    begins, ends = rng.uniform(0, 100, (2, 40, 2))
    assert sorted(index for index, _ in tour(begins, ends)) == list(range(40))


def test_improvement_never_lengthens_a_tour():
    for seed in range(5):
        rng = np.random.default_rng(seed)
        begins, ends = rng.uniform(0, 100, (2, 30, 2))
        quick = hop_length(begins, ends, tour(begins, ends, (0.0, 0.0), improve=False), (0.0, 0.0))
        assert hop_length(begins, ends, tour(begins, ends, (0.0, 0.0)), (0.0, 0.0)) <= quick + 1e-9


def test_small_tours_are_nearly_as_short_as_can_be():
    from itertools import permutations, product

    rng = np.random.default_rng(7)
    begins, ends = rng.uniform(0, 100, (2, 5, 2))
    best = min(
        hop_length(begins, ends, list(zip(order, flips, strict=True)))
        for order in permutations(range(5))
        for flips in product((False, True), repeat=5)
    )
    assert hop_length(begins, ends, tour(begins, ends)) <= 1.15 * best


def test_no_strokes_make_no_tour():
    assert tour(np.empty((0, 2)), np.empty((0, 2))) == []
