"""What becomes of the behaviours of 2015."""

from itertools import pairwise
from math import hypot

import pytest

from mmrs_core.languages.writing import to_xmi


@pytest.fixture
def flown(migrated, flyaq):
    return migrated(flyaq / "round.xmi", flyaq / "Heron.xmi")


@pytest.fixture
def behaviour(flown, model):
    return model(flown, "behaviour.xmi")


@pytest.fixture
def moves(behaviour):
    return [{move.name: move for move in robot.moves} for robot in behaviour.robots]


@pytest.fixture
def changed(flyaq, written):
    """Return a function that writes the behaviour with some text replaced."""

    def change(old, new):
        text = (flyaq / "round.xmi").read_text()
        assert old in text
        return written("changed.xmi", text.replace(old, new, 1))

    return change


def test_xmi_and_json_of_a_model_become_the_same(migrated, flyaq, registry):
    files = [migrated(flyaq / name, flyaq / "Heron.xmi") for name in ("round.xmi", "round.json")]
    one, other = (to_xmi((found.outputs[-1].element,), registry) for found in files)
    assert one == other


def test_a_model_that_is_given_twice_is_written_once(migrated, flyaq):
    found = migrated(flyaq / "round.xmi", flyaq / "round.json")
    (output,) = found.outputs
    assert len(output.sources) == 2


def test_several_behaviours_get_folders_with_the_types_they_name(migrated, flyaq, changed, told):
    found = migrated(flyaq / "round.xmi", changed('name="round"', 'name="other"'), flyaq / "Heron.xmi")
    assert [str(output.path) for output in found.outputs] == [
        "robots/Heron.xmi",
        "round/behaviour.xmi",
        "round/robots/Heron.xmi",
        "changed/behaviour.xmi",
        "changed/robots/Heron.xmi",
    ]
    assert told(found, "a project has one behaviour, so each of the 2 has a folder of its own")


def test_an_omitted_travel_mode_is_the_cautious_one(flown, behaviour, told):
    assert [robot.travelMode for robot in behaviour.robots] == ["NORMAL", "SAFE"]
    assert told(flown, "DEFAULTED: travelMode is not given: SAFE")


def test_a_hover_becomes_a_hold(moves):
    assert type(moves[0]["watch"]).__name__ == "HoldPosition"
    assert moves[0]["watch"].duration == 4.0


def test_the_place_of_a_goto_becomes_a_target_of_the_behaviour(behaviour, moves):
    target = moves[0]["out"].target
    assert target in behaviour.targets
    assert (target.latitude, target.longitude, target.altitude) == (46.001, 11.001, 30.0)
    assert moves[0]["out"].trajectory == "VERTICAL_FIRST"


def test_a_circle_becomes_way_points_around_its_centre(flown, behaviour, moves, told):
    ring = [move for move in behaviour.robots[0].moves if move.name.startswith("around")]
    assert len(ring) == 3 * 12 + 1
    centre = ring[0].target.reference
    assert (centre.latitude, centre.altitude) == (46.0015, 30.0)
    for move in ring:
        assert move.target.reference is centre
        assert hypot(move.target.x, move.target.y) == pytest.approx(12.0, abs=0.001)
        assert move.target.z == 5.0
    assert told(flown, "3 times at 7.454 m/s takes so long: duration 30.0 of Circle 'around'")
    assert [move.speed for move in ring] == [None, *([7.454] * 36)]


def test_rounds_last_as_long_as_the_circle(behaviour):
    ring = [move for move in behaviour.robots[0].moves if move.name.startswith("around")]
    ways = (
        hypot(one.target.x - other.target.x, one.target.y - other.target.y) for one, other in pairwise(ring)
    )
    assert sum(ways) / ring[1].speed == pytest.approx(30.0, abs=0.01)


def test_without_its_robot_type_a_circle_is_one_round_at_no_speed_that_is_made_up(
    migrated, model, flyaq, told
):
    found = migrated(flyaq / "round.xmi")
    ring = [move for move in model(found, "behaviour.xmi").robots[0].moves if "around" in move.name]
    assert [move.speed for move in ring] == [None] * 13
    assert told(found, "LOST: the speeds of robot type 'Heron' are not known")


def test_a_circle_too_tight_for_its_speed_is_flown_at_the_robots_own(
    migrated, model, flyaq, changed, told, tmp_path
):
    heron = tmp_path / "Heron.xmi"
    text = (flyaq / "Heron.xmi").read_text()
    heron.write_text(text.replace('maxSpeed="10"', 'maxSpeed="10" maxAcceleration="3"'))
    found = migrated(changed('duration="30.0"', 'duration="8.0"'), heron)
    ring = [move for move in model(found, "behaviour.xmi").robots[0].moves if "around" in move.name]
    assert [move.speed for move in ring] == [None] * 13
    assert told(found, "LOST: the robot goes round once, and no speed that it has makes that last so long")


def test_a_circle_longer_than_any_rounds_is_told(migrated, model, flyaq, changed, told):
    found = migrated(changed('duration="30.0"', 'duration="30000.0"'), flyaq / "Heron.xmi")
    ring = [move for move in model(found, "behaviour.xmi").robots[0].moves if "around" in move.name]
    assert len(ring) == 10 * 12 + 1
    assert told(found, "LOST: the robot goes round 10 times, and no speed that it has makes that last")


@pytest.mark.parametrize(
    ("given", "value", "assumed"),
    [
        ('clockwise="true"', "clockwise", "clockwise is not given: false"),
        ('altitude="35.0" clockwise', "altitude", "altitude is not given: 0.0"),
        ('radius="12.0"', "radius", "radius is not given: 0.0"),
        ('duration="30.0"', "duration", "duration is not given: 0.0"),
    ],
)
def test_what_a_circle_does_not_say_is_what_2015_took_it_for(migrated, told, changed, given, value, assumed):
    rest = given.partition(" ")[2]
    assert told(migrated(changed(given, rest)), f"DEFAULTED: {assumed}: {value} of Circle 'around'")


def test_a_circle_that_does_not_say_which_way_goes_the_other_way(migrated, model, changed):
    found = model(migrated(changed('clockwise="true"', "")), "behaviour.xmi")
    fourth = next(move for move in found.robots[0].moves if move.name == "around_4")
    assert (fourth.target.x, fourth.target.y) == (-12.0, 0.0)


def test_a_circle_without_an_altitude_lies_on_the_ground(migrated, model, changed):
    found = model(migrated(changed('altitude="35.0" clockwise', "clockwise")), "behaviour.xmi")
    assert next(move for move in found.robots[0].moves if move.name == "around_4").target.z == -30.0


def test_circles_of_one_name_make_moves_of_different_names(migrated, model, changed, told):
    circle = (
        '<movements xsi:type="behaviour:Circle" name="around" radius="1"><targetPosition/></movements>'
        '<movements xsi:type="behaviour:Hover" name="around_3"/>'
    )
    found = migrated(changed("<slots", f"{circle}<slots"))
    names = [move.name for move in model(found, "behaviour.xmi").robots[0].moves]
    assert len(set(names)) == len(names) == 2 * 13 + 8
    assert told(found, "'around' is taken already, so this one is called 'around_2'")


def test_a_direction_that_is_not_given_is_north(migrated, model, changed, told):
    found = migrated(changed(' direction="90.0"', ""))
    move = next(move for move in model(found, "behaviour.xmi").robots[0].moves if move.name == "east")
    assert (move.heading.target.x, move.heading.target.y) == (0.0, 100_000.0)
    assert told(found, "DEFAULTED: direction is not given: 0.0: direction of HeadTo 'east'")


def test_a_clockwise_circle_goes_from_north_to_east(moves):
    first, quarter = moves[0]["around"].target, moves[0]["around_4"].target
    assert (first.x, first.y) == (0.0, 12.0)
    assert (quarter.x, quarter.y) == (12.0, 0.0)


def test_a_circle_the_other_way_goes_from_north_to_west(migrated, model, changed):
    found = model(migrated(changed('clockwise="true"', 'clockwise="false"')), "behaviour.xmi")
    fourth = next(move for move in found.robots[0].moves if move.name == "around_4")
    assert (fourth.target.x, fourth.target.y) == (-12.0, 0.0)


def test_the_way_leads_through_the_whole_circle(behaviour):
    transitions = behaviour.robots[0].moveTransitions
    way = ["begin"]
    following = {each.from_.name: each.to.name for each in transitions}
    while way[-1] in following:
        way.append(following[way[-1]])
    assert len(following) == len(transitions)
    assert way[2:4] == ["out", "around"]
    assert way[-5:] == ["around_37", "east", "watch", "down", "end"]
    assert [each.fluid for each in transitions if each.to.name.startswith("around_")] == [True] * 36


def test_what_follows_a_circle_is_done_at_its_end(moves):
    assert [action.name for action in moves[0]["around_37"].postActions] == ["ready"]
    assert list(moves[0]["around"].postActions) == []


@pytest.mark.parametrize("radius", ["0.0", "wide"])
def test_a_circle_without_a_radius_only_leads_to_its_centre(migrated, model, told, changed, radius):
    found = migrated(changed('radius="12.0"', f'radius="{radius}"'))
    names = [move.name for move in model(found, "behaviour.xmi").robots[0].moves]
    assert [name for name in names if name.startswith("around")] == ["around"]
    assert told(found, "so the robot only goes to the centre")


def test_a_direction_becomes_a_heading_to_a_place_far_away(flown, behaviour, moves, told):
    target = moves[0]["east"].heading.target
    assert (target.x, target.y) == (100_000.0, 0.0)
    assert target.reference is behaviour.robots[0].home
    assert told(flown, "headings lead to a place: one 100000 m away in this direction: direction 90.0")


def test_the_heading_at_a_place_becomes_that_of_the_move(moves):
    heading = moves[1]["look"].heading
    assert (heading.target.x, heading.target.y) == (0.0, -100_000.0)
    assert heading.target.reference is moves[1]["look"].target


def test_a_notification_reaches_the_slot_of_the_receiver(flown, behaviour, moves, told):
    (notify,) = moves[0]["around_37"].postActions
    assert notify.slot is behaviour.robots[1].slots[0]
    assert notify.active is True
    assert told(flown, "the slot was the sender's; it is the receiver's slot of the same name here")


def test_a_receiver_without_such_a_slot_gets_one(migrated, model, told, changed):
    found = migrated(changed('<slots name="go"/>', '<slots name="ready"/>'))
    follower = model(found, "behaviour.xmi").robots[1]
    assert [slot.name for slot in follower.slots] == ["go", "ready"]
    assert told(found, "DEFAULTED: 'follower' had no Slot of this name, so one is made for it: slot 'ready'")


def test_a_check_before_a_move_becomes_a_wait_on_the_way_to_it(flown, behaviour, told):
    follower = behaviour.robots[1]
    assert [len(each.waitFor) for each in follower.moveTransitions] == [1, 0, 0, 0]
    assert follower.moveTransitions[0].waitFor[0] is follower.slots[0]
    assert list(follower.moves[1].preActions) == []
    assert told(flown, "a CheckNotification is no action here")


def test_a_check_after_a_move_becomes_a_wait_on_the_way_on(migrated, model, changed):
    check = '<preActions xsi:type="behaviour:CheckNotification"'
    found = migrated(changed(check, check.replace("pre", "post")))
    follower = model(found, "behaviour.xmi").robots[1]
    assert [len(each.waitFor) for each in follower.moveTransitions] == [0, 1, 0, 0]


def test_a_check_that_no_transition_can_wait_for_is_told(migrated, told, changed):
    check = '<preActions xsi:type="behaviour:CheckNotification" name="wait" slot="//@drones.1/@slots.0"/>'
    start = '<movements xsi:type="behaviour:Start" name="begin"/>'
    found = migrated(changed(start, f"{start[:-2]}>{check}</movements>"))
    assert told(found, "LOST: no transition stands where it could wait: CheckNotification 'wait'")


def test_a_transition_to_a_move_of_another_drone_leads_to_the_own_one(flown, behaviour, told):
    follower = behaviour.robots[1]
    last = follower.moveTransitions[-1]
    assert (last.from_, last.to) == (follower.moves[-2], follower.moves[-1])
    assert len(told(flown, "it led to a move of another drone")) == 2


def test_an_action_goes_to_the_device_that_does_it(flown, moves, told):
    (action,) = moves[0]["out"].postActions
    assert (action.deviceId, action.actionName) == ("camera", "TakePicture")
    assert (action.parameters[0].key, action.parameters[0].value) == ("zoom", "2")
    assert told(flown, "'TakeSnapshot' is called 'TakePicture' here")


def test_an_action_that_no_device_does_is_told_and_left_out(migrated, model, told, flyaq):
    found = migrated(flyaq / "round.xmi")
    assert list(model(found, "behaviour.xmi").robots[0].moves[2].postActions) == []
    (line,) = told(found, "no single device of the robot type 'Heron' is known to do 'TakePicture'")
    assert "parameters Parameter (key zoom; value 2)" in line


def test_the_action_of_a_feedback_becomes_the_first_entry_of_its_payload(moves):
    (feedback,) = moves[1]["down"].postActions
    assert [(pair.key, pair.value) for pair in feedback.payload] == [
        ("actionName", "landed"),
        ("where", "field"),
    ]
