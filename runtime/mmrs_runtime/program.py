"""Programs of robots, as plain values: the Behaviour Language with orders that vehicles understand.

A program is a table of moves. Each has actions before it, a movement, actions after it, and its transition.
Movements and actions carry an *order*, which only the robot's vehicle interprets: the driver of an
autopilot has its own, and for the simulation it is the grounded move itself.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TypeAlias

from .policies import Policy

SlotId: TypeAlias = tuple[str, str]
"""A slot: its robot, and its name there."""


@dataclass(frozen=True, slots=True)
class Notify:
    """An action that sets slots of robots."""

    slots: tuple[SlotId, ...]
    active: bool = True


@dataclass(frozen=True, slots=True)
class Then:
    """What comes next, once all of these own slots are active; `fluid`: without a stop, if possible."""

    move: str
    waits: tuple[str, ...] = ()
    fluid: bool = False
    policies: tuple[Policy, ...] = ()

    @property
    def ways(self) -> tuple[str, ...]:
        """Return all moves that may follow."""
        return (self.move,)


@dataclass(frozen=True, slots=True)
class Choose:
    """What comes next depends on a condition, which is asked for once, after the wait."""

    condition: str
    move: str
    otherwise: str
    waits: tuple[str, ...] = ()
    policies: tuple[Policy, ...] = ()

    @property
    def ways(self) -> tuple[str, ...]:
        """Return all moves that may follow."""
        return (self.move, self.otherwise)


@dataclass(frozen=True, slots=True)
class Move:
    """A movement, with what is done before and after it.

    Attributes:
        id: unique in the robot.
        order: what the vehicle is to do.
        before, after: notifies, and orders to the vehicle.
        then: what comes next; None at the end of the program.
    """

    id: str
    order: object = None
    before: tuple[object, ...] = ()
    after: tuple[object, ...] = ()
    then: Then | Choose | None = None

    def action(self, detail: str) -> object:
        """Return the action that a log names: ``pre:0`` is the first before the movement, or ``post:0``."""
        side, _, index = detail.partition(":")
        return (self.before if side == "pre" else self.after)[int(index)]


@dataclass(frozen=True)
class ExecutableRobot:
    """One robot and all that it does.

    Attributes:
        start: the first move.
        slots: names of its own.
        policies: the first for an event is the one that counts.
        reserve: part of the energy with less than which a program is not gone on with.
    """

    id: str
    moves: tuple[Move, ...]
    start: str
    slots: tuple[str, ...] = ()
    policies: tuple[Policy, ...] = ()
    reserve: float = 0.2

    @cached_property
    def by_id(self) -> Mapping[str, Move]:
        """Return the moves by identifier."""
        return {move.id: move for move in self.moves}

    @cached_property
    def notifies(self) -> tuple[Notify, ...]:
        """Return all notifies of the robot, in the order of its moves."""
        return tuple(
            action
            for move in self.moves
            for action in (*move.before, *move.after)
            if isinstance(action, Notify)
        )

    @cached_property
    def conditions(self) -> tuple[str, ...]:
        """Return the conditions that its choices ask for, in the order of its moves."""
        return tuple(move.then.condition for move in self.moves if isinstance(move.then, Choose))


@dataclass(frozen=True)
class Program:
    """What all robots of a mission do, in the order in which they step where several are due at once."""

    robots: tuple[ExecutableRobot, ...]
    name: str = ""
    fingerprint: str = field(default="", compare=False)

    @cached_property
    def by_id(self) -> Mapping[str, ExecutableRobot]:
        """Return the robots by identifier."""
        return {robot.id: robot for robot in self.robots}
