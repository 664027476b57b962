"""A robot's choices: each is decided once, by a condition, as soon as anybody can know."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from mmrs_core.behaviour.program import RobotProgram
from mmrs_core.contributions.abilities import Noting
from mmrs_core.contributions.backends import Backend
from mmrs_core.contributions.execution import Fault, RobotState
from mmrs_core.runtime.conditions import decided
from mmrs_core.runtime.rules import Rules
from mmrs_core.runtime.waiting import Wait
from mmrs_runtime.conditions import awaiting, question_of
from mmrs_runtime.questions import Questions


class Choosing:
    """Decides the choices of a robot, and asks people what only they know.

    Attributes:
        questions: that its choices ask the operator.
    """

    def __init__(self, program: RobotProgram, backend: Backend, rules: Rules) -> None:
        """Have nothing decided yet."""
        conditions = (transition.condition for transition in program.transitions.values())
        self.questions = Questions(each for each in conditions if each is not None)
        self._robot, self._backend, self._rules = program.id, backend, rules
        self._chosen: bool | None = None

    def forget(self) -> None:
        """Begin anew, at another move."""
        self._chosen, self.questions.asked = None, ""

    def decision(self, identifier: str, wait: Wait, now: float) -> bool | Fault | None:
        """Return what a condition says, once and for all here; None as long as nobody can know.

        Raises:
            LinkLostError: the robot cannot be reached.
        """
        if self._chosen is not None:
            return self._chosen
        heard = self.questions.heard()
        holds = decided(self._rules.conditions[identifier], lambda: self._known(now, heard))
        if holds is None:
            self._tell_undecided(identifier, wait)
        elif isinstance(holds, bool):
            self._chosen = holds
            self.questions.use_up(heard)
        return holds

    def _known(self, now: float, heard: Mapping[str, bool]) -> RobotState:
        state = self._backend.state(now)
        return replace(state, answers=heard, found=state.detected | self._rules.told())

    def _tell_undecided(self, identifier: str, wait: Wait) -> None:
        if wait.question == identifier:
            return
        wait.question, self.questions.asked = identifier, question_of(identifier)
        words = awaiting(identifier)
        self._rules.say(f"'{self._robot}': {words}")
        if isinstance(self._backend, Noting):
            self._backend.note("decision", {"what": "CHOICE", "why": identifier, "response": words})
