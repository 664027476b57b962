"""What new missions begin with besides robots and tasks, and the comments on what to check."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from mmrs_core.projects.importing import ImportOptions, ImportResult, imported
from mmrs_core.projects.kinds import CONTEXT

if TYPE_CHECKING:
    from mmrs_core.contributions.registry import Contributions
    from mmrs_core.languages.element import Element
    from mmrs_core.languages.registry import Registry
    from mmrs_core.projects.team import RobotWanted

SEPARATION = 5.0
SEA_WATER = 1025.0
"""Kilograms per cubic metre: pressures are the higher ones, in fresh water too."""

_NOTE = """{title}: {made}.
Heights count from the home of {first}; the ground is taken to be level at its height.
Before a real flight, check:
positionError, here {error:g} m: how far off the robots' positions are; 0.05 suits RTK, 3 a single receiver.
minimumSeparation, here {separation:g} m between two robots at the same time.
reserve, here {reserve:.0%} of the energy, kept beyond the return home.
altitudes of tasks: above trees, wires and buildings, and below what the law allows.
the files in robots/: weigh your machines, and measure their flight time.
the map, with `mmrs preview`, and after each change the models, with `mmrs validate`."""
_CONTEXT_NOTE = """What robots keep clear of, and where they land in an emergency.
Draw more in a map program and add it to this project with `mmrs import`, or write, in this order:
forbiddenAreas: areas that no robot enters, at any height.
emergencyAreas: areas for emergency landings, kept free of people.
obstacles: trees, masts, wires; maxHeight in metres above the first home.
environment: windSpeed, windDirection, temperature; without them, checks of these are unknown."""
_LINK_NOTE = (
    "when the link to a robot is lost for so long, it returns; decide whether that is safe at this place"
)
_EMPTY_NOTE = """A mission without content. What goes where, in this order:
team: robots, each with a name, a type (the name in one of the files in robots/) and a home.
tasks: each with xsi:type, such as survey:PhotoGridTask; `mmrs metamodel list` names the languages.
taskDependencies: from one task to another that begins after it.
origin: where heights and metres count from; without it, the first robot's home.
policies: responses to faults, such as event="LINK_LOST" response="RETURN" after="10.0"."""


def empty_project(folder: Path, title: str, contributions: Contributions) -> ImportResult:
    """Return a project without robots and tasks, with comments on what goes where."""

    def complete(mission: Element, context: Element, registry: Registry) -> Mapping[Element, str]:
        return {mission: _EMPTY_NOTE, context: _CONTEXT_NOTE}

    return imported((), (), ImportOptions(title=title, complete=complete), contributions, folder)


def completed(
    title: str, robots: Sequence[RobotWanted], *, in_water: bool, made: str = "made by `mmrs new`"
) -> Callable[[Element, Element, Registry], Mapping[Element, str]]:
    """Return what completes a new mission: margins, a policy and comments."""
    error, reserve = 1.0, 0.25

    def complete(mission: Element, context: Element, registry: Registry) -> Mapping[Element, str]:
        mission.positionError, mission.reserve = error, reserve  # type: ignore[attr-defined]  # a mission
        mission.minimumSeparation = SEPARATION  # type: ignore[attr-defined]
        policy = registry.create(
            "urn:mmrs:robot:1.0", "Policy", event="LINK_LOST", response="RETURN", after=10.0
        )
        mission.policies = [policy]  # type: ignore[attr-defined]
        if in_water:
            context.environment = registry.create(CONTEXT, "Environment", waterDensity=SEA_WATER)  # type: ignore[attr-defined]
        first = robots[0].name if robots else ""
        note = _NOTE.format(
            title=title, made=made, first=first, error=error, separation=SEPARATION, reserve=reserve
        )
        return {mission: note, context: _CONTEXT_NOTE, policy: _LINK_NOTE}

    return complete
