from __future__ import annotations

from dataclasses import replace

import pytest
from shapely import LineString, Polygon

from mmrs_core.mavlink.fencing import STRAY, fence_faults, fence_of, legs_of
from mmrs_core.scene import Area, AreaUse
from mmrs_core.testing.programs import go_to, move, robot_program, take_off

SQUARE = ((0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0))
YARD = Area("yard", AreaUse.FORBIDDEN, SQUARE, safety_distance=2.0)
FAR = robot_program("alpha", [take_off("up", 20.0), go_to("a", (60.0, 0.0, 20.0))], home=(50.0, 0.0, 0.0))


def passing(x: float):
    """Return a robot that passes the square at its right side, so many metres from the origin."""
    return robot_program(
        "alpha",
        [take_off("up", 20.0), go_to("a", (x, 30.0, 20.0))],
        home=(x, -30.0, 0.0),
    )


def only(rings) -> Polygon:
    (ring,) = rings
    return Polygon(ring)


def test_only_what_is_forbidden_at_every_height_is_fenced():
    others = [
        replace(YARD, use=AreaUse.EMERGENCY),
        replace(YARD, low=10.0),
        replace(YARD, high=10.0),
    ]
    assert len(fence_of(FAR, [YARD, *others], 1.0)) == 1


def test_where_there_is_room_the_fence_keeps_almost_the_whole_clearance_all_around():
    fence = only(fence_of(FAR, [YARD], 1.0))
    drawn = Polygon(SQUARE)
    assert fence.contains(drawn.buffer(0.9 * 3.0 - 1e-6))
    assert fence.exterior.hausdorff_distance(drawn.exterior) <= 3.0


def test_a_fence_has_few_corners():
    assert len(fence_of(FAR, [YARD], 1.0)[0]) == 8


@pytest.mark.parametrize("x", [13.0, 12.5, 11.0, 10.6])
def test_a_leg_along_the_edge_of_the_clearance_stays_free_by_what_vehicles_stray(x):
    fence = only(fence_of(passing(x), [YARD], 1.0))
    assert fence.distance(LineString([(x, -30.0), (x, 30.0)])) >= STRAY - 1e-9
    assert fence.contains(Polygon(SQUARE))


def test_the_farther_the_legs_the_larger_the_fence():
    areas = [only(fence_of(passing(x), [YARD], 1.0)).area for x in (10.6, 11.5, 12.5, 13.5)]
    assert areas == sorted(areas)
    assert areas[0] < areas[-1]


def test_without_room_the_area_is_fenced_as_drawn():
    assert fence_of(passing(10.2), [YARD], 1.0) == (SQUARE,)
    assert fence_of(FAR, [replace(YARD, safety_distance=0.0)], 0.0) == (SQUARE,)


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
        "robot 'alpha': its way leads through the fence around 'yard'"
    ]
    assert list(fence_faults(FAR, [YARD])) == []
