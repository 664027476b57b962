"""Goals to which a vehicle that is driven by hand is steered one after another."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from math import inf

from mmrs_mavlink.plugin.manual.steering import Goal, StickSteering


class Route:
    """Gives a steering its goals.

    Attributes:
        depth: of the last goal, or where the vehicle began; metres.
        late_at: when something must be wrong if the goal is not reached.
        paused: goal towards which it is steered again after a pause; None: there is no pause.
    """

    def __init__(self, steering: StickSteering) -> None:
        """Create without goals."""
        self.depth, self.late_at = 0.0, inf
        self.paused: Goal | None = None
        self._steering = steering
        self._goals: deque[Goal] = deque()

    @property
    def reached(self) -> bool:
        """Return whether all goals are, and there is no pause."""
        return self._steering.reached and not self._goals and self.paused is None

    def go(self, goals: Sequence[Goal], now: float) -> None:
        """Replace all goals."""
        self._goals, self.paused = deque(goals), None
        self.go_on(now)

    def go_on(self, now: float) -> None:
        """Steer towards the next goal, if there is one, unless there is a pause."""
        if self._goals and self.paused is None:
            self._aim(self._goals.popleft(), now)

    def stay(self, depth: float) -> None:
        """Hold the estimated position at that depth, without a time limit."""
        self._goals.clear()
        self.late_at = inf
        self._steering.aim(Goal(depth, self._steering.east, self._steering.north))

    def come_up(self, now: float) -> None:
        """Drop all goals, since the vehicle surfaces on its own."""
        self._goals.clear()
        self.late_at = now + self._steering.seconds(Goal(0.0))

    def pause(self) -> None:
        """Halt, and keep the goal."""
        if self.paused is None:
            self.paused = self._steering.goal or Goal(self.depth)
            self.late_at = inf
            self._steering.hold()

    def resume(self, now: float) -> None:
        """Steer towards the goal that was kept."""
        if self.paused is not None:
            goal, self.paused = self.paused, None
            self._aim(goal, now)

    def _aim(self, goal: Goal, now: float) -> None:
        self.depth, self.late_at = goal.depth, now + self._steering.seconds(goal)
        self._steering.aim(goal)
