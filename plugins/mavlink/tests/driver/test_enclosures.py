"""The vehicle's own fences by radius and height, against where a program leads."""

from __future__ import annotations

import pytest
from mavlink_peer import ARDUPILOT, PX4, linked, value

from mmrs_mavlink import Geographic
from mmrs_mavlink.services.items import Item
from mmrs_mavlink.vehicles.owner_settings import enclose
from mmrs_runtime.faults import RefusedError

HOME = Geographic(42.37, 13.35, 0.0)
USUAL = {"FENCE_ENABLE": 0.0, "FENCE_TYPE": 7.0, "FENCE_RADIUS": 300.0, "FENCE_ALT_MAX": 100.0}


def place(north: float = 0.0, height: float = 20.0) -> Geographic:
    return Geographic(42.37 + north / 111_073.0, 13.35, height)


def told(*places, polygons: bool = True, rally=(), autopilot: int = ARDUPILOT, **values: float):
    """Return what people are told, and the vehicle's parameters afterwards."""
    kept = dict(values)

    def answer(message):
        kind = message.get_type()
        if kind == "PARAM_SET" and message.param_id in kept:
            kept[message.param_id] = message.param_value
        if kind in ("PARAM_SET", "PARAM_REQUEST_READ") and message.param_id in kept:
            yield value(message.param_id, kept[message.param_id])

    with linked(answer, autopilot=autopilot) as (link, _):
        return list(enclose(link, HOME, places, rally, polygons=polygons)), kept


def test_a_fence_that_was_off_heeds_nothing_but_the_areas_of_the_program():
    lines, kept = told(place(1000.0, 150.0), **USUAL)
    assert kept["FENCE_TYPE"] == 4.0
    assert lines == ["FENCE_TYPE = 4, which was 7: its fence is the areas of the program alone"]


def test_a_fence_that_was_off_stays_as_it_is_where_there_are_no_areas():
    lines, kept = told(place(1000.0), polygons=False, **USUAL)
    assert (lines, kept) == ([], USUAL)


@pytest.mark.parametrize(
    ("where", "words"),
    [
        (place(299.0), r"ends 300 m from home \(FENCE_RADIUS\), and its program goes 299 m"),
        (place(0.0, 99.0), r"ends 100 m above home \(FENCE_ALT_MAX\), and its program goes to 99 m"),
    ],
)
def test_a_program_that_leaves_a_fence_that_was_on_is_refused(where, words):
    with pytest.raises(RefusedError, match=words):
        told(where, **USUAL | {"FENCE_ENABLE": 1.0})


def test_a_program_inside_a_fence_that_was_on_is_not_and_the_fence_stays():
    lines, kept = told(place(290.0, 90.0), **USUAL | {"FENCE_ENABLE": 1.0})
    assert (lines, kept["FENCE_TYPE"]) == ([], 7.0)


def test_only_what_a_fence_heeds_counts_and_areas_are_added():
    lines, kept = told(place(1000.0, 90.0), **USUAL | {"FENCE_ENABLE": 1.0, "FENCE_TYPE": 1.0})
    assert kept["FENCE_TYPE"] == 5.0
    assert lines == ["FENCE_TYPE = 5, which was 1: its fence obeys the areas of the program, too"]


def test_a_px4_heeds_its_distances_unless_they_are_zero():
    assert told(place(500.0), autopilot=PX4, GF_MAX_HOR_DIST=0.0, GF_MAX_VER_DIST=0.0)[0] == []
    with pytest.raises(RefusedError, match="GF_MAX_HOR_DIST"):
        told(place(500.0), autopilot=PX4, GF_MAX_HOR_DIST=400.0, GF_MAX_VER_DIST=0.0)


def test_a_vehicle_that_tells_nothing_is_not_refused():
    assert told(place(500.0))[0] == []


def test_rally_points_that_are_too_far_are_told():
    point = Item(5100, x=423_700_000, y=133_500_000, z=20.0)
    usual = USUAL | {"FENCE_TYPE": 4.0, "RALLY_LIMIT_KM": 0.3}
    (line,) = told(place(800.0), rally=[point], **usual)[0]
    assert "from 800 m away it goes home" in line
    assert told(place(200.0), rally=[point], **usual)[0] == []
