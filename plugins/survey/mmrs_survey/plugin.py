"""What this plug-in contributes: nine types of task and landmarks: their rules, constraints and looks."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING

from mmrs_core.contributions.symbols import MapSymbol
from mmrs_core.hookspecs import hookimpl
from mmrs_core.languages.sources import MetamodelSource
from mmrs_survey import names

if TYPE_CHECKING:
    from mmrs_core.contributions.checks import Check
    from mmrs_core.contributions.constraints import Constraint
    from mmrs_core.contributions.fixes import Fix
    from mmrs_core.contributions.rules import Rule


@hookimpl
def mmrs_metamodels() -> tuple[MetamodelSource, ...]:
    """Contribute survey tasks to the mission layer, and landmarks to the context layer."""
    ecore = Path(str(files("mmrs_survey"))) / "metamodels" / "survey.ecore"
    return (MetamodelSource(names.SURVEY, ecore, "mmrs-survey"),)


@hookimpl
def mmrs_constraints() -> tuple[Constraint, ...]:
    """Contribute what must hold for survey tasks and the devices that do them."""
    from mmrs_survey.constraints import CONSTRAINTS

    return CONSTRAINTS


@hookimpl
def mmrs_fixes() -> tuple[Fix, ...]:
    """Contribute the fix of overlaps in per cent."""
    from mmrs_survey.constraints import FIXES

    return FIXES


@hookimpl
def mmrs_rules() -> tuple[Rule, ...]:
    """Contribute what survey tasks are made of."""
    from mmrs_survey.around import ORBIT_RULE, PERIMETER_RULE
    from mmrs_survey.grids import PHOTO_GRID_RULE
    from mmrs_survey.measuring import MEASURE_RULE
    from mmrs_survey.points import POINT_RULES
    from mmrs_survey.roads import ROAD_RULE

    return (PHOTO_GRID_RULE, *POINT_RULES, ROAD_RULE, PERIMETER_RULE, ORBIT_RULE, MEASURE_RULE)


@hookimpl
def mmrs_checks() -> tuple[Check, ...]:
    """Contribute the check that photos cover the areas of their tasks."""
    from mmrs_survey.photo_check import PHOTOS_CHECK

    return (PHOTOS_CHECK,)


@hookimpl
def mmrs_map_symbols() -> tuple[MapSymbol, ...]:
    """Contribute how survey tasks and landmarks look on maps."""
    return (
        MapSymbol(
            names.PHOTO_GRID_TASK,
            "photo grid",
            "#c2571a",
            "▦",
            ("altitude", "gridResolution"),
            usual_for="area",
            initial={"groundResolution": 0.02, "frontOverlap": 0.7, "sideOverlap": 0.6},
            alternatives=(frozenset({"groundResolution", "gridResolution", "footprintWidth"}),),
            height="altitude",
            variants=({"gridResolution": 20.0, "frontOverlap": "", "sideOverlap": ""},),
            device="deviceId",
            action="actionName",
        ),
        MapSymbol(names.GO_TO_TASK, "go to", "#5b3fa0", "➤", ("type",), usual_for="waypoint"),
        MapSymbol(
            names.ROAD_TASK,
            "road",
            "#8a6d1f",
            "≋",
            ("altitude", "width", "inverted"),
            usual_for="line",
            height="altitude",
            device="deviceId",
            action="actionName",
        ),
        MapSymbol(
            names.PERIMETER_TASK,
            "perimeter",
            "#7a2e5d",
            "▢",
            ("altitude", "distance", "topAltitude", "photoDistance"),
            usual_for="structure",
            initial={"distance": 10.0, "photoDistance": 5.0},
            height="altitude",
            device="deviceId",
            action="actionName",
        ),
        MapSymbol(
            names.ORBIT_TASK,
            "orbit",
            "#1f6f78",
            "◯",
            ("radius", "altitude", "photoDistance"),
            initial={"radius": 20.0, "photoDistance": 5.0},
            height="altitude",
            device="deviceId",
            action="actionName",
        ),
        MapSymbol(
            names.OBSERVE_TASK,
            "observe",
            "#a0235d",
            "◉",
            ("duration", "deviceId", "altitude"),
            usual_for="point",
            initial={"duration": 10.0},
            height="altitude",
        ),
        MapSymbol(names.RELAY_TASK, "relay", "#6b4f9a", "⌁"),
        MapSymbol(
            names.MEASURE_TASK,
            "measure",
            "#2d7a3a",
            "✚",
            ("actionName", "spacing", "altitude"),
            alternatives=(frozenset({"altitude", "depth"}),),
            height="altitude",
            device="deviceId",
            action="actionName",
        ),
        MapSymbol(
            names.APPROACH_TASK,
            "approach",
            "#37474f",
            "⊕",
            ("object", "distance", "tolerance"),
            variants=({"object": "object", "distance": 3.0, "tolerance": 2.0},),
        ),
        MapSymbol(names.LANDMARK, "landmark", "#0e7490", "⚑", ("description",)),
    )
