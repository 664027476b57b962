"""Paths of a vehicle that is driven by hand: home, to emergency areas and back, and its goals on them."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from math import hypot, inf

from mmrs_core.contributions.vehicles import VehicleInput
from mmrs_core.scene import Position
from mmrs_core.simulation.escape import Escapes
from mmrs_core.simulation.known import kinematics_of
from mmrs_core.transformation.kinds import before_target
from mmrs_mavlink.plugin.context import VehicleContext
from mmrs_mavlink.plugin.manual.steering import Goal, StickSteering

AT_HOME = 2.0
"""Metres from home, as reckoned, that count as at home."""


class Ways:
    """Knows ways that keep from forbidden areas and obstacles, as goals one after another.

    Attributes:
        home: of the robot.
    """

    def __init__(self, given: VehicleInput, context: VehicleContext) -> None:
        """Create for the robot.

        Raises:
            UnsupportedError: no plug-in provides how it moves.
            InfeasibleError: its type lacks the figures.
        """
        self.home: Position = context.robot.home or (0.0, 0.0, context.zero)
        self._context = context
        self._escapes = Escapes(given, kinematics_of(given), self.home)

    def for_response(self, response: str, here: Position) -> Sequence[Goal]:
        """Return the path home or to an emergency area; empty where none is known."""
        way = self._escapes.clear(response, here)
        at_home = response == "RETURN" and here[:2] == self.home[:2]
        return (self._goals(way) or [Goal(0.0)]) if at_home or way[-1][:2] != here[:2] else ()

    def back(self, passed: Sequence[str], here: Position) -> Sequence[Goal]:
        """Return the path to where the last of the moves ended.

        Raises:
            UnreachableError: there is none; names the reason.
        """
        moves = {move.id: move for move in self._context.robot.moves}
        place = self.home
        for id in passed:
            target = moves[id].target
            if target is not None and target.position is not None:
                place = before_target(place, target.position, moves[id].distance)
        return self._goals(self._escapes.path(here, place))

    def away(self, east: float, north: float) -> str:
        """Return how far from home a place is; empty at home."""
        metres = hypot(east - self.home[0], north - self.home[1])
        return f"it is reckoned to be {metres:.0f} m from home" if metres > AT_HOME else ""

    def _goals(self, way: Sequence[Position]) -> Sequence[Goal]:
        zero = self._context.zero
        return [Goal(max(0.0, zero - up), east, north) for east, north, up in way[1:]]


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
