"""Stops that wait for each other, beside the best of all orders."""

from itertools import permutations, product
from math import inf
from random import Random

import pytest
from plain_fields import field, places

from mmrs_core.geometry.compilation import can_compile
from mmrs_core.planning import ruin
from mmrs_core.planning.effort import Effort
from mmrs_core.planning.orders import OrderSearch


def searched(given, before, steps=300, seed=0):
    search = OrderSearch(given, before, seed)
    for _ in search.run(Effort().shares(steps)):
        pass
    return search


def waits(count, seed):
    random = Random(seed)
    return [sorted(random.sample(range(i), min(i, random.randint(0, 2)))) for i in range(count)]


def makespan(given, before, order, robots):
    """Return when the last of two robots is back, each stop in that order done by the robot named."""
    n = len(before)
    here, free, ends = [n, n], [0.0, 0.0], {}
    for stop in order:
        robot = robots[stop]
        there = given.out[robot * n + stop] if here[robot] == n else given.go[here[robot] * n + stop]
        begin = max(free[robot] + there, *(ends[other] for other in before[stop]), 0.0)
        here[robot], free[robot] = stop, begin + given.work[stop]
        ends[stop] = free[robot]
    return max(free[r] + (given.back[r * n + here[r]] if here[r] < n else 0.0) for r in (0, 1))


@pytest.mark.parametrize("seed", range(4))
def test_the_best_order_of_work_at_one_place_is_found(seed):
    random, before, nowhere = Random(seed), waits(5, seed), [(0.0, 0.0)]
    given = field(nowhere * 2, nowhere * 5, work=[random.uniform(1.0, 9.0) for _ in range(5)])
    feasible = [
        order
        for order in permutations(range(5))
        if all(order.index(other) < order.index(stop) for stop in order for other in before[stop])
    ]
    least = min(makespan(given, before, *each) for each in product(feasible, product((0, 1), repeat=5)))
    assert searched(given, before).makespan == pytest.approx(least)


def test_an_order_is_kept_and_its_makespan_is_that_of_its_robots():
    before = waits(12, 5)
    given = field(places(2, 1), places(12, 2), work=[10.0] * 12)
    found = searched(given, before)
    order = list(found.best.order)
    assert sorted(order) == list(range(12))
    assert all(order.index(other) < order.index(stop) for stop in order for other in before[stop])
    assert makespan(given, before, order, found.best.robots) == pytest.approx(found.makespan)


def test_robots_recharge_and_priority_comes_first():
    given = field(
        [(0.0, 0.0)], [(5.0, 0.0), (5.0, 0.0), (5.0, 0.0)], limits=[12.0], recharges=[100.0], ranks=[0, 0, 1]
    )
    found = searched(given, [[], [], []])
    assert found.best.order[0] == 2
    assert found.makespan == pytest.approx(10.0)
    assert searched(given._replace(work=given.work + 2.0), [[], [], []]).makespan == pytest.approx(
        3 * 12.0 + 200.0
    )


def test_no_robot_that_can_do_a_stop_makes_it_endless():
    assert searched(field([(0.0, 0.0)], [(1.0, 0.0)], out=[inf]), [[]], steps=1).makespan == inf


@pytest.mark.skipif(not can_compile(), reason="numba is not installed")
@pytest.mark.thorough
def test_compiled_orders_are_the_same(monkeypatch):
    given, before = field(places(3, 1), places(60, 2), work=[7.0] * 60), waits(60, 3)
    compiled = searched(given, before)
    monkeypatch.setattr(ruin, "can_compile", lambda: False)
    plain = searched(given, before)
    assert list(compiled.best.order) == plain.best.order
    assert compiled.makespan == plain.makespan
