from dataclasses import replace
from math import inf

import pytest
from plain_scenes import road, robot, scene, task, visit, with_kinematics

from mmrs_core.planning.explaining import explain
from mmrs_core.planning.planner import plan
from mmrs_core.scene import Corridor

TWO = (robot("r1"), robot("r2", (60.0, 0.0, 0.0)))
CUTS = tuple(range(50, 1000, 50))


def explained(whole):
    found = plan(whole)
    return found, explain(whole, found)


def of(explanation, name):
    return next(each for each in explanation.tasks if each.task == name)


def test_an_alternative_costs_what_a_plan_with_that_robot_does():
    works = {"west": visit((-300.0, 0.0, 20.0)), "east": visit((400.0, 0.0, 20.0))}
    whole = scene(TWO, works)
    found, explanation = explained(whole)
    (other,) = of(explanation, "west").alternatives
    alone = scene(TWO, {**works, "west": {"r2": works["west"]}, "east": {"r2": works["east"]}})
    assert of(explanation, "west").robots == ("r1",)
    assert other.robots == ("r2",)
    assert found.makespan + other.later == pytest.approx(plan(alone).makespan)


def test_sharers_are_left_out_and_added():
    line = road((0.0, 50.0, 20.0), (1000.0, 50.0, 20.0), cuts=CUTS)
    found, explanation = explained(scene((TWO[0], robot("r2", (1000.0, 0.0, 0.0))), {"a": line}))
    alone = plan(scene(TWO[:1], {"a": line}))
    without = next(each for each in of(explanation, "a").alternatives if each.robots == ("r1",))
    assert found.makespan + without.later == pytest.approx(alone.makespan)


def test_separation_costs_what_the_best_plan_without_it_saves():
    """One robot does both tasks, which are 5 m apart, with 30 m to keep; without, each does one."""
    team = (robot("r1"), robot("r2", (40.0, 0.0, 0.0)))
    places = {"a": (20.0, 100.0, 20.0), "b": (25.0, 100.0, 20.0)}
    apart = scene(team, {name: visit(at, hold=30.0) for name, at in places.items()}, minimum_separation=30.0)
    found, explanation = explained(apart)
    free = plan(replace(apart, minimum_separation=None))
    (limit,) = (each for each in explanation.limits if each.name == "separation")
    assert limit.cost == pytest.approx(found.makespan - free.makespan)
    assert limit.cost > 30.0


def test_a_limit_costs_what_robots_wait_for_each_other_because_of_it():
    """Robots that share a corridor go through it one after the other."""
    corridor = Corridor("gate", ((20.0, 30.0), (20.0, 130.0)), 10.0)
    works = {"a": visit((20.0, 300.0, 20.0), hold=60.0), "b": visit((60.0, 300.0, 20.0), hold=60.0)}
    whole = scene((robot("r1"), robot("r2", (40.0, 0.0, 0.0))), works, minimum_separation=10.0)
    shut = replace(whole, corridors=(corridor,))
    found, explanation = explained(shut)
    costs = {each.name: each.cost for each in explanation.limits}
    assert costs["corridors"] == pytest.approx(found.makespan - plan(whole).makespan)
    near = replace(shut, minimum_separation=None), replace(whole, minimum_separation=None)
    assert costs["corridors"] > plan(near[0]).makespan - plan(near[1]).makespan + 1.0
    assert not explanation.lifted_near


def test_an_alternative_that_no_charge_suffices_for_has_a_fault():
    weak = with_kinematics(TWO[1], endurance=60.0)
    _, explanation = explained(scene((TWO[0], weak), {"a": visit((-300.0, 0.0, 20.0))}))
    (other,) = of(explanation, "a").alternatives
    assert other.later == inf
    assert "one charge allows 60 s" in other.fault


def test_an_alternative_that_misses_a_deadline_has_a_fault():
    whole = scene(TWO, {"a": visit((-300.0, 0.0, 20.0))}, tasks={"a": task("a", deadline=45.0)})
    _, explanation = explained(whole)
    assert "its deadline is 45 s" in of(explanation, "a").alternatives[0].fault
    assert [each.name for each in explanation.limits] == ["deadlines", "charge"]


def test_the_chain_goes_over_to_the_robot_that_is_waited_for():
    works = {"a": {"r1": visit((300.0, 0.0, 20.0))}, "b": {"r2": visit((60.0, 300.0, 20.0))}}
    found, explanation = explained(scene(TWO, works, after=[("a", "b")]))
    assert [(each.robot, each.task) for each in explanation.chain] == [("r1", "a"), ("r2", "b"), ("r2", "")]
    assert explanation.chain[0].begin == 0.0
    assert sum(seconds for each in explanation.chain for _, seconds in each.spent) == pytest.approx(
        found.makespan
    )
    dependencies, _ = explanation.limits
    free = plan(scene(TWO, works)).makespan
    assert dependencies.cost == pytest.approx(found.makespan - free)
    assert dependencies.margin == "'r2' waits for 'a' of 'r1'"


def test_what_charging_and_a_clock_cost_is_measured():
    works = {
        name: road((0.0, y, 20.0), (1000.0, y, 20.0), cuts=CUTS) for name, y in (("a", 50.0), ("b", 70.0))
    }
    tasks = {name: task(name, earliest=100.0) for name in works}
    whole = scene([with_kinematics(TWO[0], endurance=240.0)], works, tasks=tasks)
    found, explanation = explained(whole)
    costs = {each.name: each.cost for each in explanation.limits}
    plenty = replace(whole, robots=(TWO[0],))
    early = scene(whole.robots, works)
    assert costs["charge"] == pytest.approx(found.makespan - plan(plenty).makespan) != 0.0
    assert costs["earliest times"] == pytest.approx(found.makespan - plan(early).makespan) != 0.0


def test_a_robot_without_work_has_the_cost_of_giving_it_some():
    works = {"a": visit((-300.0, 0.0, 20.0)), "b": {"r1": visit((-310.0, 0.0, 20.0))}}
    found, explanation = explained(scene(TWO, works, after=[("a", "b")]))
    assert found.robots[1].idle
    name, best = explanation.idle["r2"]
    assert (name, best.robots) == ("a", ("r2",))
    assert best.later > 0.0
    assert of(explanation, "b").unable == {"r2": "has no work for it"}
