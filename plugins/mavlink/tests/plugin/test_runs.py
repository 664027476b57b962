from dataclasses import replace
from math import cos, radians, sin

import pytest
from mmrs_multicopter.testing import go_to, quad, robot_program, target_input

from mmrs_core.behaviour.program import Heading, MoveTarget, Transition
from mmrs_core.scene import Frame, Kinematics
from mmrs_core.testing.programs import L_AQUILA, photo, program
from mmrs_mavlink.plugin.context import context_of
from mmrs_mavlink.plugin.runs import runs_of
from mmrs_mavlink.profiles.pacing import COPTER

TURNING = Kinematics(1.5, 0.0, 2.0, 0.0, 0.0, turning_radius=1.2)
EAST = [(float(10 * index), 0.0, 20.0) for index in range(1, 6)]


def runs(
    moves=None,
    transitions=None,
    frame: Frame = L_AQUILA,
    fluid=(1, 2, 3, 4),
    kinematics=None,
    properties=None,
):
    made = moves or [go_to(f"m{index}", place) for index, place in enumerate(EAST, start=1)]
    flowing = {index: Transition(index, index + 1, fluid=True) for index in fluid}
    robot = robot_program("alpha", made, transitions=flowing | dict(transitions or {}))
    given = target_input(program(robot, frame=frame), [quad(**(properties or {}))])
    context = context_of(robot, given)
    return runs_of(context, kinematics)


def test_fluid_moves_make_one_run():
    assert [run.moves for run in runs()] == [(1, 2, 3, 4, 5)]


def test_two_moves_are_no_run():
    assert runs(fluid=(1,)) == ()


def test_only_corners_and_ends_are_held():
    assert runs()[0].holds == (1.0, 0.0, 0.0, 0.0, 1.0)


def test_a_corner_inside_is_held():
    moves = [
        go_to(f"m{i}", p) for i, p in enumerate([EAST[0], EAST[1], (20.0, 30.0, 20.0), (20.0, 60.0, 20.0)])
    ]
    assert runs(moves, fluid=(1, 2, 3))[0].holds == (1.0, 1.0, 0.0, 1.0)


def test_a_vehicle_that_needs_room_to_turn_holds_at_the_end_alone():
    moves = [
        go_to(f"m{i}", p) for i, p in enumerate([EAST[0], EAST[1], (20.0, 30.0, 20.0), (20.0, 60.0, 20.0)])
    ]
    assert runs(moves, fluid=(1, 2, 3), kinematics=TURNING)[0].holds == (0.0, 0.0, 0.0, 1.0)


def test_a_wait_ends_a_run():
    waiting = {3: Transition(3, 4, waits=("go",), fluid=True)}
    assert [run.moves for run in runs(transitions=waiting)] == [(1, 2, 3)]


def test_a_choice_ends_a_run():
    choosing = {3: Transition(3, 4, condition="c", otherwise=5)}
    assert [run.moves for run in runs(transitions=choosing)] == [(1, 2, 3)]


def test_an_action_inside_ends_a_run():
    moves = [go_to(f"m{index}", place) for index, place in enumerate(EAST)]
    moves[2] = replace(moves[2], after=(photo(),))
    assert [run.moves for run in runs(moves)] == [(1, 2, 3)]


@pytest.mark.parametrize(
    "changed",
    [
        {"heading": Heading(MoveTarget((0.0, 0.0, 0.0)))},
        {"distance": 2.0},
        {"attributes": {"trajectory": "VERTICAL_FIRST"}},
        {"target": MoveTarget((30.0, 0.0, 20.0), "a buoy", 1.0)},
        {"target": MoveTarget(None, "a buoy", None)},
    ],
    ids=lambda changed: next(iter(changed)),
)
def test_a_move_that_a_waypoint_cannot_express_is_in_no_run(changed):
    moves = [go_to(f"m{index}", place) for index, place in enumerate(EAST)]
    moves[1] = replace(moves[1], **changed)
    assert [run.moves for run in runs(moves)] == [(3, 4, 5)]


def looking(*headings, **device):
    """Return the runs of as many moves, of a drone with a camera."""
    moves = [
        replace(go_to(f"m{index}", place), heading=heading)
        for index, (place, heading) in enumerate(zip(EAST, headings, strict=True))
    ]
    return [run.moves for run in runs(moves, properties=device)]


MAST, POLE = (Heading(MoveTarget((30.0, 50.0, north)), "camera") for north in (0.0, 9.0))


def test_on_a_run_the_robot_looks_at_one_place():
    assert looking(MAST, MAST, MAST, MAST, MAST) == [(1, 2, 3, 4, 5)]
    assert looking(None, MAST, MAST, MAST, POLE) == [(2, 3, 4)]


def test_where_it_looks_aside_of_a_place_a_robot_flies_move_by_move():
    assert looking(*[replace(MAST, angle_degrees=90.0)] * 5) == []
    assert looking(*[MAST] * 5, **{"mount.yaw": "90"}) == []
    assert looking(*[MAST] * 5, **{"mount.yaw": "0"}) == [(1, 2, 3, 4, 5)]


def test_a_circle_of_short_legs_is_flown_without_a_stop_also_when_it_was_written_to_a_file():
    ring = [10.0 * complex(cos(angle), sin(angle)) for angle in (radians(10.0 * k) for k in range(36))]
    places = [(round(place.real, 4), round(place.imag, 4), 20.0) for place in ring]
    moves = [replace(go_to(f"m{index}", place), heading=MAST) for index, place in enumerate(places)]
    assert runs(moves, fluid=range(1, 36))[0].holds == (1.0, *[0.0] * 34, 1.0)


@pytest.mark.parametrize(("corners", "uploaded"), [(4, False), (36, True)])
def test_a_robot_that_looks_at_one_place_flies_a_mission_only_where_it_is_quicker_so(corners, uploaded):
    ring = [20.0 * complex(cos(angle), sin(angle)) for angle in (radians(10.0 * k) for k in range(corners))]
    moves = [
        replace(go_to(f"m{index}", (place.real, place.imag, 20.0)), heading=MAST)
        for index, place in enumerate(ring)
    ]
    copter = Kinematics(5.0, 0.0, 8.0, 2.5, 1.5, timing=COPTER.step, mission=COPTER.mission)
    assert bool(runs(moves, fluid=range(1, corners), kinematics=copter)) is uploaded


def test_a_move_that_is_entered_from_elsewhere_begins_a_run():
    back = {5: Transition(5, 3)}
    assert [run.moves for run in runs(transitions=back)] == [(3, 4, 5)]


def test_a_circle_is_no_run():
    circle = {5: Transition(5, 1, fluid=True), 0: Transition(0, 6)}
    assert runs(transitions=circle) == ()


def test_a_local_behaviour_has_no_runs():
    assert runs(frame=Frame("EPSG:4326", None, None)) == ()
