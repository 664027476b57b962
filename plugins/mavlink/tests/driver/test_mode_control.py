"""Who has the vehicle, and what it says when it does not obey."""

import pytest
from mavlink_peer import acknowledged, eventually, linked
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink import Geographic
from mmrs_mavlink.links.retries import Retries
from mmrs_mavlink.profiles import ARDUCOPTER, modes
from mmrs_mavlink.vehicles.mavlink_vehicle import MavlinkVehicle
from mmrs_mavlink.vehicles.mode_control import ModeControl
from mmrs_mavlink.vehicles.telemetry import Telemetry
from mmrs_runtime.faults import FaultError, RefusedError, UnansweredError

HOME = Geographic(42.37, 13.35, 0.0)
ARM, TAKE_OFF, PHOTO = 400, 22, 2000
LOITER, RTL, LAND = 5, 6, 9
FLYING = mavlink.MAVLink_extended_sys_state_message(0, mavlink.MAV_LANDED_STATE_IN_AIR)


def text(words: str):
    return mavlink.MAVLink_statustext_message(2, words.encode())


class Vehicle:
    """Obeys commands, but for those that it has other results for."""

    def __init__(self, wire, **results: int) -> None:
        self.wire = wire
        self.results = results
        self.mode, self.armed = 0, False

    def __call__(self, message):
        if message.get_type() != "COMMAND_LONG":
            return
        result = self.results.get(f"c{message.command}", 0)
        if result == 0 and message.command == mavlink.MAV_CMD_DO_SET_MODE:
            self.mode = int(message.param2)
        if result == 0 and message.command == ARM:
            self.armed = bool(message.param1)
        yield acknowledged(message.command, result)
        self.wire.beat(mode=self.mode, armed=self.armed)


@pytest.fixture
def steered():
    """Return a function that gives a mode control, its telemetry, the vehicle and the wire to it."""
    contexts = []

    def steer(**results):
        context = linked(speedup=10.0)
        link, wire = context.__enter__()
        contexts.append(context)
        wire.answer = vehicle = Vehicle(wire, **results)
        telemetry = Telemetry(link, HOME)
        return ModeControl(link, telemetry), telemetry, vehicle, wire

    yield steer
    for context in contexts:
        context.__exit__(None, None, None)


def in_mode(wire, telemetry, mode: int) -> None:
    wire.beat(mode=mode, armed=True)
    eventually(lambda: telemetry.mode() == mode)


def test_a_mode_is_believed_when_a_heartbeat_shows_it(steered):
    mode_control, telemetry, _, _ = steered()
    mode_control.arm()
    assert (telemetry.mode(), telemetry.armed()) == (4, True)
    mode_control.check()


def test_a_mode_that_was_acknowledged_and_never_shown_is_refused(steered):
    mode_control, _, _, wire = steered()
    wire.answer = lambda message: (
        [acknowledged(message.command)] if message.get_type() == "COMMAND_LONG" else []
    )
    with pytest.raises(RefusedError, match="does not go into mode land"):
        mode_control.enter(modes.LAND)


@pytest.mark.parametrize("refusals", [2, 3])
def test_a_mode_that_is_refused_for_a_moment_is_requested_again(steered, refusals):
    mode_control, telemetry, _, wire = steered()
    answer, refused = wire.answer, []

    def refuse(message):
        if getattr(message, "command", 0) == mavlink.MAV_CMD_DO_SET_MODE and len(refused) < refusals:
            refused.append(message)
            return [acknowledged(message.command, mavlink.MAV_RESULT_FAILED)]
        return answer(message)

    wire.answer = refuse
    if refusals < 3:
        mode_control.enter(modes.GUIDED)
        assert telemetry.mode() == 4
        return
    with pytest.raises(RefusedError, match="DO_SET_MODE: the vehicle answers 'failed'"):
        mode_control.enter(modes.GUIDED)


@pytest.mark.parametrize("mode", [LOITER, RTL, LAND, 0])
def test_a_mode_that_nobody_asked_for_is_a_pilot(steered, mode):
    mode_control, telemetry, _, wire = steered()
    mode_control.arm()
    in_mode(wire, telemetry, mode)
    with pytest.raises(FaultError, match=r"left mode guided for .*: it is under external control") as fault:
        mode_control.check()
    assert fault.value.event == "TAKEN_OVER"


@pytest.mark.parametrize(("mode", "event"), [(LAND, "POSITION_LOST"), (LOITER, "TAKEN_OVER")])
def test_what_the_vehicle_answers_by_itself_is_no_pilot_but_a_stick_always_is(steered, mode, event):
    mode_control, telemetry, _, wire = steered()
    mode_control.arm()
    wire.say(text("EKF Failsafe: changed to LAND Mode"))
    in_mode(wire, telemetry, mode)
    with pytest.raises(FaultError) as fault:
        mode_control.check()
    assert fault.value.event == event


def test_a_mode_that_is_being_changed_is_nobodys(steered):
    mode_control, telemetry, _, wire = steered()
    mode_control.arm()
    mode_control.let_go()
    in_mode(wire, telemetry, LOITER)
    mode_control.check()


def test_a_vehicle_that_does_not_arm_says_why(steered):
    mode_control, _, _, wire = steered(c400=mavlink.MAV_RESULT_FAILED)
    wire.say(text("Arm: Throttle too high"))
    with pytest.raises(
        RefusedError, match="COMPONENT_ARM_DISARM: the vehicle answers 'failed': Arm: Throttle too high"
    ):
        mode_control.arm()


def test_a_vehicle_that_disarms_itself_at_once_is_asked_to_arm_again(steered):
    mode_control, telemetry, vehicle, wire = steered()
    asked = []

    def at_first_disarmed(message):
        if message.get_type() == "COMMAND_LONG" and message.command == ARM:
            asked.append(message.param1)
        for answer in vehicle(message):
            vehicle.armed = vehicle.armed and len(asked) > 1
            yield answer

    wire.answer = at_first_disarmed
    mode_control.arm()
    assert telemetry.armed()
    assert asked == [1.0, 1.0]


@pytest.mark.parametrize("obeyed", [True, False])
def test_arming_without_an_answer_counts_where_the_heartbeat_reports_it(steered, obeyed):
    mode_control, telemetry, vehicle, wire = steered()

    def answers_lost(message):
        answers = list(vehicle(message))
        if message.get_type() != "COMMAND_LONG" or message.command != ARM:
            yield from answers
        elif not obeyed:
            vehicle.armed = not message.param1
            wire.beat(mode=vehicle.mode, armed=vehicle.armed)

    def switch(change, armed):
        vehicle.armed = not armed
        wire.beat(mode=vehicle.mode, armed=vehicle.armed)
        assert eventually(lambda: telemetry.armed() != armed)
        if obeyed:
            change()
            assert telemetry.armed() == armed
        else:
            with pytest.raises(RefusedError, match="ARM_DISARM: no answer to"):
                change()

    wire.answer = answers_lost
    switch(mode_control.start_motors, armed=True)
    switch(mode_control.disarm, armed=False)


def test_a_vehicle_that_never_stays_armed_is_told_with_what_it_has_said(steered):
    mode_control, _, vehicle, wire = steered()

    def never_armed(message):
        for answer in vehicle(message):
            vehicle.armed = False
            yield answer
            yield text("GCS Failsafe")

    wire.answer = never_armed
    with pytest.raises(FaultError, match=r"takes too long to arm: GCS Failsafe$"):
        mode_control.arm()


def test_a_take_off_whose_first_answer_was_lost_is_no_refusal(steered):
    mode_control, _, _, wire = steered(c22=mavlink.MAV_RESULT_FAILED)
    wire.say(FLYING)
    mode_control.leave_ground(20.0)


def test_a_take_off_is_asked_for_as_often_as_anything_where_the_vehicle_disarms_itself_before(steered):
    mode_control, _, vehicle, wire = steered(c22=mavlink.MAV_RESULT_FAILED)
    mode_control._link.retries, asked = Retries(tries=5), []

    def disarm_itself(message):
        if message.get_type() == "COMMAND_LONG" and message.command == mavlink.MAV_CMD_NAV_TAKEOFF:
            asked.append(message)
            vehicle.armed = len(asked) == 5
            vehicle.results = {} if vehicle.armed else vehicle.results
        yield from vehicle(message)

    wire.answer = disarm_itself
    mode_control.leave_ground(20.0)
    assert len(asked) == 5


def test_a_take_off_that_is_refused_on_the_ground_is(steered):
    mode_control, _, _, _ = steered(c22=mavlink.MAV_RESULT_FAILED)
    with pytest.raises(RefusedError, match="NAV_TAKEOFF: the vehicle answers 'failed'"):
        mode_control.leave_ground(20.0)


@pytest.fixture
def camera():
    """Return a vehicle with a camera, and the wire to it."""
    with linked(speedup=10.0) as (link, wire):
        wire.answer = Vehicle(wire)
        yield MavlinkVehicle(link, ARDUCOPTER, HOME), wire


IMAGE = mavlink.MAVLink_camera_image_captured_message(0, 0, 0, 0, 0, 0, 0, [1, 0, 0, 0], 1, 1, b"")
NO_IMAGE = mavlink.MAVLink_camera_image_captured_message(0, 0, 0, 0, 0, 0, 0, [1, 0, 0, 0], 1, 0, b"")
FEEDBACK = mavlink.MAVLink_camera_feedback_message(0, 1, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0)


@pytest.mark.parametrize(("told", "component"), [(IMAGE, 100), (FEEDBACK, 1)])
def test_an_image_that_was_promised_is_waited_for(camera, told, component):
    vehicle, wire = camera
    obey = wire.answer

    def answer(message):
        yield from obey(message)
        if message.get_type() == "COMMAND_LONG" and message.command == PHOTO:
            wire.say(told, component=component)

    wire.answer = answer
    vehicle.operate(PHOTO, (0.0, 0.0, 1.0), confirmed=True)


@pytest.mark.parametrize("told", [None, NO_IMAGE])
def test_an_image_that_never_comes_is_a_silent_device(camera, monkeypatch, told):
    monkeypatch.setattr("mmrs_mavlink.vehicles.mavlink_vehicle.IMAGE_SECONDS", 2.0)
    vehicle, wire = camera
    if told is not None:
        wire.say(told, component=100)
    vehicle.operate(PHOTO, (0.0, 0.0, 1.0))
    with pytest.raises(UnansweredError, match="IMAGE_START_CAPTURE: no image was reported within 2 s"):
        vehicle.operate(PHOTO, (0.0, 0.0, 1.0), confirmed=True)
