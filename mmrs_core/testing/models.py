"""Sample models, and what constraints find in them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from importlib.resources import files
from pathlib import Path

from mmrs_core.contributions.constraints import Constraint, Finding
from mmrs_core.languages import behaviour, context, mission, robot
from mmrs_core.languages.element import Element, descendants, is_kind
from mmrs_core.languages.modelset import ModelSet
from mmrs_core.languages.registry import MetamodelSource, Registry
from mmrs_core.scene import Name

VISITS = "urn:mmrs:testing:visits:1.0"
VISIT: Name = (VISITS, "Visit")


def sample_tasks() -> MetamodelSource:
    """Return a metamodel with one kind of task, for tests of what is not about a task of its own."""
    ecore = Path(str(files("mmrs_core.testing"))) / "metamodels" / "visits.ecore"
    return MetamodelSource(VISITS, ecore, "mmrs-core")


def sample_mission(
    *tasks: mission.Task, robot_type: str = "Any", home: tuple[float, float, float] = (0.0, 0.0, 0.0)
) -> mission.Mission:
    """Return a mission of one robot in a local frame, whose origin is the point (0, 0, 0)."""
    east, north, up = home
    place = mission.RelativeCoordinate(x=east, y=north, z=up)
    team = mission.Team(robots=[mission.Robot(name="Alba", type=robot_type, home=place)])
    origin = mission.RelativeCoordinate(x=0.0, y=0.0)
    return mission.Mission(name="sample", team=team, tasks=list(tasks), origin=origin)


def sample_visit(registry: Registry, east: float, north: float, up: float) -> mission.Task:
    """Return a task of `sample_tasks` at a point, metres from the origin."""
    point = mission.RelativeCoordinate(x=east, y=north, z=up)
    made = registry.create(*VISIT, name="visit", point=point)
    assert isinstance(made, mission.Task)  # by its metamodel
    return made


def model_set(roots: Iterable[Element]) -> ModelSet:
    """Return the project that some models make; without a mission among them, there is an empty one."""
    found = list(roots)
    missions = [each for each in found if isinstance(each, mission.Mission)]
    contexts = [each for each in found if isinstance(each, context.Context)]
    behaviours = [each for each in found if isinstance(each, behaviour.Behaviour)]
    types = {each.name: each for each in found if isinstance(each, robot.Robot)}
    return ModelSet(
        missions[0] if missions else mission.Mission(),
        contexts[0] if contexts else None,
        types,
        (),
        behaviours[0] if behaviours else None,
    )


def findings(constraint: Constraint, roots: Iterable[Element]) -> Iterator[Finding]:
    """Yield what a constraint finds in some models, in document order."""
    found = list(roots)
    models = model_set(found)
    for root in found:
        for element in (root, *descendants(root)):
            if is_kind(element, *constraint.metaclass):
                yield from constraint.check(element, models)


def breaches(constraint: Constraint, roots: Iterable[Element]) -> list[str]:
    """Return the messages of what a constraint finds in some models."""
    return [finding.message for finding in findings(constraint, roots)]
