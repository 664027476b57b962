"""Legs of a plan find the moves that carry them out."""

from dataclasses import replace

from mmrs_core.behaviour.program import BEHAVIOUR, Move, MoveTarget, Program, RobotProgram
from mmrs_core.pictures.preview.moves import with_moves
from mmrs_core.pictures.preview.picture import Leg
from mmrs_core.scene import Frame


def move(id, rule, task="", position=None):
    target = MoveTarget(position) if position else None
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


HOLD = ((BEHAVIOUR, "HoldPosition"),)
HERE = (5.0, 6.0, 7.0)


def stay(id, task="look"):
    return replace(move(id, "observe", task), metaclasses=HOLD)


def legs_named(picture, legs, *moves):
    robots = (replace(picture.robots[0], legs=tuple(legs)), *picture.robots[1:])
    return named(replace(picture, robots=robots), move("start", ""), *moves, move("stop", ""))


def work(*points, task="look"):
    return Leg("work", points, 0.0, 1.0, task)


def test_stays_at_one_place_each_end_with_their_hold(picture):
    moves = (
        move("turn", "observe", "look"),
        stay("film"),
        move("turn back", "observe", "look"),
        stay("wait"),
    )
    assert legs_named(picture, [work(HERE), work(HERE)], *moves) == [
        "moves turn to film", "moves turn back to wait",
    ]  # fmt: skip


def test_stays_that_holds_do_not_tell_apart_share_their_moves(picture):
    moves = (move("turn", "observe", "look"), stay("wait"))
    assert legs_named(picture, [work(HERE), work(HERE)], *moves) == ["moves turn to wait"] * 2


def test_a_stay_after_the_way_there_has_its_own_hold(picture):
    way = (0.0, 0.0, 7.0), HERE
    moves = (move("go", "observe", "look", HERE), stay("wait"))
    assert legs_named(picture, [work(*way), work(HERE)], *moves) == ["move go", "move wait"]
    assert legs_named(picture, [work(*way)], *moves) == ["moves go to wait"]


def test_a_way_that_crosses_its_own_end_is_one_leg(picture):
    eight = ((0.0, 0.0, 7.0), HERE, (9.0, 9.0, 7.0), HERE)
    moves = (move("a", "observe", "look", eight[1]), move("b", "observe", "look", eight[2]),
             move("c", "observe", "look", eight[3]))  # fmt: skip
    assert legs_named(picture, [work(*eight)], *moves) == ["moves a to c"]


def test_an_approach_beyond_the_end_of_its_way_belongs_to_it(picture):
    moves = (move("near", "observe", "look", HERE), move("object", "observe", "look", (8.0, 8.0, 7.0)))
    assert legs_named(picture, [work((0.0, 0.0, 7.0), HERE)], *moves) == ["moves near to object"]
