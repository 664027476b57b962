"""What conditions of choices decide: each is asked once, as soon as anybody can know."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping

from ..conditions import is_standard, standard, truth
from ..faults import CONDITION_FAILED, FAILURES
from ..vehicle import Condition, Fault, LinkLost, State


def decided(condition: Condition, know: Callable[[], State]) -> bool | Fault | None:
    """Return whether a condition holds, or the fault that asking leaves; None: nobody can know yet.

    Raises:
        LinkLost: the robot cannot be reached.
    """
    identifier = condition.identifier
    try:
        state = know()
        if not condition.known(state):
            return None
        return truth(condition.holds(state))
    except LinkLost:
        raise
    except FAILURES as error:  # a condition is foreign code: whatever it raises is the robot's fault
        return Fault(CONDITION_FAILED, f"condition '{identifier}' fails: {type(error).__name__}: {error}")


def standard_conditions(identifiers: Iterable[str]) -> dict[str, Condition]:
    """Return those of the conditions that are standard, by identifier.

    `mmrs_runtime.conditions` says what each asks. Until there is an answer, or a figure to go by, the robot
    waits.

    >>> sorted(standard_conditions(["battery-below:0.3", "is it sunny", "wind-above:gale"]))
    ['battery-below:0.3']
    """
    return {identifier: _standard(identifier) for identifier in identifiers if is_standard(identifier)}


def assumed(answers: Mapping[str, bool]) -> dict[str, Condition]:
    """Return conditions that always hold, or never, by identifier."""
    return {identifier: Condition(identifier, _always(holds)) for identifier, holds in answers.items()}


def _standard(identifier: str) -> Condition:
    asks = standard(identifier)
    return Condition(identifier, lambda state: asks(state) is True, lambda state: asks(state) is not None)


def _always(holds: bool) -> Callable[[State], bool]:
    return lambda state: holds
