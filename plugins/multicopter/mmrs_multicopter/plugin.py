"""What this plug-in contributes: the metamodel, how drones move, what must hold, how they look."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING

from mmrs_core.contributions.robot_types import RobotTypeFile
from mmrs_core.contributions.symbols import MapSymbol
from mmrs_core.hookspecs import hookimpl
from mmrs_core.languages.sources import MetamodelSource
from mmrs_multicopter.names import DRONE, MULTICOPTER

if TYPE_CHECKING:
    from mmrs_core.contributions.constraints import Constraint
    from mmrs_core.contributions.execution import Condition
    from mmrs_core.contributions.rules import MoveKind, RobotKind


@hookimpl
def mmrs_metamodels() -> tuple[MetamodelSource, ...]:
    """Contribute drones to the Robot Language, take-off, landing and trajectories to behaviours."""
    ecore = Path(str(files("mmrs_multicopter"))) / "metamodels" / "multicopter.ecore"
    return (MetamodelSource(MULTICOPTER, ecore, "mmrs-multicopter"),)


@hookimpl
def mmrs_constraints() -> tuple[Constraint, ...]:
    """Contribute what must hold for drones and for behaviours that fly them."""
    from mmrs_multicopter.constraints import CONSTRAINTS

    return CONSTRAINTS


@hookimpl
def mmrs_robot_kinds() -> tuple[RobotKind, ...]:
    """Contribute how drones move on a mission."""
    from mmrs_multicopter.kinds import MULTICOPTER_KIND

    return (MULTICOPTER_KIND,)


@hookimpl
def mmrs_move_kinds() -> tuple[MoveKind, ...]:
    """Contribute what take-off, landing and going to a target along a trajectory do."""
    from mmrs_multicopter.kinds import MOVE_KINDS

    return MOVE_KINDS


@hookimpl
def mmrs_conditions() -> tuple[Condition, ...]:
    """Contribute conditions on the energy that is left: ``energy_above_100_kJ`` and the like."""
    from mmrs_multicopter.conditions import CONDITIONS

    return CONDITIONS


@hookimpl
def mmrs_robot_types() -> tuple[RobotTypeFile, ...]:
    """Contribute drones to begin a mission with, with the sources of their figures."""
    folder = Path(str(files("mmrs_multicopter"))) / "robot_types"
    return (
        RobotTypeFile(
            "Freefly Astro LR1",
            folder / "freefly-astro-lr1.xmi",
            "quadcopter with a full-frame mapping camera",
        ),
        RobotTypeFile(
            "Amovlab P600 camera", folder / "amovlab-p600-camera.xmi", "quadcopter with a zoom camera"
        ),
        RobotTypeFile(
            "Amovlab P600 gas", folder / "amovlab-p600-gas.xmi", "quadcopter with a gas sensor, carries 1 kg"
        ),
    )


@hookimpl
def mmrs_map_symbols() -> tuple[MapSymbol, ...]:
    """Contribute how drones look on maps."""
    return (MapSymbol(DRONE, "drone", "#1f6fb2", "✈", ("name", "maxAltitude", "positionHold", "maxPayload")),)
