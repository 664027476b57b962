"""Whether a goal is reached, or will not be."""

from __future__ import annotations

from math import hypot

from auv_vessel.movement.abilities import Abilities
from auv_vessel.movement.guidance import ADRIFT, Guidance
from auv_vessel.movement.loops import Motion, turn

PLACE, DEPTH, HEADING, SPEED = 0.3, 0.1, 5.0, 0.12
"""Metres, metres, degrees and metres per second within which a goal is reached."""

SETTLED = 0.5
"""Seconds for which all of it has to be so."""

PATIENCE, ALLOWANCE = 3.0, 30.0
"""How many times as long as it should take, and seconds more, until a goal counts as failed."""


class Progress:
    """How far a goal is.

    A vehicle without thrust to the side cannot keep both its place and a heading in a current: it keeps its
    place, and any heading will do.

    Attributes:
        state: one of `catalogue.PROGRESS`; once reached or failed it stays so.
        distance: metres left to go, in the plane and in depth.
    """

    def __init__(
        self, guidance: Guidance, motion: Motion, abilities: Abilities, now: float, *, beyond: float = 0.0
    ) -> None:
        """Begin to judge; `beyond`: metres by which the goal is deeper than it may lead."""
        self._guidance = guidance
        self._abilities = abilities
        self._beyond = beyond
        self._since: float | None = None
        self.state = "ACTIVE"
        self.distance = self._left(motion)
        goal = guidance.goal
        deep = abs(goal.depth - motion.depth) / max(abilities.steepest, 0.05)
        way = guidance.distance(motion) / max(guidance.speed, 0.05) if goal.mode != "SURFACE" else 0.0
        self._until = now + ALLOWANCE + PATIENCE * (way + deep + 3.2 / max(abilities.turning, 0.05))

    def judge(self, motion: Motion, now: float, *, steers: bool) -> None:
        """Bring state and distance up to now.

        Args:
            steers: whether the vehicle has no thrust to the side.
        """
        self.distance = self._left(motion)
        if self.state != "ACTIVE":
            return
        if not self._within(motion, steers):
            self._since = None
        elif self._since is None:
            self._since = now
        elif now - self._since >= SETTLED:
            self.state = "REACHED"
            return
        if now > self._until and self._guidance.goal.mode not in ("HOLD", "SEARCH"):
            self.state = "FAILED"

    def _within(self, motion: Motion, steers: bool) -> bool:
        goal = self._guidance.goal
        if goal.mode == "SURFACE":
            return motion.depth <= self._abilities.afloat
        if not self._guidance.done or self._beyond > DEPTH:
            return False
        deep = (
            abs(goal.depth - motion.depth) <= DEPTH or max(goal.depth, motion.depth) <= self._abilities.afloat
        )
        swept = steers and goal.mode != "TURN" and hypot(motion.current_north, motion.current_east) > ADRIFT
        any_heading = goal.along or goal.mode == "SEARCH" or swept
        faces = any_heading or abs(turn(goal.heading, motion.heading)) <= HEADING
        free = goal.mode == "SEARCH" or (goal.mode == "TURN" and steers)
        here = free or self._guidance.distance(motion) <= PLACE
        north, east, down = motion.over_ground()
        still = free or (hypot(north, east) <= SPEED and abs(down) <= SPEED)
        return deep and faces and here and still

    def _left(self, motion: Motion) -> float:
        goal = self._guidance.goal
        deep = abs(goal.depth + self._beyond - motion.depth)
        if goal.mode == "SURFACE":
            return deep
        return hypot(self._guidance.distance(motion), deep)
