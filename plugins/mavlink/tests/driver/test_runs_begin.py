"""Where runs of an uploaded mission begin, with vehicles that take what they are told each in their way."""

from dataclasses import replace

import pytest
from flight_crew import manned, robot_of
from patience import until
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.driving.moves import Moves
from mmrs_mavlink.program import Geographic, GoTo, Land, Look, Run, Start, Step, Stop, TakeOff, Then
from mmrs_mavlink.services import parameters
from mmrs_mavlink.services.missions import upload
from mmrs_mavlink.services.uploads import mission_of, uploads_of
from mmrs_mavlink.vehicles.mission import check_feasible, first_flown, items_for, keep_place, speed_before
from mmrs_runtime.controllers.geodesy import bearing, distance, turn
from mmrs_runtime.faults import FaultError, RefusedError

WAYS = {
    name: Geographic(42.37 + north / 111_080.0, 13.35, 10.0)
    for name, north in (("a1", 10.0), ("a2", 20.0), ("b1", 40.0), ("b2", 60.0), ("b3", 90.0))
}
MOVES = [("start", Start()), ("up", TakeOff(10.0))]
MOVES += [(name, GoTo(place, 4.0 if name == "b3" else 3.0)) for name, place in WAYS.items()]
MOVES += [("down", Land()), ("stop", Stop())]
ROBOT = replace(
    robot_of(),
    steps=tuple(
        Step(name, movement, then=Then(MOVES[index + 1][0]) if index + 1 < len(MOVES) else None)
        for index, (name, movement) in enumerate(MOVES)
    ),
    runs=(Run(("a1", "a2"), (0.0, 0.0)), Run(("b1", "b2", "b3"), (0.0, 0.0, 0.0))),
)
MISSION, FLIGHTS = mission_of(ROBOT)
UNHURRIED = replace(
    ROBOT,
    steps=tuple(
        replace(step, movement=GoTo(WAYS[step.move], None)) if step.move[0] == "b" else step
        for step in ROBOT.steps
    ),
)
"""The second run of which says no speed."""

SECOND = FLIGHTS["b1"]


def prepare(made, robot=ROBOT):
    """Have the mission uploaded; return what people are told meanwhile."""
    told = []
    made.vehicle._tell = told.append
    made.vehicle.prepare(uploads_of(robot))
    return told


def take_off(made):
    made.watch.renew()
    made.vehicle.take_off(10.0)


@pytest.fixture
def airborne():
    """Return a function that gives a robot that has taken off, with its mission uploaded."""
    opened = []

    def fly(robot=ROBOT, **settings):
        opened.append(manned(robot, **settings))
        made = opened[-1].__enter__()
        prepare(made, robot)
        take_off(made)
        return made

    yield fly
    for made in opened:
        made.__exit__(None, None, None)


@pytest.mark.parametrize("firmware", ["ardupilot", "px4"])
def test_a_run_begins_with_its_own_first_place(airborne, firmware):
    made = airborne(firmware=firmware)
    reached = []
    made.vehicle.fly(SECOND.first, SECOND.last, reached.append)
    assert reached == list(range(SECOND.first, SECOND.last + 1))
    assert distance(made.vehicle.state().place, WAYS["b3"]) < 4.0


def test_a_run_is_followed_from_its_beginning_also_where_the_mode_is_heard_of_later(airborne):
    made = airborne()
    link, run, reached = made.link, FLIGHTS["a1"], []
    hears, body = link.hears, made.simulated.autopilot.body

    def hears_late(message, sender):
        late = made.mode == "auto" and body.position[0] < 16.0
        if not (late and message.get_type() == "HEARTBEAT"):
            hears(message, sender)

    link.hears = hears_late
    made.vehicle.fly(run.first, run.last, reached.append)
    assert reached == list(range(run.first, run.last + 1))


def test_what_is_left_of_a_run_is_flown_as_fast_as_the_run(airborne):
    made = airborne()
    autopilot, speeds = made.simulated.autopilot, []
    rest = SECOND.first + 2
    assert MISSION[rest].x == round(WAYS["b2"].latitude * 1e7)
    made.link.observe(
        lambda message, out: speeds.append(autopilot.body.speed) if made.mode == "auto" else None
    )
    made.vehicle.fly(rest, SECOND.last, lambda seq: None)
    assert set(speeds[len(speeds) // 4 :]) == {3.0, 4.0}


def test_a_run_without_a_speed_is_not_flown_at_that_of_the_run_before(airborne):
    made = airborne(firmware="px4", robot=UNHURRIED)
    autopilot, speeds, second = made.simulated.autopilot, [], mission_of(UNHURRIED)[1]["b1"]
    made.link.observe(
        lambda message, out: speeds.append(autopilot.body.speed) if made.mode == "auto" else None
    )
    made.vehicle.fly(second.first, second.last, lambda seq: None)
    assert speeds[-1] == autopilot.parameters["MPC_XY_CRUISE"]


ROI, ROI_NONE = 195, 197
MAST = Look(Geographic(42.37 + 60.0 / 111_080.0, 13.351, 0.0))
LOOKING = replace(
    ROBOT,
    steps=tuple(
        replace(step, movement=replace(step.movement, look=MAST)) if step.move[0] == "b" else step
        for step in ROBOT.steps
    ),
)


@pytest.mark.parametrize("firmware", ["ardupilot", "px4"])
def test_a_vehicle_looks_at_one_place_all_along_a_run_and_ahead_on_the_next(airborne, firmware):
    made = airborne(firmware=firmware, robot=LOOKING)
    autopilot, aside = made.simulated.autopilot, []

    def sees(message, out):
        if made.mode == "auto" and not out:
            here = made.vehicle.state().place
            aside.append(abs(turn(autopilot.body.heading, bearing(here, MAST.at))))

    made.link.observe(sees)
    flight = mission_of(LOOKING)[1]["b1"]
    made.vehicle.fly(flight.first, flight.last, lambda seq: None, flight.look)
    assert max(aside[len(aside) // 4 :]) < 10.0
    first = mission_of(LOOKING)[1]["a1"]
    assert first.look is None
    made.vehicle.fly(first.first, first.last, lambda seq: None, first.look)
    assert aside[-1] > 45.0


def test_a_vehicle_that_does_not_say_whether_it_has_a_gimbal_flies_leg_by_leg(airborne):
    made = airborne(robot=LOOKING)
    made.simulated.autopilot.silent.add(int(mavlink.MAV_CMD_REQUEST_MESSAGE))
    told = prepare(made, LOOKING)
    assert any("gimbal may turn" in line for line in told)
    assert not made.vehicle.can_look(MAST)


def test_after_a_run_that_is_broken_off_the_vehicle_looks_ahead(airborne):
    made = airborne(robot=LOOKING)
    flight = mission_of(LOOKING)[1]["b1"]

    def break_off(seq):
        raise FaultError("ORDERED", "to hold")

    with pytest.raises(FaultError):
        made.vehicle.fly(flight.first, flight.last, break_off, flight.look)
    commands = made.simulated.autopilot.history
    assert [number for _, number, _ in commands if number in (ROI, ROI_NONE)] == [ROI]
    made.vehicle.hold()
    made.vehicle.carry_on()
    made.vehicle.go_to(WAYS["b3"], 3.0, None, False)
    assert [number for _, number, _ in commands if number in (ROI, ROI_NONE)] == [ROI, ROI_NONE]


def test_where_a_gimbal_would_look_instead_of_the_vehicle_runs_are_flown_leg_by_leg(airborne):
    made = airborne(robot=LOOKING)
    answer = made.simulated.streams.send_once

    def with_gimbal(number):
        if number != mavlink.MAVLINK_MSG_ID_GIMBAL_MANAGER_INFORMATION:
            return answer(number)
        sideways = mavlink.GIMBAL_MANAGER_CAP_FLAGS_HAS_YAW_AXIS
        limits = (0.0,) * 6
        made.simulated.radio.send(mavlink.MAVLink_gimbal_manager_information_message(0, sideways, 1, *limits))
        return mavlink.MAV_RESULT_ACCEPTED

    assert made.vehicle.can_look(MAST)
    made.simulated.streams.send_once = with_gimbal
    assert any("flown leg by leg" in line for line in prepare(made, LOOKING))
    assert not made.vehicle.can_look(MAST)
    assert made.vehicle.can_look(replace(MAST, gimbal=True))
    flight, passed = mission_of(LOOKING)[1]["b1"], []
    made.vehicle.fly = None
    Moves(LOOKING, made.vehicle, made.clock, {}, lambda *_: None).run(flight, passed.append).run()
    assert passed == ["b1", "b2"]
    assert distance(made.vehicle.state().place, WAYS["b3"]) < 4.0


def test_a_vehicle_that_begins_its_missions_anew_is_set_to_go_on_and_people_are_told():
    with manned(ROBOT, parameters={"MIS_RESTART": 1.0}) as made:
        told = prepare(made)
        assert made.simulated.autopilot.parameters["MIS_RESTART"] == 0.0
        assert "MIS_RESTART = 0, which was 1: each run begins with its own first place" in told
        take_off(made)
        made.vehicle.fly(SECOND.first, SECOND.last, lambda seq: None)
        assert distance(made.vehicle.state().place, WAYS["b3"]) < 4.0


def test_a_px4_is_set_not_to_begin_its_mission_by_itself_after_take_off():
    with manned(ROBOT, firmware="px4", parameters={"COM_TAKEOFF_ACT": 1}) as made:
        told = prepare(made)
        assert made.simulated.autopilot.parameters["COM_TAKEOFF_ACT"] == 0.0
        assert "COM_TAKEOFF_ACT = 0, which was 1: each run begins with its own first place" in told
        take_off(made)
        until(lambda: made.mode != "take_off")
        assert made.mode == "hold"


def test_a_mission_that_a_px4_has_accepted_and_would_not_fly_is_refused_on_the_ground():
    with (
        manned(ROBOT, firmware="px4", parameters={"MIS_DIST_1WP": 5.0}) as made,
        pytest.raises(RefusedError, match="mission: the vehicle has accepted it, and would not fly it"),
    ):
        prepare(made)


def test_what_a_px4_says_against_a_mission_is_told():
    with manned(ROBOT, firmware="px4", parameters={"MIS_DIST_1WP": 5.0}) as made:
        link, telemetry = made.link, made.vehicle.telemetry
        upload(link, items_for(link.profile.autopilot, MISSION))
        with made.simulated.lock:
            made.simulated.autopilot.say(2, "First waypoint too far away: 10m, 5 max")
        with pytest.raises(RefusedError, match=r"would not fly it; it says 'First waypoint too far away"):
            check_feasible(link, telemetry, 0.0)


def test_a_vehicle_that_keeps_beginning_its_missions_anew_is_not_flown(monkeypatch):
    monkeypatch.setattr(parameters, "write", lambda *given: False)
    with (
        manned(ROBOT, parameters={"MIS_RESTART": 1.0}) as made,
        pytest.raises(RefusedError, match="MIS_RESTART = 1: the vehicle would begin every run"),
    ):
        keep_place(made.link)


def test_a_run_says_its_speed_before_its_first_place():
    assert first_flown(MISSION, SECOND.first) == SECOND.first + 1
    assert speed_before(MISSION, SECOND.first) is None
    assert speed_before(MISSION, SECOND.first + 1) == 3.0
    assert speed_before(MISSION, SECOND.last) == 4.0
