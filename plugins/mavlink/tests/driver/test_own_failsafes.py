"""What a vehicle does by its failsafes: what it is taken back from."""

from dataclasses import replace

import pytest
from flight_crew import HOME, manned, robot_of

from mmrs_mavlink.profiles import profile_for
from mmrs_mavlink.program import Policy
from mmrs_mavlink.services.uploads import Uploads

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
    assert made.mode == "altitude_hold"


def test_an_altitude_hold_that_a_pilot_chose_is_not(in_the_air):
    made = in_the_air(Policy("POSITION_LOST", "LAND", 1000.0))
    set_parameter(made, "FS_EKF_ACTION", 0.0)
    made.simulated.faults.begin("gps-lost")
    made.simulated.faults.begin("stick", "altitude_hold")
    assert made.caught().event == "TAKEN_OVER"


def test_a_robot_that_is_to_go_on_without_a_position_is_landed_where_the_vehicle_gives_up(in_the_air):
    made = in_the_air(Policy("POSITION_LOST", "CONTINUE"))
    made.simulated.faults.begin("gps-lost")
    fault = made.caught()
    assert (fault.event, fault.instead) == ("POSITION_LOST", "LAND")
    assert "without a position it cannot be taken back" in str(fault)


@pytest.mark.parametrize(("answered", "event"), [(1.0, "FENCE_BREACHED"), (0.0, "TAKEN_OVER")])
def test_a_rover_that_returns_from_its_fence_is_no_pilots_although_it_says_nothing(answered, event):
    with manned(robot_of(Policy("FENCE_BREACHED", "RETURN"), vehicle="rover"), kind="rover") as made:
        made.vehicle.prepare(Uploads())
        made.watch.renew()
        made.vehicle.go_to(replace(HOME, latitude=42.3701), 2.0, None, False)
        for name, value in {"FENCE_ENABLE": 1.0, "FENCE_ACTION": answered}.items():
            set_parameter(made, name, value)
        made.watch.relax({"FENCE_BREACHED"}, "RETURN")
        made.simulated.faults.begin(*(("breach",) if answered else ("stick", "return")))
        fault = made.caught()
        assert (fault.event, made.mode) == (event, "return")


@pytest.mark.parametrize("kind", ["copter", "sub", "rover"])
@pytest.mark.parametrize("values", [{}, {"FS_GCS_ENABLE": 0.0, "FS_ACTION": 1.0}])
def test_nothing_is_expected_of_a_vehicle_whose_failsafe_is_off_or_not_known(kind, values):
    assert profile_for(kind).lost_link.modes_by(values) == frozenset()


@pytest.mark.parametrize("kind", ["copter", "sub", "rover"])
def test_whatever_a_vehicle_is_told_to_do_about_a_lost_link_is_known(kind):
    stays = {"CONTINUE", "STOP_THRUST"}
    for response, values in profile_for(kind).lost_link.answers.items():
        assert bool(profile_for(kind).lost_link.modes_by(values)) is (response not in stays)
