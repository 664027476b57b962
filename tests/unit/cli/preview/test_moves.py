"""Legs of a plan find the moves that carry them out."""

from mmrs_core.behaviour.program import BEHAVIOUR, Move, Program, RobotProgram, Target
from mmrs_core.cli.preview.moves import with_moves
from mmrs_core.scene import Frame


def move(id, rule, task="", position=None):
    target = Target(position) if position else None
    return Move(id, ((BEHAVIOUR, "GoTo"),), target=target, task=task, rule=rule)


def program_with(*moves):
    robot = RobotProgram("Alba", "quad", "NORMAL", 0.0, None, (), moves, {}, 0, len(moves) - 1)
    return Program("m", Frame("EPSG:4326", None, None), (robot,))


def named(picture, *moves):
    return [leg.moves for leg in with_moves(picture, program_with(*moves)).robots[0].legs]


COMPLETE = (
    move("start", "launch"),
    move("up", "launch", "field"),
    move("over", "transit", "field", (10.0, 5.0, 20.0)),
    move("first", "grid", "field", (10.0, 30.0, 20.0)),
    move("second", "grid", "field", (10.0, 55.0, 20.0)),
    move("pause", "grid", "field"),
    move("back", "transit", "", (-20.0, 0.0, 20.0)),
    move("down", "recover"),
    move("stop", ""),
)


def test_each_leg_names_its_moves_in_order(picture):
    assert named(picture, *COMPLETE) == [
        "move up", "move over", "moves first to pause", "move back", "move down",
    ]  # fmt: skip


def test_waits_between_legs_belong_to_none(picture):
    with_wait = (*COMPLETE[:2], move("wait", "wait", "field"), *COMPLETE[2:])
    assert named(picture, *with_wait)[:2] == ["move up", "move over"]


def test_a_leg_without_moves_names_none(picture):
    without_transit = (*COMPLETE[:2], *COMPLETE[3:])
    assert named(picture, *without_transit)[1] == ""


def test_a_robot_that_the_program_does_not_have_stays_as_it_is(picture):
    shown = with_moves(picture, program_with(*COMPLETE))
    assert shown.robots[1] == picture.robots[1]
