"""What robots keep of their charges, so that from everywhere on their paths they reach an emergency area.

A robot that continues its sortie comes no farther from an area in a second than it goes in one. So where its
charge suffices for a diversion from above home, at the end of a sortie, it suffices for one from everywhere.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from math import inf

from mmrs_core.errors import UnreachableError
from mmrs_core.planning.travel import Travel
from mmrs_core.scene import Point, Position, Robot, Scene, distinct_works
from mmrs_core.scene.rally_points import rally_points
from mmrs_runtime.policies import ESCAPE, in_precedence


@dataclass(frozen=True, slots=True)
class Diversions:
    """Diversions of one robot.

    Attributes:
        travel: of the robot.
        places: its rally points.
        events: those to which a policy responds with a diversion.
        from_home: seconds that a diversion from above home takes longer than to come down there; inf: no
            emergency area can be reached from there.
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

    def _to(self, position: Position, place: Point) -> float:
        try:
            return self.travel.land_at(position, place).longest
        except UnreachableError:
            return inf


def diversions_of(scene: Scene, travels: Mapping[str, Travel]) -> dict[str, Diversions]:
    """Return the diversions of the robots that a policy may lead to an emergency area, by name."""
    events = {id(robot.type): _events(scene, robot) for robot in scene.robots}
    if not any(events.values()):
        return {}
    clearances = [robot.type.half_diagonal + scene.position_error for robot in scene.robots]
    heights = _heights(scene)
    levels = [*heights, *(robot.home[2] for robot in scene.robots)]
    found = {}
    for number, robot in enumerate(scene.robots):
        if not events[id(robot.type)]:
            continue
        areas = [each for each in scene.areas if each.concerns(robot.type.name)]
        places = rally_points(
            number, clearances, areas, separation=scene.minimum_separation, heights=levels
        ).points
        diversions = Diversions(travels[robot.name], places, events[id(robot.type)])
        found[robot.name] = replace(diversions, from_home=_from_home(diversions, heights))
    return found


def _events(scene: Scene, robot: Robot) -> tuple[str, ...]:
    """Return the events after which a robot goes to an emergency area, as mission and robot type have it."""
    responses: dict[str, str] = {}
    for policy in in_precedence((), scene.policies, robot.type.policies):
        responses.setdefault(policy.event, policy.response)
    return tuple(event for event, response in responses.items() if response == ESCAPE)


def _heights(scene: Scene) -> tuple[float, ...]:
    """Return at which heights paths lead home: at the transit altitude, or at those of tasks."""
    if scene.transit_altitude is not None:
        return (scene.transit_altitude,)
    points = (p for work in distinct_works(scene.works) for stroke in work.strokes for p in stroke.points)
    return tuple(sorted({point[2] for point in points}))


def _from_home(diversions: Diversions, heights: tuple[float, ...]) -> float:
    """Return the seconds more for the worst height; heights from which there is no path do not count."""
    travel = diversions.travel
    starts = travel.above_home(heights)
    more = [diversions.seconds(start) - travel.landing_longest(start) for start in starts]
    return max((max(0.0, each) for each in more if each < inf), default=inf)
