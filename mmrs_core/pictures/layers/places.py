"""The layers of a mission: its areas, context elements, tasks, homes and rally points."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from math import isfinite
from types import MappingProxyType

from mmrs_core.behaviour.program import Program
from mmrs_core.behaviour.rally_points import rally_points_of
from mmrs_core.contributions.symbols import MapSymbol
from mmrs_core.drawings.drawing import HeightReference, LeftOut, MapFeature, Property, Role
from mmrs_core.pictures.layers.chart import Chart, Drawn, Shape
from mmrs_core.pictures.layers.layer import Layer
from mmrs_core.pictures.palette import COLOURS, style_of
from mmrs_core.pictures.preview.features import elements_of, task_pictures
from mmrs_core.pictures.preview.picture import ElementPicture, TaskPicture
from mmrs_core.scene import Area, AreaUse, Name, Part, Point, Position, RobotType, Scene, Value

_ROLES = {
    AreaUse.FORBIDDEN: Role.FORBIDDEN,
    AreaUse.OBSTACLE: Role.OBSTACLE,
    AreaUse.EMERGENCY: Role.EMERGENCY_AREA,
}
_OF_FEATURES = ("description", "type")


def areas_on(chart: Chart, areas: Iterable[Area]) -> Iterator[MapFeature]:
    """Yield areas as drawn, on the height of their upper side; those that elements make are these' own."""
    for area in areas:
        if area.types is None:
            top = isfinite(area.high) and area.use is not AreaUse.EMERGENCY
            shell: Shape = [(*point, area.high) for point in area.shell] if top else area.shell
            yield replace(
                chart.area([shell]),
                name=area.name,
                role=_ROLES[area.use],
                folders=(Layer.AREAS,),
                properties=properties_of(area.part),
                colour=COLOURS[area.use.value][0],
            )


def elements_on(chart: Chart, elements: Iterable[Part], symbols: Mapping[Name, MapSymbol]) -> Iterator[Drawn]:
    """Yield each shape of context elements of plug-ins, and of what they contain."""
    for each in elements_of(elements, symbols):
        ups = _ups_of(each.model)
        shapes = (
            *(chart.area([_raised(ring, ups)]) for ring in each.outlines),
            *(chart.line(_raised(line, ups)) for line in each.lines),
            *(chart.line(_raised([mark], ups)) for mark in each.marks),
        )
        yield from _described(each, shapes, Role.ELEMENT, Layer.ELEMENTS)


def tasks_on(chart: Chart, scene: Scene, symbols: Mapping[Name, MapSymbol]) -> Iterator[Drawn]:
    """Yield the tasks of a mission as drawn in it; the heights at which they are done are properties."""
    for each in task_pictures(scene, {}, {}, symbols):
        ups = _ups_of(each.model)
        shapes = (
            *([chart.area([_raised(ring, ups) for ring in each.rings])] if each.rings else ()),
            *(chart.line(_raised(line, ups)) for line in each.lines),
            *([chart.line(_raised([each.point], ups))] if each.point is not None else ()),
        )
        entry = each.model.attributes.get("initialPosition") if each.model is not None else None
        more: dict[str, Property] = {}
        match entry:
            case (float() as east, float() as north, float()):
                more["initialPosition"] = chart.words((east, north))
        yield from _described(each, shapes, Role.TASK, Layer.TASKS, more)


def homes_on(chart: Chart, robots: Iterable[tuple[str, str, Position | None]]) -> Iterator[MapFeature]:
    """Yield the homes of robots that have one, given by their name, their type's name and their home."""
    for index, (robot, type_name, home) in enumerate(robots):
        if home is not None:
            high = chart.reference is not HeightReference.HOME
            yield replace(
                chart.line([home] if high else _raised([home[:2]], {home[:2]: home[2]})),
                name=robot,
                role=Role.HOME,
                folders=(Layer.HOMES,),
                properties={"robot": robot, "type": type_name},
                colour=colour_of(index),
            )


def rally_points_on(
    chart: Chart, program: Program, types: Mapping[str, RobotType], areas: Iterable[Area]
) -> Iterator[MapFeature]:
    """Yield where each robot lands or surfaces in an emergency."""
    known = tuple(areas)
    for index, robot in enumerate(program.robots):
        for point in rally_points_of(robot, program, types, known).points:
            yield replace(
                chart.point(point),
                name=robot.id,
                role=Role.CHOSEN_RALLY_POINT,
                folders=(Layer.RALLY_POINTS,),
                properties={"robot": robot.id},
                colour=colour_of(index),
            )


def colour_of(index: int) -> str:
    """Return the colour of the robot at that index, as in pictures."""
    return COLOURS[style_of(index).colour][0]


def properties_of(part: Part) -> dict[str, Property]:
    """Return what an element is and what is known of it but its name and shape, by feature name.

    What belongs to an element inside of it is called ``outer.inner``; one with a shape has its own. ``type``
    is its class; an attribute with the name of what every feature has is called ``Class.attribute``.
    """
    known: dict[str, Property] = {}
    for _, kind in part.metaclasses[:1]:
        known["type"] = kind
        for name, value in part.attributes.items():
            if name != "name":
                known.update(_properties(f"{kind}.{name}" if name in _OF_FEATURES else name, value))
    return known


def _described(
    picture: TaskPicture | ElementPicture,
    shapes: Iterable[MapFeature],
    role: Role,
    layer: Layer,
    more: Mapping[str, Property] = MappingProxyType({}),
) -> Iterator[Drawn]:
    part, drawn = picture.model, False
    for shape in shapes:
        drawn = True
        yield replace(
            shape,
            name=picture.name or picture.symbol.label,
            description=picture.symbol.label,
            role=role,
            folders=(layer,),
            properties={**(properties_of(part) if part is not None else {}), **more},
            colour=picture.symbol.colour,
        )
    if not drawn:
        yield layer, LeftOut(f"{picture.symbol.label} '{picture.name}'", "has no position")


def _properties(name: str, value: Value) -> Iterator[tuple[str, Property]]:
    if isinstance(value, Part):
        if not any(_positions(value)):
            for inner, each in value.attributes.items():
                yield from _properties(f"{name}.{inner}", each)
    elif isinstance(value, tuple) and not any(_positions(value)):
        if any(isinstance(each, Part) for each in value):
            for index, each in enumerate(value):
                yield from _properties(f"{name}[{index}]", each)
        elif value:
            yield name, ", ".join(str(each).replace(",", "\\,") for each in value)
    elif isinstance(value, bool | int | float) or (isinstance(value, str) and value):
        yield name, value


def _ups_of(part: Part | None) -> dict[Point, float]:
    """Return the height of each position of an element; where two lie above each other, that of neither."""
    ups: dict[Point, float] = {}
    for east, north, up in _positions(part):
        ups[east, north] = up if ups.get((east, north), up) == up else 0.0
    return ups


def _positions(value: Value) -> Iterator[Position]:
    if isinstance(value, Part):
        for inner in value.attributes.values():
            yield from _positions(inner)
    elif isinstance(value, tuple):
        match value:
            case (float() as east, float() as north, float() as up):
                yield east, north, up
            case _:
                for each in value:
                    yield from _positions(each)


def _raised(points: Iterable[Point], ups: Mapping[Point, float]) -> Shape:
    """Return points with their heights; without, if all lie on the ground, at the origin's height."""
    flat = tuple(points)
    if not any(ups.get(point) for point in flat):
        return flat
    return [(*point, ups.get(point, 0.0)) for point in flat]
