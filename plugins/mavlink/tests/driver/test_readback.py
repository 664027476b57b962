"""Which differences between what was uploaded and what is given back are none, by autopilot."""

from dataclasses import replace
from math import nan

import pytest

from mmrs_mavlink.profiles import ARDUPILOT, GENERIC, PX4, Autopilot
from mmrs_mavlink.services.items import FENCE, MISSION, NO_FRAME, RALLY, Item
from mmrs_mavlink.services.missions import alike

POINT = Item(16, (2.0, 1.5, 0.0, 90.0), 423_700_000, 133_500_000, 20.5)
SPEED = Item(178, (1.0, 5.0, -1.0, 0.0), frame=NO_FRAME)
ALL = (ARDUPILOT, PX4, GENERIC)


def same(wanted: Item, autopilot: Autopilot, kind: int = MISSION, **kept) -> bool:
    return alike(wanted, replace(wanted, **kept), kind, autopilot.keeping)


@pytest.mark.parametrize("autopilot", ALL, ids=lambda each: each.name)
def test_the_same_is_the_same(autopilot):
    assert same(POINT, autopilot)
    assert same(SPEED, autopilot)


@pytest.mark.parametrize(("autopilot", "kept"), [(ARDUPILOT, True), (PX4, False), (GENERIC, False)])
def test_an_ardupilot_keeps_nothing_but_the_hold_of_a_waypoint(autopilot, kept):
    assert same(POINT, autopilot, params=(2.0, 0.0, 0.0, 0.0)) is kept


@pytest.mark.parametrize("autopilot", ALL, ids=lambda each: each.name)
def test_a_hold_that_is_lost_is_a_difference(autopilot):
    assert not same(POINT, autopilot, params=(0.0, 1.5, 0.0, 90.0))


@pytest.mark.parametrize(("autopilot", "is_same"), [(PX4, True), (GENERIC, False)])
def test_a_px4_gives_headings_back_between_minus_180_and_180(autopilot, is_same):
    east = replace(POINT, params=(2.0, 1.5, 0.0, 270.0))
    assert same(east, autopilot, params=(2.0, 1.5, 0.0, -90.0)) is is_same


def test_what_is_no_number_stays_none():
    free = replace(POINT, params=(2.0, 1.5, 0.0, nan))
    assert same(free, PX4)
    assert not same(free, PX4, params=(2.0, 1.5, 0.0, 0.0))


@pytest.mark.parametrize("autopilot", ALL, ids=lambda each: each.name)
@pytest.mark.parametrize(("apart", "is_same"), [(1, True), (2, False)])
def test_places_may_lose_one_unit_of_the_seventh_decimal(autopilot, apart, is_same):
    assert same(POINT, autopilot, y=POINT.y - apart) is is_same


@pytest.mark.parametrize(
    ("autopilot", "kind", "step"),
    [(ARDUPILOT, MISSION, 0.02), (ARDUPILOT, RALLY, 1.0), (PX4, MISSION, 0.01), (PX4, RALLY, 0.01)],
)
def test_heights_may_lose_what_each_autopilot_loses(autopilot, kind, step):
    assert same(POINT, autopilot, kind, z=POINT.z - 0.9 * step)
    assert not same(POINT, autopilot, kind, z=POINT.z - 1.1 * step)


@pytest.mark.parametrize("autopilot", ALL, ids=lambda each: each.name)
def test_fences_have_no_heights(autopilot):
    vertex = Item(5002, (4.0, 0.0, 0.0, 0.0), 423_700_000, 133_500_000, 0.0)
    assert same(vertex, autopilot, FENCE, frame=0, z=700.0)
    assert not same(vertex, autopilot, FENCE, params=(5.0, 0.0, 0.0, 0.0))


@pytest.mark.parametrize("autopilot", ALL, ids=lambda each: each.name)
def test_another_command_is_another_item(autopilot):
    assert not same(POINT, autopilot, command=17)


@pytest.mark.parametrize("autopilot", ALL, ids=lambda each: each.name)
def test_a_speed_must_be_kept_as_it_is(autopilot):
    assert not same(SPEED, autopilot, params=(1.0, 4.9, -1.0, 0.0))
