"""Steps of a plan take their times from the moves that carry them out."""

from types import SimpleNamespace

import pytest

from mmrs_core.scene import Await, Branch, Plan, Recharge, RobotPlan, Serve, Stroke, Transit, all_steps
from mmrs_core.simulation.plan_times import as_simulated
from mmrs_core.transformation.engine import Trace, TraceLink
from mmrs_runtime.records.steps import StepRecord

HERE, THERE = (0.0, 0.0, 0.0), (10.0, 0.0, 0.0)


def go(begin, end, task="look"):
    return Transit(begin, end, task, (HERE, THERE))


def serve(begin, end, task="look"):
    return Serve(begin, end, task, Stroke((THERE,)), 5.0, "observe", True, True)


def timed(steps, own, *made):
    """Return the plan of a robot by the times of its run.

    Args:
        steps: of the plan.
        own: for each step, also those in arms, the moves that carry it out.
        made: (label, move, time) of each record.
    """
    links = [
        TraceLink("a", move, "", "", number) for number, moves in enumerate(own) for move in moves.split()
    ]
    records = [StepRecord("r", "a", i, i, time, label, move) for i, (label, move, time) in enumerate(made)]
    run = SimpleNamespace(records=records, ending=SimpleNamespace(time=records[-1].time))
    robot = RobotPlan("a", tuple(steps), busy=100.0, energy=50.0)
    plan = Plan((robot,), 100.0, {"look": 0.0}, {"look": 9.0}, lower_bound=99.5)
    return as_simulated(plan, run, Trace(tuple(links)), ())


def spans(plan):
    return [(step.begin, step.end) for step in all_steps(plan.robots[0].steps)]


def test_a_step_lasts_from_where_the_move_before_was_left_to_the_end_of_its_last_action():
    plan = timed(
        [go(0.0, 10.0), serve(10.0, 40.0)],
        ["m1", "m2 m3"],
        *[("end", "m1", 12.0), ("take", "m1", 12.0), ("act", "m2", 16.0), ("begin", "m2", 16.0)],
        *[("end", "m2", 20.0), ("take", "m2", 20.0), ("end", "m3", 25.0), ("act", "m3", 30.0)],
        ("take", "m3", 44.0),
    )
    assert spans(plan) == [(0.0, 12.0), (12.0, 30.0)]
    assert (plan.begins, plan.ends, plan.makespan) == ({"look": 12.0}, {"look": 30.0}, 44.0)
    assert (plan.robots[0].busy, plan.robots[0].energy) == (30.0, 15.0)


def test_what_is_waited_for_ends_when_the_robot_goes_on():
    plan = timed(
        [go(0.0, 10.0), Await(10.0, 20.0, "look", ("go",)), serve(20.0, 40.0)],
        ["m1", "", "m2"],
        *[("end", "m1", 12.0), ("take", "m1", 35.0), ("end", "m2", 50.0)],
    )
    assert spans(plan) == [(0.0, 12.0), (12.0, 35.0), (35.0, 50.0)]


def test_an_earliest_time_is_that_of_its_stay():
    plan = timed([Await(0.0, 60.0, "look", (), 60.0), go(60.0, 70.0)], ["m1", "m2"],
                 ("end", "m1", 61.0), ("take", "m1", 61.0), ("end", "m2", 70.0))  # fmt: skip
    assert spans(plan) == [(0.0, 61.0), (61.0, 70.0)]
    assert plan.robots[0].steps[0].until == 60.0


@pytest.mark.parametrize("taken", ["m2", "m3"])
def test_a_choice_ends_with_the_arm_that_was_taken_and_the_other_lasts_as_planned(taken):
    arms = (("windy", (serve(10.0, 13.0, "dip"),)), (None, (serve(10.0, 45.0),)))
    plan = timed(
        [go(0.0, 10.0), Branch(10.0, 45.0, "fork", arms, THERE), go(45.0, 60.0, "")],
        ["m1", "", "m2", "m3", "m4"],
        *[("end", "m1", 12.0), ("choose", "m1", 12.0), ("end", taken, 30.0), ("take", taken, 30.0)],
        ("end", "m4", 40.0),
    )
    dip, look = ((12.0, 30.0), (12.0, 47.0)) if taken == "m2" else ((12.0, 15.0), (12.0, 30.0))
    assert spans(plan) == [(0.0, 12.0), (12.0, 30.0), dip, look, (30.0, 40.0)]


def test_the_last_step_ends_when_the_robot_has_stopped():
    plan = timed([go(0.0, 10.0)], ["m1"], ("end", "m1", 12.0), ("take", "m1", 12.0), ("end", "stop", 12.5))
    assert (spans(plan), plan.makespan) == ([(0.0, 12.5)], 12.5)


@pytest.mark.parametrize(
    ("simulated", "least", "planned"), [(99.8, 99.5, 0.0), (99.2, 99.2, 0.0), (80.0, 99.5, 100.0)]
)
def test_the_lower_bound_stays_with_the_makespan_that_it_is_a_bound_of(simulated, least, planned):
    plan = timed([go(0.0, 10.0)], ["m1"], ("end", "m1", simulated))
    assert (plan.makespan, plan.lower_bound, plan.planned) == (simulated, least, planned)


def test_time_at_home_is_not_away():
    plan = timed(
        [go(0.0, 10.0), Recharge(10.0, 60.0, ""), Await(60.0, 60.0, "", ("go",)), go(60.0, 70.0)],
        ["m1", "m2", "", "m3"],
        *[("end", "m1", 12.0), ("take", "m1", 12.0), ("end", "m2", 62.0), ("take", "m2", 90.0)],
        ("end", "m3", 100.0),
    )
    assert plan.robots[0].busy == 22.0
