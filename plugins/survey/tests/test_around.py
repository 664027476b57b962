from itertools import pairwise
from math import cos, dist, pi, sin

import numpy as np
import pytest
import shapely
from mmrs_survey.around import orbit_work, perimeter_work

from mmrs_core.errors import InfeasibleError
from mmrs_core.geometry.stretches import point_at

SHELL = ((0.0, 0.0, 0.0), (40.0, 0.0, 0.0), (40.0, 20.0, 0.0), (0.0, 20.0, 0.0))


def perimeter(task, **more):
    given = {
        "initialPosition": (-10.0, 0.0, 0.0),
        "shell": SHELL,
        "altitude": 10.0,
        "distance": 8.0,
        "clockwise": True,
        "faceBorder": True,
        "actionName": "TakePicture",
    }
    return task("PerimeterTask", **{**given, **more})


def test_a_perimeter_goes_around_at_its_distance_and_faces_each_side(robot, scene, task):
    work = perimeter_work(perimeter(task, photoDistance=10.0), robot(), scene())
    area = shapely.Polygon([point[:2] for point in SHELL])
    assert [stroke.points[0] for stroke in work.strokes] == [
        (-8.0, -8.0, 10.0),
        (-8.0, 28.0, 10.0),
        (48.0, 28.0, 10.0),
        (48.0, -8.0, 10.0),
    ]
    for stroke in work.strokes:
        line = shapely.LineString([point[:2] for point in stroke.points])
        view = shapely.LineString([line.centroid.coords[0], stroke.look.at[:2]])
        assert line.distance(area) == 8.0
        assert view.crosses(area)
        assert stroke.look.at[2] == 10.0


@pytest.mark.parametrize(("facing", "most"), [(False, 1), (True, 60)])
def test_a_border_drawn_freehand_is_followed_along_few_sides(robot, scene, task, facing, most):
    turns = [2 * pi * step / 400 for step in range(400)]
    shell = tuple(((30 + 2 * sin(7 * a)) * cos(a), (30 + 2 * sin(7 * a)) * sin(a), 0.0) for a in turns)
    given = perimeter(task, shell=shell, faceBorder=facing, capture="AT_STOPS", photoDistance=6.0)
    strokes = perimeter_work(given, robot(), scene()).strokes
    path = shapely.Polygon([point[:2] for each in strokes for point in each.points])
    drawn = shapely.Polygon([point[:2] for point in shell]).buffer(8.0, join_style="mitre", mitre_limit=2.0)
    assert len(strokes) <= most
    assert all(one.points[-1] == two.points[0] for one, two in pairwise((*strokes, strokes[0])))
    assert shapely.hausdorff_distance(path.exterior, drawn.exterior) <= 0.1 + 1e-9
    places = [point_at(each.points, action.at) for each in strokes for action in each.actions]
    assert len(places) <= path.length / 6.0 + 2.0 + len(strokes) / 2.0
    assert all(dist(one, two) <= 6.0 + 1e-6 for one, two in pairwise((*places, places[0])))
    for each in strokes if facing else ():
        chord = shapely.LineString([each.points[0], each.points[-1]])
        off = max(chord.distance(shapely.Point(point)) for point in each.points)
        assert off <= max(0.3, 0.044 * chord.length)


@pytest.mark.parametrize(("radius", "most"), [(1.0, 20.0), (5.0, 20.0), (30.0, 10.0)])
def test_a_round_border_is_faced_all_along(robot, scene, task, radius, most):
    turns = [2 * pi * step / 72 for step in range(72)]
    shell = tuple((radius * cos(a), radius * sin(a), 0.0) for a in turns)
    for each in perimeter_work(perimeter(task, shell=shell, distance=1.0), robot(), scene()).strokes:
        chord = np.subtract(each.points[-1], each.points[0])[:2]
        legs = np.diff(np.array(each.points)[:, :2], axis=0)
        cosines = legs @ chord / (np.linalg.norm(legs, axis=1) * np.linalg.norm(chord))
        assert np.degrees(np.arccos(np.clip(cosines, -1.0, 1.0))).max() <= most


def test_a_perimeter_inside_turned_round_faces_the_border_too(robot, scene, task):
    work = perimeter_work(perimeter(task, distance=-5.0, clockwise=False), robot(), scene())
    first = work.strokes[0]
    assert first.points == ((5.0, 5.0, 10.0), (35.0, 5.0, 10.0))
    assert first.look.at[:2] == (20.0, 5.0 - 30.0 * 30.0)
    with pytest.raises(InfeasibleError, match="nothing of the area is 11 m from its border"):
        perimeter_work(perimeter(task, distance=-11.0), robot(), scene())


def at_ground(*corners):
    return tuple((*corner, 0.0) for corner in corners)


def faced(strokes, shell):
    """Yield how far before a place on each stroke the border is to which its camera looks, metres."""
    border = shapely.LinearRing([point[:2] for point in shell])
    for each in strokes:
        begin, end = np.array(each.points[0][:2]), np.array(each.points[-1][:2])
        there = begin + 0.2 * (end - begin)
        aim = shapely.LineString([there, there + each.look.at[:2] - (begin + end) / 2.0])
        yield round(shapely.intersection(aim, border).distance(shapely.Point(there)), 3)


@pytest.mark.parametrize("facing", [False, True])
@pytest.mark.parametrize("clockwise", [False, True])
def test_all_rooms_are_gone_around_and_what_no_path_faces_is_left_out(robot, scene, task, facing, clockwise):
    rooms = at_ground(
        *((0, 0), (60, 0), (60, 22), (80, 22), (80, 0), (140, 0), (140, 60)),
        *((80, 60), (80, 38), (60, 38), (60, 60), (0, 60)),
    )
    given = perimeter(
        task,
        shell=rooms,
        distance=-10.0,
        initialPosition=(130.0, 30.0, 0.0),
        clockwise=clockwise,
        faceBorder=facing,
    )
    work = perimeter_work(given, robot(), scene())
    gone = shapely.get_parts(
        shapely.line_merge(shapely.MultiLineString([[p[:2] for p in each.points] for each in work.strokes]))
    )
    assert {each.bounds for each in gone} == {(10, 10, 50, 50), (90, 10, 130, 50)}
    assert work.strokes[0].points[0][0] == 130.0
    assert not facing or set(faced(work.strokes, rooms)) == {10.0}
    assert [(round(gap.begin, 1), round(gap.length, 1)) for gap in work.gaps] == [(87.3, 9.4), (331.3, 9.4)]


def test_a_courtyard_with_a_narrow_mouth_is_gone_around_inside(robot, scene, task):
    walls = ((0, 0), (80, 0), (80, 80), (46, 80), (46, 70), (70, 70), (70, 10), (10, 10), (10, 70), (34, 70))
    shell = at_ground(*walls, (34, 80), (0, 80))
    work = perimeter_work(perimeter(task, shell=shell), robot(), scene())
    inside = [
        each for each in work.strokes if shapely.box(0, 0, 80, 80).covers(shapely.LineString(each.points))
    ]
    path = shapely.polygonize([shapely.LineString([p[:2] for p in each.points]) for each in inside])
    assert shapely.equals(shapely.unary_union(path), shapely.box(18, 18, 62, 62))
    assert set(faced(inside, shell)) == {8.0}
    assert [round(gap.length, 1) for gap in work.gaps] == [1.4, 1.4]


def test_a_perimeter_in_the_middle_of_an_area_may_be_short(robot, scene, task):
    square = at_ground((0, 0), (20, 0), (20, 20), (0, 20))
    given = perimeter(task, shell=square, distance=-9.9, initialPosition=(5.0, 5.0, 0.0))
    places = {
        tuple(np.round(p, 1)) for each in perimeter_work(given, robot(), scene()).strokes for p in each.points
    }
    assert places <= {(x, y, 10.0) for x in (9.9, 10.0, 10.1) for y in (9.9, 10.0, 10.1)}


def test_a_narrow_notch_is_left_out_of_a_perimeter(robot, scene, task):
    shell = at_ground((0, 0), (60, 0), (60, 50), (36, 50), (36, 10), (24, 10), (24, 50), (0, 50))
    (gap,) = perimeter_work(perimeter(task, shell=shell), robot(), scene()).gaps
    assert (gap.line, gap.area, gap.at[:2]) == ("the border", "other sides of it", (30.0, 10.0))
    assert 80.0 < gap.length < 92.0


@pytest.mark.parametrize(
    ("more", "heights"),
    [
        ({}, [10.0]),
        ({"topAltitude": 20.0}, [10.0, 20.0]),
        ({"topAltitude": 20.0, "layers": 3, "startFromTop": True}, [20.0, 15.0, 10.0]),
        (
            {"topAltitude": 20.0, "footprintWidth": 6.0, "footprintLength": 5.0, "sideOverlap": 0.2},
            [10.0, 13.333, 16.667, 20.0],
        ),
    ],
)
def test_layers_are_spread_evenly_as_near_as_they_must_be(robot, scene, task, more, heights):
    work = perimeter_work(perimeter(task, **more), robot(), scene())
    assert list(dict.fromkeys(round(stroke.points[0][2], 3) for stroke in work.strokes)) == heights


def test_every_part_of_a_wall_is_photographed_with_the_overlaps(robot, scene, task):
    seen = {"footprintWidth": 6.0, "footprintLength": 5.0, "frontOverlap": 0.5, "sideOverlap": 0.2}
    work = perimeter_work(perimeter(task, topAltitude=20.0, **seen), robot(), scene())
    wall = shapely.box(0.0, 8.0, 40.0, 22.0)
    shown = [
        shapely.box(x - 1.5, stroke.points[0][2] - 2.0, x + 1.5, stroke.points[0][2] + 2.0)
        for stroke in work.strokes
        if {point[1] for point in stroke.points} == {-8.0}
        for x in (
            stroke.points[0][0] + action.at * (1 if stroke.points[1][0] > 0 else -1)
            for action in stroke.actions
        )
    ]
    assert shapely.difference(wall, shapely.union_all(shown, grid_size=1e-6)).area == pytest.approx(0.0)


def test_an_orbit_keeps_its_radius_begins_at_home_and_looks_at_the_point(robot, scene, task):
    asked = {"point": (30.0, 0.0, 5.0), "radius": 12.0, "altitude": 9.0, "clockwise": True, "turns": 2}
    (stroke,) = orbit_work(
        task("OrbitTask", photoDistance=6.0, actionName="TakePicture", **asked), robot(), scene()
    ).strokes
    assert stroke.points[0] == pytest.approx((18.0, 0.0, 9.0))
    assert stroke.points[9] == pytest.approx((30.0, 12.0, 9.0))
    assert {round(dist(point[:2], (30.0, 0.0)), 6) for point in stroke.points} == {12.0}
    assert len(stroke.points) == 73
    assert (stroke.look.at, stroke.look.device) == ((30.0, 0.0, 5.0), "camera")
    assert stroke.actions[-1].at == pytest.approx(stroke.length)


def test_what_areas_are_in_the_way_of_is_left_out_of_an_orbit(robot, scene, task):
    asked = task("OrbitTask", point=(30.0, 0.0, 5.0), radius=12.0, turns=1)
    work = orbit_work(asked, robot(), scene((42.0, 0.0, 2.0, 90.0)))
    assert len(work.gaps) == 1
    assert len(work.strokes) == 2
