"""What vehicles take lies within the bounds of the check: legs of simulated ones, and what was measured."""

from dataclasses import replace
from itertools import accumulate, pairwise
from math import cos, dist, radians, sin
from statistics import mean

import pytest
from counts import many
from hypothesis import example, given, settings
from hypothesis import strategies as st
from mmrs_multicopter.testing import LAND, go_to, quad, robot_program, take_off, target_input

from mmrs_core.analysis.durations import durations_of
from mmrs_core.analysis.figures import kinematics_of
from mmrs_core.analysis.motion import motions
from mmrs_core.behaviour.program import DEVICE_ACTION, NOTIFY, Action
from mmrs_core.contributions.checks import CheckInput
from mmrs_core.contributions.passages import Passages
from mmrs_core.contributions.timing import as_uploaded
from mmrs_core.generation.planned_moves import planned_moves
from mmrs_core.scene import Capability, Kinematics
from mmrs_core.scene.passing import Passage, passed
from mmrs_core.scene.timing import STANDING, Rates
from mmrs_core.testing.programs import installed, move, program
from mmrs_mavlink.plugin.vehicles import timings
from mmrs_mavlink.profiles import ARDUCOPTER, ARDUSUB, PROFILES, PX4_MULTICOPTER
from mmrs_mavlink.sitl.body import STEP, Body, Vector
from mmrs_mavlink.steps.energy import CHARGING_FACTOR

ACCEPTANCE, STILL = 1.0, 0.3
"""Metres from a target, and metres per second, at which the driver takes a vehicle to have arrived."""

HERE = (0.0, 0.0, 20.0)
level = st.floats(-80.0, 80.0)
places = st.tuples(level, level, st.floats(3.0, 40.0))


def flown(profile, to: Vector, speed: float) -> float:
    """Return the seconds in which a simulated vehicle comes to a place, as the driver judges it.

    One that trails its set-point is given one that moves there at the speed.
    """
    figures, length = profile.pacing.step, dist(HERE, to)
    body = Body(figures, HERE, speed=speed, climb=figures.climb, descent=figures.descent)
    body.target, steps = to, 0
    while not (dist(body.position, to) <= ACCEPTANCE and body.pace <= STILL):
        if figures.trailing and length:
            part = min(1.0, speed * steps * STEP / length)
            body.target = tuple(p + part * (q - p) for p, q in zip(HERE, to, strict=True))
        body.advance(STEP)
        steps += 1
        assert steps < 20_000
    return steps * STEP


@pytest.mark.parametrize("profile", [ARDUCOPTER, PX4_MULTICOPTER], ids=lambda each: each.name)
@given(places, st.floats(1.0, 10.0))
@example(HERE, 5.0)
@example((0.0, 0.5, 20.0), 5.0)
@example((0.0, 12.0, 20.0), 8.5)
@example((0.0, 0.0, 40.0), 5.0)
@settings(max_examples=many(600, fast=30))
def test_a_leg_of_a_simulated_vehicle_keeps_to_its_bounds(profile, to, speed):
    figures = profile.pacing.step
    rates = Rates(speed, figures.climb, figures.descent, figures)
    least, most = (each.from_stop_to_stop(HERE, to) for each in (rates.soonest(), rates.latest()))
    assert least <= flown(profile, to, speed) <= most


def submarine(speed=1.05, **limits):
    """Return the rates of an ArduSub whose type states some limits."""
    (autopilot,) = (each.of(quad()) for each in timings() if each.vehicle == "sub")
    figures = Capability(0.0, None, (0.0, 1.8), **limits).timing("STEP", autopilot.step)
    return Rates(speed, figures.climb, figures.descent, figures)


@pytest.mark.parametrize(
    ("aside", "seconds"),
    [(90, 22.6), (120, 22.9), (135, 25.0), (150, 27.5), (160, 29.7), (170, 35.4), (175, 37.3)],
)
def test_a_car_takes_longer_to_what_is_behind_it_as_was_measured(aside, seconds):
    """Flown by ArduRover 4.7-dev in GUIDED at 1.5 m/s: legs of 30 m, each turning by so many degrees."""
    (autopilot,) = (each.of(quad()) for each in timings() if each.vehicle == "rover")
    rover = Rates(1.5, 1.0, 1.0, autopilot.step, 36.0, 3.2, rounds=True, shunts_within=9.6, circling=5.03)
    leg = ((0.0, 0.0, 0.0), (0.0, 30.0, 0.0))
    assert rover.from_stop_to_stop(*leg, facing=float(aside)) == pytest.approx(seconds, rel=0.05)
    assert rover.latest().from_stop_to_stop(*leg, facing=float(aside)) > seconds


@pytest.mark.parametrize(
    ("metres", "speed", "seconds"),
    [(14.0, 1.0, 25.5), (20.0, 1.5, 25.5), (25.0, 1.5, 29.9), (30.0, 2.0, 28.5), (40.0, 1.5, 41.4)],
)
def test_a_car_that_turns_round_once_more_takes_less_longer_as_was_measured(metres, speed, seconds):
    """Flown by ArduRover 4.7-dev in GUIDED; all but 20 m calibrated it."""
    (autopilot,) = (each.of(quad()) for each in timings() if each.vehicle == "rover")
    rover = Rates(speed, 1.0, 1.0, autopilot.step, 36.0, 3.2, rounds=True, shunts_within=9.6, circling=5.03)
    there, back = ((0.0, 0.0, 0.0), (0.0, metres, 0.0)), ((0.0, metres, 0.0), (0.0, 0.0, 0.0))
    once = rover.faces(*back, 0.0)
    assert rover.from_stop_to_stop(*there, facing=once) == pytest.approx(seconds, rel=0.05)
    assert rover.latest().from_stop_to_stop(*there, facing=once) > seconds


def test_a_car_on_a_mission_may_drive_on_before_it_turns_to_what_is_behind_it():
    """ArduRover took 21.3 s for the first leg of 6 m back at 1 m/s, and 11.5 s for each of the others."""
    (autopilot,) = (each.of(quad()) for each in timings() if each.vehicle == "rover")
    rover = Rates(1.0, 1.0, 1.0, autopilot.mission, 36.0, 3.2, rounds=True, shunts_within=0.0, circling=7.54)
    leg = ((0.0, 6.0, 0.0), (0.0, 0.0, 0.0))
    assert rover.soonest().from_stop_to_stop(*leg, facing=0.0) < 11.5
    assert rover.latest().from_stop_to_stop(*leg, facing=0.0) > 21.3
    assert rover.latest().from_stop_to_stop(*leg, facing=90.0) < 21.3


@pytest.mark.parametrize(
    ("metres", "aside", "seconds"), [(4.0, 180, 11.0), (14.0, 180, 23.4), (9.22, 139, 16.6), (10.0, 90, 14.6)]
)
def test_a_robot_on_tracks_turns_before_it_goes_to_what_is_behind_it_as_was_measured(metres, aside, seconds):
    """Flown by ArduRover 4.7-dev on tracks in GUIDED at 0.8 m/s, WP_PIVOT_ANGLE being 120."""
    (autopilot,) = (each.of(quad()) for each in timings() if each.vehicle == "ground")
    crawler = Kinematics(
        cruise=0.8, slowest=0.0, fastest=1.5, climb=1.0, descent=1.0, turn_rate=autopilot.turn_rate
    ).flown_by(autopilot.step)
    leg, rates = ((0.0, 0.0, 0.0), (0.0, metres, 0.0)), crawler.rates(0.8)
    assert rates.from_stop_to_stop(*leg, facing=float(aside)) == pytest.approx(seconds, rel=0.03)
    assert rates.latest().from_stop_to_stop(*leg) > seconds


@pytest.mark.parametrize(
    ("metres", "aside", "speed", "seconds"),
    [(4.0, 90, 1.2, 6.1), (9.0, 90, 1.2, 10.2), (12.0, 120, 1.5, 13.7), (6.0, 120, 1.0, 11.2)],
)
def test_a_robot_on_tracks_gets_onto_a_leg_behind_a_corner_as_late_as_was_measured(
    metres, aside, speed, seconds
):
    """Flown by ArduRover 4.7-dev on tracks in GUIDED; legs of 12 m calibrated it."""
    (autopilot,) = (each.of(quad()) for each in timings() if each.vehicle == "ground")
    crawler = Kinematics(
        cruise=speed, slowest=0.0, fastest=1.5, climb=1.0, descent=1.0, turn_rate=autopilot.turn_rate
    ).flown_by(autopilot.step)
    leg, rates = ((0.0, 0.0, 0.0), (0.0, metres, 0.0)), crawler.rates(speed)
    assert rates.from_stop_to_stop(*leg, facing=float(aside)) == pytest.approx(seconds, rel=0.03)
    assert rates.latest().from_stop_to_stop(*leg) > seconds


@pytest.mark.parametrize(
    ("metres", "aside", "seconds"), [(12.0, 180, 19.5), (14.42, 146, 21.4), (8.0, 90, 12.7)]
)
def test_a_robot_on_tracks_turns_before_it_goes_on_missions_as_was_measured(metres, aside, seconds):
    """Flown by ArduRover 4.7-dev on tracks in AUTO at 1.0 m/s, WP_PIVOT_ANGLE being 120."""
    (autopilot,) = (each.of(quad()) for each in timings() if each.vehicle == "ground")
    crawler = Kinematics(
        cruise=1.0,
        slowest=0.0,
        fastest=1.5,
        climb=1.0,
        descent=1.0,
        turn_rate=autopilot.turn_rate,
        mission=autopilot.mission,
    ).in_mission()
    leg = ((0.0, 0.0, 0.0), (0.0, metres, 0.0))
    assert crawler.rates(1.0).from_stop_to_stop(*leg, facing=float(aside)) == pytest.approx(seconds, rel=0.06)


def level_leg(rates, metres):
    return rates.from_stop_to_stop((0.0, 0.0, -5.0), (0.0, metres, -5.0))


SUBMARINE_LEGS = [
    (1.05, 14.28, (18.79, 19.26)),
    (1.05, 30.0, (35.74, 36.39)),
    (1.0, 90.0, (96.5, 97.4)),
    (0.8, 20.0, (31.6, 31.9)),
    (0.6, 80.36, (139.1, 139.7)),
]
"""Commanded speed, metres, and the least and most seconds that level legs of an ArduSub took."""


@pytest.mark.parametrize(("speed", "metres", "measured"), SUBMARINE_LEGS)
@pytest.mark.parametrize(
    "limits", [{}, {"acceleration": 0.2}], ids=["", "a type that states its acceleration"]
)
def test_a_leg_of_a_submarine_is_expected_to_take_what_was_measured(speed, metres, measured, limits):
    """It comes near to its speed at last, and nothing makes it keep the acceleration of its type."""
    expected = level_leg(submarine(speed, **limits), metres)
    assert measured[0] * 0.95 <= expected <= measured[1] * 1.05


@pytest.mark.parametrize("seconds", [2.79, 3.4, 4.1, 4.75])
def test_a_short_leg_of_a_submarine_keeps_to_its_bounds(seconds):
    """Measured: legs of 1.04 m, of which all but the first of each four began at up to 0.3 m/s."""
    rates = submarine()
    assert level_leg(rates.soonest(), 1.04) <= seconds <= level_leg(rates.latest(), 1.04)


@pytest.mark.parametrize(("metres", "seconds"), [(1.04, 8.09), (2.42, 8.78), (14.28, 22.18), (30.0, 40.36)])
def test_a_submarine_that_is_set_up_as_its_type_states_is_no_later_than_its_bound(metres, seconds):
    """Measured with WPNAV_ACCEL = 20."""
    assert seconds <= level_leg(submarine(acceleration=0.2).latest(), metres)


@given(st.floats(1.01, 50.0), st.floats(0.2, 1.05), st.floats(0.0, STILL))
def test_no_leg_that_is_cut_short_at_both_ends_is_quicker_than_its_bound(metres, speed, still):
    """One that begins and ends on an S-curve, as fast as the driver takes for standing still."""
    rates = submarine(speed)
    jerk = rates.timing.jerk
    end = (2.0 * min(still, speed / 2.0) / jerk) ** 0.5
    curve = replace(rates, timing=replace(rates.timing, still=0.0, lag=0.0, settling=0.0, unlimited=None))
    whole = level_leg(curve, metres + 2.0 * jerk * end**3 / 6.0)
    assert level_leg(rates.soonest(), metres) <= whole - 2.0 * end + 1e-9


BACK, FURTHER = (0.0, 0.0, -5.0), (60.0, 0.0, -5.0)
AFTER_LONG_LEGS = [
    (1.35, BACK, 30.0, 36.0),
    (1.35, BACK, 20.0, 28.0),
    (1.05, FURTHER, 51.42, 51.5),
    (1.35, FURTHER, 1.0, 5.0),
]
"""Commanded speed, where a leg of a mission led after one of 30 m, its metres, and the seconds it took."""


def after_a_long_leg(speed, towards, metres, bound=0):
    """Return the seconds of a leg of an ArduSub's mission after one of 30 m."""
    (autopilot,) = (each.of(quad()) for each in timings() if each.vehicle == "sub")
    rates = Rates(speed, 1.05, 1.5, autopilot.mission, bound=bound)
    begin, middle = (0.0, 0.0, -5.0), (30.0, 0.0, -5.0)
    end = (30.0 + (metres if towards == FURTHER else -metres), 0.0, -5.0)
    return rates.from_stop_to_stop(middle, end, push=rates.push(begin, middle, (0.0, 0.0)))


@pytest.mark.parametrize(("speed", "towards", "metres", "seconds"), AFTER_LONG_LEGS)
def test_a_submarine_makes_use_of_the_thrust_for_the_leg_before_or_must_lose_it(
    speed, towards, metres, seconds
):
    assert after_a_long_leg(speed, towards, metres) == pytest.approx(seconds, rel=0.15)


@pytest.mark.parametrize(("metres", "seconds"), [(1.0, 33.0), (2.0, 22.5), (5.0, 14.0)])
def test_a_short_leg_back_of_a_submarines_mission_may_wait_at_its_end(metres, seconds):
    assert seconds <= after_a_long_leg(1.35, BACK, metres, bound=1) <= 1.6 * seconds
    assert after_a_long_leg(1.35, FURTHER, metres, bound=1) < 11.0


def test_a_type_that_states_less_acceleration_goes_no_less_beyond_its_targets():
    """Nothing makes its autopilot keep that: 0.79 m were measured on legs of 12 m."""
    (autopilot,) = (each.of(quad()) for each in timings() if each.vehicle == "copter")
    figures = Capability(0.0, None, (0.0, 12.0), acceleration=1.0).timing("STEP", autopilot.step)
    slow = Kinematics(5.0, 0.0, 12.0, 2.5, 1.5, figures)
    assert slow.beyond(HERE, (12.0, 0.0, 20.0), 6.0)[0] >= 12.79


def checked(robot, **movement):
    """Return the input of the check of a quadcopter."""
    contributions, kind = installed(), quad()
    kind = replace(
        kind,
        part=replace(kind.part, attributes={"maxAltitude": 120.0}),
        capabilities=tuple(replace(each, **movement) for each in kind.capabilities),
    )
    kinds = contributions.robot_kinds, contributions.move_kinds
    return CheckInput(program(robot), {kind.name: kind}, *kinds, ())


def bounds(*moves, **movement):
    """Return the bounds of the moves of a robot between take-off and landing, by the check."""
    robot = robot_program("alpha", [take_off("up", 20.0), *moves, LAND])
    given = checked(robot, **movement)
    found = durations_of(given, robot, motions(given)["alpha"]).of
    return {robot.moves[index].id: each for index, each in found.items()}


@given(st.lists(st.sampled_from([1.0, 3.0, 9.0, 15.0, 30.0, 100.0]), min_size=3, max_size=9))
@settings(max_examples=many(20))
def test_bounds_of_legs_that_are_passed_are_no_less_than_what_passing_takes(lengths):
    norths = accumulate(lengths)
    legs = [replace(go_to(f"m{index}", (0.0, north, 20.0)), flows=True) for index, north in enumerate(norths)]
    robot = robot_program("alpha", [take_off("up", 20.0), *legs, LAND])
    inner = range(2, len(legs) + 1)
    fluid = {index: replace(robot.transitions[index], fluid=True) for index in inner}
    robot = replace(robot, transitions={**robot.transitions, **fluid})
    given = checked(robot, acceleration=5.0)
    most = durations_of(given, robot, motions(given)["alpha"]).of
    planned = {
        each.index: each.seconds
        for each in planned_moves(robot, target_input(program(robot), given.types.values()))
    }
    spread = 1.0 + ARDUCOPTER.pacing.mission.spread
    for index in range(2, len(legs) + 2):
        assert most[index].moved.high >= spread * planned[index].expected - 1e-9


def test_the_last_leg_of_a_run_takes_until_the_program_notices():
    """PX4s took two seconds longer for it in each of seven flights."""
    legs = [go_to(f"m{north}", (0.0, north, 20.0)) for north in (20.0, 40.0, 60.0)]
    robot = robot_program("alpha", [take_off("up", 20.0), *legs, LAND])
    fluid = {index: replace(robot.transitions[index], fluid=True) for index in (2, 3)}
    robot, given = replace(robot, transitions={**robot.transitions, **fluid}), checked(robot)
    kinematics = replace(kinematics_of(given, robot), noticing=2.5)
    passages = Passages(robot, None, given.move_kinds, kinematics, local=False)
    first, middle, last = (passages.kinematics(leg).timing.settling for leg in legs)
    assert (middle - first, last - middle) == (0.0, 2.5)


def test_the_first_leg_of_a_run_takes_what_the_vehicle_takes_to_set_out():
    """A rover's took 1.2 s longer, and its last one less, in each of five runs."""
    legs = [go_to(f"m{north}", (0.0, north, 20.0)) for north in (20.0, 40.0, 60.0)]
    robot = robot_program("alpha", [*legs])
    fluid = {index: replace(robot.transitions[index], fluid=True) for index in (1, 2)}
    robot, given = replace(robot, transitions={**robot.transitions, **fluid}), checked(robot)
    plain = replace(kinematics_of(given, robot), turning_radius=1.2)

    def passed(starting):
        kinematics = replace(plain, mission=replace(plain.mission, starting=starting))
        passages = Passages(robot, None, given.move_kinds, kinematics, local=False)
        return passages.ahead(legs[0], ((0.0, 0.0, 20.0), (0.0, 20.0, 20.0)))

    late, at_once = passed(1.2), passed(0.0)
    assert (late.saved, late.onward) == pytest.approx((at_once.saved - 1.2, at_once.onward + 1.2))


def legs_of(rates, lengths, aside=0.0):
    """Yield the legs of a route between passed places, their pushes and seconds; it turns right, then left.

    The robot comes to the first and from the last of them by legs of the same lengths.
    """
    here, course, route = (0.0, 0.0, 0.0), 0.0, []
    for index, length in enumerate((lengths[0], *lengths, lengths[-1])):
        course = radians(aside) if index % 2 else 0.0
        there = (here[0] + length * sin(course), here[1] + length * cos(course), 0.0)
        route.append((here, there))
        here = there
    passage, push = Passage(0.0, 0.0), STANDING
    for leg, after in pairwise(route):
        before, passage = passage, passed(rates, leg, after, passage, push=push)
        if leg is not route[0]:
            yield leg, push, rates.from_stop_to_stop(*leg, push=push) - before.onward - passage.saved
        push = rates.push(*leg, push)


def taken(rates, lengths, aside=0.0):
    """Return the mean of the seconds of such legs."""
    return mean(seconds for _, _, seconds in legs_of(rates, lengths, aside))


PX4_LEGS = [
    (3.0, 25.0, (13.3, 13.5)),
    (3.0, 30.0, (14.7, 14.9)),
    (5.0, 12.0, (6.3, 8.5)),
    (5.0, 25.0, (10.3, 12.3)),
    (5.0, 30.0, (11.3, 13.8)),
    (5.0, 100.0, (25.0, 29.1)),
]
"""Commanded speed, metres, and the least and most seconds that legs of a PX4 took, first ones left out."""


@pytest.mark.parametrize(("speed", "metres", "measured"), PX4_LEGS)
def test_a_leg_of_a_px4_is_expected_to_take_what_was_measured(speed, metres, measured):
    figures = PX4_MULTICOPTER.pacing.step
    rates = Rates(speed, figures.climb, figures.descent, figures)
    least, most = measured
    assert level_leg(rates, metres) == pytest.approx((least + most) / 2.0, rel=0.08)
    assert level_leg(rates.soonest(), metres) < least
    assert level_leg(rates.latest(), metres) > most


PX4_PASSES = [
    (5.0, 30.0, 45.0, 8.1),
    (5.0, 30.0, 90.0, 9.5),
    (5.0, 30.0, 135.0, 10.4),
    (5.0, 20.0, 150.0, 8.0),
    (5.0, 12.0, 90.0, 4.8),
    (9.0, 30.0, 20.0, 5.2),
    (9.0, 30.0, 135.0, 9.5),
    (5.0, 5.0, 0.0, 1.8),
    (9.0, 10.0, 0.0, 2.2),
    (9.0, 15.0, 0.0, 2.4),
    (5.0, 20.0, 0.0, 4.2),
    (9.0, 30.0, 0.0, 3.6),
    (5.0, 60.0, 0.0, 12.3),
    (3.0, 12.0, 180.0, 6.4),
]
"""Speed, metres, degrees to the right and the left between which they are, and the mean of eight legs."""


@pytest.mark.parametrize(("speed", "metres", "degrees", "measured"), PX4_PASSES)
def test_a_px4_that_passes_places_on_a_mission_takes_what_was_measured(speed, metres, degrees, measured):
    figures = PX4_MULTICOPTER.pacing.mission
    assert figures is not None
    rates = Rates(speed, figures.climb, figures.descent, figures)
    assert taken(rates, [metres] * 8, degrees) == pytest.approx(measured, rel=0.1)


@pytest.mark.parametrize(
    ("speed", "metres", "degrees", "measured"),
    [(1.0, 10.0, 45.0, 10.0), (2.0, 20.0, 90.0, 10.1), (3.0, 30.0, 90.0, 11.1), (4.0, 40.0, 60.0, 11.5)],
)
def test_a_rover_that_passes_places_on_a_mission_takes_what_was_measured(speed, metres, degrees, measured):
    """Flown by ArduRover 4.7-dev; 2 m/s judges what the others calibrated."""
    (autopilot,) = (each.of(quad()) for each in timings() if each.vehicle == "rover")
    assert taken(Rates(speed, 1.0, 1.0, autopilot.mission), [metres] * 8, degrees) == pytest.approx(
        measured, rel=0.05
    )


def test_a_px4_stops_for_a_place_that_is_higher_or_lower_and_does_not_settle():
    """Legs of 15 m at 5 m/s with 3 m up or down took 5.1 to 5.5 s on a mission."""
    figures = PX4_MULTICOPTER.pacing.mission
    assert figures is not None
    rates = Rates(5.0, figures.climb, figures.descent, figures)
    route = [(0.0, 15.0 * index, 3.0 * index) for index in range(9)]
    passage, push, found = Passage(0.0, 0.0), STANDING, []
    for leg, after in pairwise(pairwise(route)):
        before, passage = passage, passed(rates, leg, after, passage, push=push)
        found.append(rates.from_stop_to_stop(*leg, push=push) - before.onward - passage.saved)
        push = rates.push(*leg, push)
    assert mean(found[1:]) == pytest.approx(5.3, rel=0.1)


@pytest.mark.parametrize("turn", [0.0, 0.5, 20.0, 90.0, 135.0, 179.0, 180.0])
@pytest.mark.parametrize("metres", [0.3, 1.0, 3.0, 8.0, 30.0, 100.0])
@pytest.mark.parametrize("speed", [1.0, 5.0, 12.0])
def test_what_a_px4_is_expected_to_take_between_corners_is_within_the_bounds(speed, metres, turn):
    """So it is of a type that states a narrow spread; a corner costs no more than a stop there."""
    assert PX4_MULTICOPTER.pacing.mission is not None
    figures = replace(PX4_MULTICOPTER.pacing.mission, spread=0.05)
    rates = Rates(speed, figures.climb, figures.descent, figures)
    for leg, push, seconds in legs_of(rates, [metres] * 3, turn):
        assert rates.soonest().eased(*leg) <= seconds + 1e-9
        assert seconds <= rates.latest().from_stop_to_stop(*leg, push=push) + 1e-9


def test_a_px4_lands_as_long_as_was_measured_and_within_the_bounds_of_launch_and_landing():
    """From 12 m, missions took 13.4 to 15.7 s for it, and 14.5 s in the mean; programs, 18.6 s in the mean.

    With the default LNDMC_Z_VEL_MAX, they took up to 32.3 s.
    """
    robot = robot_program("alpha", [take_off("up", 12.0), LAND])
    given = checked(robot)
    (kind,) = given.types.values()
    px4 = replace(kind, devices=quad(**{"mavlink.autopilot": "px4"}).devices)
    kinds = as_uploaded(given.robot_kinds)
    given = replace(given, types={kind.name: px4}, robot_kinds=kinds)
    assert 14.5 <= kinematics_of(given, robot).landing(12.0) <= 18.6 - 2.0
    landing = durations_of(given, robot, motions(given)["alpha"]).of[robot.stop - 1]
    assert landing.moved.low <= 13.4
    assert landing.moved.high >= 32.3


def test_a_leg_may_be_as_quick_as_commanded_in_a_wind_that_may_slow_it_down():
    """ArduCopter flew 25 m at 5 m/s in a wind of 9 m/s, in 8.0 s with it and in 9.8 s against it."""
    robot = robot_program("alpha", [take_off("up", 20.0), go_to("there", (0.0, 25.0, 20.0), speed=5.0), LAND])
    given = checked(robot)
    (kind,) = given.types.values()
    slow = replace(kind, capabilities=(replace(kind.capabilities[0], speed=(0.0, 12.0)),))
    given = replace(given, types={kind.name: slow}, environment={"windSpeed": 9.0})
    found = durations_of(given, robot, motions(given)["alpha"]).of[2].moved
    assert found.low <= 7.9
    assert found.high >= 9.9


def on_the_spot(name, **attributes):
    return move(name, name, **attributes)


def test_a_turn_takes_as_long_as_the_autopilot_that_is_slower_than_the_type():
    """52 degrees per second were measured with ArduCopter where types stated 90."""
    turn = bounds(on_the_spot("HeadTo"), turn_rate=90.0)["HeadTo"].moved
    assert turn.low == 0.0
    assert 180.0 / 52.0 < turn.high < 180.0 / 40.0


def test_a_slow_type_turns_at_its_own_rate():
    assert bounds(on_the_spot("HeadTo"), turn_rate=20.0)["HeadTo"].moved.high > 9.0


def test_a_leg_of_no_length_takes_some_time_at_most():
    """Measured: 0.0 to 0.5 s one by one."""
    zero = bounds(go_to("there", (0.0, 10.0, 20.0)), go_to("again", (0.0, 10.0, 20.0)))["again"].moved
    assert zero.low == 0.0
    assert zero.high >= 0.5


def passage_of(timing=None, actions=()):
    """Return what is saved at the end of the second of three legs in line; None: the robot stops there."""
    legs = [go_to("first", (0.0, 20.0, 20.0)), replace(go_to("second", (0.0, 40.0, 20.0)), after=actions)]
    legs += [go_to("third", (0.0, 60.0, 20.0))]
    robot = robot_program("alpha", [take_off("up", 20.0), *legs, LAND])
    fluid = {index: replace(robot.transitions[index], fluid=True) for index in (2, 3)}
    robot, given = replace(robot, transitions={**robot.transitions, **fluid}), checked(robot)
    kinematics = kinematics_of(given, robot)
    kinematics = kinematics if timing is None else replace(kinematics, timing=timing, mission=timing)
    passages = Passages(robot, None, given.move_kinds, kinematics, local=True)
    return passages.ahead(robot.moves[3], ((0.0, 20.0, 20.0), (0.0, 40.0, 20.0)))


def test_vehicles_that_stop_at_each_place_save_nothing_there():
    """ArduSub on missions: legs of 12 m in line took 15.4 to 18.7 s; PX4 leg by leg: 15 m took 8.9 s."""
    assert passage_of() is not None
    assert passage_of(ARDUSUB.pacing.mission) is None
    assert passage_of(PX4_MULTICOPTER.pacing.step) is None


def test_a_leg_that_ends_with_an_action_ends_with_a_stop_unless_it_only_notifies():
    """PX4 took photos at places 15 m apart, in 9 s each."""
    photo, notify = Action((DEVICE_ACTION,), "photo", "camera"), Action((NOTIFY,))
    assert passage_of(actions=(notify,)) is not None
    assert passage_of(actions=(photo,)) is None


def test_a_px4_slows_down_on_a_leg_that_it_enters_faster_than_that_is_commanded():
    """Legs of 20 m by turns at 9 and at 2 m/s: the slow ones took 6.0 to 7.0 s instead of 10 s."""
    figures = PX4_MULTICOPTER.pacing.mission
    assert figures is not None
    fast, slow = (Rates(speed, figures.climb, figures.descent, figures) for speed in (9.0, 2.0))
    before, leg, after = (((0.0, 20.0 * n, 0.0), (0.0, 20.0 * n + 20.0, 0.0)) for n in range(3))
    entering = passed(fast, before, leg, None, slow)
    leaving = passed(slow, leg, after, entering, fast, fast.push(*before, STANDING))
    assert entering.speed > 4.0
    push = fast.push(*before, STANDING)
    seconds = slow.from_stop_to_stop(*leg, push=push) - entering.onward - leaving.saved
    assert seconds == pytest.approx(6.5, rel=0.1)


def test_an_underwater_vehicle_loses_the_thrust_of_a_fast_leg_on_a_slow_one_back():
    """ArduSub took 48.9 s for 12 m at 0.4 m/s back, after as much at 1.2 m/s; 29 s of that are even speed."""
    figures = ARDUSUB.pacing.mission
    assert figures is not None
    fast, slow = (Rates(speed, figures.climb, figures.descent, figures) for speed in (1.2, 0.4))
    push = slow.push((0.0, 0.0, 0.0), (0.0, 12.0, 0.0), STANDING)
    push = fast.push((0.0, 12.0, 0.0), (0.0, 24.0, 0.0), push)
    back = slow.from_stop_to_stop((0.0, 24.0, 0.0), (0.0, 12.0, 0.0), push=push)
    assert back == pytest.approx(48.9, rel=0.1)


def test_legs_in_line_of_an_underwater_vehicle_lag_at_each_stop():
    """ArduSub took 16.1, 15.6, 15.4 and 16.2 s for legs of 12 m at 1 m/s in line."""
    figures = ARDUSUB.pacing.mission
    assert figures is not None
    rates, push, found = Rates(1.0, figures.climb, figures.descent, figures), STANDING, []
    for leg in pairwise((0.0, 12.0 * index, -3.0) for index in range(6)):
        found.append(rates.from_stop_to_stop(*leg, push=push))
        push = rates.push(*leg, push)
    assert mean(found[1:]) == pytest.approx(15.8, rel=0.03)


def test_a_stop_takes_until_the_next_heartbeat():
    """Measured: up to 1.7 s."""
    found = bounds()
    assert found["stop"].moved.high >= 1.7
    assert found["start"].moved.high >= 0.3


def test_a_stay_is_noticed_a_little_later():
    """Measured: 10.00 to 10.19 s, and none at all where nothing is to be waited for."""
    assert bounds(on_the_spot("HoldPosition", duration=10.0))["HoldPosition"].moved.high >= 10.19
    assert bounds(on_the_spot("HoldPosition", duration=0.0))["HoldPosition"].moved.high > 0.0


def test_charging_may_end_at_once_or_take_as_long_as_the_driver_does_not_complain():
    charging = bounds(on_the_spot("Recharge", duration=600.0))["Recharge"].moved
    assert charging.low == 0.0
    assert charging.high >= CHARGING_FACTOR * 600.0


@pytest.mark.parametrize("profile", [ARDUCOPTER, ARDUSUB, PX4_MULTICOPTER], ids=lambda each: each.name)
def test_every_autopilot_that_turns_says_how_fast_and_reports_at_last(profile):
    assert profile.pacing.turn_rate <= 60.0
    assert profile.pacing.step.reporting >= 2.0


def test_each_class_of_vehicle_that_a_profile_carries_takes_its_time():
    """Nearly all legs that a tracked robot drove were outside bounds without any width."""
    found = {each.vehicle: each.of(quad()) for each in timings()}
    assert found.keys() == {word for profile in PROFILES.values() for word in profile.words}
    assert found["ground"] == found["rover"]
