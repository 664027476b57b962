"""A robot that would have to wait in the air sets out later."""

from itertools import count

import pytest
from plain_scenes import robot, scene, task, visit, with_kinematics
from sound_plans import sound

from mmrs_core.planning.departures import waiting_at_home
from mmrs_core.planning.effort import Effort
from mmrs_core.planning.planner import plan
from mmrs_core.scene import Await, Launch, Recharge

WORKS = {"a": visit((0.0, 60.0, 20.0), hold=20.0), "b": visit((40.0, 60.0, 20.0), hold=20.0)}
SHORT = with_kinematics(robot(), endurance=150.0, recharge=None)


def waits_in_the_air(found, name):
    """Return the seconds that a robot waits between a launch and the next charging."""
    steps = (step for each in found.robots if each.robot == name for step in each.steps)
    aloft, seconds = False, 0.0
    for step in steps:
        aloft = isinstance(step, Launch) or (aloft and not isinstance(step, Recharge))
        seconds += step.end - step.begin if aloft and isinstance(step, Await) else 0.0
    return seconds


@pytest.mark.parametrize("deadline", [None, 405.0])
@pytest.mark.parametrize("recharge", [None, 300.0])
def test_a_sortie_whose_second_task_has_a_time_begins_later(recharge, deadline):
    """It cannot stay in the air until then; with charging it would land and wait for 300 s."""
    team = [with_kinematics(robot(), endurance=150.0, recharge=recharge)]
    tasks = {"a": task("a", deadline=deadline), "b": task("b", earliest=400.0)}
    found = sound(scene(team, WORKS, after=[("a", "b")], tasks=tasks))
    assert waits_in_the_air(found, "r1") < 1.0
    assert found.begins["b"] == pytest.approx(400.0, abs=1.0)
    assert found.ends["a"] <= (deadline or 405.0)
    assert 0.0 < found.lower_bound <= found.makespan < 443.0


def test_a_sortie_whose_second_task_waits_for_another_robot_begins_later():
    slow = robot("r2", (100.0, 0.0, 0.0))
    works = {
        "a": {"r1": WORKS["a"]},
        "b": {"r1": WORKS["b"]},
        "long": {"r2": visit((100.0, 60.0, 20.0), hold=300.0)},
    }
    found = sound(scene([SHORT, slow], works, after=[("a", "b"), ("long", "b")]))
    assert waits_in_the_air(found, "r1") < 1.0
    assert found.begins["b"] == pytest.approx(found.ends["long"], abs=1.0)


def test_nothing_is_put_off_in_a_plan_without_waits():
    whole = scene([robot()], WORKS, after=[("a", "b")])
    assert list(waiting_at_home(whole, plan(whole), plan)) == []


def test_later_departures_are_sought_in_the_time_that_is_left():
    tasks = {"a": task("a"), "b": task("b", earliest=400.0)}
    whole = scene([with_kinematics(robot(), endurance=150.0, recharge=300.0)], WORKS, tasks=tasks)
    ticks = count()
    found = plan(whole, effort=Effort(300.0, lambda: float(next(ticks))))
    assert next(ticks) < 360.0
    assert waits_in_the_air(found, "r1") < 1.0


def test_a_search_that_is_stopped_seeks_no_later_departures():
    tasks = {"a": task("a"), "b": task("b", earliest=400.0)}
    whole = scene([with_kinematics(robot(), endurance=150.0, recharge=300.0)], WORKS, tasks=tasks)
    effort = Effort(3600.0, show=lambda best, least: effort.stop())
    assert plan(whole, effort=effort).earliest == {}
    assert effort.stopped


def test_a_departure_without_which_there_is_no_plan_is_sought_though_time_is_over():
    tasks = {"a": task("a"), "b": task("b", earliest=400.0)}
    whole = scene([SHORT], WORKS, after=[("a", "b")], tasks=tasks)
    ticks = count()
    found = plan(whole, effort=Effort(0.0, lambda: float(next(ticks))))
    assert found.begins["b"] == pytest.approx(400.0, abs=1.0)
