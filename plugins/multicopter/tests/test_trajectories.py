from itertools import pairwise
from math import dist

import pytest
from hypothesis import given
from hypothesis import strategies as st
from mmrs_multicopter.names import GO_TO
from mmrs_multicopter.trajectories import path, travel

from mmrs_core.behaviour.program import Move, MoveTarget

METRES = st.integers(-500, 500).map(float)
POSITIONS = st.tuples(METRES, METRES, METRES)


def go_to(target, trajectory="DIRECT", distance=0.0):
    return Move("m", (GO_TO,), {"trajectory": trajectory}, target=MoveTarget(target), distance=distance)


def trajectories(route):
    return [spec.attributes["trajectory"] for spec in travel(route)]


def flown(route):
    here = route[0]
    passed = [here]
    for spec in travel(route):
        passed += path(go_to(spec.target, spec.attributes["trajectory"]), here, None)[1:]
        here = spec.target
    return passed


def test_an_upright_and_a_level_leg_become_one_move():
    assert trajectories(((0.0, 0.0, 5.0), (0.0, 0.0, 30.0), (80.0, 0.0, 30.0))) == ["VERTICAL_FIRST"]


def test_a_level_and_an_upright_leg_become_one_move():
    assert trajectories(((0.0, 0.0, 30.0), (80.0, 9.0, 30.0), (80.0, 9.0, 5.0))) == ["HORIZONTAL_FIRST"]


def test_two_level_legs_remain_two_moves():
    assert trajectories(((0.0, 0.0, 9.0), (8.0, 0.0, 9.0), (8.0, 8.0, 9.0))) == ["DIRECT", "DIRECT"]


def test_a_sloped_leg_is_flown_directly():
    assert trajectories(((0.0, 0.0, 5.0), (40.0, 0.0, 30.0))) == ["DIRECT"]


def test_staying_where_one_is_takes_no_move():
    assert travel(((1.0, 2.0, 3.0), (1.0, 2.0, 3.0))) == ()


def legs(here, choices):
    route = [here]
    for sort, (east, north, up) in choices:
        last = route[-1]
        level = (last[0], last[1]) if sort == "upright" else (east, north)
        route.append((*level, last[2] if sort == "level" else up))
    return tuple(route)


@given(POSITIONS, st.lists(st.tuples(st.sampled_from(["upright", "level", "sloped"]), POSITIONS), max_size=8))
def test_moves_pass_every_position_of_their_route_and_no_other(here, choices):
    route = legs(here, choices)
    expected = [route[0], *(b for a, b in pairwise(route) if a != b)]
    assert flown(route) == expected


@given(
    POSITIONS,
    POSITIONS,
    st.sampled_from(["DIRECT", "VERTICAL_FIRST", "HORIZONTAL_FIRST"]),
    st.floats(0.1, 300),
)
def test_a_distance_ends_the_way_that_far_from_the_target_and_never_nearer(
    here, target, trajectory, distance
):
    end = path(go_to(target, trajectory, distance), here, None)[-1]
    assert dist(end, target) == pytest.approx(min(distance, dist(here, target)), abs=1e-6)


def test_an_object_without_a_place_has_no_known_path():
    move = Move("m", (GO_TO,), {"trajectory": "DIRECT"}, target=MoveTarget(None, "buoy"))
    assert path(move, (0.0, 0.0, 1.0), None) is None


def test_a_trajectory_that_is_not_given_is_direct():
    move = Move("m", (GO_TO,), target=MoveTarget((3.0, 4.0, 9.0)))
    assert path(move, (0.0, 0.0, 1.0), None) == ((0.0, 0.0, 1.0), (3.0, 4.0, 9.0))
