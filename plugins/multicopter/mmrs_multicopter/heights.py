"""Whether tasks and transits lie between the floor and the ceiling of a team of drones."""

from __future__ import annotations

from collections.abc import Iterator
from math import inf

from mmrs_core.analysis.constraints.sketch import sketch_of
from mmrs_core.contributions.constraints import Finding
from mmrs_core.grounding.coordinates import Ground, heights_of_task
from mmrs_core.grounding.features import child, children, number, text
from mmrs_core.languages.element import Element, is_kind, label_of
from mmrs_core.languages.modelset import ModelSet
from mmrs_multicopter.kinds import LOWEST_FLIGHT
from mmrs_multicopter.names import DRONE

EXACT = 1e-6
"""Metres."""


def too_high(mission: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield the tasks above the ceiling of every robot; none where some robot is not a drone."""
    ground = sketch_of(models).ground
    ceiling = _highest_ceiling(mission, models, ground)
    for task in children(mission, "tasks"):
        height = max(heights_of_task(task, ground), default=-inf)
        if height > ceiling:
            yield Finding(
                task,
                f"task '{label_of(task)}' is at {height:g} m, the team's drones reach {ceiling:g} m",
            )


def too_low(mission: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield the tasks below the floor of every robot; none where some robot is not a drone."""
    ground = sketch_of(models).ground
    floors = [_floor(member, models, ground) for member in children(child(mission, "team"), "robots")]
    floor = min(floors, default=-inf)
    for task in children(mission, "tasks"):
        height = min(heights_of_task(task, ground), default=inf)
        if height < floor - EXACT:
            yield Finding(
                task,
                f"task '{label_of(task)}' is at {height:g} m, "
                f"the team's drones fly no lower than {floor:g} m",
            )


def cut_transit(mission: Element, models: ModelSet) -> Iterator[Finding]:
    """Yield a mission whose transits are above the ceiling of every robot; none where some is not a drone."""
    ceiling = _highest_ceiling(mission, models, sketch_of(models).ground)
    transit = number(mission, "transitAltitude")
    if transit is not None and transit > ceiling:
        yield Finding(
            mission,
            f"transitAltitude of '{label_of(mission)}' is {transit:g} m, "
            f"the team's drones go at {ceiling:g} m instead",
        )


def _highest_ceiling(mission: Element, models: ModelSet, ground: Ground) -> float:
    team = child(mission, "team")
    return max((_ceiling(member, models, ground) for member in children(team, "robots")), default=inf)


def _ceiling(member: Element, models: ModelSet, ground: Ground) -> float:
    """Return how high a robot gets, metres above the origin; inf where that is not known."""
    drone, home = _drone(member, models), _home_height(member, ground)
    highest = number(drone, "maxAltitude") if drone is not None else None
    return inf if highest is None or home is None else home + highest


def _floor(member: Element, models: ModelSet, ground: Ground) -> float:
    """Return how low a robot flies, metres above the origin; -inf where that is not known."""
    home = _home_height(member, ground)
    return -inf if _drone(member, models) is None or home is None else home + LOWEST_FLIGHT


def _drone(member: Element, models: ModelSet) -> Element | None:
    robot_type = models.robots.get(text(member, "type"))
    return robot_type if robot_type is not None and is_kind(robot_type, *DRONE) else None


def _home_height(member: Element, ground: Ground) -> float | None:
    home = child(member, "home")
    return ground.positions[home][2] if home is not None and home in ground.positions else None
