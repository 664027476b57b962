from dataclasses import replace

import pytest
from plain_scenes import DRONE, TYPE, photo, robot

from mmrs_core.planning.strokes import (
    between,
    can_turn,
    commanded_speed,
    joined,
    length_of,
    missing_action,
    parts_of,
    serve_seconds,
    turned,
    uncertain_seconds,
)
from mmrs_core.scene import ActionAt, Device, DeviceAction, Look, Repetition, Stroke

BENT = Stroke(
    ((0.0, 0.0, 10.0), (100.0, 0.0, 10.0), (100.0, 50.0, 10.0)),
    actions=(photo(10.0), photo(100.0), photo(140.0)),
    cuts=(40.0, 100.0),
    hold=7.0,
    reversible=True,
)


def test_speed_is_the_cruise_unless_the_stroke_says_otherwise():
    assert commanded_speed(BENT, DRONE) == 10.0
    assert commanded_speed(replace(BENT, slow_down=0.5), DRONE) == 5.0
    assert commanded_speed(replace(BENT, speed=4.0), DRONE) == 4.0
    assert commanded_speed(replace(BENT, speed=float("inf")), DRONE) == 15.0


def test_time_is_movement_actions_and_hold():
    assert serve_seconds(BENT, robot(), DRONE) == pytest.approx(15.0 + 3.0 + 7.0)


def test_a_steep_leg_takes_as_long_as_its_climb():
    steep = Stroke(((0.0, 0.0, 10.0), (10.0, 0.0, 40.0)))
    assert serve_seconds(steep, robot(), DRONE) == pytest.approx(10.0)
    assert serve_seconds(turned(steep), robot(), DRONE) == pytest.approx(15.0)


def test_turning_on_the_spot_is_uncertain_by_half_a_circle():
    looking = Stroke(((0.0, 0.0, 10.0),), look=Look((1.0, 1.0, 0.0)))
    assert uncertain_seconds(looking, DRONE) == pytest.approx(2.0)


def test_an_object_is_uncertain_by_the_way_there_and_back():
    stroke = Stroke(((0.0, 0.0, 10.0),), object="buoy", object_tolerance=5.0)
    assert uncertain_seconds(stroke, DRONE) == pytest.approx(1.0)


def test_parts_keep_length_actions_and_hold():
    parts = parts_of(BENT)
    assert [length_of(part.points) for part in parts] == pytest.approx([40.0, 60.0, 50.0])
    assert [[action.at for action in part.actions] for part in parts] == [[10.0], [], [0.0, 40.0]]
    assert [part.hold for part in parts] == [0.0, 0.0, 7.0]


def test_parts_put_together_are_the_whole_again():
    (whole,) = joined(parts_of(BENT))
    assert whole.points == BENT.points
    assert whole.actions == BENT.actions
    assert whole.hold == BENT.hold
    assert whole.cuts == BENT.cuts


def test_strokes_that_do_not_follow_each_other_stay_apart():
    one, _, three = parts_of(BENT)
    assert joined((one, three)) == (one, three)


def test_a_part_in_the_middle_of_legs_begins_and_ends_there():
    part = between(BENT, 90.0, 120.0)
    assert part.points == ((90.0, 0.0, 10.0), (100.0, 0.0, 10.0), (100.0, 20.0, 10.0))


def test_a_turned_stroke_does_the_same_backwards():
    back = turned(BENT)
    assert back.points == BENT.points[::-1]
    assert [action.at for action in back.actions] == [10.0, 50.0, 140.0]
    assert back.cuts == (50.0, 110.0)
    assert turned(back) == BENT


def test_a_stroke_with_a_hold_or_an_object_cannot_be_turned():
    assert not can_turn(BENT)
    assert can_turn(replace(BENT, hold=0.0))
    assert not can_turn(replace(BENT, hold=0.0, object="buoy"))


def test_what_is_missing_for_an_action_is_told():
    two = replace(
        TYPE, devices={**TYPE.devices, "other": Device("other", {"photo": DeviceAction("photo", 1.0)}, {})}
    )
    assert missing_action(TYPE, ActionAt(0.0, "photo")) is None
    assert missing_action(TYPE, ActionAt(0.0, "photo", "camera")) is None
    assert missing_action(TYPE, ActionAt(0.0, "photo", "lidar")) == "has no device 'lidar'"
    assert "does not support" in missing_action(TYPE, ActionAt(0.0, "scan", "camera"))
    assert "camera, other" in missing_action(two, ActionAt(0.0, "photo"))


PASSING = Stroke(
    ((0.0, 0.0, 10.0), (100.0, 0.0, 10.0)),
    cuts=(45.0,),
    reversible=True,
    repetition=Repetition(30.0, "Trigger", "camera"),
)


def test_what_is_repeated_in_passing_is_done_at_both_ends_too():
    assert PASSING.spots == (0.0, 30.0, 60.0, 90.0, 100.0)
    assert PASSING.repetition.times(100.0) == 5
    assert PASSING.repetition.times(90.0) == 4


def test_a_repetition_is_commanded_at_the_first_point_and_ended_at_the_last():
    begin, end = PASSING.commands
    assert (begin.at, begin.device, begin.parameters) == (0.0, "camera", (("distance", "30.000"),))
    assert (end.at, end.device, end.parameters) == (100.0, "camera", (("distance", "0"),))


def test_every_part_of_a_stroke_repeats_on_its_own():
    assert [part.spots for part in parts_of(PASSING)] == [(0.0, 30.0, 45.0), (0.0, 30.0, 55.0)]
    assert joined(parts_of(PASSING)) == (PASSING,)


def test_nothing_is_repeated_where_a_stroke_turns_around():
    stroke = replace(PASSING, repetition=replace(PASSING.repetition, before=10.0, after=20.0))
    assert stroke.spots == (10.0, 40.0, 70.0, 80.0)
    assert turned(stroke).spots == (20.0, 50.0, 80.0, 90.0)
    assert [part.spots for part in parts_of(stroke)] == [(10.0, 40.0, 45.0), (0.0, 30.0, 35.0)]
    assert joined(parts_of(stroke)) == (stroke,)


def test_a_robot_that_acts_in_passing_does_not_stop_on_the_way():
    stops = replace(PASSING, repetition=None, actions=tuple(photo(at) for at in PASSING.spots))
    assert serve_seconds(PASSING, robot(), DRONE) == pytest.approx(10.0)
    assert serve_seconds(stops, robot(), DRONE) == pytest.approx(10.0 + 5 * 1.0)
