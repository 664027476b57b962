"""Robots of different sorts share one task: each part of it is done by one of them."""

from dataclasses import replace

import pytest
from plain_scenes import CAMERA, DRONE, box, field_work, photo, robot, scene, task
from plan_replay import complaints, flat

from mmrs_core.errors import InfeasibleError
from mmrs_core.planning.planner import plan
from mmrs_core.planning.remainders import Remainders, Turn
from mmrs_core.scene import ActionAt, Gap, Serve, Stroke, Work

FIELD = ((0.0, 50.0), (300.0, 50.0), (300.0, 200.0), (0.0, 200.0))
WIDE = Work((Stroke(((0.0, 50.0, 20.0), (90.0, 50.0, 20.0))),), divisible=True, rule="row")


def team(*speeds):
    """Return robots of one type that differ in speed."""
    return tuple(
        robot(f"r{k}", (15.0 * k, 0.0, 0.0), kinematics=replace(DRONE, cruise=speed))
        for k, speed in enumerate(speeds, 1)
    )


def mixed(works, robots, **features):
    """Return the plan of a task that all robots have to do, each with its own work."""
    whole = scene(robots, {"a": works}, tasks={"a": task("a", wanted=len(robots))}, **features)
    found = plan(whole)
    assert complaints(whole, found) == []
    return found


def strokes(found, name):
    """Return the strokes of a robot."""
    steps = next(each.steps for each in found.robots if each.robot == name)
    return [step.stroke for step in flat(steps) if isinstance(step, Serve)]


def points(count, device):
    """Return work at points in a row, with an action of a device."""
    done = (ActionAt(0.0, "photo", device),)
    places = [(25.0 * k, 60.0, 20.0) for k in range(count)]
    return Work(tuple(Stroke((place,), done) for place in places), divisible=True, rule="at", ordered=False)


def lines(begin, end, width=10.0):
    """Return work along a line that is called by its name, with photos and a cut between each two."""
    at = [width * k for k in range(int((end - begin) / width) + 1)]
    cuts = tuple(each + width / 2.0 for each in at[:-1])
    way = ((begin, 60.0, 20.0), (end, 60.0, 20.0))
    return Stroke(way, tuple(photo(each) for each in at), cuts=cuts, part="the line", stretch=(begin, end))


def test_robots_with_other_cameras_share_a_field_and_end_at_about_the_same_time():
    robots = team(10.0, 10.0)
    works = {
        "r1": field_work(scene(robots, {}), FIELD, width=12.0),
        "r2": field_work(scene(robots, {}), FIELD, width=30.0, altitude=25.0),
    }
    found = mixed(works, robots)
    ends = [each.steps[-1].end for each in found.robots]
    alone = plan(scene(robots[1:], {"a": works["r2"]})).makespan
    assert max(ends) < 0.85 * alone
    assert max(ends) - min(ends) < 0.15 * max(ends)
    assert found.lower_bound > 0.6 * found.makespan


def test_each_point_is_done_by_one_robot_whose_device_has_another_name():
    robots = tuple(
        replace(each, type=replace(each.type, devices={each.name: replace(CAMERA, id=each.name)}))
        for each in team(10.0, 5.0)
    )
    whole = scene(
        robots, {"a": {each.name: points(12, each.name) for each in robots}}, tasks={"a": task("a", wanted=2)}
    )
    found = plan(whole)
    places = [stroke.points[0] for each in robots for stroke in strokes(found, each.name)]
    assert sorted(places) == [stroke.points[0] for stroke in points(12, "r1").strokes]
    assert all(each.actions[0].device == "r2" for each in strokes(found, "r2"))


def test_a_line_that_one_of_two_robots_cannot_follow_as_a_whole_is_done_as_a_whole():
    gap = Gap("the line", 100.0, 60.0, (130.0, 60.0, 20.0), "'mast'")
    wide = Work((lines(0.0, 100.0), lines(160.0, 400.0)), divisible=True, rule="road", gaps=(gap,))
    found = mixed(
        {"r1": wide, "r2": Work((lines(0.0, 400.0),), divisible=True, rule="road")}, team(10.0, 10.0)
    )
    done = [
        (stroke.points[0][0], stroke.points[-1][0])
        for name in ("r1", "r2")
        for stroke in strokes(found, name)
    ]
    reached = 0.0
    for begin, end in sorted((min(each), max(each)) for each in done):
        assert begin <= reached + 1e-6
        reached = max(reached, end)
    assert reached == 400.0
    assert sum(abs(end - begin) for begin, end in done) <= 430.0
    assert found.left_out == ()


def test_a_line_there_and_back_is_followed_twice():
    way = ((0.0, 60.0, 20.0), (200.0, 60.0, 20.0), (0.0, 60.0, 20.0))
    one = Work((Stroke(way, cuts=(50.0, 100.0, 150.0, 200.0, 250.0, 300.0, 350.0)),), True, "road")
    found = mixed({"r1": one, "r2": replace(one, rule="other")}, team(10.0, 10.0))
    length = sum(
        abs(b[0] - a[0])
        for name in ("r1", "r2")
        for stroke in strokes(found, name)
        for a, b in zip(stroke.points, stroke.points[1:], strict=False)
    )
    assert length == pytest.approx(400.0)


def test_the_entry_is_the_way_of_one_robot_only():
    entry = (-40.0, 60.0, 20.0)
    robots = team(10.0, 10.0)
    works = {
        name: replace(field_work(scene(robots, {}), FIELD, width=width), entry=entry)
        for name, width in (("r1", 12.0), ("r2", 20.0))
    }
    found = mixed(works, robots)
    assert sum(any(entry in getattr(s, "route", ()) for s in each.steps) for each in found.robots) == 1


def test_what_others_photograph_beside_their_own_target_is_not_photographed_again():
    """One sort must keep 5 mm further from a mast, but its photos reach beyond that."""
    areas = (box("mast", 40.0, 60.0, 48.0, 75.0),)
    scenes = [scene((robot(clearance=clearance),), {}, areas=areas) for clearance in (1.005, 1.0)]
    known = Remainders([field_work(each, FIELD, width=7.0, length=6.0) for each in scenes])
    every = frozenset(range(len(known.parts[0])))
    assert known.left(1, [Turn(0, left=every, done=every)]) == frozenset()


def test_strips_that_are_laid_alike_but_for_less_than_a_millimetre_are_not_photographed_again():
    one = field_work(scene((robot(),), {}), FIELD, width=7.5, length=6.0)
    aside = tuple(
        replace(each, points=tuple((east, north + 4e-4, up) for east, north, up in each.points))
        for each in one.strokes
    )
    known = Remainders([one, replace(one, strokes=aside)])
    every = range(len(known.parts[0]))
    done = frozenset(every[: len(every) // 2])
    assert known.left(1, [Turn(0, left=frozenset(every), done=done)]) == frozenset(every) - done


def test_works_with_nothing_in_common_are_not_shared():
    aside = replace(WIDE, strokes=(Stroke(((0.0, 70.0, 20.0), (90.0, 70.0, 20.0))),))
    with pytest.raises(InfeasibleError, match="r1 cannot share it with r2"):
        mixed({"r1": WIDE, "r2": aside}, team(10.0, 10.0))


def test_parts_with_one_name_are_shared_wherever_their_points_are():
    def rows(offset):
        ways = [
            ((0.0, 60.0 + 10.0 * k + offset, 20.0), (90.0, 60.0 + 10.0 * k + offset, 20.0)) for k in range(8)
        ]
        return Work(
            tuple(Stroke(way, part=f"row {k}", reversible=True) for k, way in enumerate(ways)),
            divisible=True,
            rule="row",
            ordered=False,
        )

    found = mixed({"r1": rows(0.0), "r2": rows(3.0)}, team(10.0, 10.0))
    done = sorted(stroke.part for name in ("r1", "r2") for stroke in strokes(found, name))
    assert done == [f"row {k}" for k in range(8)]


def test_a_part_that_takes_two_passes_is_done_when_both_are():
    def passes(count):
        ways = [
            ((0.0, 60.0 + 20.0 * row + k, 20.0), (90.0, 60.0 + 20.0 * row + k, 20.0))
            for row in range(6)
            for k in range(count)
        ]
        made = [Stroke(way, part=f"row {k // count}", reversible=True) for k, way in enumerate(ways)]
        return Work(tuple(made), divisible=True, rule="row", ordered=False)

    found = mixed({"r1": passes(2), "r2": passes(1)}, team(10.0, 10.0))
    single = {stroke.part for stroke in strokes(found, "r2")}
    double = [stroke.part for stroke in strokes(found, "r1")]
    assert single | {part for part in double if double.count(part) == 2} == {f"row {k}" for k in range(6)}
