"""The kinematic simulation."""

from dataclasses import replace

import pytest

from mmrs_core.behaviour.program import Action, Heading, Move, MoveTarget
from mmrs_core.contributions.execution import Fault
from mmrs_core.contributions.vehicles import VehicleInput
from mmrs_core.errors import UnsupportedError, UsageError
from mmrs_core.scene import Area, AreaUse, Policy
from mmrs_core.simulation.legs import CLIMBING
from mmrs_core.simulation.simulation import SIMULATION, SimulatedRobot
from mmrs_core.testing.small_programs import (
    BEHAVIOUR,
    MOVE,
    go,
    hold,
    notify,
    program,
    robot,
    robot_type,
    use,
)
from mmrs_runtime.semantics import Outcome

FLYER = ("urn:test", "Flyer")


def rise(altitude):
    return Move("rise", (("urn:test", "Rise"), MOVE), {"altitude": altitude})


SINK = Move("sink", (("urn:test", "Sink"), MOVE))


def flyer(**figures):
    return robot_type(metaclass=FLYER, **figures)


def times(run, move, robot_id="r"):
    """Return when a move began and ended."""
    return tuple(
        r.time for r in run.records if (r.robot, r.move) == (robot_id, move) and r.label in ("begin", "end")
    )


def last(run, robot_id="r"):
    return run.tracks[robot_id][-1]


def test_a_robot_goes_to_its_targets_at_its_cruise_speed(fly):
    run = fly(program(robot("r", [go("g", (30, 0, 0)), go("h", (30, 15, 0))])))
    assert times(run, "g") == (0.0, 10.0)
    assert times(run, "h") == (10.0, 15.0)
    assert [(s.time, s.east, s.north) for s in run.tracks["r"]] == [(0, 0, 0), (10, 30, 0), (15, 30, 15)]


def test_a_commanded_speed_counts_within_the_robots_limits(fly):
    run = fly(program(robot("r", [go("slow", (4, 0, 0), speed=1.0), go("fast", (8, 0, 0), speed=99.0)])))
    assert times(run, "slow") == (0.0, 4.0)
    assert times(run, "fast") == (4.0, 5.0)


def test_a_move_that_ends_at_a_distance_stops_there(fly):
    run = fly(program(robot("r", [go("g", (30, 0, 0), distance=6.0)])))
    assert last(run).east == pytest.approx(24.0)


def test_a_robot_begins_at_its_home(fly):
    run = fly(program(robot("r", [hold("h")], home=(3.0, 4.0, 5.0))))
    assert run.tracks["r"][0].position == (3.0, 4.0, 5.0)


def test_a_turn_takes_the_angle_over_the_turn_rate(fly):
    look = Heading(MoveTarget((0.0, -9.0, 0.0)))
    head = Move("turn", ((BEHAVIOUR, "HeadTo"), MOVE), heading=look)
    run = fly(program(robot("r", [go("g", (0, 9, 0)), head])))
    assert times(run, "turn") == (3.0, 5.0)


def test_half_of_the_longest_turn_is_expected_of_a_robot_that_has_not_moved_yet(fly):
    head = Move("turn", ((BEHAVIOUR, "HeadTo"), MOVE), heading=Heading(MoveTarget((0.0, -9.0, 0.0))))
    assert times(fly(program(robot("r", [head]))), "turn") == (0.0, 1.0)


def test_device_actions_take_their_declared_time_and_feedback_none(fly):
    feedback = Action(((BEHAVIOUR, "Feedback"),))
    behaviour = program(robot("r", [hold("h", 1.0, before=(use("cam", "shoot"), feedback))]))
    run = fly(behaviour, robot_type(devices={"cam": {"shoot": 2.5}}))
    assert times(run, "h") == (2.5, 3.5)


def test_a_device_that_the_type_does_not_have_stays_silent(fly):
    behaviour = program(
        robot("r", [hold("h", before=(use("cam", "shoot"),))], policies=(Policy("DEVICE_SILENT", "HOLD"),))
    )
    assert fly(behaviour).ending.faults["r"] == Fault("DEVICE_SILENT", "'cam' does not do 'shoot'")


def test_energy_falls_by_mean_power_and_time_waits_included(fly):
    run = fly(
        program(
            robot("r", [go("g", (30, 0, 0))], waits={"g": ["s"]}),
            robot("q", [hold("h", 50.0, after=(notify("r.s"),))]),
        )
    )
    assert last(run).energy == pytest.approx(100_000.0 - 50.0 * 100.0)


def test_energy_falls_faster_in_a_climb_and_slower_on_the_way_down(fly):
    run = fly(program(robot("r", [rise(20.0), SINK])), flyer())
    climb, descent = 10.0, 10.0
    at_the_top = next(sample for sample in run.tracks["r"] if sample.up == pytest.approx(20.0))
    assert at_the_top.energy == pytest.approx(100_000.0 - 100.0 * climb * (1.0 + CLIMBING))
    assert last(run).energy == pytest.approx(at_the_top.energy - 100.0 * descent * (1.0 - CLIMBING))


def test_energy_falls_faster_against_the_wind(fly):
    way = program(robot("r", [rise(10.0), go("g", (30, 0, 10))]))
    still = last(fly(way, flyer())).energy
    windy = last(fly(way, flyer(), environment={"windSpeed": 1.0, "windDirection": 90.0})).energy
    assert windy < still


def test_a_robot_that_flies_takes_nothing_on_the_ground(fly):
    run = fly(program(robot("r", [hold("before", 100.0), rise(10.0), SINK, hold("after", 100.0)])), flyer())
    flown = 5.0 + 5.0
    assert last(run).energy == pytest.approx(100_000.0 - 100.0 * flown)


def test_an_empty_battery_is_a_fault_where_it_runs_out(fly):
    policies = (Policy("BATTERY_LOW", "CONTINUE"),)
    behaviour = program(robot("r", [go("g", (9000, 0, 0))], policies=policies))
    run = fly(behaviour, robot_type(lifetime=100.0))
    assert run.ending.faults["r"].which == "BATTERY_EMPTY"
    assert run.records[-1].time == pytest.approx(100.0)
    assert last(run).east == pytest.approx(300.0)
    assert last(run).energy == pytest.approx(0.0)


def test_a_battery_that_is_low_is_next_worth_a_look_when_it_is_empty(kinds):
    away, policies = go("g", (30, 0, 0)), (Policy("BATTERY_LOW", "RETURN"),)
    behaviour = program(robot("r", [away], policies=policies))
    waiting = SimulatedRobot(given(behaviour, kinds, robot_type(lifetime=100.0)))
    waiting.do(away, 0.0)
    waiting.look(10.0)
    assert waiting.done
    waiting.wait(10.0)
    low = waiting.look(10.0)
    assert low == pytest.approx(90.0, abs=1e-3)
    assert waiting.look(low) == pytest.approx(100.0, abs=1e-3)
    assert waiting.trouble.which == "BATTERY_LOW"


def test_a_battery_also_runs_out_in_a_wait(fly):
    run = fly(
        program(
            robot("r", [hold("h", 1.0)], waits={"h": ["s"]}),
            robot("q", [rise(1.0), hold("h", 500.0, after=(notify("r.s"),)), SINK]),
        ),
        flyer(lifetime=800.0),
    )
    assert run.ending.outcome is Outcome.SUCCESS
    swimmer = fly(
        program(
            robot("r", [hold("h", 1.0)], waits={"h": ["s"]}),
            robot("q", [hold("h", 500.0, after=(notify("r.s"),))]),
        ),
        robot_type(lifetime=100.0),
    )
    assert {fault.which for fault in swimmer.ending.faults.values()} == {"BATTERY_EMPTY"}


def test_a_move_that_the_robot_is_in_no_state_for_is_a_fault(fly):
    run = fly(program(robot("r", [rise(1.0)])), flyer())
    assert run.ending.faults["r"].which == "STATE"
    assert run.ending.faults["r"].reason == "Stop 'stop' needs it grounded or moving, it is airborne"


def test_a_recharge_fills_the_battery(fly):
    recharge = Move(
        "charge", ((BEHAVIOUR, "Recharge"), (BEHAVIOUR, "HoldPosition"), MOVE), {"duration": 60.0}
    )
    run = fly(program(robot("r", [hold("h", 90.0), recharge, hold("i", 90.0)])), robot_type(lifetime=100.0))
    assert run.ending.outcome is Outcome.SUCCESS
    assert last(run).energy == pytest.approx(10_000.0)


def test_a_robot_without_a_lifetime_never_runs_out(fly):
    run = fly(program(robot("r", [hold("h", 1e6)])), robot_type(lifetime=None, energy=0.0))
    assert run.ending.outcome is Outcome.SUCCESS
    assert last(run).energy == float("inf")


def test_energy_is_not_known_where_only_the_lifetime_is(fly):
    run = fly(program(robot("r", [hold("h", 9.0)])), robot_type(lifetime=100.0, energy=0.0))
    assert last(run).energy is None


@pytest.mark.parametrize(("speed", "fault"), [(7.0, None), (9.0, "WIND")])
def test_hovering_in_more_wind_than_the_robot_can_bear_is_a_fault(fly, speed, fault):
    behaviour = program(robot("r", [rise(10.0), hold("h", 5.0), SINK]))
    type = flyer(speed=(0.0, 20.0), attributes={"positionHold": 8.0})
    faults = fly(behaviour, type, environment={"windSpeed": speed}).ending.faults
    assert (faults["r"].which if "r" in faults else None) == fault


def test_wind_does_not_trouble_a_robot_on_the_ground(fly):
    behaviour = program(robot("r", [hold("h", 5.0)]))
    run = fly(behaviour, flyer(attributes={"positionHold": 8.0}), environment={"windSpeed": 20.0})
    assert run.ending.outcome is Outcome.SUCCESS


def test_wind_too_strong_to_make_headway_is_a_fault(fly):
    behaviour = program(robot("r", [rise(10.0), go("g", (30, 0, 10))]))
    run = fly(behaviour, flyer(), environment={"windSpeed": 5.0, "windDirection": 90.0})
    assert run.ending.faults["r"] == Fault("WIND", "too strong to make headway")


def test_current_slows_down_what_is_under_water_and_wind_does_not(fly):
    behaviour = program(robot("r", [go("g", (30, 0, -5))], home=(0.0, 0.0, -5.0)))
    against = {"currentSpeed": 3.0, "currentDirection": 270.0}
    assert times(fly(behaviour, environment=against), "g") == (0.0, 30.0)
    assert times(fly(behaviour, environment={"windSpeed": 30.0}), "g") == (0.0, 10.0)


def test_current_does_not_trouble_a_robot_on_land(fly):
    behaviour = program(robot("r", [go("g", (30, 0, 0))]))
    against = {"currentSpeed": 3.0, "currentDirection": 270.0}
    assert times(fly(behaviour, environment=against), "g") == (0.0, 10.0)


def test_passing_a_waypoint_saves_the_time_to_brake_and_to_get_going_again(fly):
    moves = [go("g", (30, 0, 0)), go("h", (60, 0, 0))]
    sluggish = robot_type(acceleration=1.0)
    stopping, passing = (
        fly(program(robot("r", moves, fluid=fluid)), sluggish).ending.time for fluid in ([], ["g"])
    )
    assert stopping == pytest.approx(26.0)
    assert passing == pytest.approx(23.0)


@pytest.mark.parametrize(
    ("response", "finish"),
    [
        ("HOLD", (30.0, 0.0, 10.0)),
        ("LAND", (30.0, 0.0, 0.0)),
        ("RETURN", (0.0, 0.0, 0.0)),
        ("SURFACE", (30.0, 0.0, -2.0)),
        ("EMERGENCY_AREA", (35.0, 5.0, 0.0)),
        ("STOP_THRUST", (30.0, 0.0, 10.0)),
    ],
)
def test_a_fault_is_answered_as_the_policy_says(fly, response, finish):
    near = Area("near", AreaUse.EMERGENCY, ((34, 4), (36, 4), (36, 6), (34, 6)))
    far = Area("far", AreaUse.EMERGENCY, ((94, 4), (96, 4), (96, 6), (94, 6)))
    behaviour = program(
        robot(
            "r",
            [rise(10.0), go("g", (30, 0, 10), after=(use("cam", "shoot"),))],
            policies=(Policy("DEVICE_SILENT", response),),
        ),
        surface=-2.0,
    )
    run = fly(behaviour, flyer(), areas=(far, near))
    assert run.records[-1].label == "fault"
    assert (last(run).east, last(run).north, last(run).up) == pytest.approx(finish)


def test_a_robot_turns_back_while_its_battery_still_lasts_for_the_way_home(fly):
    behaviour = program(robot("r", [go("g", (900, 0, 0))], policies=(Policy("BATTERY_LOW", "RETURN"),)))
    run = fly(behaviour, robot_type(lifetime=100.0))
    assert run.ending.faults["r"].which == "BATTERY_LOW"
    assert run.records[-1].time == pytest.approx(50.0, abs=0.01)
    assert last(run).east == pytest.approx(0.0, abs=0.01)
    assert last(run).energy == pytest.approx(0.0, abs=10.0)


def there_and_back():
    moves = [rise(20.0), go("g", (60, 0, 20)), go("home", (0, 0, 20)), SINK]
    return program(robot("r", moves, policies=(Policy("BATTERY_LOW", "RETURN"),)))


@pytest.mark.parametrize(("acceleration", "seconds"), [(None, 60.0), (0.5, 72.0), (3.0, 62.0)])
def test_a_planned_return_that_just_suffices_is_no_fault(fly, acceleration, seconds):
    run = fly(there_and_back(), flyer(lifetime=seconds, acceleration=acceleration))
    assert run.ending.outcome is Outcome.SUCCESS
    assert last(run).energy == pytest.approx(0.0, abs=1.0)


@pytest.mark.parametrize(("acceleration", "seconds"), [(None, 59.0), (0.5, 59.0), (3.0, 59.0)])
def test_a_planned_return_that_does_not_suffice_is_cut_short(fly, acceleration, seconds):
    run = fly(there_and_back(), flyer(lifetime=seconds, acceleration=acceleration))
    assert run.ending.faults["r"].which == "BATTERY_LOW"
    assert (last(run).east, last(run).up) == pytest.approx((0.0, 0.0), abs=0.01)


def test_an_object_whose_place_nobody_knows_is_found_where_the_robot_is_and_a_note_says_so(fly):
    wreck = Move("g", ((BEHAVIOUR, "GoTo"), MOVE), target=MoveTarget(None, "wreck", None))
    run = fly(program(robot("r", [go("near", (30, 0, 0)), wreck])))
    assert run.ending.outcome is Outcome.SUCCESS
    assert last(run).east == 30.0
    assert run.notes == ("robot 'r', move 'g': object taken to be where the robot looks for it",)


def given(behaviour, kinds, type=None, **more):
    robot, kind = behaviour.robots[0], type or robot_type()
    return VehicleInput(behaviour, {kind.name: kind}, **kinds, robot=robot, type=kind, **more)


def test_unknown_moves_and_actions_are_refused_and_listed_never_skipped(kinds):
    dance = Move("d", (("urn:x", "Dance"), MOVE), after=(Action((("urn:x", "Sing"),)),))
    with pytest.raises(UnsupportedError) as caught:
        SimulatedRobot(given(program(robot("r", [dance])), kinds))
    assert caught.value.elements == ("robot 'r', move 'd': Dance", "robot 'r', move 'd': action Sing")


def test_a_robot_of_a_kind_that_nobody_contributed_is_refused(kinds):
    with pytest.raises(UnsupportedError, match="type 'plain': no plug-in provides its robot kind"):
        SimulatedRobot(given(program(robot("r", [])), kinds, robot_type(metaclass=("urn:x", "Blimp"))))


def test_the_policies_of_a_type_count_where_the_behaviour_says_nothing(fly):
    silent = program(robot("r", [hold("h", before=(use("cam", "shoot"),))]))
    patient = replace(robot_type(), policies=(Policy("DEVICE_SILENT", "CONTINUE"),))
    strict = replace(robot_type(), policies=(Policy("DEVICE_SILENT", "HOLD"),))
    outcomes = [fly(silent, type=each).ending.outcome for each in (patient, strict)]
    assert outcomes == [Outcome.SUCCESS, Outcome.FAILED]


def test_an_option_that_the_simulation_does_not_have_is_refused(kinds):
    with pytest.raises(UsageError, match="option 'rain'"):
        SIMULATION.connect(given(program(robot("r", [])), kinds, options={"rain": "1"}))


def test_a_robot_type_that_is_missing_is_named(kinds):
    from mmrs_core.contributions.targets import TargetInput
    from mmrs_core.simulation.run import simulate

    with pytest.raises(UnsupportedError) as caught:
        simulate(TargetInput(program(robot("r", [])), {}, **kinds), SIMULATION)
    assert caught.value.elements == ("robot 'r': type 'plain'",)


def test_state_lies_between_the_ends_of_a_leg_and_faces_its_way(kinds):
    move = go("g", (30, 0, 0))
    moved = SimulatedRobot(given(program(robot("r", [move])), kinds))
    moved.do(move, 5.0)
    state = moved.state(10.0)
    assert state.position == pytest.approx((15.0, 0.0, 0.0))
    assert (state.speed, state.heading) == (pytest.approx(3.0), 90.0)
    assert moved.look(10.0) == 15.0
    assert not moved.done
    moved.look(15.0)
    assert moved.done
    assert moved.state(15.0).speed == 0.0


def test_a_robot_faces_what_its_heading_points_at_turned_by_the_angle(kinds):
    look = Heading(MoveTarget((30.0, 50.0, 0.0)), angle_degrees=90.0)
    move = go("g", (30, 0, 0), heading=look)
    moved = SimulatedRobot(given(program(robot("r", [move])), kinds))
    moved.do(move, 0.0)
    assert moved.state(10.0).heading == pytest.approx(270.0)


def test_stopping_a_robot_on_its_way_keeps_it_where_it_is(kinds):
    move = go("g", (30, 0, 0))
    moved = SimulatedRobot(given(program(robot("r", [move])), kinds))
    moved.do(move, 0.0)
    moved.respond("HOLD", 5.0)
    moved.respond("RETURN", 6.0)
    assert moved.state(99.0).position == pytest.approx((15.0, 0.0, 0.0))
