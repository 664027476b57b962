"""The oracle of plan tests must see what is wrong."""

from dataclasses import replace

import pytest
from plain_scenes import box, robot, scene, visit
from plan_replay import complaints

from mmrs_core.planning.planner import plan
from mmrs_core.scene import Await, Recover, Serve, Signal, Transit

WORKS = {"a": {"r1": visit((300.0, 0.0, 20.0))}, "b": {"r2": visit((30.0, 0.0, 20.0))}}
WHOLE = scene((robot("r1"), robot("r2", (20.0, 0.0, 0.0))), WORKS, after=[("a", "b")])


def without(found, kind):
    return replace(
        found,
        robots=tuple(
            replace(each, steps=tuple(step for step in each.steps if not isinstance(step, kind)))
            for each in found.robots
        ),
    )


def test_a_sound_plan_has_no_complaints():
    assert complaints(WHOLE, plan(WHOLE)) == []


@pytest.mark.parametrize(
    ("kind", "words"),
    [(Signal, "waits for ever"), (Serve, "is not done"), (Transit, "begins at"), (Recover, "never lands")],
)
def test_a_missing_step_is_seen(kind, words):
    assert any(words in fault for fault in complaints(WHOLE, without(plan(WHOLE), kind)))


def test_a_task_that_begins_too_early_is_seen():
    found = plan(WHOLE)
    early = replace(found, begins={**found.begins, "b": 0.0})
    assert any("begins before" in fault for fault in complaints(WHOLE, early))


def test_a_leg_too_near_is_seen():
    near = replace(WHOLE, areas=(box("wall", 100, -10, 110, 10),))
    assert any("from wall" in fault for fault in complaints(near, plan(WHOLE)))


def test_too_long_a_sortie_is_seen():
    short = replace(
        WHOLE,
        robots=tuple(
            replace(each, kinematics=replace(each.kinematics, endurance=50.0)) for each in WHOLE.robots
        ),
    )
    assert any("on one charge of 50.0 s" in fault for fault in complaints(short, plan(WHOLE)))


def test_a_wait_that_ends_before_its_signal_is_seen():
    found = plan(WHOLE)
    hasty = replace(
        found,
        robots=tuple(
            replace(
                each,
                steps=tuple(
                    replace(step, end=step.begin) if isinstance(step, Await) else step for step in each.steps
                ),
            )
            for each in found.robots
        ),
    )
    assert any("goes on before" in fault for fault in complaints(WHOLE, hasty))
