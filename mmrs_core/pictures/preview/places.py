"""What the preview shows of a scene: its areas, its tasks, where it lies."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from mmrs_core.contributions.symbols import MapSymbol, has_symbol, symbol_of
from mmrs_core.geometry.clearance import grow, shrink
from mmrs_core.geometry.polygons import parts, rings
from mmrs_core.pictures.preview.picture import TaskPicture, Zone
from mmrs_core.pictures.preview.things import details_of, point_of, points_of
from mmrs_core.scene import Area, AreaUse, Frame, Name, Part, Ring, RobotType, Scene, Task, Value


def origin_of(frame: Frame) -> str:
    """Return where the origin of the local frame lies, for people."""
    if frame.latitude is None or frame.longitude is None:
        return "local coordinates"
    return f"{frame.latitude:.6f}, {frame.longitude:.6f} ({frame.crs})"


def zones_of(areas: Iterable[Area], clearances: Iterable[float]) -> tuple[Zone, ...]:
    """Return areas as drawn, with the outline that the robot of the widest clearance keeps to.

    Args:
        areas: as drawn.
        clearances: of each robot without the areas' safety distances, metres.
    """
    widest = max(clearances, default=0.0)
    return tuple(_zone(area, area.safety_distance + widest) for area in areas)


def _zone(area: Area, clearance: float) -> Zone:
    change = shrink if area.use is AreaUse.EMERGENCY else grow
    pieces = parts(change(area.shell, clearance))
    outlines = tuple(ring for piece in pieces for ring in (rings(piece)[0], *rings(piece)[1]))
    return Zone(area.name, area.use, area.shell, area.low, area.high, outlines, clearance, area.types)


def task_pictures(
    scene: Scene,
    begins: Mapping[str, float],
    ends: Mapping[str, float],
    symbols: Mapping[Name, MapSymbol],
) -> tuple[TaskPicture, ...]:
    """Return the tasks, those without a place (Fork, Join) included.

    A task's place is found by the shape of its attributes: ``shell`` and ``holes`` make an area,
    ``points`` a line, ``point`` a point, whichever plug-in the task comes from.
    """
    return tuple(
        _task_picture(
            task, begins.get(task.name), ends.get(task.name), symbol_of(task.part.metaclasses, symbols)
        )
        for task in scene.tasks
    )


def _task_picture(task: Task, begin: float | None, end: float | None, symbol: MapSymbol) -> TaskPicture:
    attributes = task.part.attributes
    shell = points_of(attributes.get("shell"))
    return TaskPicture(
        name=task.name,
        symbol=symbol,
        rings=(shell, *_holes(attributes.get("holes"))) if shell else (),
        line=points_of(attributes.get("points")),
        point=point_of(attributes.get("point")),
        begin=begin,
        end=end,
        details=details_of(task.part, symbol),
    )


def symbol_of_robot(robot_type: RobotType, symbols: Mapping[Name, MapSymbol]) -> MapSymbol | None:
    """Return the symbol of a robot's type, else that of how it moves; None where neither has one."""
    for metaclasses in (robot_type.metaclasses, robot_type.capability_metaclasses):
        if has_symbol(metaclasses, symbols):
            return symbol_of(metaclasses, symbols)
    return None


def _holes(value: Value) -> Iterator[Ring]:
    for hole in value if isinstance(value, tuple) else ():
        ring = points_of(hole.attributes.get("points") if isinstance(hole, Part) else hole)
        if ring:
            yield ring
