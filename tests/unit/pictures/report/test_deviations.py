"""How far a robot was from where it should have been."""

import re

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from mmrs_multicopter.testing import go_to
from shapely.geometry import LineString, Point

from mmrs_core.pictures.flights.planned import PlannedLeg
from mmrs_core.pictures.flights.positions import Locator
from mmrs_core.pictures.flights.tracks import along, nearest
from mmrs_core.pictures.report.charts import cross_track_chart
from mmrs_core.pictures.report.deviations import deviation_of
from mmrs_core.scene import Frame
from mmrs_core.testing.programs import move

WAY = ((0.0, 0.0, 10.0), (100.0, 0.0, 10.0))
PLACES = Locator(Frame("EPSG:4326", None, None))


def leg(begin=0.0, end=10.0, way=WAY, of=None):
    return PlannedLeg(of or go_to("east", way[-1] if way else (0.0, 0.0, 0.0)), begin, end, True, way)


def told(make, points, *entries, legs=None):
    flown = make.flown("alpha", (), make.track(points), entries)
    return deviation_of(flown, legs or [leg()], PLACES.of)


def test_sideways_and_height_are_told_apart(make):
    found = told(make, [(0, 0, 0, 10), (1, 10, 3, 10), (2, 20, 0, 14)])
    assert found.sideways.largest == pytest.approx(3.0)
    assert (found.time, found.move, found.where.position) == (1.0, "east", (10.0, 3.0, 10.0))
    assert found.upwards.largest == pytest.approx(4.0)
    assert (found.high_time, found.high_move) == (2.0, "east")


def test_half_and_95_percent_of_the_fixes_are_under_their_figures(make):
    found = told(make, [(i / 10, i, i / 10, 10) for i in range(100)])
    assert found.fixes == 100
    assert found.sideways.median == pytest.approx(4.95)
    assert found.sideways.most == pytest.approx(9.405)


@pytest.mark.parametrize(
    ("points", "legs", "fixes", "sideways"),
    [
        ([(1, 10, 1, 10), (50, 0, 500, 0)], [leg()], 1, 1.0),
        ([(1, 3, 4, 10)], [leg(of=move("stay", "HoldPosition", duration=5.0), way=WAY[:1])], 1, 5.0),
        ([(1, 5, 5, 5)], [leg(of=move("load", "Recharge", duration=5.0), way=WAY[:1])], 0, None),
        ([(1, 3, 4, 10)], [leg(way=())], 0, None),
    ],
    ids=["not outside of moves", "a hold from its place", "not on the ground", "not from an unknown path"],
)
def test_fixes_count_where_they_have_a_planned_path(make, points, legs, fixes, sideways):
    found = told(make, points, legs=legs)
    assert (found.fixes if found else 0) == fixes
    assert (found.sideways.largest if found else None) == (
        None if sideways is None else pytest.approx(sideways)
    )


def test_what_a_policy_made_a_robot_do_does_not_count_until_it_is_back(make):
    points = [
        (0, 0, 0, 10),
        (1, 10, 1, 10),
        (2, 10, 50, 10),
        (3, 10, 90, 0),
        (8, 10, 1, 10),
        (9, 20, 0.5, 10),
    ]
    decided = make.entry(1.5, "decision", what="BATTERY_LOW", response="RETURN")
    assert told(make, points).sideways.largest == pytest.approx(90.0)
    found = told(make, points, decided)
    assert (found.fixes, found.sideways.largest) == (3, pytest.approx(1.0))


def test_a_robot_that_carries_on_is_still_measured(make):
    decided = make.entry(0.5, "decision", what="PEER_LOST", response="CONTINUE")
    assert told(make, [(0, 0, 0, 10), (1, 10, 9, 10)], decided).sideways.largest == pytest.approx(9.0)


def test_a_way_of_several_legs_is_measured_to_the_nearest_of_them(make):
    way = ((0.0, 0.0, 0.0), (0.0, 0.0, 10.0), (20.0, 0.0, 10.0))
    found = told(make, [(1, 2, 0, 5), (2, 10, -3, 10)], legs=[leg(way=way)])
    assert found.sideways.largest == pytest.approx(3.0)
    assert found.upwards.largest == pytest.approx(0.0)


coordinates = st.floats(-100.0, 100.0).map(lambda value: round(value, 3))


@given(
    hnp.arrays(float, st.tuples(st.integers(1, 6), st.just(2)), elements=coordinates),
    hnp.arrays(float, st.tuples(st.integers(2, 6), st.just(2)), elements=coordinates),
)
def test_distances_agree_with_shapely(points, way):
    flat = [np.column_stack([each, np.zeros(len(each))]) for each in (points, way)]
    found = np.linalg.norm(flat[0] - nearest(*flat)[0], axis=1)
    assert found == pytest.approx([LineString(way).distance(Point(point)) for point in points], abs=1e-6)


def test_parts_of_a_way_are_told():
    way = np.array([[0.0, 0.0, 0.0], [10.0, 0.0, 0.0], [10.0, 30.0, 0.0]])
    assert along(np.array([[5.0, 1.0, 0.0], [10.0, 10.0, 9.0]]), way).tolist() == [0.125, 0.5]
    assert along(np.array([[5.0, 1.0, 0.0]]), way[:1].repeat(2, axis=0)).tolist() == [0.0]


def test_the_scale_of_a_chart_is_told_as_it_is():
    pieces = [(np.array([0.0, 10.0]), np.array([0.1, 0.38]))]
    told = re.findall(r">([\d.]+) m<", cross_track_chart(pieces, 10.0, "#000"))
    assert told == ["0", "0.25", "0.5"]
