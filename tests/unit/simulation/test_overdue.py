"""Deadlines are kept as the behaviour is simulated, which may take longer than planned."""

from dataclasses import replace

import pytest
from plain_scenes import robot, scene, task, visit

from mmrs_core.errors import InfeasibleError
from mmrs_core.planning.planner import plan
from mmrs_core.simulation.overdue import plan_in_time

WORKS = {"near": visit((100.0, 0.0, 20.0), hold=10.0), "far": visit((300.0, 0.0, 20.0), hold=10.0)}


def later(made):
    """Return a plan whose tasks take a tenth longer, from the mission's start on."""
    return [sooner(made, 1.1)]


def sooner(made, share):
    """Return a plan whose tasks begin and end at a share of its times."""
    begins, ends = ({name: share * at for name, at in times.items()} for times in (made.begins, made.ends))
    return replace(made, begins=begins, ends=ends)


def test_a_task_that_would_be_late_in_the_simulation_is_done_earlier():
    """By the planner's times the nearer one first keeps both deadlines; the farther one is late then."""
    tasks = {"near": task("near", deadline=120.0), "far": task("far", deadline=65.0)}
    whole, asked = scene([robot()], WORKS, tasks=tasks), []

    def planned(part):
        asked.append([each.deadline for each in part.tasks])
        return plan(part)

    made = plan_in_time(whole, planned, later)
    assert asked[0] == [120.0, 65.0]
    assert asked[1][1] < 65.0
    assert later(made)[0].ends["far"] <= 65.0
    assert later(made)[0].ends["near"] <= 120.0


def test_a_deadline_that_no_behaviour_keeps_is_refused_with_one_that_would_do():
    whole = scene([robot()], {"far": WORKS["far"]}, tasks={"far": task("far", deadline=55.0)})
    assert plan(whole).ends["far"] < 55.0
    with pytest.raises(
        InfeasibleError, match=r"as it is simulated: task 'far' ends 57 s .* a deadline of 57 s"
    ):
        plan_in_time(whole, plan, later)
    enough = scene([robot()], {"far": WORKS["far"]}, tasks={"far": task("far", deadline=57.0)})
    assert plan_in_time(enough, plan, later) == plan(enough)


def test_a_deadline_that_only_the_behaviour_keeps_is_none_to_be_refused_for():
    """By the planner's times it is missed; the behaviour takes less."""
    whole = scene([robot()], {"far": WORKS["far"]}, tasks={"far": task("far", deadline=50.0)})
    with pytest.raises(InfeasibleError):
        plan(whole)
    made = plan_in_time(whole, plan, lambda made: [sooner(made, 0.9)])
    assert sooner(made, 0.9).ends["far"] < 50.0 < made.ends["far"]
    with pytest.raises(InfeasibleError, match=r"task 'far' ends 52 s .* a deadline of 52 s would do"):
        plan_in_time(whole, plan, lambda made: [sooner(made, 0.99)])


def test_a_duration_that_the_behaviour_exceeds_is_refused():
    whole = scene([robot()], {"far": WORKS["far"]}, tasks={"far": task("far", longest=10.5)})
    with pytest.raises(
        InfeasibleError, match=r"task 'far' takes 11 s, 10\.5 s are allowed: 1 s too long; 11 s"
    ):
        plan_in_time(whole, plan, later)


def test_a_deadline_is_kept_whichever_way_choices_are_decided():
    whole = scene([robot()], {"far": WORKS["far"]}, tasks={"far": task("far", deadline=55.0)})
    with pytest.raises(InfeasibleError, match=r"task 'far' ends 57 s .* a deadline of 57 s"):
        plan_in_time(whole, plan, lambda made: [sooner(made, 0.9), sooner(made, 1.1)])


def test_a_plan_of_which_an_outcome_cannot_be_simulated_says_so():
    whole = scene([robot()], {"far": WORKS["far"]}, tasks={"far": task("far", deadline=55.0)})
    made = plan_in_time(whole, plan, lambda made: [made, "the simulated run ends with 'timeout'"])
    note = "whether all times are kept as simulated is not known: the simulated run ends with 'timeout'"
    assert made.notes == (note, *plan(whole).notes)
    tight = scene([robot()], {"far": WORKS["far"]}, tasks={"far": task("far", deadline=50.0)})
    with pytest.raises(InfeasibleError, match="a deadline of"):
        plan_in_time(tight, plan, lambda made: [sooner(made, 0.9), "the run does not end"])
