"""What a robot goes by beside its program."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from mmrs_core.behaviour.program import Program
from mmrs_core.contributions.backends import Backend
from mmrs_core.contributions.execution import Condition
from mmrs_core.errors import UnsupportedError
from mmrs_core.scene import Policy


@dataclass(frozen=True, slots=True)
class Rules:
    """What a robot goes by beside its program.

    Attributes:
        conditions: by identifier.
        policies: of its type and kind, which go after the program's.
        suspends: whether a low battery only breaks the program off, to go on with a full one.
        reserve: part of the energy with which a program is not gone on with.
        live: whether robots are real ones: steps then tell only which fault it is, black boxes the reason.
        say: tells people what goes on.
        told: names of what those that notified the robot had detected.
    """

    conditions: Mapping[str, Condition]
    policies: tuple[Policy, ...]
    suspends: bool
    reserve: float = 0.0
    live: bool = False
    say: Callable[[str], None] = lambda words: None
    told: Callable[[], frozenset[str]] = frozenset


def refuse_unknown(
    program: Program, backends: Mapping[str, Backend], conditions: Mapping[str, Condition]
) -> None:
    """Do nothing if every backend is for a robot of the program, and all its choices can be decided.

    Raises:
        ValueError: one is for another robot.
        UnsupportedError: a condition is unknown; lists all of them.
    """
    known = {robot.id for robot in program.robots}
    for id in backends:
        if id not in known:
            raise ValueError(f"robot '{id}': not in the behaviour")
    unknown = [
        f"robot '{robot.id}', after move '{robot.moves[source].id}': condition '{transition.condition}'"
        for robot in program.robots
        if robot.id in backends
        for source, transition in sorted(robot.transitions.items())
        if transition.condition is not None and transition.condition not in conditions
    ]
    if unknown:
        raise UnsupportedError(f"{len(unknown)} choices have conditions that nobody decides", unknown)
