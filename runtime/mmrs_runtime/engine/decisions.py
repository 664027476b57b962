"""Decisions of conditions of choices: each is asked once, as soon as it can be known."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterable, Mapping

from ..conditions import ANSWER_SECONDS, is_standard, standard, truth
from ..faults import CONDITION_FAILED, FAILURES
from ..questions import OperatorAnswers
from ..vehicle import Condition, Fault, LinkLost, VehicleState

SLOW_SECONDS = 1.0
"""Real seconds after which the operator learns that a function of theirs has not answered yet."""


def decided(condition: Condition, know: Callable[[], VehicleState]) -> bool | Fault | None:
    """Return whether a condition holds, or the fault that asking leaves; None: it cannot be known yet.

    Raises:
        LinkLost: the robot cannot be reached.
    """
    identifier = condition.identifier
    try:
        holds = condition.asked(know())
        return None if holds is None else truth(holds)
    except LinkLost:
        raise
    except FAILURES as error:  # a condition is foreign code: whatever it raises is the robot's fault
        return Fault(CONDITION_FAILED, f"condition '{identifier}' fails: {type(error).__name__}: {error}")


class Asking:
    """A condition that is being asked in a thread of its own, so that the run continues whatever it does.

    Attributes:
        done: whether `answer` is there.
        answer: as of `decided`.
        answers: the operator's answers that it is asked with.
    """

    def __init__(
        self, condition: Condition, state: VehicleState, answers: OperatorAnswers, wake: Callable[[], None]
    ) -> None:
        """Ask; `wake` is called once there is an answer."""
        self.done, self.answers = False, answers
        self.answer: bool | Fault | None = None
        self._condition, self._until = condition, time.monotonic() + ANSWER_SECONDS
        name = f"condition {condition.identifier!r}"
        threading.Thread(target=self._ask, args=(state, wake), name=name, daemon=True).start()

    @property
    def is_slow(self) -> bool:
        """Return whether it takes so long that people should know."""
        return time.monotonic() > self._until - ANSWER_SECONDS + SLOW_SECONDS

    def look(self) -> bool:
        """Return whether there is an answer, which is a fault where it has not come in time."""
        if not self.done and time.monotonic() > self._until:
            words = f"condition '{self._condition.identifier}' has not answered for {ANSWER_SECONDS:g} s"
            self.answer, self.done = Fault(CONDITION_FAILED, words), True
        return self.done

    def _ask(self, state: VehicleState, wake: Callable[[], None]) -> None:
        answer = decided(self._condition, lambda: state)
        if not self.done:
            self.answer, self.done = answer, True
            wake()


def standard_conditions(identifiers: Iterable[str]) -> dict[str, Condition]:
    """Return those of the conditions that are standard, by identifier.

    `mmrs_runtime.conditions` defines what each asks. Until there is an answer, or a figure to go by, the
    robot waits.

    >>> sorted(standard_conditions(["battery-below:0.3", "is it sunny", "wind-above:gale"]))
    ['battery-below:0.3']
    """
    return {identifier: _standard(identifier) for identifier in identifiers if is_standard(identifier)}


def assumed(answers: Mapping[str, bool]) -> dict[str, Condition]:
    """Return conditions that always hold, or never, by identifier."""
    return {
        identifier: Condition(identifier, _always(holds), instant=True)
        for identifier, holds in answers.items()
    }


def _standard(identifier: str) -> Condition:
    asks = standard(identifier)
    known = lambda state: asks(state) is not None  # noqa: E731
    return Condition(identifier, lambda state: asks(state) is True, known, instant=True)


def _always(holds: bool) -> Callable[[VehicleState], bool]:
    return lambda state: holds
