"""When a battery is low: by the reserve, and by the way back from where the robot is."""

from math import cos, dist, inf, radians, sqrt

import pytest

from mmrs_mavlink.program import Local, Robot, Travel
from mmrs_mavlink.steps.energy import ACCELERATION, TURNING_SECONDS, MeanWind, Reserve, seconds_back
from mmrs_runtime.controllers.return_paths import way_back
from mmrs_runtime.controllers.state import State

HOME = Local(0.0, 0.0, 0.0)
TRACK = [("up", Local(0.0, 0.0, 10.0)), ("a", Local(300.0, 0.0, 10.0)), ("b", Local(300.0, 100.0, 10.0))]


def robot(**more):
    given = {"endurance": 1000.0, "cruise": 5.0, "travel": Travel(descent=1.0), "reserve": 0.1} | more
    return Robot("r", "r.jsonl", "copter", HOME, "start", (), **given)


def state(energy, *, time=100.0, place=TRACK[-1][1], armed=True, **wind):
    return State(time, place, 5.0, 0.0, energy, armed=armed, **wind)


STOP = 5.0 / ACCELERATION
"""Seconds that speeding up to five metres a second, and stopping, take more than going on."""

LANDING = 10.0 / 0.5 + 3.0
"""Seconds that an ArduCopter takes from ten metres until it is disarmed."""


def test_the_way_back_is_the_way_that_the_robot_came_with_its_corners_and_the_descent():
    assert seconds_back(robot(), state(0.5), "RETURN", TRACK) == pytest.approx(
        400.0 / 5.0 + 2 * STOP + TURNING_SECONDS + LANDING
    )
    assert seconds_back(robot(), state(0.5), "LAND", TRACK) == pytest.approx(LANDING)


def test_an_emergency_area_ends_the_way_back_where_it_is_left_for():
    given = robot(escapes=(("a", (Local(300.0, -50.0, 10.0),)),))
    assert list(way_back(given, "EMERGENCY_AREA", TRACK, TRACK[-1][1]))[-1] == Local(300.0, -50.0, 10.0)
    seconds = (100 + 50) / 5.0 + STOP + TURNING_SECONDS + LANDING
    assert seconds_back(given, state(0.5), "EMERGENCY_AREA", TRACK) == pytest.approx(seconds)


def test_head_wind_makes_the_way_longer_and_tail_wind_no_shorter():
    against = seconds_back(robot(), state(0.5, wind=2.5, wind_from=180.0), "RETURN", TRACK)
    behind = seconds_back(robot(), state(0.5, wind=2.5, wind_from=0.0), "RETURN", TRACK)
    assert against == pytest.approx(120.0 + 20.0 + 1.5 * STOP + TURNING_SECONDS + LANDING)
    assert behind == pytest.approx(80.0 + 2 * STOP + TURNING_SECONDS + LANDING)


def test_short_legs_around_corners_are_slow():
    bends = [("up", Local(0.0, 0.0, 10.0))]
    bends += [(f"p{n}", Local(8.0 * n, 8.0 * (n % 2), 10.0)) for n in range(1, 26)]
    legs = [dist((8.0 * n, 8.0 * (n % 2)), (8.0 * n + 8.0, 8.0 * ((n + 1) % 2))) for n in range(25)]
    flown = sum(2.0 * sqrt(leg / ACCELERATION) for leg in legs)
    found = seconds_back(robot(cruise=15.0), state(0.5, place=bends[-1][1]), "RETURN", bends)
    assert found == pytest.approx(flown + TURNING_SECONDS + LANDING)


def test_a_leg_that_comes_down_takes_as_long_as_that():
    steep = [("up", Local(0.0, 0.0, 10.0)), ("a", Local(30.0, 0.0, 50.0))]
    found = seconds_back(robot(), state(0.5, place=steep[-1][1]), "RETURN", steep)
    assert found > 40.0 + TURNING_SECONDS + LANDING


def test_the_reserve_counts_wherever_the_robot_is():
    assert Reserve(robot()).low(state(0.11, place=TRACK[0][1]), "LAND", TRACK[:1]) == ""
    assert "less than 10%" in Reserve(robot()).low(state(0.09, place=TRACK[0][1]), "LAND", TRACK[:1])


def test_the_point_of_no_return_comes_before_the_reserve_far_from_home():
    assert Reserve(robot()).low(state(0.18), "RETURN", TRACK) == ""
    assert "point of no return: 13%" in Reserve(robot()).low(state(0.13), "RETURN", TRACK)


def test_a_battery_that_empties_faster_than_the_type_says_is_believed():
    watched = Reserve(robot())
    assert watched.low(state(1.0, time=0.0), "RETURN", TRACK) == ""
    assert "point of no return" in watched.low(state(0.5, time=50.0), "RETURN", TRACK)


def test_there_is_no_point_of_no_return_for_who_stays():
    assert Reserve(robot()).low(state(0.11), "HOLD", TRACK) == ""


def test_a_robot_that_can_do_more_keeps_its_pace_against_the_wind_as_long_as_that_suffices():
    def against(wind):
        known = state(0.5, wind=wind, wind_from=180.0)
        return seconds_back(robot(fastest=10.0), known, "RETURN", TRACK)

    calm = 400.0 / 5.0 + 2 * STOP + TURNING_SECONDS + LANDING
    assert against(4.0) == pytest.approx(calm)
    assert against(8.0) == pytest.approx(calm - 300.0 / 5.0 - STOP + 300.0 / 2.0 + 2.0 / ACCELERATION)
    assert against(9.8) == inf


def test_a_gust_is_not_the_wind_of_the_whole_way_back():
    watched = Reserve(robot(fastest=10.0))
    for second in range(60):
        now = state(0.9, time=float(second), wind=11.0 if second % 10 == 9 else 4.0, wind_from=180.0)
        assert watched.low(now, "RETURN", TRACK) == "", second


def test_a_wind_that_stays_is_believed_within_a_minute():
    watched = Reserve(robot(fastest=10.0))
    for second in range(300):
        watched.low(state(0.9, time=float(second), wind=4.0, wind_from=180.0), "RETURN", TRACK)
    whys = [
        watched.low(state(0.9, time=300.0 + second, wind=14.0, wind_from=180.0), "RETURN", TRACK)
        for second in range(60)
    ]
    assert (whys[0], "the wind is stronger" in whys[-1]) == ("", True)


def test_a_wind_that_turns_is_averaged_as_what_it_does():
    mean = MeanWind()
    for second in range(0, 20, 2):
        mean.with_mean(state(0.9, time=float(second), wind=6.0, wind_from=350.0))
        found = mean.with_mean(state(0.9, time=second + 1.0, wind=6.0, wind_from=10.0))
    assert found.wind_from == pytest.approx(0.0, abs=1.0) or found.wind_from == pytest.approx(360.0, abs=1.0)
    assert found.wind == pytest.approx(6.0 * cos(radians(10.0)), abs=0.1)


def test_a_wind_that_is_too_strong_is_a_reason_to_turn_round_at_once():
    why = Reserve(robot()).low(state(0.9, wind=6.0, wind_from=180.0), "RETURN", TRACK)
    assert "the wind is stronger than the robot" in why


def test_a_battery_that_is_told_no_longer_is_reckoned_on_from_what_was_told_last():
    watched, low = Reserve(robot()), TRACK[:1]
    assert watched.low(state(0.5, time=0.0, place=low[0][1]), "LAND", low) == ""
    assert watched.untold == ""
    assert watched.low(state(None, time=350.0, place=low[0][1]), "LAND", low) == ""
    assert watched.untold == "does not tell its battery any more: reckoned from 50%"
    watched.begin()
    assert "less than 10%" in watched.low(state(None, time=410.0, place=low[0][1]), "LAND", low)
    assert watched.low(state(0.5, time=411.0, place=low[0][1]), "LAND", low) == watched.untold == ""


def test_a_battery_that_is_told_no_longer_is_forgotten_on_the_ground():
    watched = Reserve(robot())
    watched.low(state(0.2, time=0.0), "LAND", TRACK)
    watched.low(state(None, time=5.0, armed=False), "LAND", TRACK)
    assert watched.low(state(None, time=1000.0), "LAND", TRACK) == watched.untold == ""


def test_people_are_told_where_nobody_can_reckon_a_battery_that_is_told_no_longer():
    watched = Reserve(robot(endurance=None))
    watched.low(state(0.5, time=0.0), "LAND", TRACK)
    assert watched.low(state(None, time=9.0), "LAND", TRACK) == ""
    assert "a low battery will go unnoticed" in watched.untold


@pytest.mark.parametrize("known", [state(None), state(0.01, armed=False)])
def test_nothing_is_low_that_nobody_knows_or_that_stands_on_the_ground(known):
    assert Reserve(robot()).low(known, "RETURN", TRACK) == ""
