"""What this plug-in contributes: panel groups, two types of task, and what must hold for them."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING

from mmrs_core.contributions.symbols import MapSymbol
from mmrs_core.hookspecs import hookimpl
from mmrs_core.languages.sources import MetamodelSource
from mmrs_solar import names

if TYPE_CHECKING:
    from mmrs_core.contributions.checks import Check
    from mmrs_core.contributions.constraints import Constraint
    from mmrs_core.contributions.fixes import Fix
    from mmrs_core.contributions.rules import Rule


@hookimpl
def mmrs_metamodels() -> tuple[MetamodelSource, ...]:
    """Contribute panel groups to the context layer, and tasks on them to the mission layer."""
    ecore = Path(str(files("mmrs_solar"))) / "metamodels" / "solar.ecore"
    return (MetamodelSource(names.SOLAR, ecore, "mmrs-solar"),)


@hookimpl
def mmrs_constraints() -> tuple[Constraint, ...]:
    """Contribute what must hold for panel groups, tasks on them, and cameras."""
    from mmrs_solar.constraints import CONSTRAINTS

    return CONSTRAINTS


@hookimpl
def mmrs_fixes() -> tuple[Fix, ...]:
    """Contribute the fixes of unambiguous figures."""
    from mmrs_solar.constraints import FIXES

    return FIXES


@hookimpl
def mmrs_rules() -> tuple[Rule, ...]:
    """Contribute what tasks on panels are made of."""
    from mmrs_solar.panel_looks import PANEL_LOOK_RULE
    from mmrs_solar.row_inspection import ROW_INSPECTION_RULE

    return (ROW_INSPECTION_RULE, PANEL_LOOK_RULE)


@hookimpl
def mmrs_checks() -> tuple[Check, ...]:
    """Contribute whether the sun is strong enough for what a behaviour records."""
    from mmrs_solar.irradiance import IRRADIANCE_CHECK

    return (IRRADIANCE_CHECK,)


@hookimpl
def mmrs_map_symbols() -> tuple[MapSymbol, ...]:
    """Contribute how panel groups, and tasks on them, look on maps."""
    from mmrs_solar.groups import outlines_of

    figures = ("rows", "pitch", "azimuth", "tilt")
    return (
        MapSymbol(names.PANEL_GROUP, "panel group", "#1f4e8c", "▤", figures, outlines_of),
        MapSymbol(names.THERMAL_ROW_TASK, "thermal rows", "#b3261e", "≣", ("group", "pixelSize", "speed")),
        MapSymbol(names.PANEL_LOOK_TASK, "panel look", "#7a4a00", "◎", ("group", "pixelSize")),
    )
