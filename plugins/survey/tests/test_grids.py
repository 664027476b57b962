from itertools import pairwise

import pytest
import shapely
from mmrs_survey.grids import photo_grid_work, spacing_of

from mmrs_core.errors import InfeasibleError
from mmrs_core.planning.strokes import parts_of

SHELL = ((0.0, 0.0, 0.0), (90.0, 0.0, 0.0), (90.0, 60.0, 0.0), (45.0, 30.0, 0.0), (0.0, 60.0, 0.0))
PIXELS = {"image.width": "1200", "image.height": "800"}


IN_PASSING = {"capture": "IN_PASSING", "triggerAction": "TriggerByDistance", "blur": 0.5}


def grid(task, **more):
    given = {
        "altitude": 20.0,
        "initialPosition": (-5.0, -5.0, 0.0),
        "shell": SHELL,
        "actionName": "TakePicture",
    }
    return task("PhotoGridTask", **{**given, **more})


def squares(work):
    """Return what the photos of a work cover, each a rectangle along its leg."""
    width, length = work.coverage.width, work.coverage.length
    for stroke in work.strokes:
        line = shapely.LineString([point[:2] for point in stroke.points])
        for at in stroke.spots:
            a = line.interpolate(max(at - 1e-3, 0.0))
            b = line.interpolate(at + 1e-3)
            angle = shapely.LineString([a, b])
            (ax, ay), (bx, by) = angle.coords
            east, north = (bx - ax) / angle.length, (by - ay) / angle.length
            x, y = (ax + bx) / 2, (ay + by) / 2
            yield shapely.Polygon(
                [
                    (
                        x + i * length / 2 * east - j * width / 2 * north,
                        y + i * length / 2 * north + j * width / 2 * east,
                    )
                    for i, j in ((1, 1), (1, -1), (-1, -1), (-1, 1))
                ]
            )


@pytest.mark.parametrize("asked", [{}, IN_PASSING])
@pytest.mark.parametrize("obstacles", [(), ((45.0, 15.0, 6.0, 90.0),), ((20.0, 12.0, 3.0, 90.0),)])
def test_photos_cover_all_of_the_area_that_can_be_covered(snapper, scene, task, obstacles, asked):
    work = photo_grid_work(grid(task, gridResolution=12.0, **asked), snapper(), scene(*obstacles))
    assert any(stroke.repetition for stroke in work.strokes) == bool(asked)
    target = shapely.union_all([shapely.Polygon(shell, holes) for shell, holes in work.coverage.target])
    seen = shapely.union_all(list(squares(work)), grid_size=1e-6)
    assert shapely.intersection(seen, target).area >= 0.999 * target.area


def test_swaths_are_flown_at_the_altitude_of_the_task(robot, scene, task):
    work = photo_grid_work(grid(task, gridResolution=12.0), robot(), scene())
    assert {point[2] for stroke in work.strokes for point in stroke.points} == {20.0}


def test_the_task_begins_at_its_initial_position_at_its_altitude(robot, scene, task):
    assert photo_grid_work(grid(task, gridResolution=12.0), robot(), scene()).entry == (-5.0, -5.0, 20.0)


def test_the_speed_of_the_task_limits_the_cruise_speed_on_its_swaths(robot, scene, task):
    work = photo_grid_work(grid(task, gridResolution=12.0, speed=2.5), robot(), scene())
    assert {(stroke.speed, stroke.slow_down) for stroke in work.strokes} == {(2.5, 1.0)}


def spacing(robot, task, properties, **more):
    device = robot(properties=properties).type.devices["camera"]
    found = spacing_of(grid(task, **more).part, device, 20.0)
    return round(found.width, 9), round(found.length, 9)


def test_a_grid_resolution_is_the_distance_along_and_across(robot, task):
    assert spacing(robot, task, {}, gridResolution=12.0) == (12.0, 12.0)


def test_overlaps_are_taken_off_the_footprint(robot, task):
    more = {"footprintWidth": 30.0, "footprintLength": 20.0, "sideOverlap": 0.6, "frontOverlap": 0.75}
    assert spacing(robot, task, {}, **more) == (12.0, 5.0)


def test_a_ground_resolution_uses_the_image_size(robot, task):
    assert spacing(robot, task, PIXELS, groundResolution=0.02) == (24.0, 16.0)


def test_the_optics_tell_the_footprint_where_the_task_does_not(robot, task):
    optics = {"sensor.width": "12", "sensor.height": "8", "focal.length": "8"}
    assert spacing(robot, task, optics, sideOverlap=0.5) == (15.0, 20.0)


def test_a_grid_of_which_nobody_knows_the_footprint_is_refused(robot, task):
    with pytest.raises(InfeasibleError, match="'camera' does not state what one photo covers"):
        spacing(robot, task, {})


def test_under_water_a_footprint_must_be_given(robot, task):
    optics = robot().type.devices["camera"]
    with pytest.raises(InfeasibleError, match="not known at -3 m: give a footprint"):
        spacing_of(grid(task).part, optics, -3.0)


def test_an_overlap_that_leaves_no_distance_is_refused(robot, task):
    with pytest.raises(InfeasibleError, match="leave no distance between photos"):
        spacing(robot, task, {}, footprintWidth=30.0, footprintLength=20.0, sideOverlap=1.0)


def test_an_area_within_the_clearance_of_obstacles_is_refused(robot, scene, task):
    asked = grid(task, gridResolution=5.0, initialPosition=(-200.0, 0.0, 0.0))
    with pytest.raises(InfeasibleError, match="lies within the clearance of areas or is closed in by them"):
        photo_grid_work(asked, robot(), scene((45.0, 30.0, 60.0, 90.0)))


def test_an_initial_position_inside_an_obstacle_is_refused(robot, scene, task):
    with pytest.raises(InfeasibleError, match="the initial position comes"):
        photo_grid_work(grid(task, gridResolution=12.0), robot(), scene((-5.0, -5.0, 2.0, 90.0)))


def test_a_hole_is_left_out_of_the_target(robot, scene, task):
    from mmrs_core.scene import Part

    hole = Part((), {"points": ((10.0, 5.0, 0.0), (20.0, 5.0, 0.0), (20.0, 15.0, 0.0), (10.0, 15.0, 0.0))})
    work = photo_grid_work(grid(task, gridResolution=5.0, holes=(hole,)), robot(), scene())
    area = sum(shapely.Polygon(shell, holes).area for shell, holes in work.coverage.target)
    assert area == pytest.approx(shapely.Polygon([p[:2] for p in SHELL]).area - 100.0)


def test_more_photos_than_can_be_planned_are_refused_at_once(robot, scene, task):
    with pytest.raises(InfeasibleError, match=r"takes about 40,500,000 photos or samples, of which 200,000"):
        photo_grid_work(grid(task, gridResolution=0.01), robot(), scene())


def test_what_areas_close_in_is_no_part_of_the_target(robot, scene, task):
    walls = [(*place, 10.0, 150.0) for place in ((30.0, 30.0), (70.0, 30.0), (50.0, 50.0), (50.0, 10.0))]
    asked = {"shell": ((0.0, 0.0, 0.0), (100.0, 0.0, 0.0), (100.0, 60.0, 0.0), (0.0, 60.0, 0.0))}
    work = photo_grid_work(grid(task, gridResolution=5.0, **asked), robot(), scene(*walls))
    target = shapely.union_all([shapely.Polygon(*rings) for rings in work.coverage.target])
    assert target.distance(shapely.Point(50.0, 30.0)) > 10.0
    assert target.covers(shapely.Point(5.0, 30.0))


def in_passing(task, **more):
    return grid(task, **{"gridResolution": 12.0, **IN_PASSING, **more})


def test_photos_in_passing_are_never_farther_apart_than_the_grid(snapper, scene, task):
    strokes = photo_grid_work(in_passing(task), snapper(), scene()).strokes
    along = [stroke for stroke in strokes if stroke.repetition]
    assert along
    assert all(stroke.actions == () and stroke.repetition.every <= 12.0 for stroke in along)
    assert all(b - a <= 12.0 + 1e-9 for stroke in along for a, b in pairwise(stroke.spots))


@pytest.mark.parametrize(
    ("more", "properties", "expected"),
    [
        ({}, {}, 12.0),
        ({"speed": 2.5}, {}, 2.5),
        ({}, {"capture.interval": "4"}, 3.0),
        ({}, {"exposure.time": "0.01", "image.width": "3000", "image.height": "2000"}, 0.5),
    ],
)
def test_the_camera_limits_the_speed_in_passing(snapper, scene, task, more, properties, expected):
    strokes = photo_grid_work(in_passing(task, **more), snapper(**properties), scene()).strokes
    interval = float(properties.get("capture.interval", 1.0))
    for stroke in strokes:
        ready = stroke.repetition.every / interval if stroke.repetition else expected
        assert stroke.speed == pytest.approx(min(expected, ready))


def test_the_camera_is_ready_for_each_photo_wherever_a_swath_is_divided(snapper, scene, task):
    strokes = photo_grid_work(in_passing(task), snapper(**{"capture.interval": "4"}), scene()).strokes
    for stroke in (each for each in strokes if each.repetition):
        for part in (stroke, *parts_of(stroke)):
            assert min(b - a for a, b in pairwise(part.spots)) >= 4.0 * stroke.speed - 1e-6
            assert max(b - a for a, b in pairwise(part.spots)) <= 12.0 + 1e-9


@pytest.mark.parametrize("capture", ["AUTOMATIC", "AT_STOPS"])
def test_a_robot_stops_for_photos_where_its_camera_or_the_task_wants_it(robot, snapper, scene, task, capture):
    asked, able = in_passing(task, capture=capture), snapper() if capture == "AT_STOPS" else robot()
    work = photo_grid_work(asked, able, scene())
    assert not any(stroke.repetition for stroke in work.strokes)
    said = ("stops for each photo: device 'camera' has no action 'TriggerByDistance' with a parameter",)
    assert [note[: len(said[0])] for note in work.notes] == [*said][: capture == "AUTOMATIC"]


def test_a_camera_that_can_takes_photos_in_passing_unless_it_must_not(snapper, scene, task):
    work = photo_grid_work(in_passing(task, capture="AUTOMATIC"), snapper(), scene())
    assert all(stroke.repetition or len(stroke.actions) == 1 for stroke in work.strokes)


@pytest.mark.parametrize(
    ("able", "reason"),
    [
        (lambda robot, snapper: robot(), "has no action 'TriggerByDistance' with a parameter 'distance'"),
        (lambda robot, snapper: snapper(**{"capture.interval": "often"}), r"not state capture\.interval"),
        (lambda robot, snapper: snapper(slowest=20.0), r"smallest speed is 20\.00 m/s"),
    ],
)
def test_photos_in_passing_are_refused_where_they_are_impossible(robot, snapper, scene, task, able, reason):
    with pytest.raises(InfeasibleError, match=reason):
        photo_grid_work(in_passing(task), able(robot, snapper), scene())
