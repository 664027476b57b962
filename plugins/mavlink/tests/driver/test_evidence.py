"""What counts as a sign that a vehicle obeys, and what may come about by accident."""

from contextlib import contextmanager

import pytest
from mavlink_peer import ARDUPILOT, PX4, eventually, linked
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.profiles import ARDUCOPTER, ARDUSUB, PX4_MULTICOPTER
from mmrs_mavlink.profiles.modes import GUIDED, HOLD
from mmrs_mavlink.program import Geographic
from mmrs_mavlink.vehicles.evidence import LinkEvidence
from mmrs_mavlink.vehicles.telemetry import Telemetry

HOME = Geographic(42.37, 13.35, 10.0)
FAR = Geographic(42.371, 13.35, 10.0)
"""111 m to the north of home."""

ON_ITS_WAY, OTHERWISE = 42.3705, 42.36
COPTER_GUIDED, COPTER_BRAKE = 4, 17


def position(latitude: float, north: float = 0.0, east: float = 0.0):
    at = (round(latitude * 1e7), round(HOME.longitude * 1e7), 730_000, 10_000)
    return mavlink.MAVLink_global_position_int_message(
        1, *at, round(north * 100), round(east * 100), 0, 36_000
    )


def target(latitude: float):
    at = (round(latitude * 1e7), round(HOME.longitude * 1e7), 730.0)
    return mavlink.MAVLink_position_target_global_int_message(1, 0, 0xDF8, *at, *[0.0] * 8)


@contextmanager
def watched(*, mode: int = COPTER_GUIDED, autopilot: int = ARDUPILOT, profile=ARDUCOPTER):
    """Give evidence that begins now, of a vehicle that stands at home, and what it says afterwards."""
    with linked(autopilot=autopilot) as (link, wire):
        link.expect(profile)
        telemetry = Telemetry(link, HOME)
        wire.beat(autopilot=autopilot, mode=mode, armed=True)
        wire.say(position(HOME.latitude))
        eventually(lambda: link.latest("GLOBAL_POSITION_INT") and telemetry.mode() == mode)

        def say(message) -> None:
            told = link.since(message.get_type())
            before = link.clock.now() - told
            wire.say(message)
            eventually(lambda: link.clock.now() - link.since(message.get_type()) > before)

        yield LinkEvidence(link, telemetry, geographic=True), say, wire


def beat(mode: int):
    return mavlink.MAVLink_heartbeat_message(2, ARDUPILOT, 129, mode, 4, 3)


def test_a_mode_that_was_shown_before_the_order_proves_nothing():
    with watched(mode=COPTER_BRAKE) as (evidence, say, wire):
        assert not evidence.in_mode(HOLD)
        say(beat(COPTER_BRAKE))
        assert evidence.in_mode(HOLD)
        assert not evidence.in_mode(GUIDED)
        (asked,) = wire.of("COMMAND_LONG")
        assert (asked.command, asked.param1) == (mavlink.MAV_CMD_REQUEST_MESSAGE, 0)


@pytest.mark.parametrize("metres", [0.3, 0.8])
def test_a_vehicle_that_the_wind_drives_towards_the_place_is_not_seen_to_go_there(metres):
    with watched() as (evidence, say, _):
        say(position(HOME.latitude, north=metres))
        assert not evidence.bound_for(FAR, 5.0)


def test_a_vehicle_that_tells_another_target_is_not_believed_however_fast_it_comes_nearer():
    with watched() as (evidence, say, _):
        say(position(HOME.latitude, north=5.0))
        say(target(OTHERWISE))
        assert not evidence.bound_for(FAR, 5.0)


def test_a_target_that_was_told_before_the_order_proves_nothing():
    with linked() as (link, wire):
        telemetry = Telemetry(link, HOME)
        wire.say(target(FAR.latitude))
        wire.say(position(HOME.latitude))
        eventually(lambda: link.latest("GLOBAL_POSITION_INT") and telemetry.aim())
        evidence = LinkEvidence(link, telemetry, geographic=True)
        wire.say(position(HOME.latitude))
        link.wait(lambda: None, 0.2)
        assert not evidence.bound_for(FAR, 5.0)


def test_a_vehicle_that_tells_the_place_as_its_target_goes_there_although_it_still_stands():
    with watched() as (evidence, say, wire):
        say(position(HOME.latitude))
        assert not evidence.bound_for(FAR, 5.0)
        say(target(FAR.latitude))
        assert evidence.bound_for(FAR, 5.0)
        asked = [message.param1 for message in wire.of("COMMAND_LONG")]
        assert asked == [mavlink.MAVLINK_MSG_ID_POSITION_TARGET_GLOBAL_INT]


def test_a_vehicle_in_another_mode_does_not_go_where_it_is_told():
    with watched(mode=COPTER_BRAKE) as (evidence, say, _):
        say(target(FAR.latitude))
        assert not evidence.bound_for(FAR, 5.0)


def test_a_vehicle_that_never_tells_its_target_must_hurry_straight_there():
    with watched() as (evidence, say, _):
        say(position(HOME.latitude, north=2.0, east=2.0))
        assert not evidence.bound_for(FAR, 5.0)
        say(position(HOME.latitude, north=2.0, east=0.2))
        assert evidence.bound_for(FAR, 5.0)


def test_a_submarine_never_tells_its_target_and_is_slow():
    with watched(profile=ARDUSUB) as (evidence, say, _):
        say(position(HOME.latitude, north=0.1))
        assert not evidence.bound_for(FAR, None)
        say(position(HOME.latitude, north=0.5))
        assert evidence.bound_for(FAR, None)


def test_a_vehicle_that_is_there_obeys_as_soon_as_it_is_heard():
    with watched() as (evidence, say, _):
        assert not evidence.bound_for(HOME, 5.0)
        say(position(HOME.latitude))
        assert evidence.bound_for(HOME, 5.0)


@pytest.mark.parametrize(("moved", "goes"), [(ON_ITS_WAY, True), (OTHERWISE, False)], ids=["to", "away"])
def test_set_points_that_move_towards_the_place_are_those_of_a_px4_that_goes_there(moved, goes):
    offboard = PX4_MULTICOPTER.modes[GUIDED].number
    with watched(mode=offboard, autopilot=PX4) as (evidence, say, _):
        say(target(HOME.latitude))
        assert not evidence.bound_for(FAR, 5.0)
        say(target(moved))
        assert evidence.bound_for(FAR, 5.0) == goes
