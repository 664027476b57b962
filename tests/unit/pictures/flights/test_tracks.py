"""Where a robot was at a time, as far as anybody knows; and where fixes lie in the frame of a behaviour."""

from dataclasses import replace

import numpy as np
import pytest
from mmrs_multicopter.testing import quad, robot_program, take_off

from mmrs_core.behaviour.earth import degrees_of
from mmrs_core.pictures.flights.fixes import Datum, Fixes, datum_of
from mmrs_core.scene import Frame
from mmrs_core.testing.programs import L_AQUILA, program
from mmrs_core.transformation.kinds import PLAIN_ROBOT
from mmrs_runtime.records.entries import Entry

HOME = (100.0, -50.0, 7.0)
UP = [take_off("up", 5.0)]


def fix(time, place, energy=None):
    return Entry("r", "Ann", time, "", "fix", {"place": place, "energy": energy})


def local(north, east, height):
    return {"north": north, "east": east, "height": height}


def track_of(entries, frame=L_AQUILA, *, exact=False):
    fixes = Fixes()
    for entry in entries:
        fixes.add(entry)
    return fixes, fixes.track(Datum(frame, HOME, HOME[2]), exact=exact)


def test_places_near_home_count_from_home():
    _, track = track_of([fix(0.0, local(1.0, 2.0, 3.0))])
    assert track.positions.tolist() == [[102.0, -49.0, 10.0]]


def test_places_on_the_earth_are_where_targets_put_them():
    points = [(12.5, -80.25), (4000.0, 3000.0)]
    places = [
        {"latitude": latitude, "longitude": longitude, "height": 4.0}
        for latitude, longitude in degrees_of(points, L_AQUILA)
    ]
    _, track = track_of([fix(float(i), place) for i, place in enumerate(places)])
    assert track.positions[:, :2] == pytest.approx(np.array(points), abs=0.02)
    assert track.positions[:, 2].tolist() == [11.0, 11.0]


def test_places_on_the_earth_have_none_in_a_local_frame_and_are_counted():
    frame = Frame("EPSG:4326", None, None)
    fixes, track = track_of([fix(0.0, {"latitude": 42.0, "longitude": 13.0, "height": 0.0})], frame)
    assert len(track.times) == 0
    assert fixes.unplaced == 1


@pytest.mark.parametrize(
    "place",
    [None, {}, {"north": 1.0, "east": "x", "height": 0.0}, {"latitude": 1e9, "longitude": 0, "height": 0}],
)
def test_a_place_that_is_none_is_counted_and_left_out(place):
    fixes, track = track_of([fix(0.0, place), fix(1.0, local(0, 0, 0))])
    assert fixes.unplaced == 1
    assert track.times.tolist() == [1.0]


def test_a_place_at_the_other_side_of_the_earth_does_not_hide_the_others():
    near = {"latitude": 42.37, "longitude": 13.35, "height": 0.0}
    fixes, track = track_of([fix(0.0, near), fix(1.0, {**near, "longitude": -120.0, "latitude": 0.0})])
    assert track.times.tolist()[0] == 0.0
    assert len(track.times) + fixes.unplaced == 2


@pytest.mark.parametrize(
    ("time", "expected"),
    [
        (0.4, None),
        (0.6, (100.0, -50.0, 7.0)),
        (1.25, (100.0, -47.5, 8.0)),
        (2.0, (100.0, -40.0, 11.0)),
        (2.4, (100.0, -40.0, 11.0)),
        (2.6, None),
    ],
)
def test_a_robot_went_straight_between_fixes_and_is_unknown_from_half_a_second_beyond(time, expected):
    _, track = track_of([fix(1.0, local(0, 0, 0)), fix(2.0, local(10, 0, 4))])
    assert track.at(time) == (None if expected is None else pytest.approx(expected))


@pytest.mark.parametrize(
    ("times", "exact", "gaps"),
    [
        ((0.0, 1.0, 2.0, 10.0, 11.0), False, ((2.0, 10.0),)),
        ((0.0, 10.0, 20.0, 30.0, 40.0), False, ()),
        ((0.0, 1.0, 2.0, 500.0), True, ()),
    ],
    ids=["lost", "slow telemetry", "simulation"],
)
def test_a_long_time_without_fixes_is_a_gap(times, exact, gaps):
    _, track = track_of([fix(time, local(time, 0, 0)) for time in times], exact=exact)
    assert track.gaps == gaps
    assert all(track.at(time) is not None for time in times)
    assert (track.at(5.0) is None) == bool(gaps)


def test_a_fix_of_which_the_time_was_damaged_is_left_out_and_counted():
    fixes, track = track_of([fix(t, local(t, 0, 0)) for t in (0.0, 1.0, 9e9, 2.0, 3.0)])
    assert track.times.tolist() == [0.0, 1.0, 2.0, 3.0]
    assert (fixes.astray, fixes.turned) == (1, 0)


def test_time_that_goes_back_stands_still_and_is_counted():
    fixes, track = track_of([fix(t, local(t, 0, 0)) for t in (0.0, 4.0, 5.0, 2.0, 3.0, 6.0)])
    assert track.times.tolist() == [0.0, 4.0, 5.0, 5.0, 5.0, 6.0]
    assert fixes.turned == 2


DIVER = replace(PLAIN_ROBOT, name="ray", metaclass=("urn:rays:1.0", "Ray"), vehicle="ray", medium="water")


def test_heights_under_water_count_from_the_surface():
    behaviour = program(robot_program("Ann", UP, home=HOME), frame=replace(L_AQUILA, surface=2.0))
    kinds = {DIVER.metaclass: DIVER, PLAIN_ROBOT.metaclass: PLAIN_ROBOT}
    assert datum_of(behaviour.robots[0], behaviour, None, DIVER.vehicle, kinds).up == 2.0
    assert datum_of(behaviour.robots[0], behaviour, None, PLAIN_ROBOT.vehicle, kinds).up == 7.0


def test_heights_of_a_robot_whose_box_is_silent_count_as_its_kind_says():
    behaviour = program(robot_program("Ann", UP, home=HOME), frame=replace(L_AQUILA, surface=2.0))
    ray = replace(quad(), metaclasses=(DIVER.metaclass, PLAIN_ROBOT.metaclass))
    assert datum_of(behaviour.robots[0], behaviour, ray, kinds={DIVER.metaclass: DIVER}).up == 2.0


@pytest.mark.parametrize(
    ("marked", "expected"),
    [
        ((), [3.0, 6.0, 9.0]),
        ((3.2, 6.5), [3.2, 6.5, 9.5]),
        ((3.2, 6.1, 6.3), [3.2, 6.1, 9.1]),
        ((0.1,), [3.0, 6.0, 9.0]),
    ],
)
def test_a_distance_is_gone_again_from_where_it_was_marked_to_be(marked, expected):
    _, track = track_of([fix(float(t), local(10.0 * t, 0.0, 20.0)) for t in range(11)])
    assert track.times_at_each(30.0, 0.0, 10.0, marked) == pytest.approx(expected)


def test_a_distance_that_ends_with_the_way_is_left_to_its_end():
    _, track = track_of([fix(float(t), local(10.0 * t, 0.0, 20.0)) for t in range(10)])
    assert track.times_at_each(30.0, 0.0, 9.0) == pytest.approx([3.0, 6.0])
