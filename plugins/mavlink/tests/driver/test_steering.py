"""Pointing gimbals, turning, and going where the vehicle is told."""

import pytest
from mavlink_peer import acknowledged, eventually, linked
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink import Geographic, Local, Look
from mmrs_mavlink.profiles import ARDUCOPTER
from mmrs_mavlink.vehicles.mavlink_vehicle import MavlinkVehicle

ROI, ROI_NONE, GIMBAL, SPEED = 195, 197, 1000, 178
RELATIVE = 3
TARGETS = ("SET_POSITION_TARGET_GLOBAL_INT", "SET_POSITION_TARGET_LOCAL_NED")
HOME = Geographic(42.37, 13.35, 0.0)


def on_the_earth(north: float = 0.0):
    latitude = round((42.37 + north / 111_319.49) * 1e7)
    return mavlink.MAVLink_global_position_int_message(0, latitude, 133_500_000, 720_000, 20_000, 0, 0, 0, 0)


def near_home(north: float = 0.0, east: float = 0.0):
    return mavlink.MAVLink_local_position_ned_message(0, north, east, -20.0, 0, 0, 0)


class Obedient:
    """A vehicle in GUIDED, armed, that is at once where it is told to be."""

    def __init__(self, wire) -> None:
        self.wire = wire

    def __call__(self, message):
        if message.get_type() in ("COMMAND_LONG", "COMMAND_INT"):
            yield acknowledged(message.command)
            self.wire.beat(mode=4, armed=True)
        elif message.get_type() == "SET_POSITION_TARGET_GLOBAL_INT":
            yield mavlink.MAVLink_global_position_int_message(
                0, message.lat_int, message.lon_int, 720_000, round(message.alt * 1000), 0, 0, 0, 0
            )
        elif message.get_type() == "SET_POSITION_TARGET_LOCAL_NED":
            yield mavlink.MAVLink_local_position_ned_message(0, message.x, message.y, message.z, 0, 0, 0)


@pytest.fixture
def driven():
    """Return a function that gives a vehicle with that home, and the wire to it."""
    contexts = []

    def drive(home, first):
        context = linked(speedup=10.0)
        link, wire = context.__enter__()
        contexts.append(context)
        wire.answer = Obedient(wire)
        vehicle = MavlinkVehicle(link, ARDUCOPTER, home)
        wire.say(first)
        eventually(vehicle.telemetry.placed)
        return vehicle, wire

    yield drive
    for context in contexts:
        context.__exit__(None, None, None)


def commands(wire, *numbers: int):
    return [each for each in wire.of("COMMAND_LONG") if each.command in numbers]


def test_a_gimbal_looks_at_a_place_on_the_earth_until_the_leg_ends(driven):
    vehicle, wire = driven(HOME, on_the_earth())
    look = Look(Geographic(42.3705, 13.35, 5.0), gimbal=True, device=2)
    vehicle.go_to(Geographic(42.371, 13.35, 20.0), 5.0, look, False)
    (roi,) = wire.of("COMMAND_INT")
    assert (roi.command, roi.param1, roi.frame, roi.z) == (ROI, 2.0, RELATIVE, 5.0)
    assert (roi.x, roi.y) == (423_705_000, 133_500_000)
    (none,) = commands(wire, ROI, ROI_NONE)
    assert (none.command, none.param1) == (ROI_NONE, 2.0)


def test_a_gimbal_is_turned_to_a_place_near_home_by_its_angles(driven):
    vehicle, wire = driven(Local(0.0, 0.0, 0.0), near_home())
    vehicle.turn(Look(Local(20.0, 20.0, -8.284), gimbal=True, device=3))
    (sent,) = commands(wire, GIMBAL)
    assert sent.param1 == pytest.approx(-45.0, abs=0.01)
    assert sent.param2 == pytest.approx(45.0)
    assert (sent.param5, sent.param7) == (mavlink.GIMBAL_MANAGER_FLAGS_YAW_LOCK, 3.0)


def test_a_speed_is_commanded_behind_three_targets_and_then_no_more(driven):
    vehicle, wire = driven(HOME, on_the_earth())
    for latitude in (42.3705, 42.371, 42.3715, 42.372):
        vehicle.go_to(Geographic(latitude, 13.35, 20.0), 5.0, None, False)
    sent = commands(wire, SPEED)
    assert {(each.param1, each.param2, each.param3) for each in sent} == {(1.0, 5.0, -1.0)}
    assert len(sent) == 3
    names = [
        message.get_type() for message, _ in wire.sent if message.get_type() in TARGETS or message in sent
    ]
    assert names[0] in TARGETS


def test_another_speed_is_set_before_the_target_that_it_is_for(driven):
    vehicle, wire = driven(HOME, on_the_earth())
    for latitude, speed in ((42.3705, 5.0), (42.371, 2.0)):
        vehicle.go_to(Geographic(latitude, 13.35, 20.0), speed, None, False)
    slower = next(each for each in commands(wire, SPEED) if each.param2 == 2.0)
    sent = [message for message, _ in wire.sent]
    second = next(each for each in sent if each.get_type() in TARGETS and each.lat_int == round(42.371 * 1e7))
    assert sent.index(slower) < sent.index(second)


def test_targets_are_heights_above_home_and_the_vehicle_looks_where_it_goes(driven):
    vehicle, wire = driven(HOME, on_the_earth())
    vehicle.go_to(Geographic(42.37, 13.351, 30.0), None, None, False)
    point = wire.of("SET_POSITION_TARGET_GLOBAL_INT")[0]
    assert (point.coordinate_frame, point.alt) == (mavlink.MAV_FRAME_GLOBAL_RELATIVE_ALT_INT, 30.0)
    assert point.yaw == pytest.approx(1.5708, abs=1e-3)


def test_a_hold_is_carried_on_from_where_the_vehicle_is(driven):
    vehicle, wire = driven(HOME, on_the_earth(50.0))
    wire.say(mavlink.MAVLink_extended_sys_state_message(0, mavlink.MAV_LANDED_STATE_IN_AIR))
    wire.beat(mode=17, armed=True)
    eventually(vehicle.telemetry.airborne)
    vehicle.carry_on()
    point = wire.of("SET_POSITION_TARGET_GLOBAL_INT")[-1]
    assert point.lat_int == round((42.37 + 50.0 / 111_319.49) * 1e7)


def test_on_the_ground_there_is_nothing_to_carry_on(driven):
    vehicle, wire = driven(HOME, on_the_earth())
    vehicle.carry_on()
    assert wire.sent == []
