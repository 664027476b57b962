"""What ended a robot's program, or broke it off, and how the robot stops."""

from __future__ import annotations

from enum import Enum

from ..faults import TAKEN_OVER
from ..policies import OVERTAKES
from ..vehicle import Fault

OVERTAKING = OVERTAKES | {TAKEN_OVER}


class Progress(Enum):
    """How far a robot is with what it was told to do instead of its program.

    Attributes:
        NOTHING_TOLD: it was told nothing, or is taken at its word.
        STOPPING: it has still to confirm that it has stopped.
        STOPPED: it has, or is not known to, and never will be.
        DOWN: it has come down, as it was told to.
        AT_REST: it has come down, and its motors were seen to be off then.
    """

    NOTHING_TOLD = "nothing told"
    STOPPING = "stopping"
    STOPPED = "stopped"
    DOWN = "down"
    AT_REST = "at rest"


class Halt:
    """Why and how a robot stops; a new one for each time that its program is taken up again.

    Attributes:
        fault: what ended the program, or broke it off; None as long as nothing did.
        response: how the robot was told to stop; empty: it was not.
        before_hold: how it was told to stop before somebody ordered it to hold meanwhile; empty: nobody did.
        progress: how far it is with that.
        released: whether somebody ordered it to stop, so that it need not be watched, and nothing since.
    """

    def __init__(self) -> None:
        """Have nothing wrong."""
        self.fault: Fault | None = None
        self.response = self.before_hold = ""
        self.progress = Progress.NOTHING_TOLD
        self.released = False
        self._answered: set[str] = set()

    def is_for(self, which: str) -> bool:
        """Return whether it is this fault that ended the program, or broke it off."""
        fault = self.fault
        return fault is not None and fault.which == which

    @property
    def stopping(self) -> bool:
        """Return whether the robot has still to confirm that it has stopped."""
        return self.progress is Progress.STOPPING

    @property
    def is_down(self) -> bool:
        """Return whether it has come down, as it was told to."""
        return self.progress in (Progress.DOWN, Progress.AT_REST)

    def end(self, found: Fault, response: str) -> None:
        """Have the program end, or be broken off, by a fault with that response."""
        self.fault, self.response = found, response
        self._answered.add(found.which)

    def is_overtaken_by(self, found: Fault) -> bool:
        """Return whether a fault is answered now although the robot still answers another one."""
        return bool(found.instead) or (found.which in OVERTAKING and found.which not in self._answered)

    def answer(self, found: Fault, response: str) -> None:
        """Have the robot respond to another fault than that which ended its program."""
        self._answered.add(found.which)
        self.response = response

    def hold(self) -> None:
        """Have it hold, as somebody orders, and keep what it was to do."""
        if self.response != "HOLD":
            self.before_hold = self.before_hold or self.response
        self.response = "HOLD"

    def go_on(self) -> None:
        """Have it do what it was to do before it was ordered to hold."""
        self.respond(self.before_hold)

    def respond(self, response: str) -> None:
        """Have it do this, as somebody orders, and forget what it was to do."""
        self.before_hold, self.response = "", response

    def begin(self) -> None:
        """Wait until it has confirmed that it does."""
        self.progress = Progress.STOPPING

    def settle(self, *, down: bool, at_rest: bool) -> None:
        """Wait no longer.

        Args:
            down: whether it has come down, as it was told to.
            at_rest: whether its motors are seen to be off then.
        """
        self.progress = Progress.STOPPED
        if down:
            self.progress = Progress.AT_REST if at_rest else Progress.DOWN
