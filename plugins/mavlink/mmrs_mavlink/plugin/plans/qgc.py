"""The target qgc-plan: one plan for QGroundControl for each sortie of each robot."""

from __future__ import annotations

from collections.abc import Iterator
from math import isnan

from mmrs_core.behaviour.travel import capability_of
from mmrs_core.contributions.targets import FileSpec, Target, TargetInput
from mmrs_mavlink.plugin.capabilities import OF_MISSIONS, WIRINGS
from mmrs_mavlink.plugin.context import VehicleContext, templates_of
from mmrs_mavlink.plugin.plans.items import Row
from mmrs_mavlink.plugin.plans.refusals import refusals
from mmrs_mavlink.plugin.plans.surroundings import PlannedMission, missions_of

TEMPLATES = templates_of("qgc-plan")
HEIGHT_ABOVE_HOME = 1
DEFAULT_SPEED = 5.0


def files(input: TargetInput) -> Iterator[FileSpec]:
    """Yield ``<robot>.plan``, and ``<robot>.sortie-2.plan`` and so on where there are more sorties.

    Raises:
        UnsupportedError: the behaviour is local, or a robot has no home.
    """
    for mission in missions_of(input):
        trace = tuple(row.step for row in mission.rows)
        yield FileSpec(
            f"{mission.stem}.plan",
            "plan.jinja",
            view_of(mission),
            trace=trace,
            asks=mission.asks,
            note=mission.note,
        )


def view_of(mission: PlannedMission) -> dict[str, object]:
    """Return what the template sees; heights are above home."""
    return {
        "firmware": mission.context.profile.autopilot.number,
        "vehicle": mission.context.profile.mav_types[0],
        "speed": _usual_speed(mission.context),
        "height_above_home": HEIGHT_ABOVE_HOME,
        "home": list(mission.home),
        "items": [{"step": row.step, "content": _simple(row)} for row in mission.rows],
        "fence": {"version": 2, "circles": [], "polygons": [_polygon(ring) for ring in mission.fence]},
        "rally": {"version": 2, "points": [list(spot) for spot in mission.rally]},
    }


def _simple(row: Row) -> dict[str, object]:
    simple: dict[str, object] = {
        "type": "SimpleItem",
        "autoContinue": True,
        "command": row.command,
        "doJumpId": row.number,
        "frame": row.frame,
        # What is left to the vehicle is no number, which JSON has no form for but null.
        "params": [None if isnan(param) else param for param in row.params],
    }
    if row.has_place:
        height = {"Altitude": row.params[-1], "AltitudeMode": HEIGHT_ABOVE_HOME, "AMSLAltAboveTerrain": None}
        simple |= height
    return simple


def _polygon(ring: tuple[tuple[float, float], ...]) -> dict[str, object]:
    return {"version": 1, "inclusion": False, "polygon": [list(vertex) for vertex in ring]}


def _usual_speed(context: VehicleContext) -> float:
    speeds = [speed for move in context.robot.moves if (speed := context.speed(move)) is not None]
    capability = capability_of(context.robot, context.type) if context.type else None
    return max(speeds, default=capability.speed[1] if capability else DEFAULT_SPEED)


QGC_PLAN = Target(
    name="qgc-plan",
    description="plans for QGroundControl: mission, geofence and rally points, one a sortie of each robot",
    templates=TEMPLATES,
    files=files,
    refusals=refusals,
    capabilities=OF_MISSIONS,
    tried_with="copter",
    wirings=WIRINGS,
)
