"""What sets PX4 apart, as its documentation says."""

from __future__ import annotations

import math
import struct

import pytest
from simulated import Bench

from mmrs_mavlink.sitl.commands import steer
from mmrs_mavlink.sitl.items import Item, kept
from mmrs_mavlink.sitl.parameters import decoded, encoded
from mmrs_mavlink.sitl.settings import Settings

OFFBOARD, MISSION, LOITER = (6, 0), (4, 4), (4, 3)
INT32 = 6


def switch(bench: Bench, mode: tuple[int, int]) -> int:
    return bench.command(176, 1, *mode)


def stream(bench: Bench, place, seconds: float, rate: float = 10.0) -> None:
    for _ in range(round(seconds * rate)):
        steer(bench.pilot, place, None)
        bench.wait(1.0 / rate)


@pytest.fixture
def bench():
    bench = Bench(firmware="px4")
    assert bench.command(400, 1) == 0
    assert bench.command(22, 0, 0, 0, 0, 0, 0, 720.0 + 10.0) == 0
    assert bench.wait_for(lambda: bench.pilot.mode_name == "loiter", 30.0)
    return bench


def test_take_off_takes_a_height_above_the_sea_and_ends_in_hold(bench):
    assert bench.pilot.body.position[2] == pytest.approx(10.0, abs=0.4)
    assert [number for _, number in bench.pilot.modes] == [4 << 16 | 2 << 24, 4 << 16 | 3 << 24]


def test_offboard_is_refused_without_set_points(bench):
    assert switch(bench, OFFBOARD) != 0


def test_offboard_is_refused_with_set_points_that_come_too_seldom(bench):
    stream(bench, (0.0, 0.0, 10.0), 4.0, rate=1.0)
    assert switch(bench, OFFBOARD) != 0


def test_offboard_follows_a_stream_of_set_points(bench):
    stream(bench, (0.0, 0.0, 10.0), 1.5)
    assert switch(bench, OFFBOARD) == 0
    stream(bench, (0.0, 20.0, 10.0), 10.0)
    assert bench.pilot.body.distance_to((0.0, 20.0, 10.0)) < 0.2


def test_offboard_is_left_when_the_stream_ends(bench):
    stream(bench, (0.0, 0.0, 10.0), 1.5)
    switch(bench, OFFBOARD)
    bench.wait(0.8)
    assert bench.pilot.mode_name == "guided"
    bench.wait(0.5)
    assert bench.pilot.mode_name == "poshold"


def test_offboard_comes_back_by_itself_with_the_stream(bench):
    stream(bench, (0.0, 0.0, 10.0), 1.5)
    switch(bench, OFFBOARD)
    bench.wait(1.3)
    assert bench.pilot.mode_name == "poshold"
    stream(bench, (0.0, 0.0, 10.0), 1.5)
    assert bench.pilot.mode_name == "guided"


def unheard(bench: Bench, seconds: float) -> str:
    """Let time pass in which no ground station is heard; return the mode then."""
    bench.wait_for(lambda: False, seconds, heard=False)
    return bench.pilot.mode_name


def test_it_holds_for_a_while_before_it_returns_since_nobody_is_heard(bench):
    bench.pilot.parameters |= {"NAV_DLL_ACT": 2, "COM_OF_LOSS_T": 60.0}
    stream(bench, (0.0, 0.0, 10.0), 1.5)
    switch(bench, OFFBOARD)
    assert unheard(bench, 9.5) == "guided"
    assert unheard(bench, 1.0) == "loiter"
    assert unheard(bench, 4.0) == "loiter"
    assert unheard(bench, 1.0) == "return"
    assert [text for _, _, text in bench.pilot.said[-3:]] == [
        "Connection to ground station lost",
        "Failsafe activated, entering Hold for 5 seconds",
        "Failsafe activated",
    ]


def test_where_its_owner_exempts_a_mode_it_goes_on_although_it_hears_nobody(bench):
    bench.pilot.parameters |= {"NAV_DLL_ACT": 2, "COM_OF_LOSS_T": 60.0, "COM_DLL_EXCEPT": 4}
    stream(bench, (0.0, 0.0, 10.0), 1.5)
    switch(bench, OFFBOARD)
    assert unheard(bench, 20.0) == "guided"


def test_whoever_gives_it_another_mode_while_it_holds_has_it(bench):
    bench.pilot.parameters["NAV_DLL_ACT"] = 2
    switch(bench, (3, 0))
    assert unheard(bench, 10.5) == "loiter"
    switch(bench, (3, 0))
    assert unheard(bench, 10.0) == "poshold"


def test_what_it_held_for_is_forgotten_once_it_is_disarmed(bench):
    bench.pilot.parameters["NAV_DLL_ACT"] = 2
    assert unheard(bench, 10.5) == "loiter"
    bench.command(400, 0, 21196)
    bench.wait(0.2)
    assert bench.command(400, 1) == 0
    bench.wait(6.0)
    assert bench.pilot.mode_name == "loiter"


def test_out_of_its_fence_it_does_what_it_is_told_for_that(bench):
    bench.pilot.parameters |= {"GF_ACTION": 5, "GF_MAX_HOR_DIST": 15.0, "COM_FAIL_ACT_T": 0.0}
    stream(bench, (0.0, 0.0, 10.0), 1.5)
    switch(bench, OFFBOARD)
    stream(bench, (0.0, 30.0, 10.0), 8.0)
    assert bench.pilot.mode_name == "land"
    assert "Geofence: approaching or outside geofence" in [text for _, _, text in bench.pilot.said]


@pytest.mark.parametrize(("kind", "east"), [(0, 0.0), (1, 30.0)])
def test_it_returns_to_a_rally_point_where_it_is_told_to_rather_than_home(bench, kind, east):
    bench.pilot.parameters |= {"RTL_TYPE": kind, "RTL_RETURN_ALT": 10.0}
    bench.pilot.stores[2] = [bench.item(5100, (0.0, 30.0, 0.0))]
    switch(bench, (4, 5))
    assert bench.wait_for(lambda: not bench.pilot.armed, 120.0)
    assert bench.pilot.body.position[1] == pytest.approx(east, abs=1.0)


def test_a_mission_begins_with_its_first_item(bench):
    bench.pilot.stores[0] = [bench.item(16, (0.0, 20.0, 10.0), 1.0), bench.item(17, (10.0, 20.0, 10.0))]
    assert switch(bench, MISSION) == 0
    assert bench.wait_for(lambda: bench.pilot.item == 1, 30.0)
    assert [item for _, item in bench.pilot.visited] == [0]


def test_whole_numbers_travel_as_their_bytes():
    value, kind = encoded("NAV_DLL_ACT", 2.0, "px4")
    assert (struct.unpack("<i", struct.pack("<f", value))[0], kind) == (2, INT32)
    assert decoded("NAV_DLL_ACT", value, INT32, "px4") == 2.0
    assert encoded("BATT_FS_LOW_ACT", 2.0, "ardupilot") == (2.0, INT32)


def test_items_are_kept_as_they_came():
    item = Item(6, 16, (1.5, 0.0, 0.0, math.nan), 1, 2, 3.14159)
    assert kept(item, 0, "px4") is item


def test_only_copters_fly_it():
    with pytest.raises(ValueError, match="not a firmware for a rover"):
        Settings("rover", firmware="px4")
