"""Injected faults, as the ground station sees them."""

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.sitl import FAULTS
from mmrs_mavlink.sitl.items import StoredItem

METRES_PER_DEGREE = 111_412.0
"""Of longitude, at the equator: no degree is longer."""


@pytest.fixture
def vehicle(ground):
    return ground.switch_on(ground=("127.0.0.1", 9))


@pytest.fixture
def airborne(vehicle, ground):
    for command in ((176, 1, 4), (400, 1), (22, 0, 0, 0, 0, 0, 0, 10)):
        assert ground.command(*command).result == 0
    ground.wait(20.0)
    assert vehicle.autopilot.body.position[2] == pytest.approx(10.0, abs=0.1)
    return vehicle


def test_a_lost_position_is_reported_and_lands_the_vehicle(airborne, ground):
    airborne.faults.begin("gps-lost")
    assert ground.receive("GPS_RAW_INT", lambda m: m.fix_type < 2)
    assert ground.receive("EKF_STATUS_REPORT", lambda m: not m.flags & 16)
    assert ground.receive("HEARTBEAT", lambda m: m.custom_mode == 9)
    airborne.faults.end("gps-lost")
    assert ground.receive("EKF_STATUS_REPORT", lambda m: m.flags & 16)


def test_a_failed_motor_drops_a_copter_that_lies_with_running_motors(airborne, ground):
    airborne.faults.begin("motor-failed")
    assert ground.receive("ATTITUDE", lambda m: m.roll > 1.0)
    assert ground.receive("GLOBAL_POSITION_INT", lambda m: m.relative_alt == 0 and m.vz == 0)
    ground.wait(20.0)
    assert airborne.autopilot.armed
    assert ground.receive("ATTITUDE", lambda m: m.roll == 0.0)


def test_a_wrong_position_estimate_moves_the_vehicle_and_ends(airborne, ground):
    pilot, home = airborne.autopilot, airborne.autopilot.settings.longitude
    airborne.faults.begin("position-shift", "40", "90")
    east = 40.0 / METRES_PER_DEGREE
    assert ground.receive("GLOBAL_POSITION_INT", lambda m: m.lon * 1e-7 - home > 0.9 * east)
    here = mavlink.MAVLink_set_position_target_global_int_message(
        0, 1, 1, 6, 0xDF8, round(pilot.settings.latitude * 1e7), round(home * 1e7), 10.0, *[0.0] * 8
    )
    ground.send(here)
    ground.wait(20.0)
    assert pilot.body.position == pytest.approx((0.0, -40.0, 10.0), abs=1.0)
    airborne.faults.end("position-shift")
    assert ground.receive("GLOBAL_POSITION_INT", lambda m: m.lon * 1e-7 - home < -0.9 * east)


def test_a_restart_resets_the_time_since_boot_and_drops_the_vehicle_but_keeps_uploads(airborne, ground):
    pilot = airborne.autopilot
    kept = pilot.stores[0] = [StoredItem(0, 16, (0.0, 0.0, 0.0, 0.0), 0, 0, 0.0)]
    assert ground.receive("SYSTEM_TIME", lambda m: m.time_boot_ms > 5_000)
    airborne.faults.begin("restart")
    assert ground.receive("HEARTBEAT", lambda m: m.custom_mode == 0)
    ground.command(mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, mavlink.MAVLINK_MSG_ID_SYSTEM_TIME, 1e5)
    assert ground.receive("SYSTEM_TIME", lambda m: m.time_boot_ms < 5_000)
    ground.wait(3.0)
    assert (pilot.armed, pilot.body.position[2], pilot.stores[0]) == (False, 0.0, kept)


def test_the_pilot_changes_the_mode(vehicle, ground):
    vehicle.faults.begin("stick", "altitude_hold")
    assert ground.receive("HEARTBEAT", lambda m: m.custom_mode == 2)


def test_an_obstacle_is_reported_until_it_is_gone(vehicle, ground):
    vehicle.faults.begin("obstacle", 3.0)
    report = ground.receive("OBSTACLE_DISTANCE")
    assert (report.distances[0], min(report.distances)) == (300, 300)
    vehicle.faults.end("obstacle")
    assert ground.receive("OBSTACLE_DISTANCE", seconds=5.0) is None


def test_a_breached_fence_is_reported_and_answered(airborne, ground):
    assert ground.command(207, 1).result == 0
    airborne.faults.begin("breach")
    assert ground.receive("FENCE_STATUS", lambda m: m.breach_status == 1)
    assert ground.receive("HEARTBEAT", lambda m: m.custom_mode == 6)


def test_a_battery_is_replaced(vehicle, ground):
    vehicle.faults.begin("battery", 0.17)
    assert ground.receive("SYS_STATUS", lambda m: 15 <= m.battery_remaining <= 20)


def test_a_silent_command_is_neither_answered_nor_executed(vehicle, ground):
    vehicle.faults.begin("silent", 400)
    assert ground.command(400, 1) is None
    assert not vehicle.autopilot.armed
    vehicle.faults.end("silent")
    assert ground.command(400, 1) is not None


def test_a_cut_link_carries_nothing_until_it_is_restored(vehicle, ground):
    fault = "link-down"
    vehicle.faults.begin(fault)
    assert ground.receive("HEARTBEAT", seconds=5.0) is None
    vehicle.faults.end(fault)
    assert ground.receive("HEARTBEAT")


@pytest.mark.parametrize(
    ("words", "complaint"),
    [
        (("gps-gone",), "known are gps-lost"),
        (("battery",), "battery: takes 1 value"),
        (("battery", "half"), "'half' is not a finite number"),
        (("gps-lost", "3"), "gps-lost 3: takes 0 values"),
        (("obstacle", "1", "2"), "takes 1 value"),
        (("silent", "abc"), "'abc' is not a finite number"),
        (("restart", "armed"), "takes 0 values"),
        (("stick", "circle"), "this vehicle has"),
    ],
)
def test_an_unknown_fault_or_value_is_refused(vehicle, words, complaint):
    with pytest.raises(ValueError, match=complaint):
        vehicle.faults.begin(*words)


def test_every_fault_can_be_injected_and_cleared_by_its_name(vehicle):
    values = {"battery": ("0.5",), "silent": ("400",), "wind": ("5", "270")}
    for name in FAULTS:
        vehicle.faults.begin(name, *values.get(name, ()))
        vehicle.faults.end(name)
    assert vehicle.autopilot.battery.level == pytest.approx(0.5, abs=0.05)
