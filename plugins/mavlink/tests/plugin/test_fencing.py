from dataclasses import replace
from math import cos, pi, sin

import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st
from mmrs_multicopter.testing import go_to, robot_program, take_off
from shapely import LineString, Polygon

from mmrs_core.scene import Area, AreaUse
from mmrs_core.testing.programs import move
from mmrs_mavlink.plugin.fencing import FINE, STRAY, Fence, fence_faults, fence_of, legs_of

SQUARE = ((0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0))
YARD = Area("yard", AreaUse.FORBIDDEN, SQUARE, safety_distance=2.0)
FAR = robot_program("alpha", [take_off("up", 20.0), go_to("a", (60.0, 0.0, 20.0))], home=(50.0, 0.0, 0.0))


def passing(x: float):
    """Return a robot that passes the square at its right side, so many metres from the origin."""
    return robot_program("alpha", [take_off("up", 20.0), go_to("a", (x, 30.0, 20.0))], home=(x, -30.0, 0.0))


def fenced(robot, area=YARD, clearance=1.0, error=0.0, escapes=()) -> Fence:
    (fence,) = fence_of(robot, [area], clearance, error, escapes)
    return fence


def test_only_what_is_forbidden_at_every_height_is_fenced():
    others = [replace(YARD, use=AreaUse.EMERGENCY), replace(YARD, low=10.0), replace(YARD, high=10.0)]
    assert len(fence_of(FAR, [YARD, *others], 1.0, 0.0)) == 1


def test_where_there_is_room_the_fence_keeps_the_whole_clearance_all_around():
    fence, drawn = fenced(FAR), Polygon(SQUARE)
    assert fence.kept == fence.wanted == 3.0
    assert Polygon(fence.ring).contains(drawn.buffer(3.0 - 1e-6))
    assert Polygon(fence.ring).exterior.hausdorff_distance(drawn.exterior) <= 3.0 * fence.reach + 1e-6


def test_a_fence_has_few_corners():
    assert len(fenced(FAR).ring) == 8


@pytest.mark.parametrize("x", [13.0, 12.5, 11.0, 10.6])
def test_a_leg_along_the_edge_of_the_clearance_stays_free_by_what_vehicles_stray(x):
    fence = Polygon(fenced(passing(x)).ring)
    assert fence.distance(LineString([(x, -30.0), (x, 30.0)])) >= STRAY - 1e-9
    assert fence.contains(Polygon(SQUARE))


@pytest.mark.parametrize("error", [0.2, 0.8, 1.5])
def test_a_fence_leaves_legs_free_by_the_position_error_of_the_mission(error):
    fence = fenced(passing(12.0 + 1.0 + error), clearance=1.0 + error, error=error)
    assert fence.stray == max(STRAY, error)
    assert Polygon(fence.ring).distance(LineString([(13.0 + error, -30.0), (13.0 + error, 30.0)])) >= error


def test_of_a_plan_that_keeps_clear_the_fence_holds_all_but_what_is_strayed():
    """So the safety distance and half the robot stay in it, where the position error covers straying."""
    fence = fenced(passing(13.8), clearance=1.8, error=0.8)
    assert fence.kept >= 3.0 / fence.reach - 0.02
    assert Polygon(fence.ring).contains(Polygon(SQUARE).buffer(fence.kept - 1e-6))
    assert not fence.is_tight


def test_the_farther_the_legs_the_larger_the_fence():
    kept = [fenced(passing(x)).kept for x in (10.6, 11.5, 12.5, 13.5, 14.0)]
    assert kept == sorted(kept)
    assert kept[0] < kept[-1] == 3.0


def test_without_room_the_area_is_fenced_as_drawn():
    assert fenced(passing(10.2)).ring == SQUARE
    assert fenced(FAR, replace(YARD, safety_distance=0.0), clearance=0.0).ring == SQUARE


@pytest.mark.parametrize("x", [10.2, 11.0, 12.0])
def test_a_fence_that_a_leg_makes_tighter_than_straying_does_is_told(x):
    fence = fenced(passing(x))
    assert fence.is_tight
    words = f"the fence around 'yard' is {fence.kept:.1f} m from it, although 3.0 m must be kept"
    assert str(fence).startswith(words)


@pytest.mark.parametrize("x", [13.0, 14.0, 30.0])
def test_nothing_is_told_of_a_fence_that_straying_alone_makes_tighter(x):
    assert not fenced(passing(x)).is_tight


def test_a_way_to_an_emergency_area_is_left_free_too():
    escape = ((13.1, -30.0), (13.1, 30.0))
    fence = fenced(FAR, escapes=[escape])
    assert fence.kept < 3.0
    assert Polygon(fence.ring).distance(LineString(escape)) >= STRAY


angles = st.lists(st.floats(0.0, 2.0 * pi), min_size=3, max_size=8, unique=True)


@settings(deadline=None)
@example([0.0, 1.8e-289, 1.2e-26, 1.0, 2.0], [2.0, 3.0, *[2.0] * 6], 1.0, 0.0, 0.0, 0.0)
@example([0.0, 1.2e-26, 3.5, 4.0], [2.0] * 8, 1.0, 0.0, 0.0, 0.0)
@example([0.0, 1.0, 2.0, 1.2e-26, 2.9e-147], [2.0, 2.66, *[2.0] * 6], 2.0, 0.0, 0.0, 0.0)
@given(
    angles=angles,
    sizes=st.lists(st.floats(2.0, 40.0), min_size=8, max_size=8),
    clearance=st.floats(0.0, 15.0),
    error=st.floats(0.0, 3.0),
    beyond=st.floats(-10.0, 20.0),
    towards=st.floats(0.0, 2.0 * pi),
)
def test_whatever_the_area_and_the_leg_the_fence_is_what_is_promised(
    angles, sizes, clearance, error, beyond, towards
):
    shell = tuple((s * cos(a), s * sin(a)) for a, s in zip(sorted(angles), sizes, strict=False))
    drawn = Polygon(shell)
    assume(drawn.is_valid and drawn.area > 1.0)
    ahead, aside = (cos(towards), sin(towards)), (-sin(towards), cos(towards))
    out = max(x * ahead[0] + y * ahead[1] for x, y in shell) + max(0.0, clearance + beyond)
    ends = [(out * ahead[0] + far * aside[0], out * ahead[1] + far * aside[1]) for far in (-80.0, 80.0)]
    robot = robot_program("alpha", [take_off("up", 20.0), go_to("a", (*ends[1], 20.0))], home=(*ends[0], 0.0))
    fence = fenced(robot, replace(YARD, shell=shell, safety_distance=0.0), clearance, error)
    ring, leg = Polygon(fence.ring), LineString(ends)
    room = drawn.distance(leg)
    assert ring.buffer(1e-6).contains(drawn)
    assert ring.buffer(1e-6).contains(drawn.buffer(fence.kept * 0.999))
    assert fence.kept <= clearance
    assert ring.distance(leg) >= min(fence.stray, room) - 1e-6
    assert fence.kept >= min(clearance, (room - fence.stray) / fence.reach) - FINE - 1e-6


def test_legs_lead_past_moves_that_go_nowhere():
    robot = robot_program(
        "alpha",
        [
            take_off("up", 20.0),
            go_to("a", (0.0, 5.0, 20.0)),
            move("wait", "HoldPosition"),
            go_to("b", (5.0, 5.0, 20.0)),
        ],
    )
    assert legs_of(robot).length == pytest.approx(10.0)


def test_a_robot_whose_home_or_way_is_in_the_fence_is_told():
    inside = robot_program("alpha", [take_off("up", 20.0)], home=(5.0, 5.0, 0.0))
    assert list(fence_faults(inside, [YARD])) == ["robot 'alpha': its home is inside the fence around 'yard'"]
    assert list(fence_faults(passing(5.0), [YARD])) == [
        "robot 'alpha': its path leads through the fence around 'yard'"
    ]
    assert list(fence_faults(FAR, [YARD])) == []
