from dataclasses import replace
from itertools import pairwise
from math import atan2, degrees, hypot, inf

import numpy as np
import pytest
import shapely

from mmrs_core.errors import InfeasibleError
from mmrs_core.planning.coverage import Sweep, target_of, work_over
from mmrs_core.planning.omissions import uncovered
from mmrs_core.planning.patterns import Pattern
from mmrs_core.scene import Area, AreaUse, Capability, Frame, Part, Robot, RobotType, Scene

SQUARE = ((0.0, 0.0), (100.0, 0.0), (100.0, 100.0), (0.0, 100.0))
TYPE = RobotType("quad", (), (), 0.5, None, (Capability(0.0, None, (0.0, 10.0)),), (), {}, Part((), {}))


def robot(clearance=1.0):
    return Robot("r1", TYPE, (0.0, 0.0, 0.0), True, 0.0, "NORMAL", clearance)


def scene(*areas):
    return Scene("s", Frame("wgs84", 42.0, 13.0), (), (), (robot(),), areas=areas)


def box(low, high, use=AreaUse.OBSTACLE, bottom=-inf, top=inf, safety=2.0):
    (x0, y0), (x1, y1) = low, high
    return Area("box", use, ((x0, y0), (x1, y0), (x1, y1), (x0, y1)), bottom, top, safety)


def covered(work):
    """The share of the target under rectangles about straight pieces of strokes, laid out by hand."""
    width = work.coverage.width
    pieces = [
        shapely.buffer(shapely.LineString([one[:2], two[:2]]), width / 2, cap_style="flat")
        for stroke in work.strokes
        for one, two in zip(stroke.points[:-1], stroke.points[1:], strict=True)
    ]
    target = shapely.union_all([shapely.Polygon(*piece) for piece in work.coverage.target], grid_size=1e-6)
    union = shapely.union_all(pieces, grid_size=1e-6)
    return shapely.intersection(target, union, grid_size=1e-6).area / target.area


def seen(stroke, side):
    """The squares that the actions of a stroke cover, along the leg on which each is first met."""
    waiting = [action.at for action in stroke.actions]
    if len(stroke.points) == 1:
        yield shapely.Point(stroke.points[0][:2]).buffer(side / 2)
        return
    done = 0.0
    for one, two in zip(stroke.points[:-1], stroke.points[1:], strict=True):
        line = shapely.LineString([one[:2], two[:2]])
        while waiting and waiting[0] <= done + line.length + 1e-6:
            share = (waiting.pop(0) - done) / line.length
            east, north = (a + share * (b - a) for a, b in zip(one[:2], two[:2], strict=True))
            ahead = [(b - a) / line.length * side / 2 for a, b in zip(one[:2], two[:2], strict=True)]
            along = [(east - ahead[0], north - ahead[1]), (east + ahead[0], north + ahead[1])]
            yield shapely.buffer(shapely.LineString(along), side / 2, cap_style="flat")
        done += line.length


def test_a_free_square_is_covered_whole_by_as_few_strokes_as_fit():
    work = work_over(scene(), robot(), SQUARE, Sweep(altitude=20.0, width=20.0, rule="test"))
    assert len(work.strokes) == 5
    assert covered(work) == pytest.approx(1.0)
    assert uncovered(work.coverage).area == 0.0
    assert work.divisible
    assert not work.ordered


def test_strokes_are_at_the_altitude():
    work = work_over(scene(), robot(), SQUARE, Sweep(altitude=33.0, width=20.0, rule="test"))
    assert {point[2] for stroke in work.strokes for point in stroke.points} == {33.0}


def test_an_obstacle_takes_its_grown_shape_away():
    work = work_over(
        scene(box((40, 40), (60, 60))), robot(), SQUARE, Sweep(altitude=20.0, width=10.0, rule="test")
    )
    drawn = shapely.box(40, 40, 60, 60)
    lines = [shapely.LineString([p[:2] for p in stroke.points]) for stroke in work.strokes]
    assert min(line.distance(drawn) for line in lines) >= 3.0
    assert covered(work) >= 0.9999
    assert 26 * 26 - 9 < uncovered(work.coverage).area < 26 * 26 + 1


def test_an_obstacle_that_ends_below_is_flown_over():
    work = work_over(
        scene(box((40, 40), (60, 60), top=10.0)),
        robot(),
        SQUARE,
        Sweep(altitude=20.0, width=10.0, rule="test"),
    )
    assert uncovered(work.coverage).area == 0.0


def test_an_obstacle_just_within_the_clearance_below_is_not_flown_over():
    area = box((40, 40), (60, 60), top=17.5)
    assert target_of(scene(area), robot(), SQUARE, (), 20.0)[0].area < 10_000
    assert target_of(scene(area), robot(), SQUARE, (), 20.5)[0].area == 10_000


def test_an_emergency_area_takes_nothing_away():
    area = box((40, 40), (60, 60), use=AreaUse.EMERGENCY)
    assert target_of(scene(area), robot(), SQUARE, (), 20.0)[0].area == 10_000


def test_holes_are_not_covered_and_not_reported_as_unreachable():
    hole = ((30.0, 30.0), (70.0, 30.0), (70.0, 70.0), (30.0, 70.0))
    work = work_over(scene(), robot(), SQUARE, Sweep(altitude=20.0, width=10.0, rule="test"), (hole,))
    inside = shapely.box(30.01, 30.01, 69.99, 69.99)
    assert not any(
        shapely.LineString([p[:2] for p in stroke.points]).intersects(inside) for stroke in work.strokes
    )
    assert uncovered(work.coverage).area == pytest.approx(0.0, abs=1e-3)
    assert covered(work) >= 0.9999


def test_actions_tile_the_target():
    work = work_over(
        scene(box((40, 40), (60, 60))),
        robot(),
        SQUARE,
        Sweep(altitude=20.0, width=12.0, length=12.0, action="sample", rule="test"),
    )
    tiles = [each for stroke in work.strokes for each in seen(stroke, 12.0)]
    target = shapely.union_all([shapely.Polygon(*piece) for piece in work.coverage.target], grid_size=1e-6)
    union = shapely.union_all(tiles, grid_size=1e-6)
    assert shapely.intersection(target, union, grid_size=1e-6).area / target.area >= 0.9999
    assert work.coverage.length == 12.0


def test_cuts_lie_between_actions():
    work = work_over(
        scene(), robot(), SQUARE, Sweep(altitude=9.0, width=20.0, length=10.0, action="photo", rule="test")
    )
    for stroke in work.strokes:
        at = [action.at for action in stroke.actions]
        assert stroke.cuts == tuple(sorted(stroke.cuts))
        assert all(min(abs(cut - where) for where in at) > 1.0 for cut in stroke.cuts)


def test_a_polygon_within_a_forbidden_area_is_refused():
    area = box((-10, -10), (110, 110), use=AreaUse.FORBIDDEN)
    with pytest.raises(InfeasibleError, match=r"10000\.0 m²"):
        work_over(scene(area), robot(), SQUARE, Sweep(altitude=20.0, width=10.0, rule="test"))


def test_an_action_without_a_length_is_a_mistake():
    with pytest.raises(ValueError, match="photo"):
        work_over(scene(), robot(), SQUARE, Sweep(altitude=9.0, width=20.0, action="photo", rule="test"))


@pytest.mark.parametrize("width", [0.0, -1.0, float("nan")])
def test_a_width_that_is_not_positive_is_a_mistake(width):
    with pytest.raises(ValueError, match="swath width"):
        work_over(scene(), robot(), SQUARE, Sweep(altitude=9.0, width=width, rule="test"))


def test_the_direction_can_be_given():
    sweep = Sweep(altitude=9.0, width=20.0, rule="test", pattern=Pattern(angle=0.0))
    work = work_over(scene(), robot(), SQUARE, sweep)
    assert all(abs(s.points[0][1] - s.points[-1][1]) < 1e-9 for s in work.strokes)


def test_swaths_are_extended_as_far_as_it_is_clear_and_crossed():
    sweep = Sweep(9.0, 20.0, "test", length=10.0, action="photo", passing="trigger")
    pattern = Pattern(0.0, cross_hatch=True, corner=(1.0, 1.0), turnaround=15.0, alternate=True)
    wall = box((110.0, -50.0), (120.0, 150.0), safety=0.0)
    plain = work_over(scene(wall), robot(), SQUARE, sweep).strokes
    work = work_over(scene(wall), robot(), SQUARE, replace(sweep, pattern=pattern))
    first, *_ = along = [stroke for stroke in work.strokes if not stroke.part]
    assert [tuple(map(round, each)) for each in first.points] == [
        (109, 90, 9),
        (95, 90, 9),
        (5, 90, 9),
        (-10, 90, 9),
    ]
    assert [round(stroke.points[0][1]) for stroke in along] == [90, 50, 10, 30, 70]
    assert (first.spots[0], first.length - first.spots[-1]) == pytest.approx((14.0, 15.0), abs=0.01)
    assert sum(map(len, (stroke.spots for stroke in work.strokes))) == 2 * sum(len(s.spots) for s in plain)
    assert {abs(s.points[0][1] - s.points[-1][1]) for s in work.strokes if s.part} == {120.0}


def test_a_cross_hatch_has_one_direction_for_robots_of_all_clearances():
    """Alone, one would go east and north, and the other one north-east and north-west."""
    shell = ((0.0, 0.0), (-16.8, 24.0), (-47.1, 23.0), (-47.9, 4.0), (-32.8, -16.2), (-20.6, -21.3))
    wall = Area("wall", AreaUse.OBSTACLE, ((-32.0, 2.0), (-24.0, 2.0), (-32.0, 7.0)), -inf, inf, 1.0)
    sweep = Sweep(9.0, 8.0, "test", length=8.0, action="photo", pattern=Pattern(cross_hatch=True))

    def directions(clearance):
        strokes = work_over(scene(wall), robot(clearance), shell, sweep).strokes
        legs = [np.subtract(two, one)[:2] for each in strokes for one, two in pairwise(each.points)]
        return {round(degrees(atan2(y, x)) % 180.0) for x, y in legs if hypot(x, y) > 9.0}

    assert directions(0.5) == directions(1.5)
    assert len(directions(1.5)) == 2


@pytest.mark.parametrize("high", [0.5, 1.5, 2.5, 6.0])
def test_robots_face_in_both_directions_of_a_cross_hatch_over_what_one_photo_shows_any_way(high):
    shell = ((0.0, 0.0), (20.0, 0.0), (20.0, high), (0.0, high))
    sweep = Sweep(9.0, 8.0, "test", length=8.0, action="photo", pattern=Pattern(cross_hatch=True))
    found = {"": set(), "across": set()}
    for stroke in work_over(scene(), robot(), shell, sweep).strokes:
        east, north = np.subtract(stroke.points[-1], stroke.points[0])[:2]
        found[stroke.part].add(round(degrees(atan2(north, east))) % 180)
    assert sorted(found.values()) == [{0}, {90}]


def test_the_first_stroke_is_near_the_start():
    work = work_over(
        scene(), robot(), SQUARE, Sweep(altitude=9.0, width=20.0, rule="test", start=(100.0, 100.0))
    )
    assert abs(work.strokes[0].points[0][0] - 100) + abs(work.strokes[0].points[0][1] - 100) <= 10.01


def test_a_sliver_narrower_than_the_strip_gets_one_stroke():
    work = work_over(
        scene(), robot(), ((0, 0), (80, 0), (80, 1.5), (0, 1.5)), Sweep(altitude=9.0, width=20.0, rule="test")
    )
    assert len(work.strokes) == 1
    assert covered(work) == pytest.approx(1.0)
