from dataclasses import replace

import pytest
from mmrs_multicopter.testing import go_to, robot_program, target_input

from mmrs_core.behaviour.program import Heading, MoveTarget, Transition
from mmrs_core.scene import Frame
from mmrs_core.testing.programs import L_AQUILA, photo, program
from mmrs_mavlink.plugin.context import context_of
from mmrs_mavlink.plugin.runs import runs_of

EAST = [(float(10 * index), 0.0, 20.0) for index in range(1, 6)]


def runs(moves=None, transitions=None, frame: Frame = L_AQUILA, fluid=(1, 2, 3, 4), turning_radius=0.0):
    made = moves or [go_to(f"m{index}", place) for index, place in enumerate(EAST, start=1)]
    flowing = {index: Transition(index, index + 1, fluid=True) for index in fluid}
    robot = robot_program("alpha", made, transitions=flowing | dict(transitions or {}))
    context = context_of(robot, target_input(program(robot, frame=frame)))
    return runs_of(context, turning_radius)


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
    assert runs(moves, fluid=(1, 2, 3), turning_radius=1.2)[0].holds == (0.0, 0.0, 0.0, 1.0)


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


def test_a_move_that_is_entered_from_elsewhere_begins_a_run():
    back = {5: Transition(5, 3)}
    assert [run.moves for run in runs(transitions=back)] == [(3, 4, 5)]


def test_a_circle_is_no_run():
    circle = {5: Transition(5, 1, fluid=True), 0: Transition(0, 6)}
    assert runs(transitions=circle) == ()


def test_a_local_behaviour_has_no_runs():
    assert runs(frame=Frame("EPSG:4326", None, None)) == ()
