"""What can be drawn of a mission, or of a behaviour without one.

Places, areas, robots and the order of tasks are drawn as far as they are known: models are checked before
they are whole, so that everything here may be missing, and what is missing is left out: some other
constraint or the metamodel says so.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from math import hypot

import shapely
from shapely.geometry import Polygon

from mmrs_core.analysis.constraints.order import TaskOrder
from mmrs_core.analysis.constraints.outliers import Outliers, outliers_of
from mmrs_core.analysis.constraints.unread import drawn_once
from mmrs_core.grounding.coordinates import Ground, ground_of
from mmrs_core.grounding.features import child, children, number, text
from mmrs_core.grounding.parts import heights_of, ring_of, use_of
from mmrs_core.grounding.robots import half_diagonal
from mmrs_core.languages.element import Element
from mmrs_core.languages.modelset import ModelSet
from mmrs_core.scene import AreaUse, Position, Ring

_ROUND_THE_EARTH = 4e7
AREAS = ("forbiddenAreas", "obstacles", "emergencyAreas")


@dataclass(frozen=True, slots=True)
class DrawnArea:
    """An area whose every vertex has a place and whose shell is sound; heights and distances in metres."""

    element: Element
    use: AreaUse
    shape: Polygon
    low: float
    high: float
    safety_distance: float

    def off(self, up: float) -> float:
        """Return how far a height is above or below the area, metres; 0 between its two sides."""
        return max(self.low - up, up - self.high, 0.0)


@dataclass(frozen=True, slots=True)
class DrawnRobot:
    """A robot of the team.

    Attributes:
        type: None where there is no type of that name.
        home: None where it has no place.
        half: half its diagonal, metres; None where its size is not known.
        clearance: the same plus the position error.
    """

    element: Element
    type: Element | None
    home: Position | None
    half: float | None
    clearance: float | None


class Sketch:
    """What can be drawn of a mission or behaviour, its context and its team."""

    def __init__(self, models: ModelSet) -> None:
        self._models = models
        self._team = child(models.mission, "team")
        alone = models.behaviour if self._team is None else None
        self._framed: Element = alone if alone is not None else models.mission

    @drawn_once
    def ground(self) -> Ground:
        """Where the coordinates lie; by a behaviour that stands for itself, if there is no mission."""
        return ground_of(self._framed, self._models.context)

    @drawn_once
    def program_ground(self) -> Ground:
        """Where the coordinates of the behaviour lie."""
        return ground_of(self._models.behaviour, self._models.context)

    @drawn_once
    def order(self) -> TaskOrder:
        """What tasks wait for."""
        return TaskOrder(self._models.mission)

    @drawn_once
    def outliers(self) -> Outliers:
        """What lies apart from everything else."""
        return outliers_of(self._models)

    @drawn_once
    def areas(self) -> tuple[DrawnArea, ...]:
        """The areas that can be drawn."""
        context = self._models.context
        found = (each for feature in AREAS for each in children(context, feature))
        return tuple(area for each in found if (area := self._area(each)) is not None)

    @drawn_once
    def kept_from(self) -> tuple[DrawnArea, ...]:
        """The areas that robots keep away from."""
        return tuple(area for area in self.areas if area.use is not AreaUse.EMERGENCY)

    def distances(self, position: Position) -> Iterator[tuple[DrawnArea, float]]:
        """Yield the areas that robots keep away from, with the exact distance of a position from each."""
        shapes = [area.shape for area in self.kept_from]
        aside = shapely.distance(shapes, shapely.points(position[0], position[1])) if shapes else ()
        for area, sideways in zip(self.kept_from, aside, strict=True):
            yield area, hypot(float(sideways), area.off(position[2]))

    @drawn_once
    def robots(self) -> tuple[DrawnRobot, ...]:
        """The team; the robots of a behaviour that stands for itself."""
        owner = self._framed if self._team is None else self._team
        return tuple(self._robot(each) for each in children(owner, "robots"))

    @drawn_once
    def types(self) -> Mapping[Element | None, tuple[DrawnRobot, ...]]:
        """The robots of the team by type; None: of one that is not known."""
        found = dict[Element | None, list[DrawnRobot]]()
        for robot in self.robots:
            found.setdefault(robot.type, []).append(robot)
        return {robot_type: tuple(robots) for robot_type, robots in found.items()}

    def ring(self, owner: Element, feature: str) -> Ring | None:
        """Return the vertices of a ring, each once; None where one of them has no place."""
        corners = children(owner, feature)
        placed = all(corner in self.ground.positions for corner in corners)
        return ring_of(corners, self.ground.positions) if corners and placed else None

    def _area(self, element: Element) -> DrawnArea | None:
        ring = self.ring(element, "shell")
        shape = polygon_of(ring) if ring is not None else None
        if shape is None:
            return None
        low, high = heights_of(element)
        return DrawnArea(element, use_of(element), shape, low, high, _kept(element, "safetyDistance"))

    def _robot(self, element: Element) -> DrawnRobot:
        robot_type = self._models.robots.get(text(element, "type") or text(element, "typeName"))
        size = child(robot_type, "size") if robot_type is not None else None
        half = half_diagonal(size) if size is not None else None
        error = _kept(self._framed, "positionError")
        home = child(element, "home")
        return DrawnRobot(
            element=element,
            type=robot_type,
            home=self.ground.positions.get(home) if home is not None else None,
            half=None if half is None else min(half, _ROUND_THE_EARTH),
            clearance=None if half is None else min(half + error, _ROUND_THE_EARTH),
        )


def _kept(element: Element, name: str) -> float:
    """Return a distance that is kept, metres; one round the Earth is as good as any that is larger."""
    return min(max(number(element, name) or 0.0, 0.0), _ROUND_THE_EARTH)


def polygon_of(ring: Ring) -> Polygon | None:
    """Return the polygon of a ring; None for one that crosses itself or bounds no area."""
    if len(ring) < 3:
        return None
    shape = Polygon(ring)
    return shape if shape.is_valid and shape.area > 0.0 else None


_remembered: ContextVar[dict[int, Sketch] | None] = ContextVar("sketches", default=None)


@contextmanager
def remembering() -> Iterator[None]:
    """Let `sketch_of` draw each set of models once while they are checked, and forget them afterwards."""
    token = _remembered.set({})
    try:
        yield
    finally:
        _remembered.reset(token)


def sketch_of(models: ModelSet) -> Sketch:
    """Return what can be drawn of these models; drawn once within `remembering`."""
    sketches = _remembered.get()
    if sketches is None:
        return Sketch(models)
    return sketches.setdefault(id(models), Sketch(models))
