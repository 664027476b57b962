"""What a rule returns is looked at before anything is made of it."""

from math import nan

import pytest

from mmrs_core.contributions.guard import guarded
from mmrs_core.contributions.rules import Rule
from mmrs_core.diagnostics import Place
from mmrs_core.errors import InfeasibleError, PluginError
from mmrs_core.scene import ActionAt, Capability, Frame, Part, Robot, RobotType, Scene, Stroke, Task, Work
from mmrs_core.transformation.expand import work_of

KIND = RobotType("t", (), (), 0.5, None, (Capability(0, None, (0, 2)),), (), {}, Part((), {}))
ROBOT = Robot("r", KIND, (0.0, 0.0, 0.0), True, 0.0, "NORMAL", 0.5)
SCENE = Scene("s", Frame("EPSG:4326", None, None), (), (), (ROBOT,))
LINE = ((0.0, 0.0, 0.0), (10.0, 0.0, 0.0))


def made_by(work):
    return work_of(Rule("inspect", ("urn:t", "T"), work), Task("t", Part((), {})), ROBOT, SCENE)


def returned(*strokes):
    return made_by(lambda task, robot, scene: Work(strokes, divisible=False, rule="inspect"))


def test_a_sound_work_is_returned_as_it_is():
    stroke = Stroke(LINE, (ActionAt(0.0, "a"), ActionAt(10.0, "b")), cuts=(5.0,), hold=1.0, speed=2.0)
    assert returned(stroke).strokes == (stroke,)


@pytest.mark.parametrize(
    ("stroke", "fault"),
    [
        (Stroke(()), "has no point"),
        (Stroke(((nan, 0.0, 0.0),)), "has a point that is not finite"),
        (Stroke(LINE, (ActionAt(1e9, "a"),)), "has an action beyond its 10 m"),
        (Stroke(LINE, (ActionAt(-5.0, "a"),)), "has an action beyond its 10 m"),
        (Stroke(LINE, (ActionAt(5.0, "a"), ActionAt(1.0, "b"))), "has actions that are not in order"),
        (Stroke(LINE, cuts=(10.0,)), "has cuts that are not in order, or not within its 10 m"),
        (Stroke(LINE, hold=-1.0), r"holds for -1.0 s"),
        (Stroke(LINE, speed=0.0), r"has a speed of 0.0 m/s"),
    ],
)
def test_an_unsound_stroke_names_the_rule_and_the_fault(stroke, fault):
    with pytest.raises(PluginError, match=f"rule 'inspect', task 't', robot 'r': stroke 0 {fault}"):
        returned(stroke)


def test_a_work_without_strokes_or_none_at_all_names_the_rule():
    with pytest.raises(PluginError, match=r"rule 'inspect'.*without strokes"):
        returned()
    with pytest.raises(PluginError, match=r"rule 'inspect'.*returns NoneType, not a Work"):
        made_by(lambda task, robot, scene: None)


def test_a_rule_that_crashes_is_named():
    with pytest.raises(PluginError, match="rule 'inspect', task 't', robot 'r': fails: ZeroDivisionError"):
        made_by(lambda task, robot, scene: 1 / 0)


def test_a_rule_of_a_plugin_that_crashes_is_named_with_the_task_and_its_place():
    rule = guarded(Rule("inspect", ("urn:t", "T"), lambda task, robot, scene: 1 / 0), "plug-in 'kites': rule")
    task = Task("t", Part((), {}, Place("m.xmi", 7, "/tasks[0]")))
    words = r"rule 'inspect', task 't' \(m.xmi:7\), robot 'r': plug-in 'kites': rule fails: ZeroDivisionError"
    with pytest.raises(PluginError, match=words):
        work_of(rule, task, ROBOT, SCENE)


def test_a_rule_that_says_a_robot_cannot_is_believed():
    def cannot(task, robot, scene):
        raise InfeasibleError("too small")

    with pytest.raises(InfeasibleError, match="too small"):
        made_by(cannot)
