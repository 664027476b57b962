from itertools import permutations, product
from math import dist, inf

import pytest
from plain_fields import field, places

from mmrs_core.geometry.compilation import can_compile
from mmrs_core.planning import ruin
from mmrs_core.planning.effort import Effort
from mmrs_core.planning.ruin import Search, stops_of


def searched(given, steps=300, seed=0):
    search = Search(given, seed)
    for _ in search.run(Effort().shares(steps)):
        pass
    return search.best


def orders(tours, robots):
    return [list(stops_of(tours, robot)) for robot in range(robots)]


def length(home, way):
    return sum(map(dist, (home, *way), (*way, home)))


@pytest.mark.parametrize("seed", range(5))
def test_the_longest_of_two_tours_is_as_short_as_any(seed):
    homes, stops = places(2, seed), places(6, seed + 100)
    least = inf
    for who in product((0, 1), repeat=len(stops)):
        mine = [[stop for stop, robot in zip(stops, who, strict=True) if robot == each] for each in (0, 1)]
        shortest = [
            min(length(*pair) for pair in product([home], permutations(own)))
            for home, own in zip(homes, mine, strict=True)
        ]
        least = min(least, max(shortest))
    assert max(searched(field(homes, stops)).seconds) == pytest.approx(least)


def test_each_stop_is_in_one_tour_whose_seconds_are_those_of_its_legs():
    homes, stops = places(4, 1), places(40, 2)
    tours = searched(field(homes, stops))
    found = orders(tours, 4)
    assert sorted(stop for order in found for stop in order) == list(range(40))
    assert tours.seconds == pytest.approx(
        [length(home, [stops[i] for i in order]) for home, order in zip(homes, found, strict=True)]
    )


def test_the_same_seed_gives_the_same_tours():
    given = field(places(3, 3), places(20, 4))
    assert orders(searched(given, seed=7), 3) == orders(searched(given, seed=7), 3)


@pytest.mark.thorough
@pytest.mark.skipif(not can_compile(), reason="numba is not installed")
def test_compiled_steps_lead_to_the_same_tours(monkeypatch):
    given = field(places(4, 1), places(40, 2))
    plain = orders(searched(given), 4)
    monkeypatch.setattr(ruin, "_MANY", 0)
    assert orders(searched(given), 4) == plain


def test_priority_does_not_rise_along_a_tour():
    ranks = [i % 3 for i in range(20)]
    tours = searched(field(places(3, 5), places(20, 6), ranks=ranks))
    for order in orders(tours, 3):
        assert [ranks[i] for i in order] == sorted((ranks[i] for i in order), reverse=True)


def test_stops_that_are_to_be_apart_have_different_robots():
    apart = [1, 2, 0, 2, 0, 1, *([-1] * 14)]
    tours = searched(field(places(3, 7), places(10, 8), sizes=[10, 3, 9, 3, 2, 0], apart=apart))
    assert len({tours.robot[i] for i in range(3)}) == 3


def test_a_robot_recharges_at_home_where_its_charge_does_not_suffice():
    given = field([(0.0, 0.0)], [(10.0, 0.0), (0.0, 10.0)], limits=[25.0], recharges=[100.0])
    assert searched(given).seconds == pytest.approx([20.0 + 100.0 + 20.0])


def test_a_stop_waits_for_its_time_and_one_with_a_deadline_comes_first():
    stops = [(10.0, 0.0), (20.0, 0.0)]
    tours = searched(field([(0.0, 0.0)], stops, earliest=[50.0, 0.0], deadlines=[inf, 30.0]))
    assert orders(tours, 1) == [[1, 0]]
    assert tours.begins[:2] == [50.0, 20.0]
