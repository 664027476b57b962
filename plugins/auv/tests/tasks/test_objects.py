from itertools import pairwise
from math import atan2, cos, degrees, dist, pi

import pytest
import shapely
from mmrs_auv.tasks.objects import align_moves, align_work, inspect_work
from mmrs_auv.tasks.profiles import surface_work

from mmrs_core.errors import InfeasibleError

POINT = (30.0, 0.0, -8.0)


def inspect(task, **more):
    return task(
        "InspectObjectTask", **{"point": POINT, "object": "buoy", "distance": 3.0, "views": 4, **more}
    )


def test_places_lie_evenly_around_the_object_and_begin_on_the_side_of_the_homes(robot, scene, task):
    strokes = inspect_work(inspect(task), robot(), scene()).strokes
    places = [stroke.points[-1] for stroke in strokes]
    assert places[0] == pytest.approx((27.0, 0.0, -8.0))
    assert [dist(place, POINT) for place in places] == pytest.approx([3.0] * 4)
    assert {round(dist(a, b), 6) for a, b in pairwise(places)} == {round(3 * 2**0.5, 6)}


@pytest.mark.parametrize("views", [2, 3, 8, 100])
def test_the_way_around_the_object_keeps_its_distance(robot, scene, task, views):
    work = inspect_work(inspect(task, views=views), robot(), scene())
    way = [point[:2] for stroke in work.strokes for point in stroke.points]
    nearest = shapely.LineString(way).distance(shapely.Point(POINT[:2]))
    assert nearest >= 3.0 * cos(pi / 24.0) - 1e-9
    assert work.ordered
    assert not work.divisible


def test_every_place_faces_the_object_holds_and_then_acts(robot, scene, task):
    asked = inspect(task, actionName="TakePicture", duration=2.0)
    for stroke in inspect_work(asked, robot(), scene()).strokes:
        assert (stroke.look.at, stroke.hold) == (POINT, 2.0)
        assert [(each.action, each.device) for each in stroke.actions] == [("TakePicture", "camera")]


def test_an_object_with_something_beside_it_is_not_gone_around(robot, scene, task):
    with pytest.raises(InfeasibleError, match="the way around the object comes"):
        inspect_work(inspect(task), robot(), scene((33.0, 0.0, 0.5)))


@pytest.mark.parametrize("views", [0, 361])
def test_views_that_nobody_means_are_refused(robot, scene, task, views):
    with pytest.raises(InfeasibleError, match=f"{views} views"):
        inspect_work(inspect(task, views=views), robot(), scene())


def align(task, **more):
    return task("AlignTask", **{"point": POINT, "object": "gate", "distance": 2.0, "duration": 5.0, **more})


def test_aligning_goes_to_the_object_faces_it_holds_and_then_acts(robot, scene, task):
    asked = align(task, tolerance=1.0, actionName="TakePicture")
    there, back = align_work(asked, robot(), scene()).strokes
    go, turn, hold = align_moves(there, asked, robot(), scene())
    assert (go.object, go.target, go.distance, go.object_tolerance) == ("gate", POINT, 2.0, 1.0)
    assert (turn.metaclass[1], turn.look.at) == ("HeadTo", POINT)
    assert (turn.facing, turn.object, turn.object_tolerance) == (True, "gate", 1.0)
    assert hold.attributes == {"duration": 5.0}
    assert [each.action for each in hold.after] == ["TakePicture"]
    assert back.points == there.points[:1]


@pytest.mark.parametrize(
    ("bearing", "east", "north"), [(90.0, 28.0, 0.0), (0.0, 30.0, -2.0), (180.0, 30.0, 2.0)]
)
def test_a_bearing_is_where_the_vehicle_looks_in_the_end(robot, scene, task, bearing, east, north):
    there, _ = align_work(align(task, bearing=bearing), robot(), scene()).strokes
    begin, end = there.points
    assert end == pytest.approx((east, north, -8.0))
    assert dist(begin, POINT) == pytest.approx(2.0 + 0.5)
    looks = degrees(atan2(POINT[0] - end[0], POINT[1] - end[1])) % 360.0
    assert looks == pytest.approx(bearing)


def test_a_side_that_is_blocked_is_refused_where_a_bearing_asks_for_it(robot, scene, task):
    blocked = scene((26.0, 0.0, 1.5))
    with pytest.raises(InfeasibleError, match="the approach to the object comes"):
        align_work(align(task, bearing=90.0), robot(), blocked)
    assert align_work(align(task), robot(), blocked).strokes


@pytest.mark.parametrize("work", [inspect_work, align_work])
def test_a_vehicle_that_cannot_stand_still_does_neither(robot, scene, task, work):
    with pytest.raises(InfeasibleError, match=r"smallest speed is 0\.3 m/s"):
        work(align(task, views=4), robot(slowest=0.3), scene())


def test_a_fix_is_had_at_the_surface_above_the_point(robot, scene, task):
    asked = task("SurfaceTask", point=(5.0, 6.0, -20.0), duration=15.0)
    (stroke,) = surface_work(asked, robot(), scene()).strokes
    assert (stroke.points, stroke.hold) == (((5.0, 6.0, -3.0),), 15.0)
