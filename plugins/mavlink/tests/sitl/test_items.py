"""What is accepted of items, and what is left of them."""

from math import nan

import pytest

from mmrs_mavlink.profiles import ARDUPILOT, PX4
from mmrs_mavlink.sitl import items
from mmrs_mavlink.sitl.items import FENCE, MISSION, RALLY, StoredItem, kept

UNSUPPORTED_FRAME, UNSUPPORTED = 2, 3


def item(command: int = 16, frame: int = 3, params=(0.0, 0.0, 0.0, 0.0), z: float = 20.0) -> StoredItem:
    return StoredItem(frame, command, params, 423_700_000, 133_500_000, z)


def fault_of(given: StoredItem, kind: int = MISSION, autopilot=ARDUPILOT) -> int:
    return items.fault_of(given, kind, autopilot)


@pytest.mark.parametrize("frame", [0, 3, 5, 6, 10, 11])
def test_places_have_heights_above_sea_home_or_terrain(frame):
    assert fault_of(item(frame=frame)) == 0


@pytest.mark.parametrize("frame", [1, 2, 4, 7])
def test_places_in_other_frames_are_refused(frame):
    assert fault_of(item(frame=frame)) == UNSUPPORTED_FRAME
    assert fault_of(item(command=178, frame=frame)) == 0


def test_only_a_heading_may_be_left_open():
    assert fault_of(item(params=(0.0, 0.0, 0.0, nan))) == 0
    assert fault_of(item(params=(nan, 0.0, 0.0, 0.0))) == 6
    assert fault_of(item(command=178, params=(0.0, 0.0, 0.0, nan))) == 9


def test_what_belongs_to_another_list_is_refused():
    assert fault_of(item(command=5002)) == UNSUPPORTED
    assert fault_of(item(command=5002), FENCE) == 0
    assert fault_of(item(command=16), RALLY) == UNSUPPORTED


@pytest.mark.parametrize(("frame", "given_back"), [(6, 3), (3, 3), (5, 0), (11, 10)])
def test_frames_come_back_by_their_old_numbers(frame, given_back):
    assert kept(item(frame=frame), 0, ARDUPILOT).frame == given_back


def test_holds_are_whole_seconds_and_heights_centimetres():
    found = kept(item(params=(1.9, 3.0, 4.0, nan), z=20.126), 0, ARDUPILOT)
    assert (found.params, found.z) == ((1.0, 0.0, 0.0, 0.0), 20.13)


def test_fences_have_no_height_and_rally_points_whole_metres():
    assert (kept(item(5002), FENCE, ARDUPILOT).frame, kept(item(5002), FENCE, ARDUPILOT).z) == (0, 0.0)
    assert kept(item(5100, z=12.9), RALLY, ARDUPILOT).z == 12.0


def test_a_px4_leaves_more_headings_free_and_refuses_what_its_missions_do_not_know():
    stays = item(command=19, params=(5.0, 0.0, 0.0, nan))
    assert (fault_of(stays), fault_of(stays, autopilot=PX4)) == (9, 0)
    turns = item(command=115, frame=2)
    assert (fault_of(turns), fault_of(turns, autopilot=PX4)) == (0, UNSUPPORTED)
