"""Conditions of Choices: which a program asks for."""

from __future__ import annotations

from collections.abc import Collection, Container

from mmrs_core.behaviour.program import Program
from mmrs_core.errors import UnsupportedError, UsageError
from mmrs_core.languages.naming import nearest


def asked_by(program: Program) -> tuple[str, ...]:
    """Return the identifiers of all conditions that a program asks for, sorted."""
    asked = {each.condition for robot in program.robots for each in robot.transitions.values()}
    return tuple(sorted(identifier for identifier in asked if identifier is not None))


def refuse_unasked(program: Program, identifiers: Collection[str]) -> None:
    """Do nothing if a program asks for each of these conditions.

    Raises:
        UsageError: if it does not; tells what it asks for.
    """
    asked = asked_by(program)
    for identifier in identifiers:
        if identifier not in asked:
            known, guess = ", ".join(map(repr, asked)) or "none at all", nearest(identifier, asked)
            raise UsageError(
                f"no choice asks for condition {identifier!r}; asked for: {known}{guess and '; ' + guess}"
            )


def refuse_undecided(program: Program, robots: Container[str], conditions: Container[str]) -> None:
    """Do nothing if each choice of these robots can be decided.

    Raises:
        UnsupportedError: a condition is unknown; lists all of them.
    """
    unknown = [
        f"robot '{robot.id}', after move '{robot.moves[source].id}': condition '{transition.condition}'"
        for robot in program.robots
        if robot.id in robots
        for source, transition in sorted(robot.transitions.items())
        if transition.condition is not None and transition.condition not in conditions
    ]
    if unknown:
        raise UnsupportedError(f"{len(unknown)} choices have conditions that nobody decides", unknown)
