"""The drive of one thruster: it obeys valid commands only, and stops the thruster by itself."""

from __future__ import annotations

from auv_vessel.sheet import Thruster

OFF, RUNS, WATCHDOG, FAULT = "OFF", "RUNS", "WATCHDOG", "FAULT"

MOST_AHEAD = 127
"""By how many the counter of a valid command is ahead of the last, at most."""

_SOON = 1e-9  # seconds by which sums of periods may be off


class Drive:
    """What stands between commands and a thruster's motor.

    A command is valid if its check is right, which who decodes it sees to, and its counter is 1 to
    `MOST_AHEAD` ahead of the last one, modulo 256. Only valid commands are obeyed and keep the watchdog
    quiet. The first command of all, and the first after the watchdog stopped the thruster, are not obeyed:
    they tell where the counter is. So a sender that repeats one frame for ever does nothing.

    Attributes:
        thrust: newtons that it puts out.
        state: one of `OFF`, `RUNS`, `WATCHDOG` and `FAULT`.
        dead: whether the motor has failed. May be set.
        stopped: whether an emergency stopped it, which nothing undoes.
    """

    def __init__(self, thruster: Thruster, watchdog: float) -> None:
        self.thrust = 0.0
        self.state = OFF
        self.dead = False
        self.stopped = False
        self._most = thruster.max_thrust
        self._watchdog = watchdog
        self._counter: int | None = None
        self._heard: float | None = None
        self._wanted: float | None = None

    def command(self, thrust: float, enable: bool, counter: int, now: float) -> bool:
        """Take a command with a right check; return whether it was valid."""
        self.run(now)
        ahead = 0 if self._counter is None else (counter - self._counter) % 256
        valid = 1 <= ahead <= MOST_AHEAD
        if valid or self._heard is None:
            self._counter = counter
        if not valid:
            return False
        self._heard = now
        self._wanted = max(-self._most, min(self._most, thrust)) if enable else None
        self.run(now)
        return True

    def stop(self) -> None:
        """Stop the thruster for good."""
        self.stopped = True
        self.run(None)

    def run(self, now: float | None) -> None:
        """Do what is due at that time, seconds; None: what does not depend on it."""
        if now is not None and self._heard is not None and now - self._heard >= self._watchdog - _SOON:
            self._heard, self._wanted, self._counter, self.state = None, None, None, WATCHDOG
        if self.dead:
            self.state = FAULT
        elif self.stopped:
            self.state = OFF
        elif self._heard is not None:
            self.state = OFF if self._wanted is None else RUNS
        elif self.state != WATCHDOG:
            self.state = OFF
        self.thrust = self._wanted or 0.0 if self.state == RUNS else 0.0
