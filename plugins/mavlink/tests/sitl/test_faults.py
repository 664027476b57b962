"""Faults on demand, as the ground sees them: a bare socket and pymavlink on the other side."""

from __future__ import annotations

import time

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.sitl import FAULTS, Settings, SimulatedVehicle

pytestmark = pytest.mark.real_time("parts of flights")

SPEEDUP = 10.0
PREARM = 0x1000_0000
METRES_PER_DEGREE = 111_412.0
"""Of longitude, at the equator: no degree is longer."""


@pytest.fixture
def vehicle(ground):
    port = ground.socket.getsockname()[1]
    settings, watched = Settings(boot=0.5, ready=0.5), ("127.0.0.1", 9)
    with SimulatedVehicle(port, settings, speedup=SPEEDUP, ground=watched) as vehicle:
        assert ground.hear(
            lambda m: m.get_type() == "SYS_STATUS" and m.onboard_control_sensors_health & PREARM
        )
        yield vehicle


def airborne(vehicle, ground) -> None:
    assert ground.command(176, 1, 4).result == 0
    assert ground.command(400, 1).result == 0
    assert ground.command(22, 0, 0, 0, 0, 0, 0, 10).result == 0
    until = time.monotonic() + 5.0
    while vehicle.autopilot.body.position[2] < 9.0 and time.monotonic() < until:
        time.sleep(0.02)


def test_a_lost_position_is_told_and_lands_the_vehicle(vehicle, ground):
    airborne(vehicle, ground)
    vehicle.faults.begin("gps-lost")
    assert ground.hear(lambda m: m.get_type() == "GPS_RAW_INT" and m.fix_type < 2)
    assert ground.hear(lambda m: m.get_type() == "EKF_STATUS_REPORT" and not m.flags & 16)
    assert ground.hear(lambda m: m.get_type() == "HEARTBEAT" and m.custom_mode == 9)
    vehicle.faults.end("gps-lost")
    assert ground.hear(lambda m: m.get_type() == "EKF_STATUS_REPORT" and m.flags & 16)


def test_who_takes_himself_to_be_elsewhere_goes_back_to_where_he_then_is_not(vehicle, ground):
    airborne(vehicle, ground)
    body = vehicle.autopilot.body
    vehicle.faults.begin("position-shift", "40", "90")
    assert body.place == pytest.approx((0.0, 0.0, 10.0), abs=1.0)
    assert body.position[1] == pytest.approx(40.0, abs=1.0)
    east = 40.0 / METRES_PER_DEGREE
    home = vehicle.autopilot.settings.longitude
    assert ground.hear(lambda m: m.get_type() == "GLOBAL_POSITION_INT" and m.lon * 1e-7 - home > 0.9 * east)
    vehicle.faults.end("position-shift")
    assert body.position == body.place == pytest.approx((0.0, 0.0, 10.0), abs=1.0)


def test_a_restart_begins_time_anew_and_drops_the_vehicle_but_keeps_what_was_uploaded(vehicle, ground):
    airborne(vehicle, ground)
    vehicle.autopilot.stores[0] = ["kept"]
    assert ground.hear(lambda m: m.get_type() == "SYSTEM_TIME" and m.time_boot_ms > 5_000)
    vehicle.faults.begin("restart")
    assert ground.hear(lambda m: m.get_type() == "SYSTEM_TIME" and m.time_boot_ms < 5_000)
    assert not vehicle.autopilot.armed
    time.sleep(0.3)
    assert vehicle.autopilot.body.position[2] == 0.0
    assert vehicle.autopilot.stores[0] == ["kept"]


def test_a_watchdogs_restart_keeps_the_motors_on(vehicle, ground):
    airborne(vehicle, ground)
    vehicle.faults.begin("restart", "armed")
    assert ground.hear(lambda m: m.get_type() == "HEARTBEAT" and m.custom_mode == 0 and m.base_mode & 128)
    assert vehicle.autopilot.body.position[2] > 8.0


def test_a_pilots_stick_changes_the_mode(vehicle, ground):
    vehicle.faults.begin("stick", "alt_hold")
    assert ground.hear(lambda m: m.get_type() == "HEARTBEAT" and m.custom_mode == 2)


def test_an_obstacle_is_told_where_it_is_until_it_is_gone(vehicle, ground):
    vehicle.faults.begin("obstacle", 3.0, 90.0)
    told = ground.of("OBSTACLE_DISTANCE")
    assert (told.distances[18], min(told.distances)) == (300, 300)
    vehicle.faults.end("obstacle")
    while ground.of("OBSTACLE_DISTANCE", 0.3):
        pass
    assert ground.of("OBSTACLE_DISTANCE", 0.5) is None


def test_a_breached_fence_is_told_and_answered(vehicle, ground):
    airborne(vehicle, ground)
    assert ground.command(207, 1).result == 0
    vehicle.faults.begin("breach")
    assert ground.hear(lambda m: m.get_type() == "FENCE_STATUS" and m.breach_status == 1)
    assert ground.hear(lambda m: m.get_type() == "HEARTBEAT" and m.custom_mode == 6)


def test_a_battery_has_what_it_is_said_to_have(vehicle, ground):
    vehicle.faults.begin("battery", 0.17)
    assert ground.hear(lambda m: m.get_type() == "SYS_STATUS" and 15 <= m.battery_remaining <= 20)


def test_a_silent_command_gets_no_answer_and_does_nothing(vehicle, ground):
    vehicle.faults.begin("silent", 400)
    assert ground.command(400, 1) is None
    assert not vehicle.autopilot.armed
    vehicle.faults.end("silent")
    assert ground.command(400, 1) is not None


def test_a_cut_link_lets_nothing_through_until_it_is_mended(vehicle, ground):
    vehicle.faults.begin("link-down")
    ground.of("HEARTBEAT", 0.3)
    assert ground.of("HEARTBEAT", 0.5) is None
    vehicle.faults.end("link-down")
    assert ground.of("HEARTBEAT")


def test_the_time_of_day_jumps_and_the_time_since_it_booted_does_not(vehicle, ground):
    before = ground.of("SYSTEM_TIME")
    vehicle.faults.begin("clock-jump", -3600.0)
    after = ground.hear(lambda m: m.get_type() == "SYSTEM_TIME" and m.time_unix_usec < before.time_unix_usec)
    assert before.time_boot_ms < after.time_boot_ms < before.time_boot_ms + 3e5


def test_arming_is_refused_with_the_reason_in_words(vehicle, ground):
    vehicle.faults.begin("refuse-arming", "Battery 1 unhealthy")
    assert ground.hear(lambda m: m.get_type() == "STATUSTEXT" and m.text == "PreArm: Battery 1 unhealthy")
    assert ground.command(400, 1).result == mavlink.MAV_RESULT_FAILED


def test_answers_to_uploads_come_late(vehicle, ground):
    vehicle.faults.begin("slow-upload", 5.0)
    began = time.monotonic()
    ground.send(mavlink.MAVLink_mission_request_list_message(1, 1, 0))
    assert ground.of("MISSION_COUNT")
    assert time.monotonic() - began >= 0.4


def test_a_photo_is_told_unless_the_camera_is_dead(vehicle, ground):
    assert ground.command(203, 0, 0, 0, 0, 1).result == 0
    assert ground.of("CAMERA_FEEDBACK").img_idx == 1
    vehicle.faults.begin("camera-dead")
    assert ground.command(203, 0, 0, 0, 0, 1).result == 0
    assert ground.of("CAMERA_FEEDBACK", 0.5) is None


@pytest.mark.parametrize(
    ("words", "complaint"),
    [
        (("gps-gone",), "known are gps-lost"),
        (("battery",), "battery: takes level"),
        (("battery", "half"), "'half' is not a finite number"),
        (("gps-lost", "3"), "gps-lost 3: takes no value"),
        (("silent", "abc"), "'abc' is not the number of a command"),
        (("restart", "disarmed"), "'disarmed' is not armed"),
        (("stick", "acro"), "this vehicle has"),
    ],
)
def test_what_is_no_fault_is_refused(vehicle, words, complaint):
    with pytest.raises(ValueError, match=complaint):
        vehicle.faults.begin(*words)


def test_every_fault_can_be_had_by_its_name(vehicle):
    values = {"battery": ("0.5",), "silent": ("400",), "wind": ("5", "270")}
    for name in FAULTS:
        vehicle.faults.begin(name, *values.get(name, ()))
        vehicle.faults.end(name)
    assert vehicle.autopilot.energy == pytest.approx(0.5, abs=0.05)
