"""Carries out one duty of a vehicle at a time, and reports what goes wrong."""

from __future__ import annotations

from collections.abc import Callable
from math import inf

from auv_vessel.api import Craft, State
from auv_vessel.decision.duties import BATTERY_LOW, NO_PROGRESS, OBJECT_NOT_FOUND, STALE, Duty, FailureError

LINK_LOST, POSITION_LOST, OBSTACLE, CRASHED = "LINK_LOST", "POSITION_LOST", "OBSTACLE", "CRASHED"

COMES_UP = frozenset({CRASHED, NO_PROGRESS, OBJECT_NOT_FOUND})
"""Faults that no policy covers: the vehicle surfaces, since it would not be found under water."""

NEVER_BORNE = frozenset({LINK_LOST})
"""Events at which it surfaces although a policy says CONTINUE: that is about radio, not its own bus."""

SILENT = 2.0
"""Seconds of silence of the whole bus that count as loss."""

UNHEARD = 60.0
"""Seconds of silence after which a commanded vehicle is no longer waited for."""

AT_REST = 0.1
"""Metres per second under which a vehicle counts as halted."""


class FaultMonitor:
    """Watches a vehicle for faults, whatever it does.

    Attributes:
        tolerated: events that are not reported, since a policy is CONTINUE.
    """

    def __init__(
        self,
        craft: Craft,
        reserve: float,
        after: Callable[[str], float] = lambda event: 0.0,
        clearance: float = 0.0,
    ) -> None:
        """Look at a vehicle.

        Args:
            reserve: part of the battery with less than which it counts as low.
            after: seconds that an event lasts before it counts.
            clearance: metres ahead within which sonar must see nothing; 0: it may.
        """
        self.tolerated: set[str] = set()
        self._craft, self._reserve, self._after, self._clearance = craft, reserve, after, clearance
        self._since: dict[str, float] = {}

    def failure(self) -> FailureError | None:
        """Return what has gone wrong; what ends everything goes first."""
        state = self._craft.state()
        if state.emergency is not None:
            return FailureError(CRASHED, f"the dive was given up: {state.emergency}")
        found = self._events(state)
        for event in set(self._since) - set(found):
            del self._since[event]
        for event, reason in found.items():
            lasts = state.time - self._since.setdefault(event, state.time)
            if event not in self.tolerated and lasts >= self._after(event):
                return FailureError(event, reason)
        return None

    def _events(self, state: State) -> dict[str, str]:
        if state.silent > STALE:
            silent = f"no messages received on the bus for {state.silent:.1f} s"
            return {LINK_LOST: silent} if state.silent > SILENT else {}
        found = {}
        if not state.trusted or state.age > STALE:
            found[POSITION_LOST] = "depth and heading are not known"
        elif state.position_lost:
            found[POSITION_LOST] = f"the position is known to {state.uncertainty:.1f} m only"
        if state.charge is not None and state.charge < self._reserve:
            found[BATTERY_LOW] = f"{state.charge:.0%} are left"
        if state.sonar is not None and state.sonar < self._clearance:
            found[OBSTACLE] = f"{state.sonar:.1f} m ahead"
        return found


class DutyControl:
    """Has a vehicle do one duty at a time.

    Attributes:
        watch: of the vehicle meanwhile; None: none yet.
    """

    def __init__(self, craft: Craft) -> None:
        self.watch: FaultMonitor | None = None
        self._craft = craft
        self._duty: Duty | None = None
        self._failure: FailureError | None = None
        self._done = True
        self._paused = False

    def begin(self, duty: Duty, now: float) -> None:
        """Begin something else."""
        self._duty, self._failure, self._done = duty, None, False
        if not self._paused:
            self._set_out(duty, now)

    def done(self, now: float) -> bool:
        """Return whether it is done."""
        self._look(now)
        return self._done

    def failure(self, now: float) -> FailureError | None:
        """Return what goes wrong."""
        self._look(now)
        watched = self.watch.failure() if self.watch is not None else None
        return watched or self._failure

    def bear(self, event: str) -> None:
        """Continue in spite of that fault: what failed counts as done."""
        if self._failure is not None and self._failure.event == event:
            self._failure, self._done = None, True
        elif self.watch is not None:
            self.watch.tolerated.add(event)

    def pause(self, now: float) -> None:
        """Halt; idempotent."""
        if not self._paused:
            self._paused = True
            self._craft.hold()

    def resume(self, now: float) -> None:
        """Resume; idempotent."""
        if self._paused:
            self._paused = False
            if self._duty is not None and not self._done:
                self._set_out(self._duty, now)

    @property
    def halted(self) -> bool:
        """Return whether the vehicle has stopped, after it was to pause."""
        state = self._craft.state()
        slow = max(abs(state.surge), abs(state.sway), abs(state.heave)) < AT_REST
        return self._paused and slow and state.age < inf

    def _set_out(self, duty: Duty, now: float) -> None:
        try:
            duty.begin(self._craft, now)
        except FailureError as failure:
            self._failure = failure

    def _look(self, now: float) -> None:
        if self._done or self._paused or self._failure is not None or self._duty is None:
            return
        try:
            self._done = self._duty.done(self._craft, now)
        except FailureError as failure:
            self._failure = failure
