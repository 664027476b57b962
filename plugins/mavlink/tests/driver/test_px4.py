"""PX4's way of being steered, as far as it can be told without one: set-points, modes, missions."""

import threading
from contextlib import contextmanager
from itertools import pairwise
from math import degrees, isnan, radians
from types import SimpleNamespace

import pytest
from mavlink_peer import ARDUPILOT, PX4, acknowledged, eventually, linked
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink import Geographic
from mmrs_mavlink.profiles import PX4 as PX4_AUTOPILOT
from mmrs_mavlink.profiles import PX4_MULTICOPTER, modes
from mmrs_mavlink.profiles.px4 import px4_number
from mmrs_mavlink.services.items import Item
from mmrs_mavlink.vehicles.guidance import ArduPilotGuidance
from mmrs_mavlink.vehicles.mission import items_for
from mmrs_mavlink.vehicles.mode_control import ModeControl
from mmrs_mavlink.vehicles.px4 import Px4Guidance
from mmrs_mavlink.vehicles.steering import Steering
from mmrs_mavlink.vehicles.telemetry import Telemetry
from mmrs_runtime.faults import FaultError

HOME = Geographic(42.37, 13.35, 0.0)
NORTH = Geographic(42.371, 13.35, 20.0)
OFFBOARD, LOITER, MISSION, TAKE_OFF, POSITION = 0x6_0000, 0x304_0000, 0x404_0000, 0x204_0000, 0x3_0000
GLOBAL_INT = 5


def here(height: float = 20.0, north: float = 0.0, seconds: float = 0.0):
    latitude = 423_700_000 + round(north * 1e7 / 111_319.49)
    place = (latitude, 133_500_000, 700_000 + round(height * 1000), round(height * 1000))
    return mavlink.MAVLink_global_position_int_message(round(seconds * 1e3), *place, 0, 0, 50, 9000)


class Autopilot:
    """Grants modes as a PX4 does: OFFBOARD only while set-points come."""

    def __init__(self, wire) -> None:
        self.wire = wire
        self.mode = LOITER
        self.armed = True
        self.points: list[object] = []

    def __call__(self, message):
        kind = message.get_type()
        if kind.startswith("SET_POSITION_TARGET"):
            self.points.append(message)
            return
        if kind != "COMMAND_LONG":
            return
        if message.command == mavlink.MAV_CMD_DO_SET_MODE:
            number = px4_number(int(message.param2), int(message.param3))
            if number == OFFBOARD and len(self.points) < 3:
                yield acknowledged(message.command, mavlink.MAV_RESULT_DENIED)
                return
            self.mode = number
        yield acknowledged(message.command)
        self.wire.beat(autopilot=PX4, mode=self.mode, armed=self.armed)


@pytest.fixture
def px4():
    """Return a mode control, its telemetry, and the PX4 that it steers, in flight, at ten times real time."""
    with steered(10.0) as found:
        yield found


@contextmanager
def steered(speedup: float):
    with linked(autopilot=PX4, speedup=speedup) as (link, wire):
        wire.answer = autopilot = Autopilot(wire)
        telemetry = Telemetry(link, HOME)
        wire.say(here())
        wire.beat(autopilot=PX4, mode=LOITER, armed=True)
        eventually(telemetry.armed)
        mode_control = ModeControl(link, telemetry)
        yield mode_control, telemetry, autopilot
        mode_control.guidance.end_guiding()


def test_modes_are_main_and_sub_modes():
    assert [PX4_MULTICOPTER.modes[name].number for name in (modes.GUIDED, modes.HOLD, modes.AUTO)] == [
        OFFBOARD,
        LOITER,
        MISSION,
    ]


def test_the_heartbeat_says_which_guidance_counts(px4):
    assert isinstance(px4[0].guidance, Px4Guidance)
    with linked(autopilot=ARDUPILOT) as (link, _):
        assert isinstance(ModeControl(link, Telemetry(link, HOME)).guidance, ArduPilotGuidance)


def test_set_points_come_before_offboard_is_asked_for_and_go_on():
    with steered(1.0) as (mode_control, telemetry, autopilot):
        mode_control.enter(modes.GUIDED)
        assert telemetry.mode() == OFFBOARD
        before = len(autopilot.points)
        assert before >= 10
        eventually(lambda: len(autopilot.points) > before + 10)


def test_set_points_begin_where_the_vehicle_is_above_sea_level(px4):
    mode_control, _, autopilot = px4
    mode_control.enter(modes.GUIDED)
    first = autopilot.points[0]
    assert (first.coordinate_frame, first.lat_int, first.lon_int) == (GLOBAL_INT, 423_700_000, 133_500_000)
    assert first.alt == pytest.approx(720.0)
    assert first.yaw == pytest.approx(radians(90.0))


def test_set_points_move_along_the_leg_at_the_commanded_speed(px4):
    mode_control, _, autopilot = px4
    mode_control.enter(modes.GUIDED)
    mode_control.guidance.aim(NORTH, 0.0, 5.0)
    begun = len(autopilot.points)
    eventually(lambda: len(autopilot.points) > begun + 30)
    metres = [(point.lat_int - 423_700_000) * 1e-7 * 111_319.49 for point in autopilot.points[begun:]]
    assert metres == sorted(metres)
    steps = [after - before for before, after in pairwise(metres[3:])]
    assert 0.2 < sum(steps) / len(steps) < 1.5
    assert metres[-1] < 111.0


def test_without_a_speed_the_set_point_is_the_target(px4):
    mode_control, _, autopilot = px4
    mode_control.enter(modes.GUIDED)
    mode_control.guidance.aim(NORTH, 0.0, None)
    eventually(lambda: autopilot.points[-1].lat_int == 423_710_000)


def test_set_points_turn_at_the_turn_rate(px4):
    mode_control, _, autopilot = px4
    mode_control.enter(modes.GUIDED)
    mode_control.guidance.aim(Geographic(42.37, 13.35, 20.0), radians(-60.0), None, radians(30.0))
    begun = len(autopilot.points)
    eventually(lambda: autopilot.points[-1].yaw == pytest.approx(radians(-60.0)), 10.0)
    steps = [degrees(one.yaw - two.yaw) for one, two in pairwise(autopilot.points[begun + 1 : -1])]
    assert min(steps) > 0.0
    assert 0.5 < sum(steps) / len(steps) < 9.0


@pytest.mark.parametrize(("north", "settled"), [(1.4, True), (1.6, False)])
def test_a_vehicle_settles_near_its_target_although_it_estimates_that_it_moves(px4, north, settled):
    mode_control, telemetry, autopilot = px4
    guidance, place = mode_control.guidance, Geographic(42.37, 13.35, 20.0)
    mode_control.enter(modes.GUIDED)
    found = []
    for seconds in (0.0, 3.0, 4.5, 7.0):
        guidance.aim(place if seconds < 7.0 else NORTH, 0.0, None)  # again, as if it might be lost
        autopilot.wire.say(here(north=north, seconds=seconds))
        eventually(lambda: telemetry.time() == seconds)  # noqa: B023
        eventually(lambda: autopilot.points[-1].lat_int == (423_700_000 if seconds < 7.0 else 423_710_000))  # noqa: B023
        found.append(guidance.has_settled(place))
    assert found == [False, False, settled, False]


def test_a_vehicle_settles_that_goes_a_bit_beyond_its_surroundings_in_between(px4):
    mode_control, telemetry, autopilot = px4
    guidance, place = mode_control.guidance, Geographic(42.37, 13.35, 20.0)
    mode_control.enter(modes.GUIDED)
    guidance.aim(place, 0.0, None)
    eventually(lambda: autopilot.points[-1].lat_int == 423_700_000)
    found = []
    for seconds, north in ((1.0, 1.4), (3.0, 1.4), (3.5, 1.6), (5.0, 1.4), (6.5, 1.4), (7.5, 1.4)):
        autopilot.wire.say(here(north=north, seconds=seconds))
        eventually(lambda: telemetry.time() == seconds)  # noqa: B023
        found.append(guidance.has_settled(place))
    assert found == [False, False, False, False, False, True]


def test_a_vehicle_has_not_settled_as_soon_as_it_estimates_that_it_stands_still(px4):
    """It does so by chance: two of five legs ended 2 s early where that counted."""
    mode_control, telemetry, autopilot = px4
    place = Geographic(42.37, 13.35, 20.0)
    mode_control.enter(modes.GUIDED)
    steering = Steering(SimpleNamespace(profile=PX4_MULTICOPTER), telemetry, mode_control, 0.5)
    mode_control.guidance.aim(place, 0.0, None)
    eventually(lambda: autopilot.points[-1].lat_int == 423_700_000)
    found = []
    for seconds in (1.0, 2.0, 6.5):
        resting = here(north=0.2, seconds=seconds)
        resting.vz = 0
        autopilot.wire.say(resting)
        eventually(lambda: telemetry.time() == seconds)  # noqa: B023
        found.append(steering._arrived(place, None))
    assert found == [False, False, True]


def assert_silent(autopilot) -> None:
    """Fail where set-points still come, once those on their way have."""
    threading.Event().wait(0.05)
    count = len(autopilot.points)
    threading.Event().wait(0.2)
    assert len(autopilot.points) == count


def test_set_points_end_after_another_mode_is_there(px4):
    mode_control, telemetry, autopilot = px4
    mode_control.enter(modes.GUIDED)
    mode_control.enter(modes.HOLD)
    assert telemetry.mode() == LOITER
    assert_silent(autopilot)


def test_set_points_end_when_somebody_else_has_the_vehicle(px4):
    mode_control, telemetry, autopilot = px4
    mode_control.enter(modes.GUIDED)
    autopilot.wire.beat(autopilot=PX4, mode=POSITION, armed=True)
    eventually(lambda: telemetry.mode() == POSITION)
    with pytest.raises(FaultError, match="it is under external control") as fault:
        mode_control.check()
    assert fault.value.event == "TAKEN_OVER"
    assert_silent(autopilot)


def test_a_take_off_goes_straight_up_to_a_height_above_sea_level_and_may_change_modes(px4):
    mode_control, telemetry, autopilot = px4
    mode_control.leave_ground(20.0)
    sent = next(each for each in reversed(autopilot.wire.of("COMMAND_LONG")) if each.command == 22)
    assert sent.param7 == pytest.approx(720.0)
    assert isnan(sent.param5)
    for mode in (TAKE_OFF, LOITER):
        autopilot.wire.beat(autopilot=PX4, mode=mode, armed=True)
        eventually(lambda mode=mode: telemetry.mode() == mode)
        mode_control.check()
    autopilot.wire.beat(autopilot=PX4, mode=POSITION, armed=True)
    eventually(lambda: telemetry.mode() == POSITION)
    with pytest.raises(FaultError, match="left mode take-off for position"):
        mode_control.check()


@pytest.mark.parametrize("restored", [OFFBOARD, MISSION, LOITER])
def test_a_mode_that_it_restores_as_it_disarms_is_not_a_pilots(px4, restored):
    mode_control, telemetry, autopilot = px4
    mode_control.enter(modes.LAND)
    autopilot.wire.beat(autopilot=PX4, mode=restored, armed=False)
    eventually(lambda: telemetry.mode() == restored)
    mode_control.check()
    asked = len(autopilot.wire.of("COMMAND_LONG"))
    mode_control.check()
    assert len(autopilot.wire.of("COMMAND_LONG")) == asked


@pytest.mark.parametrize(("mode", "armed"), [(POSITION, False), (POSITION, True), (MISSION, True)])
def test_another_mode_while_it_lands_is_a_pilots(px4, mode, armed):
    mode_control, telemetry, autopilot = px4
    mode_control.enter(modes.LAND)
    autopilot.wire.beat(autopilot=PX4, mode=mode, armed=armed)
    eventually(lambda: telemetry.mode() == mode)
    with pytest.raises(FaultError, match="left mode land"):
        mode_control.check()


def test_a_mission_has_no_home():
    items = [Item(16, x=n) for n in range(3)]
    assert [item.x for item in items_for(PX4_AUTOPILOT, items)] == [1, 2]


def test_a_mission_leaves_headings_to_the_vehicle_since_nought_is_north():
    items = [Item(16), Item(178, (1.0, 5.0, -1.0, 0.0)), Item(16, (1.0, 0.0, 0.0, 0.0)), Item(17)]
    speed, waypoint, wait = items_for(PX4_AUTOPILOT, items)
    assert speed == items[1]
    assert waypoint.params[:3] == (1.0, 0.0, 0.0)
    assert isnan(waypoint.params[3])
    assert isnan(wait.params[3])


def test_no_speed_is_commanded_where_set_points_have_it(px4):
    mode_control, _, autopilot = px4
    mode_control.pace(5.0)
    assert not [each for each in autopilot.wire.of("COMMAND_LONG") if each.command == 178]
