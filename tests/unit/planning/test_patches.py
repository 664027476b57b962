"""Shares of an area that are in one patch each, and works laid row by row."""

from dataclasses import replace
from itertools import pairwise
from math import cos, dist, pi, sin
from random import Random
from types import SimpleNamespace

import pytest
import shapely
from plain_scenes import DRONE, field_work, robot, scene, with_kinematics

from mmrs_core.planning import schedule
from mmrs_core.planning.materials import Material
from mmrs_core.planning.patches import in_rows, number_of_parted
from mmrs_core.planning.planner import plan
from mmrs_core.scene import Stroke

WIDTH = 20.0


def star(corners, seed):
    random = Random(seed)
    radii = [random.uniform(280.0, 400.0) for _ in range(corners)]
    turns = [2.0 * pi * k / corners for k in range(corners)]
    return tuple((450.0 + r * cos(a), 450.0 + r * sin(a)) for r, a in zip(radii, turns, strict=True))


def shared(robots, shell):
    team = [with_kinematics(robot(f"r{k}", (15.0 * k, 0.0, 0.0), kinematics=DRONE)) for k in range(robots)]
    return scene(team, {"a": field_work(scene(team, {}), shell, width=WIDTH)})


def patches(share):
    strokes = [step.stroke for step in share.steps if getattr(step, "stroke", None) is not None]
    lines = [shapely.LineString([at[:2] for at in each.points]) for each in strokes if len(each.points) > 1]
    return shapely.get_num_geometries(shapely.union_all(shapely.buffer(lines, 0.51 * WIDTH)))


@pytest.mark.parametrize(("robots", "seed"), [(5, 3), (7, 8), (6, 9)])
def test_shares_of_an_area_are_in_one_patch_each_where_that_takes_little_longer(robots, seed, monkeypatch):
    whole = shared(robots, star(100, seed))
    found = plan(whole)
    monkeypatch.setattr(schedule, "in_fewer_patches", lambda sharing, *_: sharing)
    soonest = plan(whole)
    assert max(map(patches, soonest.robots)) > 1
    assert max(map(patches, found.robots)) == 1
    assert found.makespan <= 1.02 * soonest.makespan


def share(*portions):
    """Return a share of all portions, each of some strokes, given by the places that they lead through."""
    strokes = [tuple(Stroke(tuple((*at, 40.0) for at in line)) for line in each) for each in portions]
    material = Material("a", "field", tuple(strokes), ((),) * 3, None, (None,) * len(strokes), whole=False)
    return SimpleNamespace(run=SimpleNamespace(material=material, begin=0), end=len(strokes) - 1)


def test_strokes_that_are_apart_are_two_patches_though_they_are_one_portion():
    row, beside, away = [(0, 0), (90, 0)], [(0, 20), (90, 20)], [(500, 0), (590, 0)]
    assert number_of_parted([share([row], [beside]), share([row, beside])], WIDTH) == 0
    assert (
        number_of_parted([share([row], [away]), share([row, away]), share([row, away], [beside])], WIDTH) == 3
    )


def test_a_place_for_one_photo_is_in_a_patch_with_those_beside_it():
    assert number_of_parted([share([[(0, 0)]], [[(12, 0)]], [[(30, 0), (60, 0)]])], WIDTH) == 0
    assert number_of_parted([share([[(0, 0)]], [[(30, 0), (60, 0)]])], WIDTH) == 1


@pytest.mark.parametrize("corners", [3, 9, 40])
def test_rows_are_the_same_strokes_in_rows_each_beside_the_one_before(corners):
    work = shared(1, star(corners, corners)).works["a", "r0"]
    found = in_rows(work)
    both = [{frozenset(each.points) for each in some.strokes} for some in (work, found)]
    assert both[0] == both[1]
    assert len(found.strokes) == len(work.strokes)
    (x, y, _), *_, (far_x, far_y, _) = max(work.strokes, key=lambda each: each.length).points
    across = [(y - far_y) * each.points[0][0] + (far_x - x) * each.points[0][1] for each in found.strokes]
    metres = [each / dist((x, y), (far_x, far_y)) for each in across]
    rising = metres if metres[0] <= metres[-1] else [-each for each in metres]
    assert all(two > one - WIDTH / 2.0 for one, two in pairwise(rising))


@pytest.mark.parametrize(
    "features",
    [{"ordered": True}, {"coverage": None}, {"strokes": (Stroke(((0.0, 0.0, 9.0),), reversible=True),)}],
)
def test_there_are_no_rows_where_strokes_have_an_order_no_area_or_no_direction(features):
    work = shared(1, star(9, 1)).works["a", "r0"]
    assert in_rows(work) is not None
    assert in_rows(replace(work, **features)) is None


def test_strokes_in_two_directions_have_no_rows():
    work = shared(1, star(9, 1)).works["a", "r0"]
    across = tuple(replace(each, points=tuple((y, x, z) for x, y, z in each.points)) for each in work.strokes)
    assert in_rows(replace(work, strokes=work.strokes + across)) is None
