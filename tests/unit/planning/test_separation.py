from dataclasses import replace
from itertools import pairwise
from math import dist, inf
from time import perf_counter

import numpy as np
import pytest
from plain_scenes import CRAWLER, control, road, robot, scene, task, visit, with_kinematics
from plan_replay import complaints

from mmrs_core.analysis.distance import paired_distances
from mmrs_core.errors import InfeasibleError
from mmrs_core.planning.effort import Effort
from mmrs_core.planning.planner import plan
from mmrs_core.planning.separation import Traffic, distance_to_keep, first_conflict, stacked_altitudes
from mmrs_core.planning.team import Team
from mmrs_core.scene import Launch, Policy, Transit


def test_robots_at_neighbouring_homes_meet_nobody():
    team = (robot("r1"), robot("r2", (1.0, 0.0, 0.0)))
    whole = scene(team, {"a": visit((100.0, 0.0, 20.0))})
    assert first_conflict(whole, plan(whole), 5.0) is None


def test_an_encounter_is_told_with_time_and_distance():
    team = (robot("r1"), robot("r2", (50.0, 0.0, 0.0)))
    works = {
        "a": {"r1": visit((25.0, -100.0, 20.0), (25.0, 100.0, 20.0))},
        "b": {"r2": visit((20.0, 100.0, 20.0), (20.0, -100.0, 20.0))},
    }
    whole = scene(team, works)
    found = first_conflict(whole, plan(whole), 10.0)
    assert (found.first, found.second) == ("r1", "r2")
    assert found.distance < 10.0


def test_altitudes_are_stacked_below_the_ceiling():
    team = tuple(robot(f"r{k}") for k in range(3))
    whole = scene(team, {"a": visit((9.0, 9.0, 100.0))}, minimum_separation=15.0)
    heights = stacked_altitudes(whole)
    assert sorted(set(heights.values())) == pytest.approx([100.0, 115.101])


def test_nothing_is_stacked_where_robots_need_not_keep_apart():
    assert stacked_altitudes(scene((robot("r1"), robot("r2")), {"a": visit((9.0, 9.0, 9.0))})) == {}


def test_planned_robots_keep_the_position_error_of_both_and_a_little_more():
    whole = scene((robot("r1"),), {"a": visit((9.0, 9.0, 9.0))}, minimum_separation=4.0, position_error=1.0)
    assert distance_to_keep(whole) == pytest.approx(6.001)
    assert distance_to_keep(replace(whole, minimum_separation=None)) is None


def test_robots_at_the_planned_distance_are_refused_no_more_than_needed():
    team = (robot("r1"), robot("r2", (50.0, 0.0, 0.0)))
    works = {
        "a": {"r1": visit((100.0, 100.0, 20.0), hold=50.0)},
        "b": {"r2": visit((100.0, 106.1, 20.0), hold=50.0)},
    }
    near = scene(team, works, minimum_separation=6.0)
    assert first_conflict(near, plan(near), 6.0) is None


@pytest.mark.parametrize("seconds", [None, 0.0])
def test_robots_that_wait_for_each_other_aloft_take_turns(seconds):
    """Each one's second task is where the other one waits: only going home in between helps."""
    team = (robot("r1"), robot("r2", (30.0, 0.0, 0.0)))
    works = {
        "a": {"r1": visit((100.0, 0.0, 20.0))},
        "b": {"r2": visit((101.0, 0.0, 20.0), hold=30.0)},
        "c": {"r1": visit((102.0, 0.0, 20.0), hold=30.0)},
        "d": {"r2": visit((101.0, 0.0, 20.0))},
    }
    whole = scene(team, works, after=[("a", "b"), ("b", "c"), ("c", "d")], minimum_separation=10.0)
    found = plan(whole, effort=Effort(seconds, perf_counter))
    assert complaints(whole, found) == []
    assert first_conflict(whole, found, 10.0) is None
    assert [each.sorties for each in found.robots] == [2, 2]


def test_robots_keep_apart_also_where_charging_takes_less_time_than_planned():
    team = (with_kinematics(robot("r1"), endurance=120.0), robot("r2", (300.0, 0.0, 0.0)))
    place = (100.0, 0.0, 20.0)
    works = {
        "a": {"r1": visit(place, hold=60.0)},
        "b": {"r1": visit(place, hold=60.0)},
        "c": {"r2": visit(place, hold=200.0)},
    }
    whole = scene(team, works, after=[("a", "b"), ("a", "c")], minimum_separation=10.0)
    found = plan(whole)
    assert complaints(whole, found) == []
    assert found.robots[0].sorties == 2
    assert not Traffic(whole, found, 10.0, timing=Team(whole).timelines(hasty=True)).conflicts


def nearest(whole, found, name, place, until=inf):
    """Return how near a planned robot comes to a place on the legs that it begins by a time."""
    steps = next(each.steps for each in found.robots if each.robot == name)
    transits = [step for step in steps if isinstance(step, Transit) and step.begin <= until]
    legs = [leg for step in transits for leg in pairwise(step.route)]
    begins, ends = np.array(legs).swapaxes(0, 1)
    return float(paired_distances(begins, ends, np.array(place), np.array(place)).min())


def test_no_robot_lands_beside_one_that_has_landed():
    team = tuple(robot(f"r{k}", (-40.0, 20.0 * k, 0.0), returns=False) for k in range(2))
    works = {"a": {"r0": visit((100.0, 0.0, 20.0))}, "b": {"r1": visit((100.3, 0.0, 20.0))}}
    low = (Policy("BATTERY_LOW", "LAND"),)
    whole = scene(team, works, after=[("a", "b")], minimum_separation=3.0, policies=low)
    found = plan(whole)
    assert complaints(whole, found) == []
    assert first_conflict(whole, found, 3.0) is None
    ends = [each.steps[-1].at for each in found.robots]
    assert dist(ends[0][:2], ends[1][:2]) >= 3.0
    assert found.notes[0].startswith("r0, r1 return home unasked, so that robots on the ground keep apart")


def test_only_who_would_land_too_near_to_another_is_sent_home():
    team = tuple(robot(f"r{k}", (-40.0, 20.0 * k, 0.0), returns=False) for k in range(3))
    places = [(100.0, 0.0, 20.0), (100.3, 0.0, 20.0), (100.0, 90.0, 20.0)]
    works = {f"t{k}": {f"r{k}": visit(place)} for k, place in enumerate(places)}
    low = (Policy("BATTERY_LOW", "LAND"),)
    whole = scene(team, works, after=[("t0", "t1")], minimum_separation=3.0, policies=low)
    found = plan(whole)
    assert complaints(whole, found) == []
    ends = [each.steps[-1].at for each in found.robots]
    assert [dist(end[:2], each.home[:2]) < 1.0 for end, each in zip(ends, team, strict=True)] == [
        True,
        True,
        False,
    ]


def test_homes_that_are_too_near_are_named_where_they_are_the_cause():
    team = (robot("r1", kinematics=CRAWLER), robot("r2", (1.0, 0.0, 0.0), kinematics=CRAWLER))
    works = {"a": {"r1": visit((50.0, 0.0, 0.0))}, "b": {"r2": visit((50.0, 30.0, 0.0))}}
    whole = scene(team, works, minimum_separation=3.0)
    with pytest.raises(InfeasibleError, match=r"after 0 s \(their homes are 1\.0 m apart\)"):
        plan(whole)


def test_a_way_leads_around_a_robot_that_stands_at_home_without_work():
    team = (robot("r1"), robot("r2", (50.0, 0.0, 0.0)))
    whole = scene(team, {"a": {"r1": visit((100.0, 0.0, 3.0))}}, minimum_separation=6.0)
    found = plan(whole)
    assert complaints(whole, found) == []
    assert nearest(whole, found, "r1", team[1].home) >= 6.0


def test_a_way_keeps_away_from_a_robot_that_waits_on_the_ground():
    team = (robot("r1"), robot("r2", (50.0, 0.0, 0.0)))
    works = {"a": {"r1": visit((100.0, 0.0, 3.0))}, "b": {"r2": visit((50.0, 80.0, 20.0))}}
    whole = scene(team, works, after=[("a", "b")], minimum_separation=6.0)
    found = plan(whole)
    assert complaints(whole, found) == []
    assert first_conflict(whole, found, distance_to_keep(whole)) is None
    (launched,) = (step.end for step in found.robots[1].steps if isinstance(step, Launch))
    assert nearest(whole, found, "r1", team[1].home, until=launched - 1e-6) >= 6.0


def test_work_over_a_robot_that_stays_at_home_is_refused_with_both_robots_and_the_distance():
    team = (robot("r1"), robot("r2", (50.0, 0.0, 0.0)))
    whole = scene(team, {"a": {"r1": visit((50.0, 0.0, 4.0))}}, minimum_separation=6.0)
    with pytest.raises(InfeasibleError, match=r"'r1' and 'r2' come within .*6\.001 m are required"):
        plan(whole)


@pytest.mark.thorough
def test_taking_turns_keeps_choices_and_wanted_robots():
    team = (robot("r1"), robot("r2", (30.0, 0.0, 0.0)))
    line = road((100.0, 0.0, 20.0), (200.0, 0.0, 20.0), cuts=(25.0, 50.0, 75.0))
    works = {
        "a": {"r1": visit((100.0, 5.0, 20.0))},
        "b": {"r2": visit((101.0, 0.0, 20.0), hold=30.0)},
        "c": line,
        "e": {"r1": visit((102.0, 0.0, 20.0))},
        "f": {"r1": visit((120.0, 0.0, 20.0))},
    }
    after = [("a", "b"), ("b", "c"), ("c", "k"), ("k", "e", "windy"), ("k", "f"), ("e", "j"), ("f", "j")]
    whole = scene(
        team,
        works,
        after=after,
        controls=(control("k", "Fork"), control("j", "Join")),
        tasks={"c": task("c", wanted=2)},
        minimum_separation=60.0,
    )
    found = plan(whole)
    assert complaints(whole, found) == []
    assert first_conflict(whole, found, 60.0) is None


def test_deadlines_that_only_flying_at_once_can_keep_are_refused_with_what_is_short():
    team = (robot("r1"), robot("r2", (30.0, 0.0, 0.0)))
    works = {
        "a": {"r1": visit((100.0, 0.0, 20.0), hold=100.0)},
        "b": {"r2": visit((101.0, 0.0, 20.0), hold=100.0)},
    }
    tasks = {name: task(name, deadline=150.0) for name in works}
    whole = scene(team, works, tasks=tasks, minimum_separation=10.0)
    with pytest.raises(InfeasibleError, match=r"10\.001 m are required"):
        plan(whole)


def test_of_two_robots_that_meet_the_one_starts_later_that_is_back_sooner():
    team = (robot("a short one"), robot("the long one", (50.0, 0.0, 0.0)))
    works = {
        "near": {"a short one": visit((25.0, -100.0, 20.0), (25.0, 100.0, 20.0))},
        "far": {"the long one": visit((20.0, 100.0, 20.0), (20.0, -100.0, 20.0), (20.0, -900.0, 20.0))},
    }
    whole = scene(team, works)
    found = plan(whole)
    assert first_conflict(whole, found, 10.0) is not None
    assert set(Traffic(whole, found, 10.0).later_starts()) == {"a short one"}


@pytest.mark.parametrize(
    ("robots", "side", "seed", "share"),
    [(8, 200.0, 1, 1.01), pytest.param(50, 400.0, 2, 1.1, marks=pytest.mark.thorough)],
)
def test_robots_of_a_large_team_start_no_later_than_the_last_of_them_allows(robots, side, seed, share):
    rng = np.random.default_rng(seed)
    team = tuple(robot(f"r{k:02}", (10.0 * (k % 5), 10.0 * (k // 5), 0.0)) for k in range(robots))
    places = rng.uniform(0.0, side, (5 * robots, 2)).tolist()
    works = {f"t{k:03}": visit((*place, 20.0)) for k, place in enumerate(places)}
    free, apart = (plan(scene(team, works, minimum_separation=least)) for least in (None, 9.0))
    assert apart.makespan <= share * free.makespan
