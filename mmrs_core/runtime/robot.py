"""One robot of a run: where it is in its program, and what its backend is doing."""

from __future__ import annotations

from collections.abc import Mapping
from math import inf

from mmrs_core.behaviour.policies import patience, response_to
from mmrs_core.behaviour.program import Action, Move, RobotProgram, SlotId
from mmrs_core.behaviour.semantics import NOTIFY, Phase, Step, action_at, entry, fault, steps
from mmrs_core.contributions.execution import Backend, Bus, Condition, Delivery, Fault
from mmrs_core.errors import LinkLostError
from mmrs_core.runtime.peers import Peers
from mmrs_core.scene import Policy


class RunningRobot:
    """A robot while it runs.

    Attributes:
        point: where it is in its program.
        lamport: its logical time.
        wake: when it is worth looking at it again.
        deadline: when its present wait ends by a fault; inf: never.
        lacking: names of the slots that it waited for when last looked at.
        fault: what ended its mission; None as long as nothing did.
        delivery: a notify that owners of slots have still to answer or to acknowledge; None: there is none.
        number: of its next step.
        response: how it was told to stop.
    """

    def __init__(
        self,
        program: RobotProgram,
        backend: Backend,
        bus: Bus,
        conditions: Mapping[str, Condition],
        policies: tuple[Policy, ...],
    ) -> None:
        self.id = program.id
        self.backend = backend
        self.point = entry(program, program.start)
        self.lamport = 0
        self.wake = 0.0
        self.deadline = inf
        self.lacking: tuple[str, ...] = ()
        self.fault: Fault | None = None
        self.delivery: Delivery | None = None
        self.number = 0
        self.response = ""
        self._program, self._bus, self._conditions = program, bus, conditions
        self._policies = (*program.policies, *policies)
        self._begun = False
        self._waits_since: float | None = None
        self._peer_lost_at: float | None = None
        self._sent = False
        self._silent_since: float | None = None

    @property
    def move(self) -> Move:
        """Return the move that it is at."""
        return self._program.moves[self.point.move]

    @property
    def is_waiting(self) -> bool:
        """Return whether it waits for slots."""
        return bool(self.lacking)

    def take_number(self) -> int:
        """Return the number of its next step, and count on."""
        self.number += 1
        return self.number - 1

    def awaited(self) -> tuple[SlotId, ...]:
        """Return the slots that must be active before it leaves its move."""
        if self.point.phase is not Phase.OUT:
            return ()
        return tuple((self.id, name) for name in self._program.transitions[self.point.move].waits)

    def follow(self, step: Step) -> None:
        """Go where a step leads."""
        self.point = step.leads_to
        self._begun, self._waits_since, self._peer_lost_at = False, None, None
        self.lacking, self.deadline = (), inf

    def due(self, now: float, peers: Peers) -> Step | None:
        """Return the step to be made now, beginning what has to be begun; None: not yet.

        The only place where a fault of a robot, its device, its link or a condition becomes a step.
        """
        try:
            found = self._unanswered(now) or self._due(now, peers)
        except LinkLostError as error:
            found = Fault("LINK_LOST", str(error))
        if isinstance(found, Fault):
            self._give_up()
            self.fault = found
            self.response = response_to(found.which, self._effective_policies())
            return fault(self._program, self.point, str(found))
        return found

    def send(self) -> None:
        """Send the notify that was recorded last."""
        if self.delivery is not None:
            self._sent = True
            self.delivery.send(self.lamport)

    def next_event(self, now: float) -> float | None:
        """Return when something may have changed; inf: only slots can wake it; None: unknown."""
        if self.point.is_final:
            return inf
        event = self.backend.next_event(now)
        return min(event, self.deadline) if event is not None else None

    def _unanswered(self, now: float) -> Fault | None:
        """Return the fault that ends waiting for owners of slots; None: they have answered, or still may."""
        if self.delivery is None or not self.delivery.waiting:
            self._silent_since = None
            if self._sent:
                self.delivery, self._sent = None, False
            return None
        if self._silent_since is None:
            self._silent_since = now
        found = self.backend.fault(now)
        if found is not None and not self._bears(found):
            return found
        found = Fault("PEER_LOST", f"no answer from {', '.join(self.delivery.waiting)}")
        return found if now - self._silent_since >= self._patience(found) else None

    def _give_up(self) -> None:
        if self.delivery is not None:
            self.delivery.withdraw()
        self.delivery, self._sent, self._silent_since = None, False, None

    def _due(self, now: float, peers: Peers) -> Step | Fault | None:
        if self.delivery is not None and self.delivery.waiting:
            return None
        phase = self.point.phase
        if phase is Phase.READY:
            return self._next()
        if phase is Phase.OUT:
            return self._way_on(now, peers)
        action = action_at(self._program, self.point)
        if action is not None and action.is_a(NOTIFY):
            return self._next()
        return self._activity(action, now)

    def _next(self) -> Step:
        return steps(self._program, self.point, frozenset())[0]

    def _activity(self, action: Action | None, now: float) -> Step | Fault | None:
        """Begin the action, or the movement where there is none, and look whether it has finished."""
        if not self._begun:
            self._begun = True
            if action is not None:
                self.backend.act(action, now)
            else:
                self.backend.begin(self.move, now, through=self._may_pass())
        found = self.backend.fault(now)
        if action is not None and found is not None and found.which == "DEVICE_SILENT" and self._bears(found):
            return self._next()
        if found is not None and not self._bears(found):
            return found
        return self._next() if self.backend.finished(now) else None

    def _way_on(self, now: float, peers: Peers) -> Step | Fault | None:
        active = {slot for slot in self.awaited() if self._bus.state(slot).active}
        possible = steps(self._program, self.point, active)
        if not possible:
            return self._wait(now, active, peers)
        if len(possible) == 1:
            return possible[0]
        holds = self._decision(now)
        if isinstance(holds, Fault):
            return holds
        return possible[0] if holds else possible[1]

    def _wait(self, now: float, active: set[SlotId], peers: Peers) -> Fault | None:
        self.lacking = tuple(name for owner, name in self.awaited() if (owner, name) not in active)
        if self._waits_since is None:
            self._waits_since = now
            self.backend.wait(now)
        found = self.backend.fault(now)
        if found is not None and not self._bears(found):
            return found
        ends = (self._too_long(), self._peer_lost(now, peers))
        self.deadline = min(end for end, _ in ends)
        return next((reason for end, reason in ends if end <= now), None)

    def _too_long(self) -> tuple[float, Fault]:
        found = Fault("WAIT_TOO_LONG", f"waits for {', '.join(self.lacking)}")
        return (self._waits_since or 0.0) + self._patience(found), found

    def _peer_lost(self, now: float, peers: Peers) -> tuple[float, Fault]:
        lost = sorted({robot for name in self.lacking for robot in peers.lost((self.id, name))})
        found = Fault("PEER_LOST", f"waits for {', '.join(self.lacking)} of {', '.join(lost)}")
        if not lost:
            return inf, found
        if self._peer_lost_at is None:
            self._peer_lost_at = now
        return self._peer_lost_at + self._patience(found), found

    def _decision(self, now: float) -> bool | Fault:
        identifier = self._program.transitions[self.point.move].condition or ""
        try:
            holds = self._conditions[identifier].holds(self.backend.state(now))
        except LinkLostError:
            raise
        except Exception as error:  # a condition is foreign code: whatever it raises is the robot's fault
            return Fault("CONDITION", f"'{identifier}' raised {type(error).__name__}: {error}")
        if not isinstance(holds, bool):
            return Fault("CONDITION", f"'{identifier}' returned {holds!r}, neither True nor False")
        return holds

    def _may_pass(self) -> bool:
        """Return whether nothing as yet keeps it from going into the next move without a stop."""
        if self.point.move == self._program.stop:
            return False
        transition = self._program.transitions[self.point.move]
        if not transition.fluid or transition.condition is not None:
            return False
        following = self._program.moves[transition.to]
        blocking = (action for action in (*self.move.after, *following.before) if not action.is_a(NOTIFY))
        slots = ((self.id, name) for name in transition.waits)
        return next(blocking, None) is None and all(self._bus.state(slot).active for slot in slots)

    def _effective_policies(self) -> tuple[Policy, ...]:
        if self.point.phase is not Phase.OUT:
            return self._policies
        return (*self._program.transitions[self.point.move].policies, *self._policies)

    def _bears(self, found: Fault) -> bool:
        return response_to(found.which, self._effective_policies()) == "CONTINUE"

    def _patience(self, found: Fault) -> float:
        if self._bears(found):
            return inf
        seconds = patience(found.which, self._effective_policies())
        return inf if seconds is None else seconds
