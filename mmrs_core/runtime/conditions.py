"""Conditions of Choices that need nobody to write them: their identifiers say what they ask."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from math import isfinite

from mmrs_core.behaviour.program import Program
from mmrs_core.contributions.execution import Condition

BATTERY, WIND, DETECTED, ANSWER = "battery-below", "wind-above", "detected", "answer"


def standard_conditions(identifiers: Iterable[str]) -> dict[str, Condition]:
    """Return those of the conditions that are standard, by identifier.

    ``battery-below:0.3`` holds with less than that part of the battery left, ``wind-above:8`` in wind of
    more metres per second, ``detected:NAME`` once the robot has detected that, ``answer:QUESTION`` when the
    operator has answered yes; until there is an answer, or a figure to go by, the robot waits.

    >>> sorted(standard_conditions(["battery-below:0.3", "is it sunny", "wind-above:gale"]))
    ['battery-below:0.3']
    """
    found = {identifier: _standard(identifier) for identifier in identifiers}
    return {identifier: condition for identifier, condition in found.items() if condition is not None}


def asked_by(program: Program) -> tuple[str, ...]:
    """Return the identifiers of all conditions that a program asks for, sorted."""
    asked = {each.condition for robot in program.robots for each in robot.transitions.values()}
    return tuple(sorted(identifier for identifier in asked if identifier is not None))


def _standard(identifier: str) -> Condition | None:
    word, separator, rest = identifier.partition(":")
    make = _MAKE.get(word)
    return make(identifier, rest) if make is not None and separator and rest else None


def _battery(identifier: str, rest: str) -> Condition | None:
    limit = _number(rest)
    if limit is None:
        return None
    return Condition(
        identifier,
        lambda state: state.charge is not None and state.charge < limit,
        lambda state: state.charge is not None,
    )


def _wind(identifier: str, rest: str) -> Condition | None:
    limit = _number(rest)
    if limit is None:
        return None
    return Condition(
        identifier,
        lambda state: state.wind is not None and state.wind > limit,
        lambda state: state.wind is not None,
    )


def _detected(identifier: str, rest: str) -> Condition:
    return Condition(identifier, lambda state: rest in state.detected)


def _answer(identifier: str, rest: str) -> Condition:
    return Condition(identifier, lambda state: state.answers[rest], lambda state: rest in state.answers)


def _number(text: str) -> float | None:
    try:
        number = float(text)
    except ValueError:
        return None
    return number if isfinite(number) else None


_MAKE: Mapping[str, Callable[[str, str], Condition | None]] = {
    BATTERY: _battery,
    WIND: _wind,
    DETECTED: _detected,
    ANSWER: _answer,
}


def question_of(identifier: str) -> str | None:
    """Return what an operator is asked by a condition; None where nobody is."""
    word, _, rest = identifier.partition(":")
    return rest if word == ANSWER and rest else None
