"""What a robot does at each point of its program, until it can make a step from there."""

from __future__ import annotations

from collections.abc import Set

from mmrs_core.behaviour.program import Action, RobotProgram, SlotId
from mmrs_core.behaviour.semantics import NOTIFY, Phase, Point, Step, action_at, steps
from mmrs_core.contributions.backends import Backend
from mmrs_core.contributions.buses import Bus
from mmrs_core.contributions.execution import Fault
from mmrs_core.runtime.answers import Answers
from mmrs_core.runtime.choosing import Choosing
from mmrs_core.runtime.peers import Peers
from mmrs_core.runtime.rules import Rules
from mmrs_core.runtime.waiting import Wait


class Doing:
    """Begins what there is to do at a point, and sees when it has finished.

    Attributes:
        wait: what keeps the robot from leaving its move.
        questions: that its choices ask the operator.
    """

    def __init__(self, program: RobotProgram, backend: Backend, bus: Bus, rules: Rules) -> None:
        """Have nothing begun."""
        self._program, self._backend, self._bus = program, backend, bus
        self._choosing = Choosing(program, backend, rules)
        self.questions = self._choosing.questions
        self.wait = Wait(program.id)
        self._begun = False

    def forget(self) -> None:
        """Begin anew, at another point or once more at the same."""
        self._begun, self.wait = False, Wait(self._program.id)
        self._choosing.forget()

    def awaited(self, point: Point) -> tuple[SlotId, ...]:
        """Return the slots that must be active before the robot goes on from a point."""
        if point.phase is not Phase.OUT:
            return ()
        return tuple((self._program.id, name) for name in self._program.transitions[point.move].waits)

    def due(self, point: Point, answers: Answers, now: float, peers: Peers) -> Step | Fault | None:
        """Return the step to be made now, beginning what has to be begun; None: not yet.

        Raises:
            LinkLostError: the robot cannot be reached.
        """
        if point.phase is Phase.READY:
            return self._next(point)
        if point.phase is Phase.OUT:
            return self._way_on(point, answers, now, peers)
        action = action_at(self._program, point)
        if action is not None and action.is_a(NOTIFY):
            return self._next(point)
        return self._activity(point, action, answers, now)

    def _next(self, point: Point) -> Step:
        return steps(self._program, point, frozenset())[0]

    def _activity(
        self, point: Point, action: Action | None, answers: Answers, now: float
    ) -> Step | Fault | None:
        """Begin the action, or the movement where there is none, and look whether it has finished."""
        if not self._begun:
            self._begun = True
            if action is not None:
                self._backend.act(action, now)
            else:
                self._backend.begin(self._program.moves[point.move], now, through=self._may_pass(point))
        trouble = self._backend.fault(now)
        if (found := answers.unborne(self._backend, now)) is not None:
            return found
        skipped = action is not None and trouble is not None and trouble.which == "DEVICE_SILENT"
        return self._next(point) if skipped or self._backend.finished(now) else None

    def _way_on(self, point: Point, answers: Answers, now: float, peers: Peers) -> Step | Fault | None:
        active = {slot for slot in self.awaited(point) if self._bus.state(slot).active}
        possible = steps(self._program, point, active)
        if len(possible) == 1:
            return possible[0]
        if not possible:
            return self._wait(point, active, answers, now, peers)
        condition = self._program.transitions[point.move].condition or ""
        holds = self._choosing.decision(condition, self.wait, now)
        if holds is None:
            return self._wait(point, active, answers, now, peers)
        if isinstance(holds, Fault):
            return holds
        return possible[0] if holds else possible[1]

    def _wait(
        self, point: Point, active: Set[SlotId], answers: Answers, now: float, peers: Peers
    ) -> Fault | None:
        self.wait.lacking = tuple(name for owner, name in self.awaited(point) if (owner, name) not in active)
        if self.wait.begin(now):
            self._backend.wait(now)
        return answers.unborne(self._backend, now) or self.wait.overdue(now, answers, peers)

    def _may_pass(self, point: Point) -> bool:
        """Return whether nothing as yet keeps the robot from going into the next move without a stop."""
        if point.move == self._program.stop:
            return False
        transition = self._program.transitions[point.move]
        if not transition.fluid or transition.condition is not None:
            return False
        move, following = self._program.moves[point.move], self._program.moves[transition.to]
        blocking = (action for action in (*move.after, *following.before) if not action.is_a(NOTIFY))
        slots = ((self._program.id, name) for name in transition.waits)
        return next(blocking, None) is None and all(self._bus.state(slot).active for slot in slots)
