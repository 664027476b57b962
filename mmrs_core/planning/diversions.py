"""What robots keep of their charges, so that from everywhere on their paths they reach an emergency area.

In the middle of a sortie a robot may continue it. So where its charge suffices for a diversion from where it
comes down, at the end of the sortie, it suffices for one from everywhere.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from math import inf

from mmrs_core.errors import UnreachableError
from mmrs_core.planning.travel import Travel
from mmrs_core.scene import Point, Position, Robot, Scene, distinct_works
from mmrs_core.scene.rally_points import rally_points
from mmrs_runtime.policies import ESCAPE


@dataclass(frozen=True, slots=True)
class Diversions:
    """Diversions of one robot.

    Attributes:
        travel: of the robot.
        places: its rally points.
        events: those to which a policy responds with a diversion.
        from_home: seconds that a diversion from above home takes longer than to come down there, at the best
            of the heights at which it comes there; inf: no emergency area can be reached from there.
    """

    travel: Travel
    places: tuple[Point, ...]
    events: tuple[str, ...]
    from_home: float = 0.0
    _known: dict[Position, float] = field(default_factory=dict, compare=False)

    def seconds(self, position: Position) -> float:
        """Return how long the quickest diversion from a place takes at most, landing included; inf: none."""
        if position not in self._known:
            self._known[position] = min((self._to(position, each) for each in self.places), default=inf)
        return self._known[position]

    def more_than_landing(self, position: Position) -> float:
        """Return the seconds by which a diversion from a place is longer than to come down there; inf: none.

        Robots that do not launch are down wherever they are.
        """
        return max(0.0, self.seconds(position) - self.travel.landing_longest(position))

    def _to(self, position: Position, place: Point) -> float:
        try:
            return self.travel.land_at(position, place).longest
        except UnreachableError:
            return inf


def diversions_of(scene: Scene, travels: Mapping[str, Travel]) -> dict[str, Diversions]:
    """Return the diversions of the robots that a policy may lead to an emergency area, by name."""
    events = {robot.name: _events(scene, robot) for robot in scene.robots}
    if not any(events.values()):
        return {}
    clearances = [robot.type.half_diagonal + scene.position_error for robot in scene.robots]
    heights = _heights_of_paths(scene)
    levels = [*heights, *(robot.home[2] for robot in scene.robots)]
    found = {}
    for number, robot in enumerate(scene.robots):
        if not events[robot.name]:
            continue
        areas = [each for each in scene.areas if each.concerns(robot.type.name)]
        places = rally_points(
            number, clearances, areas, separation=scene.minimum_separation, heights=levels
        ).points
        diversions = Diversions(travels[robot.name], places, events[robot.name])
        ends = diversions.travel.above_home(heights)
        least = min(map(diversions.more_than_landing, ends), default=inf)
        found[robot.name] = replace(diversions, from_home=least)
    return found


def _events(scene: Scene, robot: Robot) -> tuple[str, ...]:
    """Return the events after which a robot goes to an emergency area."""
    return tuple(event for event, response in scene.responses(robot).items() if response == ESCAPE)


def _heights_of_paths(scene: Scene) -> tuple[float, ...]:
    """Return the heights that paths lead to: the transit altitude and those of tasks."""
    points = (p for work in distinct_works(scene.works) for stroke in work.strokes for p in stroke.points)
    aloft = () if scene.transit_altitude is None else (scene.transit_altitude,)
    return tuple(sorted({*aloft, *(point[2] for point in points)}))
