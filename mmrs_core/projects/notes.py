"""What new missions begin with besides robots and tasks, and the comments on what to check."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from mmrs_core.grounding.features import children
from mmrs_core.languages.element import label_of
from mmrs_core.projects.importing import ImportOptions, ImportResult, imported
from mmrs_core.projects.kinds import CONTEXT

if TYPE_CHECKING:
    from mmrs_core.contributions.registry import Contributions
    from mmrs_core.contributions.rules import Medium
    from mmrs_core.languages.element import Element
    from mmrs_core.languages.registry import Registry

SEPARATION = 5.0
SEA_WATER = 1025.0
"""Kilograms per cubic metre: pressures are the higher ones, in fresh water too."""

_NOTE = """{title}: {made}.
Heights count from the home of {first}; the ground is taken to be level at its height.
Check before the first run:
positionError: metres by which a robot may be off; 0.05 suits RTK, 3 a single satellite receiver{position}.
minimumSeparation: metres that two robots keep between them at any time.
reserve: fraction of each charge that is left after the return home.
{tasks}
robots/: the figures of the makers; weigh your machines, and measure how long a charge lasts.
After each change, `mmrs validate` finds errors, and `mmrs preview` draws the map."""
_TASKS: Mapping[Medium, str] = {
    "air": "altitude of tasks in the air: above trees, wires and buildings, and below the legal limit.",
    "ground": "tasks on the ground: straight lines to and along them are free of ditches and steep slopes.",
    "water": "altitude of tasks in the water: negative; the water is deeper than that, also at low tide.",
}
_CONTEXT_NOTE = """What robots keep clear of, and where they go in an emergency. `mmrs import` adds what is
drawn in a map program. What goes where, in this order:
forbiddenAreas: areas that no robot enters, at any height.
emergencyAreas: where robots land or surface when something fails: free of people, boats and animals.
obstacles: buildings, trees, wires; maxHeight in metres above the first home, without it at every height.
corridors: agreed paths from home to the field, by which all robots come and go; without one, by any path.
environment: {environment};
without them, checks that need them have the result unknown."""
_ENVIRONMENT: Mapping[Medium, str] = {
    "air": "windSpeed (m/s), windDirection (degrees that it comes from)",
    "ground": "temperature (degrees Celsius)",
    "water": "currentSpeed (m/s), currentDirection (degrees that it flows to)",
}
_LINK_NOTE = """For the event LINK_LOST: the control station has not answered for this many seconds.
RETURN is back home on a checked path. If that is not safe here: HOLD, {landing}EMERGENCY_AREA or CONTINUE."""
_LANDING: Mapping[Medium, str] = {"air": "LAND, ", "water": "SURFACE, "}
_WATER_NOTE = "waterDensity of the sea; about 1000 in fresh water"
_HOME_NOTE = "starts and ends at home: put the machine there, or its position here"
_EMPTY_NOTE = """A mission without content. `mmrs import` adds robots, and what is drawn in a map program.
What goes where, in this order:
team: robots, each with a name, a type (the name in one of the files in robots/) and a home.
tasks: each with xsi:type, such as survey:PhotoGridTask; `mmrs metamodel list` names the languages.
taskDependencies: from one task to another that begins after it.
origin: where heights and metres count from; without it, the first robot's home.
policies: responses to faults, such as event="LINK_LOST" response="RETURN" after="10.0".
Attributes of the mission are margins, too: positionError, minimumSeparation and reserve."""


def empty_project(folder: Path, title: str, contributions: Contributions) -> ImportResult:
    """Return a project without robots and tasks, with comments on what goes where."""

    def complete(mission: Element, context: Element, registry: Registry) -> Mapping[Element, str]:
        everything = _CONTEXT_NOTE.format(environment=", ".join(_ENVIRONMENT.values()))
        return {mission: _EMPTY_NOTE, context: everything}

    return imported((), (), ImportOptions(title=title, complete=complete), contributions, folder)


def completed(
    title: str, media: Collection[Medium], *, made: str = "made by `mmrs new`"
) -> Callable[[Element, Element, Registry], Mapping[Element, str]]:
    """Return what completes a new mission: margins, a policy and comments.

    Args:
        title: of the mission.
        media: where its robots move.
        made: how it was made.
    """

    def complete(mission: Element, context: Element, registry: Registry) -> Mapping[Element, str]:
        mission.positionError, mission.reserve = 1.0, 0.25  # type: ignore[attr-defined]  # a mission
        mission.minimumSeparation = SEPARATION  # type: ignore[attr-defined]
        policy = registry.create(
            "urn:mmrs:robot:1.0", "Policy", event="LINK_LOST", response="RETURN", after=10.0
        )
        mission.policies = [policy]  # type: ignore[attr-defined]
        robots = children(mission.team, "robots")  # type: ignore[attr-defined]
        note = _NOTE.format(
            title=title,
            made=made,
            first=label_of(robots[0]) if robots else "the first robot",
            position=", and in the water what its navigation reaches" if "water" in media else "",
            tasks="\n".join(words for medium, words in _TASKS.items() if medium in media),
        )
        around = ", ".join(words for medium, words in _ENVIRONMENT.items() if medium in media)
        landing = "".join(words for medium, words in _LANDING.items() if medium in media)
        comments = {
            mission: note,
            context: _CONTEXT_NOTE.format(environment=around),
            policy: _LINK_NOTE.format(landing=landing),
            **dict.fromkeys(robots, _HOME_NOTE),
        }
        if "water" in media:
            water = registry.create(CONTEXT, "Environment", waterDensity=SEA_WATER)
            context.environment = water  # type: ignore[attr-defined]
            comments[water] = _WATER_NOTE
        return comments

    return complete
