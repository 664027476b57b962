"""Makes the picture of a mission that is not valid or has no plan: what can be read, with its problems.

Ground that could not be read must not look free: what is not drawn whole is marked as incomplete, and what is
not drawn at all is listed.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from math import isfinite, nan

from mmrs_core.contributions.symbols import MapSymbol
from mmrs_core.diagnostics import Diagnostic, Severity
from mmrs_core.errors import InvalidModelError
from mmrs_core.grounding.coordinates import Ground, ground_of
from mmrs_core.grounding.features import child, children, number, text
from mmrs_core.grounding.frame import MISSION, coordinates_of
from mmrs_core.grounding.parts import area_of, names_of, part_of, use_of
from mmrs_core.grounding.robots import robot_type_of
from mmrs_core.languages.element import Element, Unknown, is_kind, place_of
from mmrs_core.languages.modelset import ModelSet
from mmrs_core.languages.uris import ROBOT
from mmrs_core.pictures.preview.features import (
    NO_CONTEXT,
    elements_of,
    gap_of_clearances,
    middle_of,
    origin_of,
    pieces_of,
    symbol_of_robot,
    task_pictures,
    zones_of,
)
from mmrs_core.pictures.preview.gaps import Gaps, is_coordinate, paths_to, source_of
from mmrs_core.pictures.preview.map import USES
from mmrs_core.pictures.preview.picture import (
    ElementPicture,
    MapGap,
    Picture,
    Problem,
    RobotPicture,
    TaskPicture,
    Zone,
)
from mmrs_core.scene import Name, Point, Position, RobotType, Scene, Task

_AREAS = ("forbiddenAreas", "obstacles", "emergencyAreas")
_ELEMENTS = ("elements", "corridors")
_QUOTED = re.compile(r"'([^']+)'")
MOST = 200
"""Problems that a picture shows."""


class _Positions(dict[Element, Position]):
    """Positions by coordinate; a coordinate without one, or that may be one, is nowhere."""

    def __contains__(self, element: object) -> bool:
        """Return whether an element stands for a position, be it known or not."""
        return is_coordinate(element)

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
    listed = tuple(problems)
    return with_problems(_Drawing(models, symbols, listed).picture(), models, listed)


class _Drawing:
    """What can be drawn of models, and what cannot."""

    def __init__(
        self, models: ModelSet, symbols: Mapping[Name, MapSymbol], problems: Iterable[Diagnostic | str]
    ) -> None:
        self._models, self._mission, self._context = models, models.mission, models.context
        self._symbols = symbols
        ground = ground_of(models.mission, models.context)
        self._gaps = Gaps(models, ground, (each for each in problems if isinstance(each, Diagnostic)))
        self._ground = replace(ground, positions=_Positions(ground.positions))
        self._found: list[MapGap] = []

    def picture(self) -> Picture:
        """Return the picture, without its problems."""
        team = names_of(children(child(self._mission, "team"), "robots"))
        robots = tuple(self._robot(robot, name) for robot, name in team.items())
        error = self._position_error()
        by_type = {name: self._clearance(name, error) for name in {each.type_name for each in robots}}
        zones = tuple(self._zones({each.name: by_type[each.type_name] for each in robots}))
        tasks, elements = self._tasks_and_elements()
        gaps = [*self._found, *gap_of_clearances(zones), *self._gaps.others()]
        if self._context is None:
            gaps.append(NO_CONTEXT)
        return Picture(
            title=text(self._mission, "name"),
            origin=origin_of(self._ground.frame),
            robots=tuple(robot for robot in robots if isfinite(robot.home[0])),
            zones=zones,
            tasks=tasks,
            elements=elements,
            gaps=tuple(sorted(gaps, key=lambda gap: gap.drawn)),
        )

    def _robot(self, robot: Element, name: str) -> RobotPicture:
        home, type_name = child(robot, "home"), text(robot, "type")
        at = self._ground.positions[home] if home is not None else (nan, nan, nan)
        known = self._type(type_name)
        symbol = symbol_of_robot(known, self._symbols) if known is not None else None
        gap = self._note("robot", name, robot, drawn=isfinite(at[0]))
        return RobotPicture(name, type_name, at, (), (), (), symbol=symbol, gap=gap)

    def _type(self, name: str) -> RobotType | None:
        try:
            return robot_type_of(self._models.robots[name]) if name in self._models.robots else None
        except (InvalidModelError, ValueError):
            return None

    def _clearance(self, type_name: str, error: float | None) -> float | None:
        """Return the clearance of robots of a type; None where it is unknown or contradictory."""
        robot_type = self._type(type_name)
        roots = (root for model in self._models.models for root in model.roots)
        named = [root for root in roots if is_kind(root, ROBOT, "Robot") and text(root, "name") == type_name]
        size_in_doubt = any(
            "size" in problem.place.path or problem.message.startswith("size")
            for root in named
            for problem in self._gaps.problems_of(root)
        )
        if robot_type is None or error is None or len(named) > 1 or size_in_doubt:
            return None
        return robot_type.half_diagonal + error

    def _position_error(self) -> float | None:
        """Return the mission's position error; None where it cannot be read, or may be misspelt."""
        given = number(self._mission, "positionError")
        for problem in self._gaps.problems_of(self._mission):
            if problem.place.path in ("", "/") and (
                "positionError" in problem.message or (problem.code == "XMI004" and not given)
            ):
                return None
        return given or 0.0

    def _note(self, kind: str, name: str, element: Element, *, drawn: bool) -> str:
        """Note that an element is not drawn, or not whole, if so; return why, if it is drawn."""
        short = self._gaps.short(element)
        if short or not drawn:
            self._found.append(self._gaps.gap(kind, name, element, drawn=drawn))
        return short if drawn else ""

    def _zones(self, clearances: Mapping[str, float | None]) -> Iterator[Zone]:
        for feature in _AREAS:
            for element, name in names_of(children(self._context, feature)).items():
                kind = USES[use_of(element)]
                if isinstance(element, Unknown):
                    self._note(kind, name, element, drawn=False)
                    continue
                area = area_of(element, self._ground, name)
                shell = tuple(point for point in area.shell if isfinite(point[0]))
                gap = self._note(kind, name, element, drawn=bool(shell))
                if gap:
                    pieces = pieces_of(area.part.attributes["shell"], closed=True)
                    lines = pieces if len(shell) < len(area.shell) else ()
                    zone = Zone(name, area.use, shell, area.low, area.high, gap=gap, pieces=lines)
                    yield replace(
                        zone, unknown=tuple(robot for robot, one in clearances.items() if one is None)
                    )
                elif shell:
                    yield from zones_of([area], clearances)

    def _tasks_and_elements(self) -> tuple[tuple[TaskPicture, ...], tuple[ElementPicture, ...]]:
        found = {"tasks": names_of(children(self._mission, "tasks"))}
        surroundings = (each for feature in _ELEMENTS for each in children(self._context, feature))
        found["elements"] = names_of(surroundings)
        parts = {
            element: part_of(element, self._ground)
            for named in found.values()
            for element in named
            if not isinstance(element, Unknown)
        }
        gaps = {part.place: gap for element, part in parts.items() if (gap := self._gaps.short(element))}
        scene = Scene(
            name="",
            frame=self._ground.frame,
            tasks=tuple(Task(name, parts[each]) for each, name in found["tasks"].items() if each in parts),
            dependencies=(),
            robots=(),
            elements=tuple(parts[each] for each in found["elements"] if each in parts),
        )
        tasks = task_pictures(scene, {}, {}, self._symbols, gaps)
        elements = elements_of(scene.elements, self._symbols, gaps)
        drawn = {each.name: each.gap for each in tasks if each.drawn}
        for element, name in found["tasks"].items():
            if drawn.get(name) and not self._gaps.short(element):
                self._found.append(
                    MapGap(f"task {name!r}", drawn[name], source_of(place_of(element)), drawn=True)
                )
            elif self._gaps.short(element) or not is_kind(element, MISSION, "ControlTask"):
                self._note("task", name, element, drawn=name in drawn)
        placed = {each.name for each in elements if each.points}
        for element, name in found["elements"].items():
            if self._gaps.short(element) or isinstance(element, Unknown):
                self._note("context element", name, element, drawn=name in placed)
        return tasks, elements


def with_problems(picture: Picture, models: ModelSet, problems: Iterable[Diagnostic | str]) -> Picture:
    """Return a picture with problems, each at the position of its element or of what it names, if any.

    Errors come first; of very many, only the first are shown.
    """
    laid = ground_of(models.mission, models.context)
    by_path = _by_path(models, laid)
    by_name = dict(_by_name(models, by_path))
    errors_first = sorted(
        problems, key=lambda each: not (isinstance(each, str) or each.severity is Severity.ERROR)
    )
    shown = tuple(
        _problem(number, each, by_path, by_name) for number, each in enumerate(errors_first[:MOST], start=1)
    )
    return replace(picture, problems=shown, more_problems=len(errors_first) - len(shown))


def _by_path(models: ModelSet, laid: Ground) -> dict[tuple[str, str], Point]:
    """Return the middle of every element that contains coordinates, by file and path; roots left out."""
    points: dict[tuple[str, str], list[Point]] = {}
    for root in (models.mission, models.context):
        for coordinate in coordinates_of(root):
            if (position := laid.positions.get(coordinate)) is not None:
                place = place_of(coordinate)
                for path in paths_to(place.path):
                    points.setdefault((place.file, path), []).append(position[:2])
    return {key: middle_of(found) for key, found in points.items()}


def _by_name(models: ModelSet, by_path: Mapping[tuple[str, str], Point]) -> Iterator[tuple[str, Point]]:
    """Yield the names of robots, areas and tasks with their positions."""
    team, context = child(models.mission, "team"), models.context
    for named in (
        names_of(children(team, "robots")),
        *(names_of(children(context, feature)) for feature in (*_AREAS, "corridors")),
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
    at = next((by_path[file, each] for each in paths_to(path)[::-1] if (file, each) in by_path), named)
    message = f"{problem.message} [{problem.code}]"
    return Problem(number, problem.severity.value, message, source_of(problem.place), problem.hint, at)
