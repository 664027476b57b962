"""Behaviours as programs of the engine, whose orders are the grounded moves and actions themselves."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mmrs_runtime import program as words

if TYPE_CHECKING:
    from mmrs_core.behaviour.program import Action, Move, Program, RobotProgram, Transition


def lowered(program: Program) -> words.Program:
    """Return what the engine executes, for vehicles that understand grounded moves, as simulated ones do."""
    return words.Program(tuple(_robot(robot, program.reserve) for robot in program.robots), program.name)


def _robot(robot: RobotProgram, reserve: float) -> words.ExecutableRobot:
    moves = tuple(_move(robot, index, move) for index, move in enumerate(robot.moves))
    start = robot.moves[robot.start].id
    return words.ExecutableRobot(robot.id, moves, start, robot.slots, robot.policies, reserve)


def _move(robot: RobotProgram, index: int, move: Move) -> words.Move:
    transition = robot.transitions.get(index) if index != robot.stop else None
    then = None if transition is None else _then(robot, transition)
    before, after = tuple(map(_action, move.before)), tuple(map(_action, move.after))
    return words.Move(move.id, move, before, after, then)


def _then(robot: RobotProgram, given: Transition) -> words.Then | words.Choose:
    to = robot.moves[given.to].id
    if given.condition is None or given.otherwise is None:
        return words.Then(to, given.waits, given.fluid, given.policies)
    return words.Choose(given.condition, to, robot.moves[given.otherwise].id, given.waits, given.policies)


def _action(action: Action) -> object:
    return words.Notify(action.sets, action.active) if action.notifies else action
