"""Devices of a vehicle, inspected before it takes off: by its parameters, its camera, and a trial."""

from dataclasses import replace

import pytest
from flight_crew import robot_of
from mavlink_peer import ARDUPILOT, PX4, acknowledged, linked, value
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.program import GoTo, Look, Measure, Operate
from mmrs_mavlink.vehicles.inspection import inspect_devices
from mmrs_mavlink.vehicles.mavlink_vehicle import MavlinkVehicle

PHOTO = Operate("camera", "TakePicture", 2000, (1.0, 0.0, 1.0), 1.0)
SAMPLE = Operate("co2", "SampleGas", 182, (0.0, 1.0, 8.0), 4.0)
UNTRIED = "unknown: whether it works: it was not tried"


def using(*actions):
    """Return a robot that carries out actions where it stays."""
    robot = robot_of()
    steps = tuple(replace(each, after=actions) if each.move == "stay" else each for each in robot.steps)
    return replace(robot, steps=steps)


def information(*, vendor: str = "", model: str = ""):
    names = [[*text.encode(), *[0] * (32 - len(text))] for text in (vendor, model)]
    return mavlink.MAVLink_camera_information_message(0, *names, 0, 0.0, 0.0, 0.0, 0, 0, 0, 2, 0, b"")


class Equipped:
    """How a vehicle answers that has these parameters, and refuses these commands."""

    def __init__(self, *, describes: bool = False, refuses: int = 0, values=(), **parameters: float) -> None:
        self.describes, self.refuses, self.values, self.parameters = describes, refuses, values, parameters
        self.commands: list[int] = []

    def __call__(self, message):
        kind = message.get_type()
        if kind == "PARAM_REQUEST_READ" and message.param_id in self.parameters:
            yield value(message.param_id, self.parameters[message.param_id])
        elif kind == "PARAM_REQUEST_READ" and not message.param_id:
            yield value("ANOTHER", 0.0, index=message.param_index)
        elif kind == "COMMAND_LONG":
            self.commands.append(message.command)
            yield acknowledged(message.command, 4 if message.command == self.refuses else 0)
            if message.command == mavlink.MAV_CMD_REQUEST_MESSAGE and self.describes:
                yield information(vendor="Acme", model="Eye")


def inspected(robot, vehicle: Equipped, tried=(), autopilot: int = ARDUPILOT):
    with linked(vehicle, autopilot=autopilot) as (link, _):
        return inspect_devices(link, MavlinkVehicle(link, robot.profile, robot.home), robot, tried)


def test_a_camera_that_is_not_set_up_is_a_defect_that_names_the_parameter():
    found = inspected(using(PHOTO), Equipped(CAM1_TYPE=0.0))
    (defect,) = found.defects
    assert defect.startswith("device 'camera' (TakePicture): CAM1_TYPE is 0: the vehicle has no camera 1")


def test_a_camera_without_an_output_for_its_shutter_is_a_defect():
    outputs = {f"SERVO{number}_FUNCTION": 33.0 if number < 5 else 0.0 for number in range(1, 17)}
    found = inspected(using(PHOTO), Equipped(CAM1_TYPE=1.0, **outputs))
    assert found.defects == [
        "device 'camera' (TakePicture): none of SERVO1_FUNCTION to SERVO16_FUNCTION is 10:"
        " no output moves the camera's shutter"
    ]


def test_a_camera_that_describes_itself_is_told_and_not_taken_to_work():
    found = inspected(using(PHOTO), Equipped(describes=True, CAM1_TYPE=1.0, SERVO9_FUNCTION=10.0))
    assert not found.defects
    assert found.lines == [
        "device 'camera' (TakePicture): CAM1_TYPE = 1, SERVO9_FUNCTION = 10, Acme Eye describes itself;"
        f" {UNTRIED}"
    ]


def test_a_camera_that_does_not_describe_itself_is_unknown_although_the_request_is_accepted():
    (line,) = inspected(using(PHOTO), Equipped(CAM1_TYPE=1.0, SERVO9_FUNCTION=10.0)).lines
    assert "unknown: whether its camera is connected" in line


@pytest.mark.parametrize(
    ("action", "parameters", "words"),
    [
        (SAMPLE, {"RELAY1_FUNCTION": 0.0, "RELAY1_PIN": 13.0}, "RELAY1_FUNCTION is 0, and must be 1"),
        (SAMPLE, {"RELAY1_FUNCTION": 1.0, "RELAY1_PIN": -1.0}, "RELAY1_PIN is -1: the relay has no output"),
        (Operate("arm", "Lower", 183, (1.0, 1900.0)), {"SERVO1_FUNCTION": 33.0}, "belongs to the vehicle"),
        (Operate("claw", "Grab", 211, (1.0, 1.0)), {"GRIP_ENABLE": 0.0}, "GRIP_ENABLE is 0, and must be 1"),
        (Operate("claw", "Grab", 211, (1.0, 1.0)), {"GRIP_ENABLE": 1.0, "GRIP_TYPE": 0.0}, "has no type"),
        (Operate("film", "Start", 2500, (1.0,)), {"CAM1_TYPE": 1.0}, "the camera records no video"),
        (Operate("line", "Lower", 42600, (1.0, 1.0)), {"WINCH_TYPE": 0.0}, "has no winch"),
    ],
)
def test_a_device_whose_parameters_leave_its_command_without_effect_is_a_defect(action, parameters, words):
    found = inspected(using(action), Equipped(**parameters))
    assert len(found.defects) == 1
    assert words in found.defects[0]


@pytest.mark.parametrize(
    ("parameters", "words"),
    [
        (
            {"PD_GRIPPER_EN": 0.0, "PD_GRIPPER_TYPE": 0.0},
            "PD_GRIPPER_EN is 0, and must be 1: the vehicle has",
        ),
        ({"PD_GRIPPER_TYPE": -1.0}, "PD_GRIPPER_TYPE is -1: the vehicle has no gripper"),
        ({"PD_GRIPPER_EN": 1.0, "PD_GRIPPER_TYPE": 0.0}, "PD_GRIPPER_EN = 1"),
        ({"PD_GRIPPER_TYPE": 0.0}, f"PD_GRIPPER_TYPE = 0; {UNTRIED}"),
        ({}, "unknown: the vehicle does not report PD_GRIPPER_TYPE"),
    ],
)
def test_a_gripper_of_px4_is_enabled_up_to_1_16_and_has_a_type_from_1_17_on(parameters, words):
    claw = Operate("claw", "Grab", 211, (1.0, 1.0))
    found = inspected(using(claw), Equipped(**parameters), autopilot=PX4)
    (said,) = found.defects or found.lines
    assert said.startswith(f"device 'claw' (Grab): {words}")
    assert bool(found.defects) == (" is " in words)


def test_an_output_that_is_free_for_commands_is_none():
    arm = Operate("arm", "Lower", 183, (9.0, 1900.0))
    found = inspected(using(arm), Equipped(SERVO9_FUNCTION=0.0))
    assert (found.defects, found.lines) == ([], [f"device 'arm' (Lower): SERVO9_FUNCTION = 0; {UNTRIED}"])


def test_a_parameter_that_is_not_told_is_unknown_and_no_defect():
    found = inspected(using(SAMPLE), Equipped())
    assert not found.defects
    assert found.lines == [
        "device 'co2' (SampleGas): unknown: the vehicle does not report RELAY1_FUNCTION,"
        " whether it works: it was not tried"
    ]


def test_an_output_that_is_not_reported_may_be_the_one_that_suits():
    outputs = {f"SERVO{number}_FUNCTION": 0.0 for number in range(1, 17) if number not in (9, 11)}
    found = inspected(using(PHOTO), Equipped(describes=True, CAM1_TYPE=1.0, **outputs))
    assert not found.defects
    (line,) = found.lines
    assert "unknown: the vehicle does not report SERVO9_FUNCTION, SERVO11_FUNCTION," in line


def test_a_command_of_ones_own_is_unknown():
    (line,) = inspected(using(Operate("lamp", "Flash", 31_010, ())), Equipped()).lines
    assert line.startswith("device 'lamp' (Flash): unknown: no parameter shows whether USER_1 has an effect")


def test_a_px4_switches_no_relays():
    found = inspected(using(SAMPLE), Equipped(), autopilot=PX4)
    assert found.defects == ["device 'co2' (SampleGas): PX4 carries out no DO_REPEAT_RELAY"]


def test_a_px4_takes_images_only_where_it_triggers_the_camera():
    (defect,) = inspected(using(PHOTO), Equipped(), autopilot=PX4).defects
    assert defect.startswith("device 'camera' (TakePicture): PX4 carries out no IMAGE_START_CAPTURE")
    digicam = replace(PHOTO, command=203, params=(0.0, 0.0, 0.0, 0.0, 1.0))
    found = inspected(using(digicam), Equipped(TRIG_MODE=0.0), autopilot=PX4)
    assert "TRIG_MODE is 0" in found.defects[0]


def test_nothing_is_tried_unless_that_is_allowed():
    vehicle = Equipped(RELAY1_FUNCTION=1.0, RELAY1_PIN=13.0)
    inspected(using(SAMPLE), vehicle)
    assert vehicle.commands == []


@pytest.mark.parametrize("by_type", [True, False])
def test_a_device_that_may_be_tried_is_and_counts_as_working_then(by_type):
    vehicle = Equipped(RELAY1_FUNCTION=1.0, RELAY1_PIN=13.0)
    found = inspected(using(replace(SAMPLE, trial=by_type)), vehicle, () if by_type else ("co2",))
    assert vehicle.commands == [182]
    assert found.lines == [
        "device 'co2' (SampleGas): RELAY1_FUNCTION = 1, RELAY1_PIN = 13, works: it was tried"
    ]


def test_an_action_of_several_commands_is_tried_once():
    vehicle = Equipped(RELAY1_FUNCTION=1.0, RELAY1_PIN=13.0, CAM1_TYPE=5.0, SERVO9_FUNCTION=10.0)
    found = inspected(using(replace(SAMPLE, more=((2000, (1.0, 0.0, 1.0)),))), vehicle, ("co2",))
    assert found.defects == []
    assert (vehicle.commands.count(182), vehicle.commands.count(2000)) == (1, 1)


def test_a_device_that_fails_its_trial_is_a_defect():
    vehicle = Equipped(refuses=182, RELAY1_FUNCTION=1.0, RELAY1_PIN=13.0)
    (defect,) = inspected(using(SAMPLE), vehicle, ("co2",)).defects
    assert (
        defect
        == "device 'co2' (SampleGas): tried on the ground: DO_REPEAT_RELAY: the vehicle answers 'failed'"
    )


def test_a_device_to_be_tried_that_the_program_does_not_operate_is_told():
    (line,) = inspected(using(), Equipped(), ("lamp",)).lines
    assert line == "device 'lamp': not tried: the program does not operate it"


def test_a_device_is_told_once_however_often_it_acts():
    vehicle = Equipped(RELAY1_FUNCTION=1.0, RELAY1_PIN=13.0)
    assert len(inspected(using(SAMPLE, SAMPLE), vehicle).lines) == 1


def test_a_gimbal_that_looks_somewhere_must_be_there():
    robot = robot_of()
    look = Look(robot.home, gimbal=True)
    steps = tuple(
        replace(each, movement=replace(each.movement, look=look)) if isinstance(each.movement, GoTo) else each
        for each in robot.steps
    )
    found = inspected(replace(robot, steps=steps), Equipped(MNT1_TYPE=0.0, MNT2_TYPE=0.0))
    assert found.defects == ["gimbal: none of MNT1_TYPE to MNT2_TYPE is set: the vehicle has no such gimbal"]


def test_a_value_that_is_not_published_is_unknown():
    (line,) = inspected(using(Measure("probe", "Measure", "CO2")), Equipped()).lines
    assert line == "unknown: device 'probe': has published no CO2 within 3 s"
