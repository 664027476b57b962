"""Plans become behaviours: who waits for whom, what is done where, what is traced."""

from dataclasses import replace

import pytest

from mmrs_core.contributions.rules import MoveSpec, Rule
from mmrs_core.errors import InfeasibleError
from mmrs_core.languages import behaviour as bl
from mmrs_core.languages.classes import ElementClass
from mmrs_core.languages.element import metaclass_of
from mmrs_core.languages.registry import core_registry, registry_with
from mmrs_core.scene import (
    ActionAt,
    Area,
    AreaUse,
    Await,
    Branch,
    Capability,
    Device,
    DeviceAction,
    Frame,
    Kinematics,
    Launch,
    Look,
    Part,
    Plan,
    Recharge,
    Recover,
    Robot,
    RobotPlan,
    RobotType,
    Scene,
    Serve,
    Signal,
    Stroke,
    Task,
    Transit,
)
from mmrs_core.transformation.engine import transform
from mmrs_core.transformation.kinds import PLAIN_ROBOT, ROBOT
from mmrs_runtime.timing import LegTiming

HOME = (0.0, 0.0, 0.0)
CAMERA = Device("camera", {"Photo": DeviceAction("Photo", 1.0)}, {})
HOPPER = replace(
    PLAIN_ROBOT,
    name="hopper",
    launch=lambda height: (MoveSpec(("urn:mmrs:behaviour:1.0", "GoTo"), target=(0.0, 0.0, height)),),
)


def robot(name="one", home=HOME, **features):
    kind = RobotType("walker", (ROBOT,), (), 0.5, None, (Capability(0, None, (0, 2)),), (), {}, Part((), {}))
    kinematics = Kinematics(cruise=1.5, slowest=0, fastest=2, climb=1, descent=1, timing=LegTiming(1.0))
    made = Robot(
        name,
        replace(kind, devices={"camera": CAMERA}),
        home,
        True,
        0.0,
        "NORMAL",
        0.5,
        "plain_robot",
        kinematics,
    )
    return replace(made, **features)


def behaviour_of(
    *plans, robots=None, areas=(), frame=None, rules=(), kinds=(PLAIN_ROBOT,), registry=None, timed=False
):
    robots = robots or tuple(robot(plan.robot) for plan in plans)
    frame = frame or Frame("EPSG:4326", None, None)
    tasks = (Task("t", Part((), {}), longest=7.0),)
    scene = Scene("test", frame, tasks, (), tuple(robots), areas=tuple(areas))
    model, trace = transform(
        scene,
        Plan(tuple(plans), 0.0, {}, {}, timed=timed),
        rules={rule.metaclass: rule for rule in rules},
        robot_kinds={(kind.name, ""): kind for kind in kinds},
        registry=registry or core_registry(),
    )
    return model, trace


def plan_of(*steps, name="one"):
    return RobotPlan(name, steps)


def transit(*route, task="t"):
    return Transit(0, 0, task, route)


def serve(*points, last=True, speed=1.5, rule="rule", **features):
    return Serve(0, 0, "t", Stroke(points, **features), speed, rule, first=True, last=last)


def kinds_of(moves):
    return [type(move).__name__ for move in moves]


def next_of(robot, move):
    (transition,) = [each for each in robot.moveTransitions if each.from_ is move]
    return transition


def test_every_robot_starts_and_stops_once():
    model, _ = behaviour_of(plan_of(transit(HOME, (10.0, 0.0, 0.0))))
    assert kinds_of(model.robots[0].moves) == ["Start", "GoTo", "Stop"]


@pytest.mark.parametrize(("fastest", "speed"), [(2.0, None), (1.5, 1.5)])
def test_a_cruise_that_the_wind_slows_down_is_commanded(fastest, speed):
    made = robot()
    slowed = replace(made.kinematics, fastest=fastest, own_speed=2.0)
    steps = transit(HOME, (10.0, 0.0, 0.0))
    model, _ = behaviour_of(plan_of(steps), robots=[replace(made, kinematics=slowed)])
    assert model.robots[0].moves[1].speed == speed


def test_what_plug_ins_subclass_is_made_of_their_subclasses():
    kinds = [type("Mine", (each,), {}) for each in (bl.Behaviour, bl.Target, bl.Move, bl.MoveTransition)]
    registry = registry_with((), classes=map(ElementClass, kinds))
    model, _ = behaviour_of(plan_of(transit(HOME, (10.0, 0.0, 0.0))), registry=registry)
    (robot,) = model.robots
    for kind, made in zip(kinds, ([model], model.targets, robot.moves, robot.moveTransitions), strict=True):
        assert [isinstance(each, kind) for each in made] == [True] * len(made) != []


def test_robots_without_work_are_idle():
    model, _ = behaviour_of(plan_of(transit(HOME, (1.0, 0.0, 0.0))), plan_of(name="idle"))
    assert [each.id for each in model.robots] == ["one"]
    (idle,) = model.idleRobots
    assert (idle.id, [metaclass_of(move).name for move in idle.moves]) == ("idle", ["Start", "Stop"])


def test_actions_come_where_they_are_due_along_a_stroke():
    actions = tuple(ActionAt(at, "Photo", "camera") for at in (0.0, 4.0, 10.0))
    model, _ = behaviour_of(plan_of(serve(HOME, (10.0, 0.0, 0.0), actions=actions)))
    _, first, second, _ = model.robots[0].moves
    assert [(first.target.x, len(first.preActions)), (second.target.x, len(second.preActions))] == [
        (4, 1),
        (10, 0),
    ]
    assert [type(each).__name__ for each in second.postActions] == ["DeviceAction", "Feedback"]


def test_an_action_without_a_device_takes_the_only_one_that_can():
    model, _ = behaviour_of(plan_of(serve(HOME, (1.0, 0.0, 0.0), actions=(ActionAt(1.0, "Photo"),))))
    assert model.robots[0].moves[1].postActions[0].deviceId == "camera"


def test_an_action_that_no_device_can_do_is_refused_by_name():
    with pytest.raises(InfeasibleError, match="robot 'one': no device supports action 'Dig'"):
        behaviour_of(plan_of(serve(HOME, (1.0, 0.0, 0.0), actions=(ActionAt(1.0, "Dig"),))))


def test_a_hold_with_a_look_turns_first_and_acts_afterwards():
    stroke = serve(
        (5.0, 0.0, 0.0), hold=20.0, look=Look((9.0, 0.0, 0.0), "camera"), actions=(ActionAt(0, "Photo"),)
    )
    model, _ = behaviour_of(plan_of(transit(HOME, (5.0, 0.0, 0.0)), stroke))
    moves = model.robots[0].moves
    assert kinds_of(moves) == ["Start", "GoTo", "HeadTo", "HoldPosition", "Stop"]
    assert moves[2].heading.deviceId == "camera"
    assert (moves[3].duration, moves[3].postActions[0].actionName) == (20.0, "Photo")


def test_an_object_is_approached_from_where_it_is_expected():
    stroke = serve((5.0, 0.0, 0.0), object="buoy", object_distance=2.0, object_tolerance=1.0)
    model, _ = behaviour_of(plan_of(stroke))
    approach = model.robots[0].moves[1]
    assert (approach.target.description, approach.distance, approach.target.tolerance) == ("buoy", 2.0, 1.0)
    assert approach.target.expectedAt.x == 5.0


def test_speed_is_said_only_where_it_differs_from_the_travel_mode():
    model, _ = behaviour_of(
        plan_of(serve(HOME, (1.0, 0.0, 0.0), last=False), serve((1.0, 0.0, 0.0), HOME, speed=0.5))
    )
    assert [move.speed for move in model.robots[0].moves[1:3]] == [None, 0.5]


def test_a_signal_becomes_a_fresh_slot_and_a_notify_that_the_receiver_waits_for():
    model, _ = behaviour_of(
        plan_of(serve(HOME, (1.0, 0.0, 0.0)), Signal(0, 0, "t", "one has ended t", ("two",))),
        plan_of(Await(0, 0, "u", ("one has ended t",)), transit(HOME, (3.0, 0.0, 0.0)), name="two"),
    )
    one, two = model.robots
    assert [slot.name for slot in two.slots] == ["one has ended t"]
    notify = one.moves[1].postActions[-1]
    assert isinstance(notify, bl.UnicastNotify)
    assert notify.slot is two.slots[0]
    assert list(next_of(two, two.moves[0]).waitFor) == list(two.slots)


@pytest.mark.parametrize(
    ("receivers", "kind"),
    [
        (("two",), bl.UnicastNotify),
        (("two", "three"), bl.MulticastNotify),
        (("two", "three", "four"), bl.BroadcastNotify),
    ],
)
def test_the_notify_is_the_narrowest_that_reaches_all_receivers(receivers, kind):
    waiting = [
        plan_of(Await(0, 0, "u", ("s",)) if name in receivers else Await(0, 0, "", ()), name=name)
        for name in ("two", "three", "four")
    ]
    model, _ = behaviour_of(plan_of(Signal(0, 0, "t", "s", receivers)), *waiting)
    assert isinstance(model.robots[0].moves[0].postActions[0], kind)


def test_a_signal_after_a_wait_is_given_only_when_the_wait_is_over():
    model, _ = behaviour_of(
        plan_of(Await(0, 0, "t", ("s",)), Signal(0, 0, "t", "r", ("two",))),
        plan_of(Signal(0, 0, "t", "s", ("one",)), Await(0, 0, "t", ("r",)), name="two"),
    )
    one = model.robots[0]
    assert kinds_of(one.moves) == ["Start", "HoldPosition", "Stop"]
    assert len(next_of(one, one.moves[0]).waitFor) == 1
    assert len(one.moves[1].postActions) == 1
    assert not one.moves[0].postActions


def test_waiting_for_a_time_is_a_hold():
    model, _ = behaviour_of(plan_of(Await(10.0, 25.0, "t", (), until=25.0)))
    assert model.robots[0].moves[1].duration == 15.0


def test_a_branch_becomes_a_choice_whose_arms_meet_again():
    here, left, right = HOME, (5.0, 0.0, 0.0), (0.0, 5.0, 0.0)
    arms = (("found", (transit(here, left), transit(left, right))), (None, (transit(here, right),)))
    model, _ = behaviour_of(plan_of(Branch(0, 0, "t", arms, right), transit(right, here)))
    only = model.robots[0]
    choice = next_of(only, only.moves[0])
    assert isinstance(choice, bl.Choice)
    assert (choice.conditionIdentifier, choice.to.target.x, choice.falseBranch.target.y) == (
        "found",
        5.0,
        5.0,
    )
    home = only.moves[-2]
    assert len([each for each in only.moveTransitions if each.to is home]) == 2


def test_three_arms_are_two_choices_one_after_the_other():
    arms = (("a", ()), ("b", ()), (None, ()))
    model, _ = behaviour_of(plan_of(Branch(0, 0, "t", arms, HOME)))
    choices = [each for each in model.robots[0].moveTransitions if isinstance(each, bl.Choice)]
    assert [each.conditionIdentifier for each in choices] == ["a", "b"]
    assert choices[0].falseBranch is choices[1].from_


def test_launch_recover_and_recharge_are_the_kinds_own():
    model, _ = behaviour_of(
        plan_of(
            Launch(0, 0, "t", HOME, 20.0), Recover(0, 0, "", (0.0, 0.0, 20.0), 0.0), Recharge(0, 60.0, "")
        ),
        robots=[robot(kind="hopper")],
        kinds=(HOPPER,),
    )
    moves = model.robots[0].moves
    assert kinds_of(moves) == ["Start", "GoTo", "Recharge", "Stop"]
    assert (moves[1].target.z, moves[2].duration) == (20.0, 60.0)


def test_a_rule_may_make_its_moves_itself():
    dance = Rule(
        "dance",
        ("urn:t", "Dance"),
        None,
        lambda stroke, task, robot, scene: (
            MoveSpec(
                ("urn:mmrs:behaviour:1.0", "HoldPosition"),
                {"duration": task.longest},
                after=(ActionAt(0, "Photo"),),
            ),
        ),
    )
    model, _ = behaviour_of(plan_of(serve(HOME, rule="dance")), rules=[dance])
    move = model.robots[0].moves[1]
    assert (move.duration, move.rule, move.postActions[0].actionName) == (7.0, "dance", "Photo")


def test_every_move_is_traced_to_its_task_and_rule():
    model, trace = behaviour_of(
        plan_of(transit(HOME, (1.0, 0.0, 0.0)), serve((1.0, 0.0, 0.0), (2.0, 0.0, 0.0)))
    )
    assert [(link.move, link.rule) for link in trace.links if link.task == "t"] == [
        ("goto_001", "transit"),
        ("goto_002", "rule"),
    ]
    assert len(trace.links) == len(model.robots[0].moves)


def test_every_move_is_traced_to_the_step_that_it_carries_out():
    arms = (("found", (transit(HOME, (1.0, 0.0, 0.0)), serve((1.0, 0.0, 0.0)))), (None, ()))
    _, trace = behaviour_of(plan_of(transit(HOME, HOME), Branch(0, 0, "t", arms, HOME), serve(HOME, HOME)))
    steps = {("one", 0): ["goto_001"], ("one", 2): ["goto_002"], ("one", 3): ["holdposition_003"]}
    assert trace.moves() == {**steps, ("one", 4): ["holdposition_005"]}


def test_one_position_makes_one_target():
    model, _ = behaviour_of(plan_of(transit(HOME, (1.0, 0.0, 0.0), HOME, (1.0, 0.0, 0.0))))
    assert len(model.targets) == 2


def test_a_way_without_work_is_fluid_away_from_areas_and_stops_near_them():
    corner = transit(HOME, (10.0, 0.0, 0.0), (10.0, 10.0, 0.0))
    near = Area("pit", AreaUse.FORBIDDEN, ((10.6, -1.0), (12.0, -1.0), (12.0, 1.0), (10.6, 1.0)))
    free, _ = behaviour_of(plan_of(corner))
    tight, _ = behaviour_of(plan_of(corner), areas=[near])
    stopping, _ = behaviour_of(plan_of(corner), timed=True)
    flows = [next_of(each.robots[0], each.robots[0].moves[1]).fluid for each in (free, tight, stopping)]
    assert flows == [True, False, False]


def test_altitudes_keep_the_reference_in_which_the_origin_has_one():
    plan = plan_of(transit(HOME, (0.0, 100.0, 30.0)))
    known, _ = behaviour_of(plan, frame=Frame("EPSG:4326", 42.0, 13.0, 700.0, "MSL"))
    unknown, _ = behaviour_of(plan, frame=Frame("EPSG:4326", 42.0, 13.0, None, "ELLIPSOID"))
    assert (known.altitudeReference, known.robots[0].moves[1].target.altitude) == ("MSL", 730.0)
    assert (unknown.altitudeReference, unknown.robots[0].moves[1].target.altitude) == ("ORIGIN", 30.0)


def test_a_robot_that_is_not_to_come_home_lands_when_its_batteries_are_low():
    plan = plan_of(transit(HOME, (1.0, 0.0, 0.0)))
    away, _ = behaviour_of(plan, robots=[robot(return_home=False)])
    back, _ = behaviour_of(plan, robots=[robot()])
    assert [(each.event, each.response) for each in away.robots[0].policies] == [("BATTERY_LOW", "LAND")]
    assert list(back.robots[0].policies) == []
