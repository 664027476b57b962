"""From models to a scene: everything in one local metric frame, without a model behind it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sized
from typing import get_args

from mmrs_core.diagnostics import Diagnostic, in_order
from mmrs_core.errors import InvalidModelError
from mmrs_core.grounding.coordinates import Ground, ground_of
from mmrs_core.grounding.features import child, children, literal, number, policies_of, text, texts, value
from mmrs_core.grounding.frame import fault
from mmrs_core.grounding.parts import area_of, corridor_of, names_of, part_of, position_of
from mmrs_core.grounding.robots import MISSING, robot_type_of
from mmrs_core.languages.element import Element, Unknown, descendants, metaclass_of, place_of
from mmrs_core.languages.metaclass import Enumeration
from mmrs_core.languages.modelset import ModelSet
from mmrs_core.scene import Area, Corridor, Dependency, Robot, RobotType, Scene, Task, TravelMode

__all__ = [
    "Ground",
    "area_of",
    "areas_of",
    "corridors_of",
    "environment_of",
    "ground",
    "ground_of",
    "part_of",
    "robot_type_of",
]

UNKNOWN_TYPE = "GND003"
NOT_INSTALLED = "GND004"
MODES: tuple[TravelMode, ...] = get_args(TravelMode)
AREAS = ("forbiddenAreas", "obstacles", "emergencyAreas")


def ground(models: ModelSet) -> Scene:
    """Return the mission in its local frame, with its context and its robots; nothing is expanded yet.

    Raises:
        InvalidModelError: if a position is undefined, or something required is missing;
            lists every such fault.
    """
    mission, context = models.mission, models.context
    laid = ground_of(mission, context)
    faults = [*laid.faults, *_incomplete(models), *_misdirected(mission), *_unknown_types(models)]
    if faults:
        found = in_order(faults)
        others = len(found) - 1
        rest = f", and {others} more {'fault' if others == 1 else 'faults'}" if others else ""
        raise InvalidModelError(f"{found[0].place}: {found[0].message}{rest}", found)
    tasks = names_of(children(mission, "tasks"))
    return Scene(
        name=text(mission, "name"),
        frame=laid.frame,
        tasks=tuple(_task(task, name, laid) for task, name in tasks.items()),
        dependencies=tuple(_dependency(each, tasks) for each in children(mission, "taskDependencies")),
        robots=_robots(models, laid),
        areas=areas_of(context, laid) if context is not None else (),
        elements=tuple(part_of(each, laid) for each in children(context, "elements")),
        corridors=corridors_of(context, laid) if context is not None else (),
        environment=environment_of(context) if context is not None else {},
        transit_altitude=number(mission, "transitAltitude"),
        minimum_separation=number(mission, "minimumSeparation"),
        reserve=_or(number(mission, "reserve"), 0.2),
        position_error=_or(number(mission, "positionError"), 0.0),
        policies=policies_of(mission),
        accepted_unknowns=texts(mission, "acceptedUnknowns"),
    )


def _or(found: float | None, default: float) -> float:
    return default if found is None else found


def _task(task: Element, name: str, laid: Ground) -> Task:
    wanted = number(task, "robotsWanted")
    return Task(
        name=name,
        part=part_of(task, laid),
        wanted=None if wanted is None else int(wanted),
        devices=texts(task, "requiredDevices"),
        actions=texts(task, "requiredActions"),
        earliest=number(task, "earliestStart"),
        deadline=number(task, "deadline"),
        longest=number(task, "maxDuration"),
        priority=int(number(task, "priority") or 0),
    )


def _dependency(dependency: Element, tasks: Mapping[Element, str]) -> Dependency:
    ends = [child(dependency, end) for end in ("from", "to")]
    before, after = (tasks[end] for end in ends if end is not None)
    return Dependency(before, after, text(dependency, "condition") or None, place_of(dependency))


def _robots(models: ModelSet, laid: Ground) -> tuple[Robot, ...]:
    error = number(models.mission, "positionError") or 0.0
    team = names_of(children(child(models.mission, "team"), "robots"))
    types = {name: robot_type_of(models.robots[name]) for name in {text(each, "type") for each in team}}
    return tuple(_robot(each, name, types[text(each, "type")], error, laid) for each, name in team.items())


def _robot(robot: Element, name: str, robot_type: RobotType, error: float, laid: Ground) -> Robot:
    home = child(robot, "home")
    assert home is not None  # required, so its absence was refused before
    return Robot(
        name=name,
        type=robot_type,
        home=position_of(home, laid),
        return_home=value(robot, "returnHome") is not False,
        payload=number(robot, "payload") or 0.0,
        travel_mode=literal(robot, "travelMode", MODES, "NORMAL"),
        clearance=robot_type.half_diagonal + error,
        place=place_of(robot),
    )


def areas_of(context: Element, laid: Ground) -> tuple[Area, ...]:
    """Return what a context forbids, what is in the way there, and where robots may flee to."""
    areas = names_of(each for feature in AREAS for each in children(context, feature))
    return tuple(area_of(each, laid, name) for each, name in areas.items())


def corridors_of(context: Element, laid: Ground) -> tuple[Corridor, ...]:
    """Return the corridors of a context."""
    return tuple(
        corridor_of(each, laid, name) for each, name in names_of(children(context, "corridors")).items()
    )


def environment_of(context: Element) -> dict[str, float]:
    """Return weather and water of a context by attribute name; absent where it does not say."""
    environment = child(context, "environment")
    if environment is None:
        return {}
    known = (
        (feature.name, number(environment, feature.name)) for feature in metaclass_of(environment).features
    )
    return {name: found for name, found in known if found is not None}


def _incomplete(models: ModelSet) -> Iterator[Diagnostic]:
    """Yield what any stage would miss: required features, and elements whose plug-in is not installed."""
    roots = (models.mission, models.context, *models.robots.values())
    for root in (root for root in roots if root is not None):
        for element in (root, *descendants(root)):
            if isinstance(element, Unknown):
                language, _, kind = element._mmrs_type.rpartition("#")
                words = f"is a {kind} of {language or 'a language'}, whose plug-in is not installed"
                yield fault(element, words, code=NOT_INSTALLED)
            else:
                yield from _missing(element)


def _missing(element: Element) -> Iterator[Diagnostic]:
    for feature in metaclass_of(element).features:
        if not feature.required or feature.is_container:
            continue
        found = value(element, feature.name)
        count = len(found) if isinstance(found, Sized) and feature.many else int(found is not None)
        if isinstance(feature.type, Enumeration) and not feature.many and not feature.type.accepts(found):
            yield fault(
                element,
                f"has the {feature.name} {found!r}, which is none of {', '.join(feature.type.names)}",
                code=MISSING,
            )
        elif count < feature.lower:
            least = f", at least {feature.lower} are needed" if feature.lower > 1 else ""
            yield fault(element, f"has {count or 'no'} {feature.name}{least}", code=MISSING)


def _misdirected(mission: Element) -> Iterator[Diagnostic]:
    tasks = set(children(mission, "tasks"))
    for dependency in children(mission, "taskDependencies"):
        if {child(dependency, "from"), child(dependency, "to")} - tasks:
            yield fault(dependency, "leads from or to a task that is not in the mission", code=MISSING)


def _unknown_types(models: ModelSet) -> Iterator[Diagnostic]:
    for robot in children(child(models.mission, "team"), "robots"):
        name = text(robot, "type")
        if name not in models.robots:
            known = ", ".join(sorted(models.robots)) or "none"
            yield fault(robot, f"has the unknown type {name!r}", f"known are: {known}", UNKNOWN_TYPE)
