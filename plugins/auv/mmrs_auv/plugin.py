"""What this plug-in contributes: the metamodel, how underwater vehicles move, what must hold."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path

from mmrs_auv.names import AUV, AUV_MOVEMENT
from mmrs_core.contributions.constraints import Constraint
from mmrs_core.contributions.fixes import Fix
from mmrs_core.contributions.rules import RobotKind
from mmrs_core.contributions.symbols import MapSymbol
from mmrs_core.hookspecs import hookimpl
from mmrs_core.languages.registry import MetamodelSource


@hookimpl
def mmrs_metamodels() -> tuple[MetamodelSource, ...]:
    """Contribute underwater vehicles to the Robot Language."""
    ecore = Path(str(files("mmrs_auv"))) / "metamodels" / "auv.ecore"
    return (MetamodelSource(AUV, ecore, "mmrs-auv"),)


@hookimpl
def mmrs_constraints() -> tuple[Constraint, ...]:
    """Contribute what must hold for underwater vehicles and for missions that use them."""
    from mmrs_auv.constraints import CONSTRAINTS

    return CONSTRAINTS


@hookimpl
def mmrs_fixes() -> tuple[Fix, ...]:
    """Contribute what mends thrusters whose figures are exchanged."""
    from mmrs_auv.fixes import FIXES

    return FIXES


@hookimpl
def mmrs_robot_kinds() -> tuple[RobotKind, ...]:
    """Contribute how robots with thrusters move on a mission."""
    from mmrs_auv.kinds import AUV_KIND

    return (AUV_KIND,)


@hookimpl
def mmrs_map_symbols() -> tuple[MapSymbol, ...]:
    """Contribute how the movement of underwater vehicles looks on maps."""
    return (MapSymbol(AUV_MOVEMENT, "underwater vehicle", "#0b7a75", "⚓", ("payloadWeight", "lifetime")),)
