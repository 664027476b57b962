"""What a vehicle does by its failsafes: taken back from, and into which modes, as simulated ones do it."""

from __future__ import annotations

import pytest

from mmrs_mavlink.profiles import PX4_MULTICOPTER, profile_for
from mmrs_mavlink.program import Policy
from mmrs_mavlink.sitl import failsafes, px4_failsafes
from mmrs_mavlink.sitl.modes import MODES

ON = "BATT_FS_LOW_ACT"


def set_parameter(made, name: str, value: float) -> None:
    with made.simulated.lock:
        made.simulated.autopilot.parameters[name] = value


def said(made, words: str) -> bool:
    return any(words in line for line in made.said)


def test_an_altitude_hold_that_the_vehicle_names_is_its_own(in_the_air):
    made = in_the_air(Policy("POSITION_LOST", "RETURN", 1000.0))
    set_parameter(made, "FS_EKF_ACTION", 2.0)
    made.simulated.faults.begin("gps-lost")
    fault = made.caught()
    assert fault.event == "POSITION_LOST"
    assert made.mode == "alt_hold"


def test_an_altitude_hold_that_a_pilot_chose_is_not(in_the_air):
    made = in_the_air(Policy("POSITION_LOST", "LAND", 1000.0))
    set_parameter(made, "FS_EKF_ACTION", 0.0)
    made.simulated.faults.begin("gps-lost")
    made.simulated.faults.begin("stick", "alt_hold")
    assert made.caught().event == "TAKEN_OVER"


def test_a_robot_that_is_to_go_on_without_a_position_is_landed_where_the_vehicle_gives_up(in_the_air):
    made = in_the_air(Policy("POSITION_LOST", "CONTINUE"))
    made.simulated.faults.begin("gps-lost")
    fault = made.caught()
    assert (fault.event, fault.instead) == ("POSITION_LOST", "LAND")
    assert "without a position it cannot be taken back" in str(fault)


CASES = [
    *(
        (kind, {"FS_GCS_ENABLE": float(value)}, names)
        for kind, answers in failsafes.ON_LINK_LOSS.items()
        for value, names in answers.items()
    ),
    *(
        ("rover", {"FS_GCS_ENABLE": 1.0, "FS_ACTION": float(value)}, names)
        for value, names in failsafes.ROVER_ACTIONS.items()
    ),
]
CONTINUING = frozenset({3})
"""AUTO, in which a copter may be left, which the simulated vehicle does not know."""


def numbered(kind: str, names) -> set[int]:
    return {MODES[kind][name] for name in names if name in MODES[kind]}


@pytest.mark.parametrize(("kind", "values", "names"), CASES)
def test_an_ardupilot_goes_into_the_modes_that_are_expected_of_it(kind, values, names):
    expected = profile_for(kind).lost_link.modes_by(values)
    assert expected - CONTINUING == numbered(kind, names)


@pytest.mark.parametrize(("action", "names"), px4_failsafes.ON_LINK_LOSS.items())
def test_a_px4_does_too_and_may_hold_before(action, names):
    expected = PX4_MULTICOPTER.lost_link.modes_by({"NAV_DLL_ACT": float(action)})
    before = {"loiter"} if {"return", "land"} & {*names} else set()
    assert expected == numbered("px4", {*names} | before)


BY_HAND = {"poshold", "alt_hold", "stabilize"}
"""Modes in which a PX4 leaves the vehicle to its pilot: they are not taken for a failsafe."""


@pytest.mark.parametrize(("action", "names"), px4_failsafes.ON_SETPOINT_LOSS.items())
def test_a_px4_that_misses_set_points_does_too(action, names):
    expected = PX4_MULTICOPTER.lost_link.modes_by({"COM_OBL_RC_ACT": float(action)})
    assert expected == numbered("px4", {*names} - BY_HAND)


@pytest.mark.parametrize("kind", ["copter", "sub", "rover"])
@pytest.mark.parametrize("values", [{}, {"FS_GCS_ENABLE": 0.0, "FS_ACTION": 1.0}])
def test_nothing_is_expected_of_a_vehicle_whose_failsafe_is_off_or_not_known(kind, values):
    assert profile_for(kind).lost_link.modes_by(values) == frozenset()


@pytest.mark.parametrize("kind", ["copter", "sub", "rover"])
def test_whatever_a_vehicle_is_told_to_do_about_a_lost_link_is_known(kind):
    stays = {"CONTINUE", "STOP_THRUST"}
    for response, values in profile_for(kind).lost_link.answers.items():
        assert bool(profile_for(kind).lost_link.modes_by(values)) is (response not in stays)
