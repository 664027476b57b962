"""The target wpl: plain lists of waypoints, ``QGC WPL 110``, for each sortie of each robot.

The format is described at https://mavlink.io/en/file_formats/, which also says that a mission in it
holds no fence and no rally points. MAVProxy's commands ``fence load`` and ``rally load`` (that is,
`pymavlink.mavwp`) read these from lists of their own in the same format, so they go into files
beside the mission. Whether other ground stations read those two is not known.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from math import isinf

from mmrs_core.contributions.targets import FileSpec, Target, TargetInput, TracedStep
from mmrs_mavlink.plugin.capabilities import OF_LISTS, WIRINGS
from mmrs_mavlink.plugin.context import templates_of
from mmrs_mavlink.plugin.plans.items import ABSOLUTE, FENCE_EXCLUSION, RALLY_POINT, RELATIVE, WAYPOINT, Row
from mmrs_mavlink.plugin.plans.refusals import refusals
from mmrs_mavlink.plugin.plans.surroundings import PlannedMission, missions_of

TEMPLATES = templates_of("wpl")
TEMPLATE = "list.waypoints.jinja"
NO_PARAMETERS = (0.0, 0.0, 0.0, 0.0)


def files(input: TargetInput) -> Iterator[FileSpec]:
    """Yield ``<robot>.waypoints``, ``<robot>.fence.waypoints`` and ``<robot>.rally.waypoints``.

    Of several sorties, the second has ``<robot>.sortie-2.waypoints`` and so on. Fence and rally
    points are only there where the context has areas for them.

    Raises:
        UnsupportedError: the behaviour is local, or a robot has no home.
    """
    for mission in missions_of(input):
        list = _list(mission, "", (_home(mission), *mission.rows))
        yield replace(list, asks=mission.asks, note=mission.note)
        for name, rows in (("fence", _fence(mission)), ("rally", _rally(mission))):
            if rows:
                yield _list(mission, f".{name}", rows)


def line(value: object) -> str:
    """Return a row as a line: twelve fields with tabs between them, reals with eight decimals.

    What is left to the vehicle is written ``nan``.

    Raises:
        ValueError: it is not a row, or holds a number that is not finite.
    """
    if not isinstance(value, Row) or any(map(isinf, value.params)):
        raise ValueError(f"{value!r} is not a row of finite numbers")
    current = int(value.number == 0 and value.command == WAYPOINT)
    head = (value.number, current, value.frame, value.command)
    return "\t".join([*map(str, head), *(f"{param:.8f}" for param in value.params), "1"])


def _list(mission: PlannedMission, what: str, rows: tuple[Row, ...]) -> FileSpec:
    trace = tuple(row.step for row in rows if row.step.move)
    return FileSpec(f"{mission.stem}{what}.waypoints", TEMPLATE, {"rows": rows}, trace=trace)


def _home(mission: PlannedMission) -> Row:
    step = TracedStep("home", mission.context.robot.id, "")
    return Row(0, ABSOLUTE, WAYPOINT, (*NO_PARAMETERS, *mission.home), step)


def _fence(mission: PlannedMission) -> tuple[Row, ...]:
    vertices = [(vertex, float(len(ring))) for ring in mission.fence for vertex in ring]
    return tuple(
        Row(number, ABSOLUTE, FENCE_EXCLUSION, (count, 0.0, 0.0, 0.0, *vertex, 0.0), _around(mission))
        for number, (vertex, count) in enumerate(vertices)
    )


def _rally(mission: PlannedMission) -> tuple[Row, ...]:
    return tuple(
        Row(number, RELATIVE, RALLY_POINT, (*NO_PARAMETERS, *spot), _around(mission))
        for number, spot in enumerate(mission.rally)
    )


def _around(mission: PlannedMission) -> TracedStep:
    return TracedStep("surroundings", mission.context.robot.id, "")


WPL = Target(
    name="wpl",
    description="lists of waypoints (QGC WPL 110) for Mission Planner, MAVProxy and others, one a sortie",
    templates=TEMPLATES,
    files=files,
    refusals=refusals,
    capabilities=OF_LISTS,
    tried_with="copter",
    wirings=WIRINGS,
    filters={"row": line},
)
