"""Whether tasks lie above what a team of drones reaches."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import inf

from mmrs_core.contributions.constraints import Finding
from mmrs_core.languages.element import Element, is_kind, label_of
from mmrs_core.languages.grounding_coordinates import ground_of
from mmrs_core.languages.grounding_values import child, children, number, text
from mmrs_core.languages.modelset import ModelSet
from mmrs_core.scene import Position
from mmrs_multicopter.names import DRONE

PLACES = ("points", "shell")


def too_high(mission: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield the tasks above the ceiling of every robot; none where some robot is no drone."""
    positions = ground_of(mission, models.context).positions
    ceiling = _highest_ceiling(mission, models, positions)
    for task in children(mission, "tasks"):
        height = _height(task, positions)
        if height > ceiling:
            yield Finding(
                task,
                f"task '{label_of(task)}' is at {height:g} m, the team's drones reach {ceiling:g} m",
            )


def _highest_ceiling(mission: Element, models: ModelSet, positions: Mapping[Element, Position]) -> float:
    team = child(mission, "team")
    ceilings = [_ceiling(member, models, positions) for member in children(team, "robots")]
    return max(ceilings, default=inf)


def _ceiling(member: Element, models: ModelSet, positions: Mapping[Element, Position]) -> float:
    """Return how high a robot gets, metres above the origin; inf where that is not known."""
    robot_type = models.robots.get(text(member, "type"))
    home = child(member, "home")
    if robot_type is None or not is_kind(robot_type, *DRONE) or home is None or home not in positions:
        return inf
    highest = number(robot_type, "maxAltitude")
    return inf if highest is None else positions[home][2] + highest


def _height(task: Element, positions: Mapping[Element, Position]) -> float:
    """Return the largest height at which a task is done, metres above the origin; -inf if not known."""
    altitude = number(task, "altitude")
    if altitude is not None:
        return altitude
    return max((positions[each][2] for each in _places(task) if each in positions), default=-inf)


def _places(task: Element) -> Iterator[Element]:
    point = child(task, "point")
    yield from (point,) if point is not None else ()
    yield from (each for name in PLACES for each in children(task, name))
