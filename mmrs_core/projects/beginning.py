"""New missions: robots at a place, and beside their homes tasks of a sensible size, to be moved."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from math import hypot, isqrt
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from mmrs_core.contributions.rules import robot_kind_of
from mmrs_core.diagnostics import has_errors
from mmrs_core.drawings.drawing import Geometry, HeightReference, MapFeature
from mmrs_core.errors import InfeasibleError, UsageError
from mmrs_core.geometry.frames import LocalFrame
from mmrs_core.grounding.robots import robot_type_of
from mmrs_core.languages.naming import nearest
from mmrs_core.pipeline import refusals
from mmrs_core.projects.attributes import decided
from mmrs_core.projects.choosing import Assignment
from mmrs_core.projects.importing import ImportOptions, ImportResult, imported
from mmrs_core.projects.kinds import ImportKinds, Kind
from mmrs_core.projects.notes import completed
from mmrs_core.projects.shapes import WGS84
from mmrs_core.projects.team import RobotWanted, TypeFile, types_for
from mmrs_core.stages import Stages

if TYPE_CHECKING:
    from mmrs_core.contributions.registry import Contributions
    from mmrs_core.contributions.rules import Medium
    from mmrs_core.languages.element import Element

HOMES_APART = 20.0
"""Least metres from home to home: more than they have to keep between them."""
_NOWHERE = Path("new")
_FARTHEST_NORTH = 85.0
_NAMES = ("Alpha", "Bravo", "Charlie", "Delta", "Echo", "Foxtrot", "Golf", "Hotel", "India", "Juliett")
_WIDTH: Mapping[Medium, float] = {"air": 60.0, "ground": 20.0, "water": 28.0}
_DEPTH: Mapping[Medium, float] = {"air": 40.0, "ground": 12.0, "water": 12.0}
_GAP: Mapping[Medium, float] = {"air": 20.0, "ground": 6.0, "water": 6.0}
"""Metres of a task along and across its row, and between tasks."""
_FROM_HOMES = 10.0
"""Least metres between a task and the row of homes: more than robots keep between them."""
_HEIGHTS: Mapping[Medium, tuple[float, ...]] = {"air": (30.0,), "ground": (0.0,), "water": (-3.0, 0.0)}
"""Heights above the homes at which a task is tried, metres."""
_SHAPES = (Geometry.AREA, Geometry.LINE, Geometry.POINT)


@dataclass(frozen=True, slots=True)
class TaskWanted:
    """A task that the user asks for.

    Attributes:
        type: name of a task type.
        attributes: as the user gave them.
        source: where it was asked for, for messages.
    """

    type: str
    attributes: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    source: str = "--task"


@dataclass(frozen=True, slots=True)
class _Attempt:
    """An attempt at a task: its shape, height and attributes; the lower its rank, the more usual."""

    rank: int
    type: str
    kind: Kind
    medium: Medium
    shape: Geometry
    height: float
    attributes: Mapping[str, tuple[str, ...]]


def names_for(count: int, taken: Iterable[str]) -> tuple[str, ...]:
    """Return names of robots that are not taken."""
    used = {name.casefold() for name in taken}
    free = (name for name in _endless() if name.casefold() not in used)
    return tuple(next(free) for _ in range(count))


def _endless() -> Iterator[str]:
    yield from _NAMES
    number = 2
    while True:
        yield from (f"{name} {number}" for name in _NAMES)
        number += 1


class Beginning:
    """Tries which robot types can do which tasks, and makes projects of them.

    Args:
        place: latitude and longitude of the first home, degrees.
    """

    def __init__(self, place: tuple[float, float], contributions: Contributions) -> None:
        if abs(place[0]) > _FARTHEST_NORTH:
            raise UsageError(f"latitude {place[0]:g}: new missions go to {_FARTHEST_NORTH:g} degrees")
        self._place = place
        self._contributions = contributions
        self._kinds = ImportKinds(contributions)
        self._tried: dict[object, _Attempt | str] = {}

    def kind_of(self, task: TaskWanted) -> Kind:
        """Return the kind of a task.

        Raises:
            UsageError: if no such task type is installed, or it cannot be drawn.
        """
        known = self.task_types()
        if task.type in known or "." in task.type:
            kind = self._kinds.named(task.type)
            if kind.feature == "tasks" and kind.shapes:
                return kind
        if any(task.type == name for _, name in self._contributions.rules):
            words = "refers to elements of the context, which have to be drawn first: write it in the model"
            raise UsageError(f"{task.source}: {task.type} {words}")
        words = nearest(task.type, known) or f"there are {', '.join(known)}"
        raise UsageError(f"{task.source}: no task type {task.type!r}; {words}")

    def task_types(self) -> tuple[str, ...]:
        """Return the names of the task types that a new mission can have."""
        return tuple(kind.name for kind in self._kinds.tasks())

    def label_of(self, task_type: str) -> str:
        """Return what people call tasks of a type."""
        symbol = self.kind_of(TaskWanted(task_type)).symbol
        return symbol.label if symbol is not None else task_type

    def is_usual(self, task_type: str) -> bool:
        """Return whether areas usually become such tasks."""
        return self.kind_of(TaskWanted(task_type)).is_usual_for == Geometry.AREA

    def require(self, task: TaskWanted, types: Iterable[str]) -> None:
        """Raise UsageError if robots of none of the types can do a task; it names those that can."""
        self._best(task, types)

    def doers(self, task: TaskWanted, types: Iterable[str]) -> tuple[tuple[str, ...], dict[str, str]]:
        """Return which robot types can do a task, and why the others cannot."""
        found = {name: self._attempt(task, name) for name in types}
        able = tuple(name for name, each in found.items() if isinstance(each, _Attempt))
        return able, {name: each for name, each in found.items() if isinstance(each, str)}

    def project(
        self, folder: Path, title: str, robots: Sequence[RobotWanted], tasks: Sequence[TaskWanted]
    ) -> ImportResult:
        """Return a project with robots and tasks, of which there is a safe plan unless it is invalid.

        Raises:
            UsageError: if a type is unknown, no robot can do a task, or no plan of all is safe; with what to
                choose instead.
        """
        types = types_for(robots, (), self._contributions)
        attempts: list[_Attempt] = []
        used = {each.type: 0 for each in robots}
        for task in tasks:
            attempts.append(self._best(task, sorted(used, key=used.__getitem__)))
            used[attempts[-1].type] += 1
        made = self._made(folder, title, robots, types, attempts)
        if not has_errors(made.diagnostics) and (reasons := self._reasons_against(made)):
            words = "no safe plan of all these robots and tasks: choose fewer of one or the other"
            raise UsageError(words, reasons)
        return made

    def _best(self, task: TaskWanted, types: Iterable[str]) -> _Attempt:
        """Return the most usual attempt of one of the types at a task."""
        found = {name: self._attempt(task, name) for name in types}
        possible = [each for each in found.values() if isinstance(each, _Attempt)]
        if possible:
            return min(possible, key=lambda each: each.rank)
        able, _ = self.doers(task, [name for name in self._contributions.robot_types if name not in found])
        if not able and len({*found.values()}) == 1:
            raise UsageError(f"{task.source}: {found.popitem()[1]}")  # its attributes are wrong
        words = f"{', '.join(able)} can" if able else "no installed type can"
        reasons = tuple(f"{name}: {reason}" for name, reason in found.items())
        kind = self.kind_of(task)
        raise UsageError(f"{task.source}: no robot of the team can do {kind.name}; {words}", reasons)

    def _attempt(self, task: TaskWanted, type_name: str) -> _Attempt | str:
        """Return how robots of a type can do a task, or why they cannot."""
        key = (task.type, type_name, tuple(sorted(task.attributes.items())))
        if key not in self._tried:
            self._tried[key] = self._first_possible(task, type_name)
        return self._tried[key]

    def _first_possible(self, task: TaskWanted, type_name: str) -> _Attempt | str:
        """Return the first attempt at a task of which there is a safe plan for one robot, or why none is."""
        kind = self.kind_of(task)
        robot = RobotWanted(type_name, type_name)  # refusals call it so
        types = types_for([robot], (), self._contributions)
        reasons: list[tuple[bool, str]] = []
        for attempt in self._attempts(task, kind, types[type_name].element):
            incomplete = False
            try:
                made = self._made(_NOWHERE, "mission", [robot], types, [attempt])
                against = self._reasons_against(made)
            except UsageError as error:
                incomplete, against = True, error.elements or (str(error),)
            if not against:
                return attempt
            reasons.append((incomplete, "; ".join(against)))
        return min(reasons, key=lambda each: each[0])[1] if reasons else f"{kind.name} cannot be drawn"

    def _reasons_against(self, made: ImportResult) -> tuple[str, ...]:
        """Return why there is no safe plan of a project that is not written yet; empty if there is one."""
        models = made.models
        if models is None or has_errors(made.diagnostics):
            return tuple(each.message for each in made.diagnostics[:1])
        stages = Stages(lambda: models, self._contributions)
        try:
            refused = refusals(stages.verdicts, stages.program)
        except InfeasibleError as error:
            return tuple(error.reasons)
        return tuple(f"{each.property}: {each.status.value}, {each.message}" for each in refused)

    def _attempts(self, task: TaskWanted, kind: Kind, robot_type: Element) -> Iterator[_Attempt]:
        """Yield attempts at a task: as its plug-in has it, then with devices and actions of the robot."""
        described = robot_type_of(robot_type)
        medium = self._medium(robot_type)
        symbol = kind.symbol
        variants: list[Mapping[str, tuple[str, ...]]] = [{}]
        if symbol is not None:
            pairs = [
                (device.id, action) for device in described.devices.values() for action in device.actions
            ]
            asked = [
                {name: value for name, value in ((symbol.device, device), (symbol.action, action)) if name}
                for device, action in pairs
            ]
            begins: list[Mapping[str, object]] = [{}, *symbol.variants]
            variants = [
                {name: (str(value),) for name, value in {**begin, **wanted}.items()}
                for begin in begins
                for wanted in ([{}, *asked] if symbol.device or symbol.action else [{}])
            ]
        shapes = [each for each in _SHAPES if each in kind.shapes]
        if symbol is not None and symbol.usual_for:
            shapes.sort(key=lambda each: each != symbol.usual_for)
        for rank, variant in enumerate(variants):
            for shape in shapes:
                for height in _HEIGHTS[medium]:
                    yield _Attempt(
                        rank, described.name, kind, medium, shape, height, {**variant, **task.attributes}
                    )

    def _medium(self, robot_type: Element) -> Medium:
        kind = robot_kind_of(robot_type_of(robot_type), self._contributions.robot_kinds)
        return kind.medium if kind is not None else "ground"

    def _made(
        self,
        folder: Path,
        title: str,
        robots: Sequence[RobotWanted],
        types: Mapping[str, TypeFile],
        attempts: Sequence[_Attempt],
    ) -> ImportResult:
        features = tuple(self._features(attempts))
        assignments = tuple(
            Assignment(f"{feature.folders[0]}/*", each.kind.name, each.attributes, f"--task {each.kind.name}")
            for feature, each in zip(features, attempts, strict=True)
        )
        homes = self._homes(robots)
        media = {self._medium(types[each.type].element) for each in robots}
        options = ImportOptions(
            choices=assignments,
            robots=homes,
            types=types,
            altitude=0.0,
            title=title,
            complete=completed(title, media),
        )
        made = imported(features, (), options, self._contributions, folder)
        left = next((each for each in made.outcomes if not each.became), None)
        if left is not None:
            raise UsageError(f"{left.by}: {left.reason}")
        return made

    def _homes(self, robots: Sequence[RobotWanted]) -> tuple[RobotWanted, ...]:
        """Return the robots with their homes in a row to the east."""
        positions = self._geographic([(number * HOMES_APART, 0.0) for number in range(len(robots))])
        return tuple(
            replace(each, position=(float(latitude), float(longitude)))
            for each, (latitude, longitude) in zip(robots, positions, strict=True)
        )

    def _features(self, attempts: Sequence[_Attempt]) -> Iterator[MapFeature]:
        """Yield the features of tasks: in the air north, in water south, on the ground north-west."""
        cells = {medium: _cells(medium, len(attempts)) for medium in _GAP}
        for number, each in enumerate(attempts):
            width, depth = _WIDTH[each.medium], _DEPTH[each.medium]
            left, near = next(cells[each.medium])
            right, far, middle = left + width, near + depth, left + width / 2
            corners = {
                Geometry.AREA: [(left, near), (right, near), (right, far), (left, far)],
                Geometry.LINE: [(left, near), (middle, near + depth / 3), (right, near)],
                Geometry.POINT: [(middle, near + depth / 2)],
            }[each.shape]
            turned = {
                "air": lambda x, y: (x, y),
                "water": lambda x, y: (x, -y),
                "ground": lambda x, y: (-y, x),
            }
            local = [turned[each.medium](x, y) for x, y in corners]
            ring = self._geographic(local)
            at = bool(each.height) and each.shape is not Geometry.AREA
            label = each.kind.symbol.label if each.kind.symbol is not None else each.kind.name
            yield MapFeature(
                each.shape,
                (ring,),
                (np.full(len(ring), each.height),) if at else (),
                HeightReference.HOME if at else HeightReference.NONE,
                name=label,
                description="\n".join(_comment_on(each)),
                folders=(f"task {number}",),
                properties=_height_of(each),
            )

    def _geographic(
        self, local: Sequence[tuple[float, float]]
    ) -> np.ndarray[tuple[int, int], np.dtype[np.float64]]:
        return LocalFrame(WGS84, *self._place).to_geographic(np.array(local, float))


def _cells(medium: Medium, count: int) -> Iterator[tuple[float, float]]:
    """Yield the left near corners of places for so many tasks, those nearest to the homes first."""
    width, depth, gap = (by[medium] for by in (_WIDTH, _DEPTH, _GAP))
    side = 2 * isqrt(count) + 2
    aside = range(0 if medium == "ground" else -side, side)  # tasks on the ground keep off those in water
    corners = [
        (column * (width + gap) + gap / 2, row * (depth + gap) + max(gap, _FROM_HOMES))
        for row in range(side)
        for column in aside
    ]
    yield from sorted(corners, key=lambda at: hypot(at[0] + width / 2, at[1] + depth / 2))


def _comment_on(attempt: _Attempt) -> Iterator[str]:
    """Yield what a task does, and what its attributes mean."""
    metaclass = attempt.kind.metaclass
    assert metaclass is not None  # of tasks
    yield f"{metaclass.documentation} Laid beside the homes: move it to where it belongs."
    symbol, names = attempt.kind.symbol, decided(attempt.kind, attempt.attributes)
    initial = {name: True for name in (symbol.initial if symbol is not None else ()) if name not in names}
    for name, value in {**initial, **attempt.attributes, **_height_of(attempt)}.items():
        if value != ("",) and name in metaclass.by_name:
            yield f"{name}: {metaclass.by_name[name].documentation}"


def _height_of(attempt: _Attempt) -> dict[str, float]:
    """Return the height as the attribute that a task has for it."""
    symbol = attempt.kind.symbol
    name = symbol.height if symbol is not None else ""
    return {name: attempt.height} if name and name not in attempt.attributes else {}
