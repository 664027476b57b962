"""What ended a robot's program, or broke it off, and how the robot stops."""

from __future__ import annotations

from enum import Enum

from ..faults import TAKEN_OVER
from ..policies import OVERTAKES
from ..vehicle import Fault

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
