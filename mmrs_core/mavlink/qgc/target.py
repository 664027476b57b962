"""The target itself: one plan for each sortie of each robot."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from mmrs_core.behaviour.program import RobotProgram
from mmrs_core.contributions.targets import FileSpec, Target, TargetInput, TracedStep
from mmrs_core.errors import UnsupportedError
from mmrs_core.generation.escaping import file_stems
from mmrs_core.mavlink.context import RobotContext, context_of
from mmrs_core.mavlink.earth import degrees_of, metres, sea_level_of
from mmrs_core.mavlink.qgc.flight import sorties_of
from mmrs_core.mavlink.qgc.items import Item, item_json
from mmrs_core.mavlink.qgc.refusals import refusals
from mmrs_core.mavlink.safety import areas_of, clearance_of, fence_of, refuges
from mmrs_core.mavlink.vehicles import capability_of
from mmrs_core.resources import shipped
from mmrs_core.scene import Point, Position

TEMPLATES = shipped("codegen_templates") / "qgc-plan"
ARDUPILOT = 3
DEFAULT_SPEED = 5.0


def files(input: TargetInput) -> Iterator[FileSpec]:
    """Yield ``<robot>.plan``, and ``<robot>.sortie-2.plan`` and so on where there are more sorties.

    Raises:
        UnsupportedError: the behaviour is local, or a robot has no home.
    """
    stems = file_stems([robot.id for robot in input.program.robots])
    for robot in input.program.robots:
        if robot.home is None:
            raise UnsupportedError(f"robot '{robot.id}': its home is not known, and heights count from there")
        context = context_of(robot, input, geographic=True)
        for number, sortie in enumerate(sorties_of(context), start=1):
            suffix = f".sortie-{number}" if number > 1 else ""
            plan = plan_of(context, input, robot.home, sortie)
            path = f"{stems[robot.id]}{suffix}.plan"
            yield FileSpec(path, "plan.jinja", {"plan": plan}, trace=_trace(robot, sortie))


def plan_of(
    context: RobotContext, input: TargetInput, home: Position, sortie: Sequence[Item]
) -> dict[str, object]:
    """Return a plan as QGroundControl reads it.

    Heights are above home. The home's own height above mean sea level, which the format demands, is
    0 where it is not known and losses are allowed; vehicles replace it by what they measure.
    """
    frame = input.program.frame
    clearance = clearance_of(context.type, input.program.position_error)
    areas = areas_of(context.robot, input)
    return {
        "fileType": "Plan",
        "version": 1,
        "groundStation": "MMRS",
        "mission": {
            "version": 2,
            "firmwareType": ARDUPILOT,
            "vehicleType": context.vehicle.mav_type,
            "cruiseSpeed": _usual_speed(context),
            "hoverSpeed": _usual_speed(context),
            "globalPlanAltitudeMode": 1,
            "plannedHomePosition": [*_degrees(home, context), sea_level_of(home, frame) or 0.0],
            "items": _items(context, sortie),
        },
        "geoFence": {
            "version": 2,
            "circles": [],
            "polygons": [_polygon(ring, context) for ring in fence_of(areas)],
        },
        "rallyPoints": {"version": 2, "points": _rally(context, refuges(areas, clearance), sortie)},
    }


def _items(context: RobotContext, sortie: Sequence[Item]) -> list[dict[str, object]]:
    positions = [item.position for item in sortie if item.position is not None]
    degrees = iter(degrees_of([(east, north) for east, north, _ in positions], context.frame))
    return [
        item_json(item, number, (*next(degrees), context.height(item.position)) if item.position else None)
        for number, item in enumerate(sortie, start=1)
    ]


def _polygon(ring: Sequence[Point], context: RobotContext) -> dict[str, object]:
    vertices = [list(pair) for pair in degrees_of(ring, context.frame)]
    return {"version": 1, "inclusion": False, "polygon": vertices}


def _rally(context: RobotContext, points: Sequence[Point], sortie: Sequence[Item]) -> list[list[float]]:
    """Return the points at the greatest height of the sortie, which is above what lies on its way."""
    highest = max(item.position[2] for item in sortie if item.position is not None)
    up = metres(highest - context.zero)
    return [[latitude, longitude, up] for latitude, longitude in degrees_of(points, context.frame)]


def _degrees(position: Position, context: RobotContext) -> tuple[float, float]:
    return degrees_of([(position[0], position[1])], context.frame)[0]


def _usual_speed(context: RobotContext) -> float:
    speeds = [speed for move in context.robot.moves if (speed := context.speed(move)) is not None]
    capability = capability_of(context.robot, context.type) if context.type else None
    return max(speeds, default=capability.speed[1] if capability else DEFAULT_SPEED)


def _trace(robot: RobotProgram, sortie: Sequence[Item]) -> tuple[TracedStep, ...]:
    return tuple(
        TracedStep(f"item {number}", robot.id, item.move.id, item.move.task, item.move.rule)
        for number, item in enumerate(sortie, start=1)
    )


QGC_PLAN = Target(
    name="qgc-plan",
    description="plans for QGroundControl: mission, geofence and rally points, one a sortie of each robot",
    templates=TEMPLATES,
    files=files,
    refusals=refusals,
)
