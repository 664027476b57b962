"""Whether a vehicle that stands somewhere is the robot's, and not that of another one."""

from contextlib import nullcontext
from dataclasses import replace
from math import inf

import pytest
from flight_crew import HOME, manned, robot_of
from mavlink_peer import ARDUPILOT, PX4, linked
from patience import until
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.program import Geographic
from mmrs_mavlink.vehicles.footing import aside
from mmrs_mavlink.vehicles.recognition import other_times, recognise, refuse_neighbours
from mmrs_runtime.faults import RefusedError


def north(metres: float) -> Geographic:
    return Geographic(HOME.latitude + metres / 111_080.0, HOME.longitude, 0.0)


def beside(metres: float):
    """Return a robot whose neighbours' homes are so far north of its own, and as far south."""
    return replace(robot_of(), neighbours=(("Brezza", north(metres)), ("Cirro", north(-metres))))


def test_a_vehicle_at_the_home_of_another_robot_is_that_ones():
    with pytest.raises(
        RefusedError, match="0 m from the home of 'Brezza' and 8 m from that of its program: are"
    ):
        refuse_neighbours(beside(8.0), HOME, north(8.0))


def test_a_vehicle_that_is_nearer_to_another_home_than_to_its_own_is_refused():
    with pytest.raises(RefusedError, match="'Cirro'"):
        refuse_neighbours(beside(8.0), HOME, north(-4.3))


@pytest.mark.parametrize(("apart", "away"), [(8.0, 3.7), (8.0, -3.7), (3.0, 1.8), (1.0, 1.0), (60.0, 19.0)])
def test_a_vehicle_near_its_own_home_is_the_robots(apart, away):
    refuse_neighbours(beside(apart), HOME, north(away))


def test_a_vehicle_that_its_program_has_landed_elsewhere_belongs_there_and_not_at_home():
    robot = beside(60.0)
    refuse_neighbours(robot, north(55.0), north(53.0))
    words = r"4 m from the home of 'Brezza' and 9 m from where its program has landed it: are"
    with pytest.raises(RefusedError, match=words):
        refuse_neighbours(robot, north(55.0), north(64.0))


def test_a_robot_alone_has_nobody_to_be_taken_for():
    refuse_neighbours(robot_of(), HOME, north(19.0))


@pytest.fixture
def found(in_the_air):
    """Return a function that gives a vehicle in the air, in a mode, as a process finds it that goes on."""

    def fly(mode: str, parameters: dict[str, float]):
        made = in_the_air()
        with made.simulated.lock:
            made.simulated.autopilot.parameters |= parameters
        made.simulated.faults.begin("stick", mode)
        until(lambda: made.vehicle.telemetry.mode() == made.simulated.autopilot.numbers[mode])
        made.vehicle.take_back()
        return made

    return fly


def recognised(made) -> None:
    recognise(made.link, made.vehicle, made.robot, inf, (HOME,), under_way=True, system=0)


@pytest.mark.parametrize(("mode", "answer"), [("return", 1.0), ("smart_return", 3.0), ("guided", 0.0)])
def test_a_vehicle_that_does_by_itself_what_it_does_about_a_lost_link_is_gone_on_with(found, mode, answer):
    recognised(found(mode, {"FS_GCS_ENABLE": answer}))


@pytest.mark.parametrize(
    ("mode", "answer"), [("return", 5.0), ("return", 0.0), ("altitude_hold", 1.0), ("smart_return", 1.0)]
)
def test_a_vehicle_that_does_otherwise_may_have_a_pilot(found, mode, answer):
    with pytest.raises(RefusedError, match="a pilot may have it"):
        recognised(found(mode, {"FS_GCS_ENABLE": answer}))


def test_a_vehicle_that_does_not_tell_what_it_does_about_a_lost_link_may_have_a_pilot(found):
    made = found("return", {"FS_GCS_ENABLE": 1.0})
    with made.simulated.lock:
        del made.simulated.autopilot.parameters["FS_GCS_ENABLE"]
    with pytest.raises(RefusedError, match="a pilot may have it"):
        recognised(made)


PERCH = north(72.0)


@pytest.mark.parametrize(
    ("starts", "away", "words"),
    [
        ((HOME,), 72.0, "72 m from the home of its program: carry it home"),
        ((PERCH,), 0.0, "72 m from where its program has landed it: carry it to 42.370648, 13.350000"),
        ((HOME, PERCH), 100.0, "28 m from where its program has landed it: carry it to 42.370648, 13.350000"),
        ((HOME, PERCH), 30.0, "30 m from the home of its program: carry it home"),
        ((HOME, PERCH), 70.0, ""),
        ((HOME, PERCH), 3.0, ""),
    ],
)
def test_a_vehicle_whose_run_is_resumed_stands_where_its_log_leaves_it_or_is_to_be_carried_there(
    starts, away, words
):
    with manned() as made:
        with made.simulated.lock:
            made.simulated.autopilot.body.position = (away, 0.0, 0.0)
        until(lambda: aside(made.vehicle.state().place, north(away)) < 0.5)
        with pytest.raises(RefusedError) if words else nullcontext() as refused:
            recognise(made.link, made.vehicle, made.robot, 20.0, starts, under_way=True, system=0)
        if words:
            assert str(refused.value) == f"the vehicle is {words}"
        else:
            assert made.vehicle.start == (PERCH if away > 50.0 else HOME)


@pytest.mark.parametrize(
    ("planned", "found", "number"), [("ardupilot", "px4", PX4), ("px4", "ardupilot", ARDUPILOT)]
)
def test_an_autopilot_that_its_times_were_not_planned_for_is_reported(planned, found, number):
    with linked(autopilot=number) as (link, _):
        assert other_times(link, robot_of(autopilot=planned)) == (
            f"the vehicle's autopilot is {found}, and it was planned for {planned} (warning: its legs take"
            f" other times than planned: set mavlink.autopilot = {found} in its robot type, and plan again)"
        )


@pytest.mark.parametrize(
    ("planned", "number"),
    [("ardupilot", ARDUPILOT), ("px4", PX4), ("ardupilot", mavlink.MAV_AUTOPILOT_GENERIC)],
)
def test_nothing_is_reported_of_an_autopilot_that_was_planned_for_or_has_no_times(planned, number):
    with linked(autopilot=number) as (link, _):
        assert other_times(link, robot_of(autopilot=planned)) == ""
