"""The paths by which simulated robots respond to faults."""

from __future__ import annotations

from contextlib import suppress
from functools import cached_property
from math import dist

from mmrs_core.behaviour.rally_points import rally_points_of
from mmrs_core.contributions.vehicles import VehicleInput
from mmrs_core.errors import UnreachableError
from mmrs_core.planning.paths import Space
from mmrs_core.scene import Area, AreaUse, Kinematics, Position


class Escapes:
    """Where one robot goes when something has gone wrong.

    Paths to home and to emergency areas keep the robot's altitude, then lead down to that of home.
    """

    def __init__(self, given: VehicleInput, kinematics: Kinematics, home: Position) -> None:
        self._given, self._kinematics, self._home = given, kinematics, home
        own = given.type.half_diagonal + given.program.position_error
        self._clearance = own + kinematics.turning_radius

    def straight(self, response: str, here: Position) -> tuple[Position, ...]:
        """Return the path regardless of areas; `here` alone where the robot stays."""
        if response == "SURFACE":
            return (here, (here[0], here[1], self._given.program.frame.surface))
        if response == "LAND":
            return self._down((here,))
        goal = self._goal(response, here)
        if goal is None:
            return (here,)
        return self._down((here,) if goal[:2] == here[:2] else (here, goal))

    def clear(self, response: str, here: Position) -> tuple[Position, ...]:
        """Return the path that keeps clear of forbidden areas and obstacles.

        Where there is none, a robot that flies lands where it is, and any other stays.
        """
        goals = self._goals(response, here)
        if not goals or any(goal[:2] == here[:2] for goal in goals):
            return self.straight(response, here)
        routes = []
        for goal in goals:
            with suppress(UnreachableError):
                routes.append(self._space.route(here, goal))
        if not routes:
            return self._down((here,)) if self._kinematics.launches else (here,)
        return self._down(min(routes, key=self._space.seconds))

    def path(self, here: Position, goal: Position) -> tuple[Position, ...]:
        """Return the path to a position that keeps clear of forbidden areas and obstacles.

        Raises:
            UnreachableError: there is none; gives the reason.
        """
        return (here,) if here == goal else self._space.route(here, goal)

    def _goal(self, response: str, here: Position) -> Position | None:
        """Return the nearest goal at the robot's altitude; None where the robot stays."""
        places = self._goals(response, here)
        nothing = here if response == "EMERGENCY_AREA" else None
        return min(places, key=lambda place: dist(place, here), default=nothing)

    def _goals(self, response: str, here: Position) -> list[Position]:
        """Return the goals at the robot's altitude; none where the robot stays."""
        if response == "RETURN":
            return [(self._home[0], self._home[1], self._height(here))]
        if response == "EMERGENCY_AREA":
            return [(east, north, self._height(here)) for east, north in self._rally_points]
        return []

    def _height(self, here: Position) -> float:
        return min(max(here[2], self._kinematics.floor), self._kinematics.ceiling)

    def _down(self, path: tuple[Position, ...]) -> tuple[Position, ...]:
        east, north, up = path[-1]
        ground = self._home[2]
        return path if up == ground else (*path, (east, north, ground))

    @cached_property
    def _rally_points(self) -> tuple[tuple[float, float], ...]:
        """Return a point of the robot's own inside every emergency area that is large enough."""
        given = self._given
        types = {**given.types, given.type.name: given.type}
        return rally_points_of(given.robot, given.program, types, given.areas).points

    @cached_property
    def _space(self) -> Space:
        kept_from = (*self._areas(AreaUse.FORBIDDEN), *self._areas(AreaUse.OBSTACLE))
        known = self._kinematics
        return Space(
            kept_from, self._clearance, known.floor, known.ceiling, turning_radius=known.turning_radius
        )

    def _areas(self, use: AreaUse) -> tuple[Area, ...]:
        concerned = self._given.type.name
        return tuple(area for area in self._given.areas if area.use is use and area.concerns(concerned))
