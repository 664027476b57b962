"""Where planned moves lead, and how long they take, as targets learn it."""

from dataclasses import replace

import pytest

from mmrs_core.behaviour.program import BEHAVIOUR, Move, MoveTarget, Transition
from mmrs_core.generation.capabilities.probes import changed
from mmrs_core.generation.planned_moves import kinematics_of, planned_moves
from mmrs_core.scene.timing import NOTICING, MoveSeconds
from mmrs_core.testing.programs import sample_of, target_input
from mmrs_core.testing.small_programs import go, hold, program, robot, robot_type, use


def planned(*moves, type=None, **features):
    one = robot("r", moves, **features)
    return planned_moves(one, target_input(program(one), [type or robot_type()]))


def test_a_move_leads_from_where_the_one_before_it_ends():
    start, out, stay, back, stop = planned(
        go("out", (30.0, 0.0, 0.0)), hold("stay", 4.0), go("back", (0.0, 40.0, 0.0))
    )
    assert (start.path, stop.path) == (((0.0, 0.0, 0.0),), ((0.0, 40.0, 0.0),))
    assert out.path == ((0.0, 0.0, 0.0), (30.0, 0.0, 0.0))
    assert back.path == ((30.0, 0.0, 0.0), (0.0, 40.0, 0.0))
    assert (out.manoeuvre, stay.manoeuvre) == ("go_to", "")
    assert stay.seconds == MoveSeconds(4.0, 4.0, 4.0 + NOTICING)


def test_time_follows_from_the_speed_of_the_robot_and_from_its_actions():
    sample = sample_of("plain_robot")
    given = sample.plain
    (first,) = (each for each in planned_moves(given.program.robots[0], given) if each.manoeuvre == "go_to")
    slow = changed(given, lambda each: replace(each, moves=tuple(replace(m, speed=0.5) for m in each.moves)))
    (second,) = (each for each in planned_moves(slow.program.robots[0], slow) if each.manoeuvre == "go_to")
    assert second.seconds.shortest < 60.0 < second.seconds.expected < 65.0 < second.seconds.longest

    def acts(each):
        return replace(each, moves=tuple(replace(m, after=(use("device", "act"),)) for m in each.moves))

    acting = changed(given, acts)
    (third,) = (each for each in planned_moves(acting.program.robots[0], acting) if each.manoeuvre == "go_to")
    assert third.seconds == pytest.approx([each + 2.0 for each in first.seconds])


def test_the_moves_of_a_vehicle_are_its_manoeuvres():
    given = sample_of("multicopter").plain
    found = planned_moves(given.program.robots[0], given)
    assert [each.manoeuvre for each in found] == ["", "take_off", "go_to", "land", ""]
    assert all(each.seconds is not None for each in found)
    assert kinematics_of(given.program.robots[0], given).ceiling == 120.0


def test_the_first_leg_on_each_charge_counts_that_motors_start():
    charge = Move("charge", ((BEHAVIOUR, "Recharge"),), {"duration": 60.0})
    moves = hold("stay", 4.0), go("out", (30.0, 0.0, 0.0)), go("back", (0.0, 0.0, 0.0)), charge
    one = robot("r", (*moves, go("again", (30.0, 0.0, 0.0))))
    given = target_input(program(one), [robot_type()])
    (kind,) = (each for each in given.robot_kinds.values() if each.name == "plain_robot")

    def seconds(launch):
        known = replace(kind, kinematics=lambda *each: replace(kind.kinematics(*each), launch=launch))
        found = planned_moves(one, replace(given, robot_kinds={kind.metaclass: known}))
        return [each.seconds for each in found]

    plain, slow = seconds(0.0), seconds(2.0)
    later = [tuple(b - a for a, b in zip(*each, strict=True)) for each in zip(plain, slow, strict=True)]
    assert later == [pytest.approx((0.0, each, 3.0 * each)) for each in (0, 0, 2.0, 0, 0, 2.0, 0)]


def test_the_first_leg_that_is_commanded_after_launching_counts_that_it_begins_late():
    given = sample_of("multicopter").plain
    (kind,) = (each for each in given.robot_kinds.values() if each.name == "multicopter")

    def seconds(guiding):
        known = replace(kind, kinematics=lambda *each: replace(kind.kinematics(*each), guiding=guiding))
        found = planned_moves(given.program.robots[0], replace(given, robot_kinds={kind.metaclass: known}))
        return {each.manoeuvre: each.seconds for each in found}

    plain, late = seconds(0.0), seconds(2.0)
    assert late["go_to"].expected == pytest.approx(plain["go_to"].expected + 2.0)
    assert (late["take_off"], late["land"]) == (plain["take_off"], plain["land"])


def test_what_is_not_known_is_none():
    one = robot("r", [go("out", (30.0, 0.0, 0.0))])
    (_, out, _) = planned_moves(one, target_input(program(one), []))
    assert out.path is not None
    assert out.seconds is None
    homeless = planned(go("out", (30.0, 0.0, 0.0)), home=None)
    assert {each.path for each in homeless} == {None}
    buoy = replace(go("find", (0.0, 0.0, 0.0)), target=MoveTarget(None, "a buoy", None))
    assert [each.path is None for each in planned(buoy, hold("stay"))] == [False, True, True, True]


def test_moves_come_in_the_order_in_which_they_are_made_each_once():
    one = robot("r", [hold("a"), hold("b"), hold("c")])
    order = {0: Transition(0, 2), 2: Transition(2, 1), 1: Transition(1, 4)}
    swapped = replace(one, transitions={**one.transitions, **order})
    given = target_input(program(swapped), [robot_type()])
    assert [each.index for each in planned_moves(swapped, given)] == [0, 2, 1, 4]
    looping = replace(one, transitions={**one.transitions, 2: Transition(2, 1)})
    assert [each.index for each in planned_moves(looping, given)] == [0, 1, 2]
