"""Makes the picture of a mission that is not valid or has no plan: what can be read, with its problems."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from itertools import accumulate
from math import isfinite, nan

from mmrs_core.contributions.symbols import MapSymbol
from mmrs_core.diagnostics import Diagnostic, Severity
from mmrs_core.errors import InvalidModelError
from mmrs_core.grounding.coordinates import Ground, ground_of
from mmrs_core.grounding.features import child, children, number, text
from mmrs_core.grounding.frame import coordinates_of
from mmrs_core.grounding.parts import area_of, names_of, part_of
from mmrs_core.grounding.robots import robot_type_of
from mmrs_core.languages.element import Element, Unknown, place_of
from mmrs_core.languages.modelset import ModelSet
from mmrs_core.pictures.preview.features import (
    elements_of,
    middle_of,
    origin_of,
    symbol_of_robot,
    task_pictures,
    zones_of,
)
from mmrs_core.pictures.preview.picture import Picture, Problem, RobotPicture
from mmrs_core.scene import Area, Name, Point, Position, RobotType, Scene, Task

_AREAS = ("forbiddenAreas", "obstacles", "emergencyAreas")
_QUOTED = re.compile(r"'([^']+)'")
_MOST = 200
"""Problems that a picture shows."""


class _Positions(dict[Element, Position]):
    """Positions by coordinate; a coordinate without one is nowhere."""

    def __missing__(self, coordinate: Element) -> Position:
        """Return a position that no picture shows."""
        return nan, nan, nan


def picture_of_models(
    models: ModelSet, symbols: Mapping[Name, MapSymbol], problems: Iterable[Diagnostic | str] = ()
) -> Picture:
    """Return what can be drawn of a mission, whatever is wrong with it.

    Args:
        symbols: how elements look, by metaclass.
        problems: diagnostics of the models, or reasons why no plan is feasible.
    """
    mission, context = models.mission, models.context
    laid = ground_of(mission, context)
    laid = replace(laid, positions=_Positions(laid.positions))
    team = names_of(children(child(mission, "team"), "robots"))
    robots = tuple(_robot(each, name, models, laid, symbols) for each, name in team.items())
    tasks = names_of(each for each in children(mission, "tasks") if not isinstance(each, Unknown))
    elements = (each for each in children(context, "elements") if not isinstance(each, Unknown))
    scene = Scene(
        name=text(mission, "name"),
        frame=laid.frame,
        tasks=tuple(Task(name, part_of(each, laid)) for each, name in tasks.items()),
        dependencies=(),
        robots=(),
        elements=tuple(part_of(each, laid) for each in elements),
    )
    error = number(mission, "positionError") or 0.0
    types = {each.type_name for each in robots} & models.robots.keys()
    known = (_type(models.robots[name]) for name in types)
    clearances = [each.half_diagonal + error for each in known if each is not None]
    return Picture(
        title=scene.name,
        origin=origin_of(laid.frame),
        robots=tuple(each for each in robots if isfinite(each.home[0])),
        zones=zones_of(_areas(context, laid), clearances),
        tasks=task_pictures(scene, {}, {}, symbols),
        elements=elements_of(scene.elements, symbols),
        problems=problems_of(models, problems),
    )


def problems_of(models: ModelSet, problems: Iterable[Diagnostic | str]) -> tuple[Problem, ...]:
    """Return numbered problems, each at the position of its element or of what it names, if that has one."""
    laid = ground_of(models.mission, models.context)
    by_path = _by_path(models, laid)
    by_name = dict(_by_name(models, by_path))
    return tuple(
        _problem(number, each, by_path, by_name) for number, each in enumerate([*problems][:_MOST], start=1)
    )


def _robot(
    robot: Element, name: str, models: ModelSet, laid: Ground, symbols: Mapping[Name, MapSymbol]
) -> RobotPicture:
    home, type_name = child(robot, "home"), text(robot, "type")
    at = laid.positions[home] if home is not None else (nan, nan, nan)
    known = _type(models.robots[type_name]) if type_name in models.robots else None
    symbol = symbol_of_robot(known, symbols) if known is not None else None
    return RobotPicture(name, type_name, at, (), (), (), symbol=symbol)


def _type(element: Element) -> RobotType | None:
    try:
        return robot_type_of(element)
    except (InvalidModelError, ValueError):
        return None


def _areas(context: Element | None, laid: Ground) -> Iterator[Area]:
    for feature in _AREAS:
        for element, name in names_of(children(context, feature)).items():
            area = area_of(element, laid, name)
            shell = tuple(point for point in area.shell if isfinite(point[0]))
            if len(shell) > 2:
                yield replace(area, shell=shell)


def _by_path(models: ModelSet, laid: Ground) -> dict[tuple[str, str], Point]:
    """Return the middle of every element that contains coordinates, by file and path; roots left out."""
    points: dict[tuple[str, str], list[Point]] = {}
    for root in (models.mission, models.context):
        for coordinate in coordinates_of(root):
            if (position := laid.positions.get(coordinate)) is not None:
                place = place_of(coordinate)
                for path in _paths(place.path):
                    points.setdefault((place.file, path), []).append(position[:2])
    return {key: middle_of(found) for key, found in points.items()}


def _paths(path: str) -> list[str]:
    """Return the paths of an element and of all that contain it, from the outermost; the root's left out.

    >>> _paths("/tasks[2]/shell[0]")
    ['/tasks[2]', '/tasks[2]/shell[0]']
    """
    return [*accumulate(path.lstrip("/").split("/"), "{}/{}".format, initial="")][1:]


def _by_name(models: ModelSet, by_path: Mapping[tuple[str, str], Point]) -> Iterator[tuple[str, Point]]:
    """Yield the names of robots, areas and tasks with their positions."""
    team, context = child(models.mission, "team"), models.context
    for named in (
        names_of(children(team, "robots")),
        *(names_of(children(context, feature)) for feature in _AREAS),
        names_of(children(models.mission, "tasks")),
    ):
        for element, name in named.items():
            place = place_of(element)
            if (place.file, place.path) in by_path:
                yield name, by_path[place.file, place.path]


def _problem(
    number: int,
    problem: Diagnostic | str,
    by_path: Mapping[tuple[str, str], Point],
    by_name: Mapping[str, Point],
) -> Problem:
    words = problem if isinstance(problem, str) else problem.message
    named = next((by_name[name] for name in _QUOTED.findall(words) if name in by_name), None)
    if isinstance(problem, str):
        return Problem(number, Severity.ERROR.value, problem, at=named)
    file, path = problem.place.file, problem.place.path
    at = next((by_path[file, each] for each in _paths(path)[::-1] if (file, each) in by_path), named)
    source = f"{file.rpartition('/')[2]}:{problem.place.line}" if problem.place.line else file
    message = f"{problem.message} [{problem.code}]"
    return Problem(number, problem.severity.value, message, source, problem.hint, at)
