"""Take-off of a PX4, which sets its home by itself, as a robot of the runtime has it."""

import threading

import pytest
from flight_crew import manned, robot_of
from patience import until

from mmrs_mavlink.services.uploads import uploads_of
from mmrs_mavlink.vehicles import px4

pytestmark = pytest.mark.real_time("parts of flights")

ROBOT = robot_of()


def raise_home(made, metres: float) -> None:
    """Have the vehicle take another height for that of its home."""
    with made.simulated.lock:
        latitude, longitude, height = made.simulated.autopilot.home
        made.simulated.autopilot.home = (latitude, longitude, height + metres)


def prepared(made):
    """Return the vehicle of a robot that is ready to take off."""
    made.vehicle.prepare(uploads_of(ROBOT))
    made.watch.renew()
    return made.vehicle


def test_a_px4_that_takes_another_height_for_home_as_it_climbs_goes_to_the_right_one():
    with manned(ROBOT, firmware="px4") as made:
        vehicle, body = prepared(made), made.simulated.autopilot.body

        def shift() -> None:
            until(lambda: body.position[2] > 1.0)
            raise_home(made, 2.0)

        shifting = threading.Thread(target=shift)
        shifting.start()
        vehicle.take_off(10.0)
        shifting.join()
        assert vehicle.state().place.height == pytest.approx(10.0, abs=0.6)
        assert body.position[2] == pytest.approx(12.0, abs=0.6)


def test_the_height_of_home_when_the_motors_start_counts(monkeypatch):
    with manned(ROBOT, firmware="px4") as made:
        vehicle, autopilot, link = prepared(made), made.simulated.autopilot, made.link
        monkeypatch.setattr(px4, "FRESH_SECONDS", 10.0 * made.clock.speedup)
        raise_home(made, -5.0)
        until(lambda: vehicle.telemetry.here().height > 4.0)
        hears = link.hears

        def hears_late(message, sender):
            armed = next((time for time, number, _ in autopilot.history if number == 400), None)
            position = message.get_type() == "GLOBAL_POSITION_INT"
            if armed is None or not position or message.time_boot_ms / 1000.0 > armed + 2.0:
                hears(message, sender)

        link.hears = hears_late
        vehicle.take_off(10.0)
        commanded = next(params for _, number, params in autopilot.history if number == 22)
        assert commanded[6] == pytest.approx(autopilot.settings.altitude + 10.0, abs=0.1)


def test_a_take_off_that_is_shown_before_it_is_acknowledged_is_not_external_control():
    with manned(ROBOT, firmware="px4") as made:
        vehicle, link = prepared(made), made.link
        hears, held, beats = link.hears, [], []

        def hears_answers_late(message, sender):
            if message.get_type() == "COMMAND_ACK" and message.command == 22 and len(beats) < 2:
                held.append((message, sender))
                return
            hears(message, sender)
            if held and message.get_type() == "HEARTBEAT":
                beats.append(message)
                if len(beats) == 2:
                    hears(*held[0])

        link.hears = hears_answers_late
        vehicle.take_off(10.0)
        assert len(beats) >= 2
        assert vehicle.state().place.height == pytest.approx(10.0, abs=0.6)
