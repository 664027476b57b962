"""What this plug-in contributes: metamodels, how underwater vehicles move, what they do, what must hold."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING

from mmrs_auv import names
from mmrs_core.contributions.commands import Command
from mmrs_core.contributions.robot_types import RobotTypeFile
from mmrs_core.contributions.symbols import MapSymbol
from mmrs_core.hookspecs import hookimpl
from mmrs_core.languages.sources import MetamodelSource

if TYPE_CHECKING:
    from mmrs_core.contributions.constraints import Constraint
    from mmrs_core.contributions.fixes import Fix
    from mmrs_core.contributions.rules import RobotKind, Rule
    from mmrs_core.contributions.targets import Target
    from mmrs_core.contributions.vehicles import VehicleFactory
    from mmrs_core.languages.evolution.migration import Migration


@hookimpl
def mmrs_metamodels() -> tuple[MetamodelSource, ...]:
    """Contribute underwater vehicles to the Robot Language, and what they do to the mission layer."""
    folder = Path(str(files("mmrs_auv"))) / "metamodels"
    return (
        MetamodelSource(names.AUV, folder / "auv.ecore", "mmrs-auv"),
        MetamodelSource(names.AUV_TASKS, folder / "auv-tasks.ecore", "mmrs-auv"),
    )


@hookimpl
def mmrs_migrations() -> tuple[Migration, ...]:
    """Contribute the step from vehicles whose movements hold their thrusters."""
    from mmrs_auv.migrations import MIGRATIONS

    return MIGRATIONS


@hookimpl
def mmrs_constraints() -> tuple[Constraint, ...]:
    """Contribute what must hold for underwater vehicles and for missions that use them."""
    from mmrs_auv.constraints import CONSTRAINTS

    return CONSTRAINTS


@hookimpl
def mmrs_fixes() -> tuple[Fix, ...]:
    """Contribute fixes of figures that are exchanged, and of overlaps in per cent."""
    from mmrs_auv.constraints.tasks import FIXES

    return FIXES


@hookimpl
def mmrs_robot_kinds() -> tuple[RobotKind, ...]:
    """Contribute how robots with thrusters move on a mission."""
    from mmrs_auv.kinds import AUV_KIND

    return (AUV_KIND,)


@hookimpl
def mmrs_rules() -> tuple[Rule, ...]:
    """Contribute what tasks under water are made of."""
    from mmrs_auv.tasks.objects import OBJECT_RULES
    from mmrs_auv.tasks.pipelines import PIPELINE_RULE
    from mmrs_auv.tasks.profiles import SURFACE_RULE, YO_YO_RULE
    from mmrs_auv.tasks.surveys import SURVEY_RULE

    return (SURVEY_RULE, YO_YO_RULE, *OBJECT_RULES, PIPELINE_RULE, SURFACE_RULE)


@hookimpl
def mmrs_targets() -> tuple[Target, ...]:
    """Contribute what can be generated for underwater vehicles."""
    from mmrs_auv.targets.ada.target import ADA
    from mmrs_auv.targets.can_c.target import CAN_C
    from mmrs_auv.targets.can_python.target import CAN_PYTHON

    return (ADA, CAN_C, CAN_PYTHON)


@hookimpl
def mmrs_robot_types() -> tuple[RobotTypeFile, ...]:
    """Contribute an inspection vehicle to begin a mission with, with the sources of their figures."""
    folder = Path(str(files("mmrs_auv"))) / "robot_types"
    return (
        RobotTypeFile(
            "BlueROV2", folder / "bluerov2.xmi", "underwater inspection vehicle with a camera, to 100 m"
        ),
    )


@hookimpl
def mmrs_map_symbols() -> tuple[MapSymbol, ...]:
    """Contribute how underwater vehicles, their tasks and pipelines look on maps."""
    return (
        MapSymbol(names.AUV_MOVEMENT, "underwater vehicle", "#0b7a75", "⚓", ("payloadWeight", "lifetime")),
        MapSymbol(names.PIPELINE, "pipeline", "#6b4f1d", "═", ("diameter",)),
        MapSymbol(
            names.DEPTH_HOLD_SURVEY_TASK,
            "sonar survey",
            "#1c5d99",
            "☰",
            ("depth", "swath", "overlap"),
            variants=({"depth": 3.0, "swath": 5.0},),
            device="deviceId",
        ),
        MapSymbol(
            names.YO_YO_TASK,
            "yo-yo",
            "#2b7a4b",
            "∿",
            ("minDepth", "maxDepth", "pitch"),
            variants=({"minDepth": 1.0, "maxDepth": 4.0},),
        ),
        MapSymbol(
            names.INSPECT_OBJECT_TASK,
            "inspect",
            "#a0235d",
            "◌",
            ("object", "distance", "views"),
            variants=({"object": "object", "distance": 3.0},),
            device="deviceId",
            action="actionName",
        ),
        MapSymbol(
            names.ALIGN_TASK,
            "align",
            "#4b3f72",
            "⊙",
            ("object", "distance", "bearing"),
            variants=({"object": "object", "distance": 2.0, "tolerance": 2.0},),
        ),
        MapSymbol(names.FOLLOW_PIPELINE_TASK, "pipeline run", "#8a4b08", "⇒", ("pipeline", "height")),
        MapSymbol(names.SURFACE_TASK, "surface", "#37474f", "⤒", ("duration",)),
    )


@hookimpl
def mmrs_vehicles() -> tuple[VehicleFactory, ...]:
    """Contribute backends for underwater vehicles on their CAN buses, real or simulated."""
    from mmrs_auv.backend import CAN, CAN_SIM

    return (CAN, CAN_SIM)


@hookimpl
def mmrs_commands() -> tuple[Command, ...]:
    """Contribute what concerns the CAN buses of vehicles, and vehicles that are simulated on them."""
    said = "Work with vehicle CAN buses."
    rehearse = "Simulate underwater vehicles."
    return (
        Command("can", said, "mmrs_auv.commands.can:app"),
        Command("auv", rehearse, "mmrs_auv.commands.auv:app"),
    )
