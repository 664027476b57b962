"""What this plug-in contributes: the metamodel, how rovers move, what must hold, how things look."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING

from mmrs_core.contributions.robot_types import RobotTypeFile
from mmrs_core.contributions.symbols import MapSymbol
from mmrs_core.hookspecs import hookimpl
from mmrs_core.languages.sources import MetamodelSource
from mmrs_rover.names import ROVER, ROVER_LANGUAGE, TERRAIN

if TYPE_CHECKING:
    from mmrs_core.contributions.constraints import Constraint
    from mmrs_core.contributions.rules import RobotKind


@hookimpl
def mmrs_metamodels() -> tuple[MetamodelSource, ...]:
    """Contribute ground vehicles to the Robot Language, and terrain to the context layer."""
    ecore = Path(str(files("mmrs_rover"))) / "metamodels" / "rover.ecore"
    return (MetamodelSource(ROVER_LANGUAGE, ecore, "mmrs-rover"),)


@hookimpl
def mmrs_constraints() -> tuple[Constraint, ...]:
    """Contribute what must hold for rovers, for terrain, and for missions that use them."""
    from mmrs_rover.constraints import CONSTRAINTS

    return CONSTRAINTS


@hookimpl
def mmrs_robot_kinds() -> tuple[RobotKind, ...]:
    """Contribute how rovers move on a mission, and what ground bars them."""
    from mmrs_rover.kinds import ROVER_KIND

    return (ROVER_KIND,)


@hookimpl
def mmrs_robot_types() -> tuple[RobotTypeFile, ...]:
    """Contribute a field rover to begin a mission with, with the sources of their figures."""
    folder = Path(str(files("mmrs_rover"))) / "robot_types"
    return (
        RobotTypeFile(
            "Clearpath Husky A300",
            folder / "clearpath-husky-a300.xmi",
            "field rover with a camera, carries 50 kg",
        ),
    )


@hookimpl
def mmrs_map_symbols() -> tuple[MapSymbol, ...]:
    """Contribute how rovers and terrain look on maps."""
    return (
        MapSymbol(ROVER, "rover", "#7a4b12", "▣", ("drive", "turningRadius", "maxSlope", "wadingDepth")),
        MapSymbol(TERRAIN, "terrain", "#6b8e23", "▒", ("slope", "waterDepth", "stepHeight")),
    )
