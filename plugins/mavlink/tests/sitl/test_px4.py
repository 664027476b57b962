"""PX4: OFFBOARD, failsafes, rally points, missions and parameters."""

import math
import struct

import pytest
from simulated import Bench

from mmrs_mavlink.profiles import ARDUPILOT, PX4
from mmrs_mavlink.sitl.commands import steer
from mmrs_mavlink.sitl.items import StoredItem, kept
from mmrs_mavlink.sitl.settings import Settings

OFFBOARD, MISSION, POSITION, RETURN = (6, 0), (4, 4), (3, 0), (4, 5)
HERE = (0.0, 0.0, 10.0)
INT32, REAL32 = 6, 9


def switch(bench: Bench, mode: tuple[int, int]) -> int:
    return bench.command(176, 1, *mode)


def stream(bench: Bench, place, seconds: float, rate: float = 10.0) -> None:
    for _ in range(round(seconds * rate)):
        steer(bench.pilot, place, None)
        bench.wait(1.0 / rate)


def without_link(bench: Bench, seconds: float) -> str:
    """Return the mode after that time without a heartbeat."""
    bench.wait_for(lambda: False, seconds, heard=False)
    return bench.pilot.mode_name


@pytest.fixture
def bench():
    """Return a vehicle in the air."""
    bench = Bench(firmware="px4")
    assert bench.command(400, 1) == 0
    assert bench.command(22, 0, 0, 0, 0, 0, 0, 720.0 + 10.0) == 0
    assert bench.wait_for(lambda: bench.pilot.mode_name == "hold", 30.0)
    return bench


@pytest.fixture
def offboard(bench):
    stream(bench, HERE, 1.5)
    assert switch(bench, OFFBOARD) == 0
    return bench


def test_take_off_takes_an_altitude_above_the_sea_and_ends_in_hold(bench):
    assert bench.pilot.body.position[2] == pytest.approx(10.0, abs=0.4)
    assert [number for _, number in bench.pilot.modes] == [4 << 16 | 2 << 24, 4 << 16 | 3 << 24]


@pytest.mark.parametrize("seconds", [0.0, 4.0])
def test_offboard_is_refused_without_set_points_or_at_a_low_rate(bench, seconds):
    stream(bench, HERE, seconds, rate=1.0)
    assert switch(bench, OFFBOARD) != 0


def test_offboard_follows_a_stream_of_set_points(offboard):
    stream(offboard, (0.0, 20.0, 10.0), 14.0)
    assert offboard.pilot.body.distance_to((0.0, 20.0, 10.0)) < 0.2


def test_offboard_ends_with_its_stream(offboard):
    offboard.wait(0.8)
    assert offboard.pilot.mode_name == "guided"
    offboard.wait(0.5)
    assert offboard.pilot.mode_name == "position"


def test_a_lost_link_is_answered(offboard):
    offboard.pilot.parameters |= {"NAV_DLL_ACT": 2, "COM_OF_LOSS_T": 60.0}
    assert [without_link(offboard, seconds) for seconds in (9.5, 1.0)] == ["guided", "return"]
    offboard.wait(1.0)
    said = [text for _, _, text in offboard.pilot.said[-2:]]
    assert said == ["Connection to ground station lost", "GCS connection regained"]


@pytest.mark.parametrize(("kind", "east"), [(0, 0.0), (1, 30.0)])
def test_return_goes_home_or_to_a_rally_point_as_configured(bench, kind, east):
    bench.pilot.parameters |= {"RTL_TYPE": kind, "RTL_RETURN_ALT": 10.0}
    bench.pilot.stores[2] = [bench.item(5100, (0.0, 30.0, 0.0))]
    switch(bench, RETURN)
    assert bench.wait_for(lambda: not bench.pilot.armed, 120.0)
    assert bench.pilot.body.position[1] == pytest.approx(east, abs=1.0)


def test_a_mission_begins_with_item_0(bench):
    bench.pilot.stores[0] = [bench.item(16, (0.0, 20.0, 10.0), 1.0), bench.item(17, (10.0, 20.0, 10.0))]
    assert switch(bench, MISSION) == 0
    assert bench.wait_for(lambda: bench.pilot.item == 1, 30.0)
    assert [item for _, item in bench.pilot.visited] == [0]


def test_integers_are_sent_as_their_bytes():
    value, kind = PX4.encoded("NAV_DLL_ACT", 2.0)
    assert (struct.unpack("<i", struct.pack("<f", value))[0], kind) == (2, INT32)
    assert PX4.decoded(value, INT32) == 2.0
    assert ARDUPILOT.encoded("BATT_FS_LOW_ACT", 2.0) == (2.0, REAL32)


def test_items_are_stored_as_received():
    item = StoredItem(6, 16, (1.5, 0.0, 0.0, math.nan), 1, 2, 3.14159)
    assert kept(item, 0, PX4) is item


def test_px4_is_for_copters_only():
    with pytest.raises(ValueError, match="not a firmware for a rover"):
        Settings("rover", firmware="px4")
