"""The ways of a robot that is driven by hand beside its program: home, to emergency areas, and back."""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot

from mmrs_core.contributions.vehicles import VehicleInput
from mmrs_core.scene import Position
from mmrs_core.simulation.escape import Escapes
from mmrs_core.simulation.known import kinematics_of
from mmrs_core.transformation.kinds import before_target
from mmrs_mavlink.plugin.context import VehicleContext
from mmrs_mavlink.plugin.manual.steering import Goal

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
