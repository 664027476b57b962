"""From a goal and where the vehicle is to the speed, depth and heading that it should have now."""

from __future__ import annotations

from dataclasses import replace
from math import cos, hypot, pi, radians, sin, sqrt

from auv_vessel.goals import Goal
from auv_vessel.movement.abilities import Abilities
from auv_vessel.movement.loops import Aim, Motion, bearing, turn
from auv_vessel.sheet import Sheet

PLACE_GAIN, LINE_GAIN = 0.35, 0.35
"""Per second: speed towards the goal by distance, and towards the line to it by distance from that."""

NEAR = 1.0
"""Metres from the goal within which a vehicle goes straight to it, and no longer faces where it goes."""

ADRIFT = 0.08
"""Metres per second through the water below which a vehicle that steers by heading need not head anywhere."""

TOO_FAR, NEAR_ENOUGH = 0.25, 0.12
"""Metres from its goal from which on it heads there again, and within which it no longer does."""

CLOSE, ALIGNED = 4.0, 0.7
"""Metres from its goal within which it turns first; cosine to its course above which it then sets off."""

BACKWARDS, SLOWLY = 110.0, 0.25
"""Degrees from the bow beyond which, metres per second below which, it rather goes backwards."""

SEARCH_RADIUS, SEARCH_SPACING, SWEEP = 5.0, 1.5, 20.0
"""Metres of a search's spiral (`Sheet.extra`: ``search.radius``, ``search.spacing``); degrees per second."""


class Guidance:
    """Guides a vehicle to one goal.

    To reach a goal it keeps to the line from where it began, at a speed that lets it stop there.
    A vehicle without thrust to the side heads where it has to go through the water, current allowed for.

    Attributes:
        goal: with its start position filled in, where its mode needs that.
        done: whether a search has been through all of its figure.
    """

    def __init__(self, goal: Goal, motion: Motion, sheet: Sheet, abilities: Abilities) -> None:
        if goal.mode in ("TURN", "SURFACE"):
            goal = replace(goal, north=motion.north, east=motion.east)
        if goal.mode == "TURN":
            goal = replace(goal, depth=motion.depth)
        if goal.mode == "SURFACE":
            goal = replace(goal, depth=0.0, heading=motion.heading, along=False)
        self.goal = replace(goal, depth=max(goal.depth, abilities.afloat - 0.1))
        self.done = goal.mode != "SEARCH"
        self._abilities = abilities
        self._begin = (motion.north, motion.east)
        self._heading = motion.heading if goal.along else goal.heading
        self._radius = sheet.extra.get("search.radius", SEARCH_RADIUS)
        self._spacing = sheet.extra.get("search.spacing", SEARCH_SPACING)
        self._angle = 0.0
        self._chases = True

    @property
    def speed(self) -> float:
        """Metres per second at which it goes where there is room to."""
        return self.goal.speed or self._abilities.cruise

    def aim(self, motion: Motion, steers: bool, period: float) -> Aim:
        """Return what loops are to bring about now.

        Args:
            steers: whether the vehicle has no thrust to the side, and steers by its heading.
        """
        north, east = self._velocity(motion, period)
        if steers and self.goal.mode != "TURN":
            return self._steered(north, east, motion)
        self._face(north, east, motion)
        if self.goal.along and self.distance(motion) > NEAR:
            slow = max(0.15, cos(radians(turn(self._heading, motion.heading))))
            north, east = slow * north, slow * east
        return Aim(north, east, self.goal.depth, self._heading)

    def distance(self, motion: Motion) -> float:
        """Return metres to the goal in the plane."""
        return hypot(self.goal.north - motion.north, self.goal.east - motion.east)

    def _velocity(self, motion: Motion, period: float) -> tuple[float, float]:
        if self.goal.mode == "SEARCH":
            return self._searching(motion, period)
        north, east = self.goal.north - motion.north, self.goal.east - motion.east
        if self.goal.mode == "GO_TO" and hypot(north, east) > NEAR:
            return self._along_line(motion)
        return self._towards(north, east)

    def _towards(self, north: float, east: float) -> tuple[float, float]:
        away = hypot(north, east)
        speed = min(self.speed, PLACE_GAIN * away, sqrt(2.0 * self._abilities.braking * away))
        return (north / away * speed, east / away * speed) if away > 1e-6 else (0.0, 0.0)

    def _along_line(self, motion: Motion) -> tuple[float, float]:
        goal, (begin_north, begin_east) = self.goal, self._begin
        north, east = goal.north - begin_north, goal.east - begin_east
        length = hypot(north, east)
        if length < NEAR:
            return self._towards(goal.north - motion.north, goal.east - motion.east)
        north, east = north / length, east / length
        gone_north, gone_east = motion.north - begin_north, motion.east - begin_east
        ahead = length - (gone_north * north + gone_east * east)
        aside = gone_east * north - gone_north * east
        if ahead < NEAR:
            return self._towards(goal.north - motion.north, goal.east - motion.east)
        speed = min(self.speed, sqrt(2.0 * self._abilities.braking * ahead), max(0.3, PLACE_GAIN * ahead))
        back = min(max(-LINE_GAIN * aside, -0.7 * speed), 0.7 * speed)
        along = sqrt(max(0.0, speed * speed - back * back))
        return along * north - back * east, along * east + back * north

    def _searching(self, motion: Motion, period: float) -> tuple[float, float]:
        """Go along a spiral outwards, or turn about on the spot where a heading is given."""
        goal = self.goal
        if not goal.along:
            self._angle += radians(SWEEP) * period
            self.done = self._angle >= 2.0 * pi
            self._heading = (goal.heading + self._angle * 180.0 / pi) % 360.0
            return self._towards(goal.north - motion.north, goal.east - motion.east)
        radius = min(self._spacing * self._angle / (2.0 * pi), self._radius)
        north = goal.north + radius * cos(self._angle) - motion.north
        east = goal.east + radius * sin(self._angle) - motion.east
        if hypot(north, east) < NEAR and not self.done:
            self._angle += self.speed * period / max(radius, self._spacing / 2.0)
            self.done = self._spacing * self._angle / (2.0 * pi) >= self._radius
        return self._towards(north, east)

    def _face(self, north: float, east: float, motion: Motion) -> None:
        goal = self.goal
        if goal.along and (goal.mode == "SEARCH" or self.distance(motion) > NEAR):
            if hypot(north, east) > ADRIFT:
                self._heading = bearing(north, east)
        elif not goal.along and goal.mode != "SEARCH":
            self._heading = goal.heading

    def _steered(self, north: float, east: float, motion: Motion) -> Aim:
        """Head where the vehicle has to go through the water, and go as far as it heads there already."""
        flow_north, flow_east = motion.current_north, motion.current_east
        through_north, through_east = north - flow_north, east - flow_east
        through = hypot(through_north, through_east)
        away = self.distance(motion)
        self._chases = away > (NEAR_ENOUGH if self._chases else TOO_FAR)
        if through > ADRIFT and (self._chases or hypot(flow_north, flow_east) > ADRIFT):
            self._heading = bearing(through_north, through_east)
            behind = abs(turn(self._heading, motion.heading)) > BACKWARDS
            if behind and through < SLOWLY and away < NEAR:
                self._heading = (self._heading + 180.0) % 360.0
        elif not self.goal.along:
            self._heading = self.goal.heading
        ahead = (cos(radians(motion.heading)), sin(radians(motion.heading)))
        surge = through_north * ahead[0] + through_east * ahead[1]
        if away > NEAR:
            surge = max(0.0, surge)
        if away < CLOSE and through > ADRIFT:
            surge *= max(0.0, (abs(surge) / through - ALIGNED) / (1.0 - ALIGNED))
        return Aim(
            surge * ahead[0] + flow_north, surge * ahead[1] + flow_east, self.goal.depth, self._heading
        )


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
