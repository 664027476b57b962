"""Robots keep apart by signals and levels: they wait for each other in corridors, and cross elsewhere."""

from dataclasses import replace
from itertools import pairwise
from math import dist

import pytest
from plain_scenes import road, robot, scene, visit, with_kinematics
from plan_replay import complaints

from mmrs_core.planning.effort import Effort
from mmrs_core.planning.planner import plan
from mmrs_core.planning.separation import distance_to_keep, first_conflict
from mmrs_core.scene import Await, Corridor, Launch, Recover, Serve, Signal, Transit
from mmrs_runtime.timing import LegTiming

LANE = Corridor("lane", ((0.0, 50.0), (0.0, 150.0)), 10.0, low=18.0, high=22.0)
OUT = replace(LANE, name="out", line=((40.0, 50.0), (40.0, 150.0)), use="EXIT")
TWO = (replace(LANE, use="ENTRY"), OUT)


def fleet(count, corridors, **timing):
    """Return drones whose times are uncertain by a fifth, with a field for each behind corridors."""
    timing = {"spread": 0.2, **timing}
    team = [
        with_kinematics(robot(f"r{k}", (10.0 * k, 0.0, 0.0)), timing=LegTiming(**timing))
        for k in range(count)
    ]
    fields = {}
    for k in range(count):
        west, east = 100.0 * k, 100.0 * k + 20.0
        outline = ((west, 250.0), (west, 850.0), (east, 850.0), (east, 250.0))
        fields[f"t{k}"] = replace(road(*((*place, 20.0) for place in outline)), divisible=False)
    return scene(team, fields, corridors=corridors, minimum_separation=5.0)


def steps(found, sort):
    return [step for each in found.robots for step in each.steps if isinstance(step, sort)]


@pytest.mark.parametrize(("count", "most"), [(2, 1.15), (3, 1.25)])
@pytest.mark.parametrize("corridors", [(LANE,), TWO], ids=["one", "two"])
def test_drones_go_through_a_corridor_as_soon_as_the_one_before_is_out_of_the_way(count, most, corridors):
    whole = fleet(count, corridors)
    found = plan(whole)
    assert complaints(whole, found) == []
    assert first_conflict(whole, found, distance_to_keep(whole)) is None
    assert found.makespan < most * plan(replace(whole, minimum_separation=None)).makespan


def test_a_drone_waits_inside_for_the_corridor_to_be_free_not_for_the_other_to_be_home():
    found = plan(fleet(2, (LANE,)))
    homewards = [
        [step for step in each.steps if isinstance(step, Await) and step.begin > last]
        for each in found.robots
        for last in [max(step.begin for step in each.steps if isinstance(step, Serve))]
    ]
    (waits,) = filter(None, homewards)
    assert all(wait.signals for wait in waits)
    assert waits[0].end < min(step.end for step in steps(found, Recover)) - 5.0


def test_signals_are_awaited_by_those_whom_they_are_for_and_only_once():
    found = plan(fleet(3, TWO))
    given = {step.signal: step.receivers for step in steps(found, Signal)}
    awaited = [
        (each.robot, signal)
        for each in found.robots
        for step in each.steps
        if isinstance(step, Await)
        for signal in step.signals
    ]
    assert sorted(awaited) == sorted((name, signal) for signal, names in given.items() for name in names)


def test_transits_are_cut_only_where_a_robot_waits_or_signals():
    found = plan(fleet(2, (LANE,)))
    for each in found.robots:
        pairs = pairwise(each.steps)
        assert not any(isinstance(one, Transit) and isinstance(two, Transit) for one, two in pairs)


def test_where_the_clock_costs_nothing_no_robot_signals():
    found = plan(fleet(2, (LANE,), spread=0.0))
    assert steps(found, Signal) == []


def test_a_drone_from_afar_waits_near_the_end_of_the_corridor():
    team = [
        with_kinematics(robot(f"r{k}", (20.0 * k, 0.0, 0.0)), timing=LegTiming(spread=0.2)) for k in (0, 1)
    ]
    places = ((-300.0, 1200.0, 20.0), (300.0, 1200.0, 20.0))
    whole = scene(
        team,
        {f"t{k}": visit(place, hold=120.0) for k, place in enumerate(places)},
        corridors=(LANE,),
        minimum_separation=5.0,
    )
    found = plan(whole)
    assert complaints(whole, found) == []
    assert found.makespan < 1.2 * plan(replace(whole, minimum_separation=None)).makespan
    stops = [
        one.route[-1]
        for each in found.robots
        for one, two in pairwise(each.steps)
        if isinstance(one, Transit) and isinstance(two, Await)
    ]
    assert any(dist(stop, (0.0, 150.0, 20.0)) < 60.0 for stop in stops)


@pytest.mark.parametrize("endurance", [260.0, 300.0])
def test_drones_that_recharge_take_turns_in_a_corridor_flight_by_flight(endurance):
    battery = {"endurance": endurance, "energy": 1e9, "recharge": 200.0, "timing": LegTiming(spread=0.2)}
    team = [with_kinematics(robot(f"r{k}", (10.0 * k, 0.0, 0.0)), **battery) for k in (0, 1)]
    fields = {}
    for k in (0, 1):
        rows = [(100.0 * k + 20.0 * row, 250.0 + 600.0 * side) for row in range(6) for side in (0, 1)]
        rows[2::4], rows[3::4] = rows[3::4], rows[2::4]
        fields[f"t{k}"] = road(*((*place, 20.0) for place in rows), cuts=tuple(range(50, 3600, 50)))
    whole = scene(team, fields, corridors=(LANE,), minimum_separation=5.0)
    found = plan(whole)
    assert complaints(whole, found) == []
    assert first_conflict(whole, found, distance_to_keep(whole)) is None
    assert all(each.sorties >= 3 for each in found.robots)
    assert found.makespan < 1.25 * plan(replace(whole, minimum_separation=None)).makespan


def crossing(ceiling):
    """Return two drones whose paths cross, and whose times are uncertain by a third."""
    team = [
        with_kinematics(robot(f"r{k}", (600.0 * k, 0.0, 0.0)), timing=LegTiming(spread=0.3), ceiling=ceiling)
        for k in (0, 1)
    ]
    works = {f"t{k}": {f"r{k}": visit((600.0 - 600.0 * k, 1200.0, 20.0))} for k in (0, 1)}
    return scene(team, works, minimum_separation=5.0)


def legs(found):
    return {
        each.robot: [step.route for step in each.steps if isinstance(step, Transit)] for each in found.robots
    }


def metres(each):
    routes = (step.route for step in each.steps if isinstance(step, Transit))
    upright = (abs(step.up - step.at[2]) for step in each.steps if isinstance(step, Launch | Recover))
    return sum(upright) + sum(dist(*leg) for route in routes for leg in pairwise(route))


def test_drones_that_may_be_early_or_late_cross_one_above_the_other():
    whole = crossing(ceiling=120.0)
    found, alone = plan(whole), plan(replace(whole, minimum_separation=None))
    assert complaints(whole, found) == []
    assert first_conflict(whole, found, distance_to_keep(whole)) is None
    highest = max(place[2] for step in steps(found, Transit) for place in step.route)
    assert highest >= 20.0 + distance_to_keep(whole)
    assert alone.makespan < found.makespan < alone.makespan + 20.0
    assert all(any({up for _, _, up in each} == {20.0} for each in routes) for routes in legs(found).values())
    for each, before in zip(found.robots, alone.robots, strict=True):
        assert each.length - before.length == pytest.approx(metres(each) - metres(before))


def test_below_a_low_ceiling_drones_that_cross_wait_for_each_other():
    whole = crossing(ceiling=24.0)
    found = plan(whole)
    assert first_conflict(whole, found, distance_to_keep(whole)) is None
    assert max(place[2] for step in steps(found, Transit) for place in step.route) <= 24.0
    assert steps(found, Await)


def time_is_over():
    ticks = iter(range(10**6))
    return Effort(0.0, lambda: float(next(ticks)))


def stopped_at_the_first_schedule():
    effort = Effort(3600.0, show=lambda best, least: effort.stop())
    return effort


@pytest.mark.parametrize("make_effort", [time_is_over, stopped_at_the_first_schedule])
def test_once_the_search_is_to_end_the_first_plan_that_keeps_drones_apart_will_do(make_effort):
    whole = fleet(3, (LANE,))
    first = plan(whole, effort=make_effort())
    assert complaints(whole, first) == []
    assert first_conflict(whole, first, distance_to_keep(whole)) is None
    assert first.makespan > 1.3 * plan(whole).makespan
