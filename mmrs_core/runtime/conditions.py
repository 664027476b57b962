"""Conditions of Choices: those that need nobody to write them, and what each decides."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable

from mmrs_core.behaviour.program import Program
from mmrs_core.contributions.execution import Condition, Fault, RobotState
from mmrs_core.errors import LinkLostError, UsageError
from mmrs_core.languages.naming import nearest
from mmrs_runtime.conditions import is_standard, standard, truth
from mmrs_runtime.faults import CONDITION_FAILED, FAILURES


def standard_conditions(identifiers: Iterable[str]) -> dict[str, Condition]:
    """Return those of the conditions that are standard, by identifier.

    They are those of generated controllers: `mmrs_runtime.conditions` says what each asks. Until
    there is an answer, or a figure to go by, the robot waits.

    >>> sorted(standard_conditions(["battery-below:0.3", "is it sunny", "wind-above:gale"]))
    ['battery-below:0.3']
    """
    return {identifier: _standard(identifier) for identifier in identifiers if is_standard(identifier)}


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


def decided(condition: Condition, know: Callable[[], RobotState]) -> bool | Fault | None:
    """Return whether a condition holds, or the fault that asking leaves; None: nobody can know yet.

    Raises:
        LinkLostError: the robot cannot be reached.
    """
    identifier = condition.identifier
    try:
        state = know()
        if not condition.known(state):
            return None
        return truth(condition.holds(state))
    except LinkLostError:
        raise
    except FAILURES as error:  # a condition is foreign code: whatever it raises is the robot's fault
        return Fault(CONDITION_FAILED, f"condition '{identifier}' fails: {type(error).__name__}: {error}")


def _standard(identifier: str) -> Condition:
    asks = standard(identifier)
    return Condition(identifier, lambda state: asks(state) is True, lambda state: asks(state) is not None)
