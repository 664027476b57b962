"""Responses to faults: which policies call for, what ended a robot's program, and how the robot stops."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum
from math import inf

from ..faults import TAKEN_OVER
from ..policies import (
    LAST_RESORT,
    NOTHING,
    OVERTAKES,
    UNDECLARED,
    UNDECLARED_AFTER,
    Policy,
    patience,
    policy_for,
    response_to,
)
from ..vehicle import Fault

LEAST_PEER_SECONDS = 2.0
"""Real seconds that other processes have at least to answer: networks are no faster when vehicles are."""


@dataclass(frozen=True, slots=True)
class Responses:
    """Policies in the order in which they count.

    Attributes:
        live: whether the robot is a real one, which does not hold by default when it
            cannot be reached or its battery gets low, and waits for lost peers for a limited time.
        least: seconds for which it waits at least for messages of other processes.
    """

    policies: Sequence[Policy]
    live: bool = False
    least: float = 0.0

    def response(self, found: Fault) -> str:
        """Return what the robot does, a response of policies or NOTHING."""
        if found.which == TAKEN_OVER:
            return NOTHING
        if found.instead:
            return found.instead
        if self.live and policy_for(found.which, self.policies) is None:
            return UNDECLARED.get(found.which, LAST_RESORT)
        return response_to(found.which, self.policies)

    def bears(self, found: Fault) -> bool:
        """Return whether the robot tolerates a fault and continues."""
        return not found.instead and response_to(found.which, self.policies) == "CONTINUE"

    def patience(self, found: Fault, *, away: bool = False) -> float:
        """Return for how many seconds the robot tolerates a fault; inf: without limit.

        Args:
            found: the fault.
            away: whether another process is silent.
        """
        if self.bears(found):
            return inf
        seconds = patience(found.which, self.policies)
        if seconds is None:
            seconds = UNDECLARED_AFTER.get(found.which, inf) if self.live else inf
        return max(seconds, self.least) if away else seconds


OVERTAKING = OVERTAKES | {TAKEN_OVER}


class HaltProgress(Enum):
    """How far a robot has carried out its response.

    Attributes:
        NOTHING_TOLD: it has no response to carry out, or its confirmation is not awaited.
        STOPPING: it has still to confirm that it has stopped.
        STOPPED: it has confirmed, or will never be able to.
        DOWN: it has landed or surfaced, as ordered.
        AT_REST: it has landed or surfaced, and was seen disarmed since.
    """

    NOTHING_TOLD = "nothing told"
    STOPPING = "stopping"
    STOPPED = "stopped"
    DOWN = "down"
    AT_REST = "at rest"


class Halt:
    """Why and how a robot stops; a new one for each time that its program is resumed.

    Attributes:
        fault: what ended the program, or broke it off; None while it continues.
        response: how the robot was ordered to stop; empty: it was not.
        before_hold: how it was ordered to stop before an order to hold meanwhile; empty: no such order.
        progress: how far it has carried out the response.
        released: whether its last order was to stop, so that it need not be watched.
    """

    def __init__(self) -> None:
        """Start without a fault."""
        self.fault: Fault | None = None
        self.response = self.before_hold = ""
        self.progress = HaltProgress.NOTHING_TOLD
        self.released = False
        self._answered: set[str] = set()

    def is_for(self, which: str) -> bool:
        """Return whether it is this fault that ended the program, or broke it off."""
        fault = self.fault
        return fault is not None and fault.which == which

    @property
    def stopping(self) -> bool:
        """Return whether the robot has still to confirm that it has stopped."""
        return self.progress is HaltProgress.STOPPING

    @property
    def is_down(self) -> bool:
        """Return whether it has landed or surfaced, as ordered."""
        return self.progress in (HaltProgress.DOWN, HaltProgress.AT_REST)

    def end(self, found: Fault, response: str) -> None:
        """End the program, or break it off, by a fault with that response."""
        self.fault, self.response = found, response
        self._answered.add(found.which)

    def is_overtaken_by(self, found: Fault) -> bool:
        """Return whether a fault is answered now although the robot still answers another one."""
        return bool(found.instead) or (found.which in OVERTAKING and found.which not in self._answered)

    def answer(self, found: Fault, response: str) -> None:
        """Respond to another fault than the one that ended the program."""
        self._answered.add(found.which)
        self.response = response

    def hold(self) -> None:
        """Hold by an order, and keep the response for later."""
        if self.response != "HOLD":
            self.before_hold = self.before_hold or self.response
        self.response = "HOLD"

    def go_on(self) -> None:
        """Continue the response that an order to hold interrupted."""
        self.respond(self.before_hold)

    def respond(self, response: str) -> None:
        """Take this response by an order, and forget the former one."""
        self.before_hold, self.response = "", response

    def begin(self) -> None:
        """Wait until it has confirmed that it does."""
        self.progress = HaltProgress.STOPPING

    def settle(self, *, down: bool, at_rest: bool) -> None:
        """Stop waiting for the confirmation.

        Args:
            down: whether it has landed or surfaced, as ordered.
            at_rest: whether it is seen disarmed then.
        """
        self.progress = HaltProgress.STOPPED
        if down:
            self.progress = HaltProgress.AT_REST if at_rest else HaltProgress.DOWN
