from math import atan2, cos, degrees, dist, hypot, pi, sin

import pytest
from hypothesis import given
from hypothesis import strategies as st
from mmrs_rover.kinds import ROVER_KIND, kinematics

from mmrs_core.behaviour.program import BEHAVIOUR, Move, MoveTarget
from mmrs_core.errors import InfeasibleError
from mmrs_core.scene.timing import MoveSeconds
from mmrs_core.transformation.kinds import path_seconds

TO_TEN = Move("m", ((BEHAVIOUR, "GoTo"),), {}, target=MoveTarget((11.0, 1.0, 2.0)))


def test_a_rover_stays_on_the_level_of_its_home(rover, field):
    found = kinematics(rover(up=2.0, turningRadius=0.0), field)
    assert (found.floor, found.ceiling, found.launches) == (2.0, 2.0, False)


def test_a_rover_neither_launches_nor_recovers():
    assert ROVER_KIND.launch(5.0) == ROVER_KIND.recover() == ()


def test_wheels_without_a_turning_radius_are_refused(rover, field):
    with pytest.raises(InfeasibleError, match="'Field rover' does not say its turningRadius"):
        kinematics(rover(), field)


def test_tracks_turn_on_the_spot(rover, field):
    found = kinematics(rover(drive="TRACKS"), field)
    assert (found.turning_radius, found.shunting) == (0.0, 0.0)


def test_half_a_turn_by_shunting_is_a_half_circle_and_halts_between_its_arcs(rover, field):
    found = kinematics(rover(turningRadius=1.5), field)
    assert found.shunting == pytest.approx(pi * 1.5 / 0.4 / 0.45 + 5 * 3.2)


@pytest.mark.parametrize(
    ("radius", "angle", "seconds"),
    [
        *((1.2, 45.0, 11.0), (1.2, 56.0, 14.1), (1.2, 60.0, 13.8), (1.2, 75.0, 14.5), (1.2, 100.0, 21.9)),
        *((1.2, 140.0, 30.2), (1.2, 168.0, 36.2), (2.0, 135.0, 44.8)),
    ],
)
def test_a_turn_by_shunting_takes_about_as_long_as_was_measured(rover, field, radius, angle, seconds):
    found = kinematics(rover(turningRadius=radius), field)
    assert angle / found.turn_rate == pytest.approx(seconds, rel=0.25)


def test_a_turn_rate_that_is_smaller_than_the_curve_allows_stands(rover, field):
    assert kinematics(rover(turningRadius=0.1, movement={"turn_rate": 5.0}), field).turn_rate == 5.0


def test_a_leg_takes_up_to_half_a_turn_longer_where_the_rover_shunts(rover, field):
    way = ((1.0, 1.0, 2.0), (11.0, 1.0, 2.0))
    on_the_spot = kinematics(rover(turningRadius=0.0), field)
    shunting = kinematics(rover(turningRadius=1.5), field)
    assert path_seconds(TO_TEN, way, on_the_spot, "SAFE") == MoveSeconds.exactly(10.0)
    longest = 10.0 + shunting.shunting
    assert path_seconds(TO_TEN, way, shunting, "SAFE") == pytest.approx((10.0, longest, longest))


def test_travel_is_one_go_to_of_the_core_for_each_leg():
    specs = ROVER_KIND.travel(((0.0, 0.0, 0.0), (5.0, 0.0, 0.0), (5.0, 9.0, 0.0)))
    assert [(spec.metaclass, spec.target) for spec in specs] == [
        ((BEHAVIOUR, "GoTo"), (5.0, 0.0, 0.0)),
        ((BEHAVIOUR, "GoTo"), (5.0, 9.0, 0.0)),
    ]


@given(st.floats(0.01, pi))
def test_turning_by_three_arcs_stays_within_the_radius_and_is_as_long_as_the_turn(angle):
    # The robot stands at the origin, points north and turns left, with a radius of 1. The centres of the
    # first and the last curve lie to its left before and after; the middle one touches both.
    first, last = (-1.0, 0.0), (-cos(angle), -sin(angle))
    base = dist(first, last)
    middle = ((first[0] + last[0]) / 2, (first[1] + last[1]) / 2)
    off = (4.0 - (base / 2) ** 2) ** 0.5 / base
    away = (-off * (last[1] - first[1]), off * (last[0] - first[0]))
    for sign in (1.0, -1.0):
        centre = (middle[0] + sign * away[0], middle[1] + sign * away[1])
        touches = [((c[0] + centre[0]) / 2, (c[1] + centre[1]) / 2) for c in (first, last)]
        if max(hypot(*touch) for touch in touches) <= 1.0 + 1e-9:
            assert arcs(first, last, centre, touches) == pytest.approx(angle, abs=1e-6)
            return
    pytest.fail(f"no three arcs turn a robot by {degrees(angle):.1f}° within its radius")


def arcs(first, last, centre, touches):
    """Return the sum of the three arcs, radians."""
    return (
        between(first, (0.0, 0.0), touches[0])
        + between(centre, *touches)
        + between(last, touches[1], (0.0, 0.0))
    )


def between(centre, one, two):
    a = atan2(one[1] - centre[1], one[0] - centre[0])
    b = atan2(two[1] - centre[1], two[0] - centre[0])
    return abs((b - a + pi) % (2 * pi) - pi)
