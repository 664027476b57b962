"""Robots that fly keep apart at other levels on single legs, and exchange tours where they cannot pass."""

from dataclasses import replace
from itertools import pairwise

import pytest
from plain_scenes import DRONE, box, field_work, robot, scene, visit, with_kinematics
from plan_replay import complaints

from mmrs_core.planning.assembly import planned
from mmrs_core.planning.charges import Charges
from mmrs_core.planning.exchanging import levelled
from mmrs_core.planning.flight_levels import on_levels
from mmrs_core.planning.jobs import jobs_of
from mmrs_core.planning.planner import plan
from mmrs_core.planning.schedule import Decisions
from mmrs_core.planning.separation import distance_to_keep, first_conflict
from mmrs_core.planning.team import Team
from mmrs_core.scene import Serve, Transit
from mmrs_runtime.timing import LegTiming

FIELD = [
    (160.0 * (k % 5) + 31.0 * (k // 5), 150.0 + 130.0 * (k // 5) + 17.0 * (k % 3), 20.0) for k in range(20)
]


def fleet(homes, **kinematics):
    return [
        with_kinematics(robot(f"r{k}", (*home, 0.0)), timing=LegTiming(spread=0.2), **kinematics)
        for k, home in enumerate(homes)
    ]


def beside(count):
    return [(10.0 * k, 0.0) for k in range(count)]


def legs(found):
    return {
        each.robot: [step.route for step in each.steps if isinstance(step, Transit)] for each in found.robots
    }


def whole_and_alone(whole):
    found, alone = plan(whole), plan(replace(whole, minimum_separation=None))
    assert complaints(whole, found) == []
    assert first_conflict(whole, found, distance_to_keep(whole)) is None
    return found, alone


def test_drones_from_homes_beside_each_other_take_hardly_longer_than_alone():
    team = fleet(beside(6))
    works = {f"t{k}": {each.name: visit(place) for each in team} for k, place in enumerate(FIELD)}
    found, alone = whole_and_alone(scene(team, works, minimum_separation=5.0))
    assert found.makespan <= 1.08 * alone.makespan


def crossed(team):
    """Return drones each of which has a place of its own, so that all paths cross."""
    places = {each.name: (300.0 - 60.0 * k, 500.0, 20.0) for k, each in enumerate(team)}
    works = {f"t-{name}": {name: visit(place)} for name, place in places.items()}
    return scene(team, works, minimum_separation=5.0)


def test_drones_whose_paths_all_cross_take_a_level_each():
    found, alone = whole_and_alone(crossed(fleet(beside(5))))
    assert found.makespan <= alone.makespan + 40.0
    heights = {max(place[2] for route in routes for place in route) for routes in legs(found).values()}
    assert len(heights) > 2


def test_a_drone_that_lacks_the_charge_to_go_higher_stays_at_its_level():
    plain = crossed(fleet(beside(3)))
    used = Charges(Team(plain).pilots).most_used(plan(replace(plain, minimum_separation=None)))["r1"]
    weary = with_kinematics(plain.robots[1], endurance=used + 1.0, recharge=None)
    short = replace(plain, robots=(plain.robots[0], weary, plain.robots[2]))
    found, _ = whole_and_alone(short)
    assert all(place[2] <= 20.0 for route in legs(found)["r1"] for place in route)


def test_two_drones_that_cannot_pass_each_other_exchange_their_tours():
    """The one with the nearer home would come back over the other's last place, and land below it."""
    tours = ((400.0, 450.0, 20.0), (400.0, 2.0, 20.0)), ((800.0, 4.0, 20.0),)
    team = fleet([(0.0, 0.0), (10.0, 0.0)])
    works = {f"t{k}": dict.fromkeys(("r0", "r1"), visit(*tour)) for k, tour in enumerate(tours)}
    whole = scene(team, works, minimum_separation=5.0)
    crew, jobs = Team(whole), jobs_of(whole)
    decisions = Decisions(("t0", "t1"), {"t0": ("r0",), "t1": ("r1",)})
    found = planned(crew, jobs, decisions)
    assert on_levels(crew, found).conflicts
    exchanged = levelled(crew, jobs, decisions, found)
    assert not exchanged.conflicts
    assert complaints(whole, exchanged.plan) == []
    assert exchanged.plan.makespan <= 1.1 * found.makespan
    assert {each.robot: each.steps[1].task for each in exchanged.plan.robots} == {"r0": "t1", "r1": "t0"}


def test_robots_that_do_not_fly_have_no_levels():
    team = [
        with_kinematics(each, timing=LegTiming(spread=0.2), launches=False, floor=0.0, ceiling=0.0)
        for each in (robot("r0"), robot("r1", (100.0, 0.0, 0.0)))
    ]
    works = {f"t{k}": {f"r{k}": visit((100.0 - 100.0 * k, 200.0, 0.0))} for k in (0, 1)}
    whole = scene(team, works, minimum_separation=5.0)
    alone = plan(replace(whole, minimum_separation=None))
    assert on_levels(Team(whole), alone).plan is alone


@pytest.mark.parametrize("ceiling", [20.0, 26.0])
def test_levels_end_at_the_ceiling(ceiling):
    found, _ = whole_and_alone(crossed(fleet(beside(3), ceiling=ceiling)))
    assert max(place[2] for routes in legs(found).values() for route in routes for place in route) <= ceiling


@pytest.mark.parametrize("altitude", [50.0, 60.0])
def test_no_level_is_below_the_transit_altitude(altitude):
    found, alone = whole_and_alone(replace(crossed(fleet(beside(4))), transit_altitude=altitude))
    assert found.makespan > alone.makespan
    for one, two in (leg for routes in legs(found).values() for route in routes for leg in pairwise(route)):
        assert one[:2] == two[:2] or min(one[2], two[2]) >= altitude


def test_a_drone_that_is_sooner_at_a_level_still_begins_no_earlier_than_its_earliest_start():
    """Over the wall it is quicker when it launches higher and flies down on a slant."""
    team = [*fleet([(0.0, 0.0)]), *fleet([(-50.0, 0.0)], ceiling=20.0)]
    team[1] = replace(team[1], name="r1")
    wall = box("wall", 195.0, -200.0, 205.0, 200.0, high=26.0)
    lane = ((100.0, 60.0, 20.0), (100.0, -60.0, 20.0))
    works = {"t0": {"r0": visit((400.0, 0.0, 20.0))}, "t1": {"r1": visit(*lane * 4)}}
    whole = scene(team, works, minimum_separation=11.0, areas=(wall,))
    tasks = tuple(replace(each, earliest=90.0) if each.name == "t0" else each for each in whole.tasks)
    whole = replace(whole, tasks=tasks)
    found, alone = whole_and_alone(whole)
    assert legs(found)["r0"][0] != legs(alone)["r0"][0]
    place = next(i for i, step in enumerate(found.robots[0].steps) if isinstance(step, Serve))
    assert Team(whole).timelines(hasty=False).of(found)["r0"].moments[place][0] >= 90.0


def test_robots_that_recharge_keep_some_of_each_charge_for_levels():
    kinematics = replace(DRONE, timing=LegTiming(spread=0.1), endurance=300.0, recharge=60.0)
    team = [robot(f"r{k}", (14.0 * k, 0.0, 0.0), kinematics=kinematics) for k in range(3)]
    shell = ((0.0, 60.0), (400.0, 60.0), (400.0, 460.0), (0.0, 460.0))
    works = {"field": field_work(scene(team, {}), shell, altitude=40.0)}
    found, alone = whole_and_alone(scene(team, works, minimum_separation=5.0))
    assert found.makespan < 1.05 * alone.makespan


def test_robots_wait_where_levels_do_not_keep_all_of_them_apart():
    team = fleet([(14.0 * (k % 4), -14.0 * (k // 4)) for k in range(8)])
    shell = ((0.0, 60.0), (400.0, 60.0), (400.0, 460.0), (0.0, 460.0))
    works = {"field": field_work(scene(team, {}), shell, altitude=40.0)}
    found, alone = whole_and_alone(scene(team, works, minimum_separation=5.0))
    assert found.makespan < 1.1 * alone.makespan
