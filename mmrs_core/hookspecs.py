"""Every hook: its signature and its contract, nothing else.

Hooks named after a plural noun declare things: they are called once, when plug-ins are loaded, take
no argument and return frozen descriptors. Hooks named ``mmrs_stage_finished`` and
``mmrs_step_executed`` observe. Choice among contributions is by explicit name or by most specific
metaclass, never by the order of registration.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import pluggy

if TYPE_CHECKING:
    from mmrs_core.contributions.checks import Check
    from mmrs_core.contributions.commands import Command
    from mmrs_core.contributions.constraints import Constraint
    from mmrs_core.contributions.drawings import DrawingReader, Exporter
    from mmrs_core.contributions.execution import Condition
    from mmrs_core.contributions.fixes import Fix
    from mmrs_core.contributions.hooks import Hook
    from mmrs_core.contributions.robot_types import RobotTypeFile
    from mmrs_core.contributions.rules import ElementKind, MoveKind, RobotKind, Rule
    from mmrs_core.contributions.symbols import MapSymbol
    from mmrs_core.contributions.targets import Target
    from mmrs_core.contributions.timing import VehicleTiming
    from mmrs_core.contributions.vehicles import VehicleFactory
    from mmrs_core.languages.classes import ElementClass
    from mmrs_core.languages.evolution.migration import Migration
    from mmrs_core.languages.importers import Importer
    from mmrs_core.languages.sources import MetamodelSource
    from mmrs_runtime.records.steps import StepRecord

hookspec = pluggy.HookspecMarker("mmrs")
hookimpl = pluggy.HookimplMarker("mmrs")


@hookspec
def mmrs_metamodels() -> Iterable[MetamodelSource]:  # type: ignore[empty-body]
    """Contribute metamodels that extend the languages.

    They refer to each other and to the core's by nsURI, never by path. Two of one nsURI are an error.
    """


@hookspec
def mmrs_element_classes() -> Iterable[ElementClass]:  # type: ignore[empty-body]
    """Contribute Python classes that elements are instances of; one for a metaclass."""


@hookspec
def mmrs_migrations() -> Iterable[Migration]:  # type: ignore[empty-body]
    """Contribute steps from older versions of languages; one for each nsURI that they begin at."""


@hookspec
def mmrs_importers() -> Iterable[Importer]:  # type: ignore[empty-body]
    """Contribute importers of other tools' models, which every command then accepts; one for a name."""


@hookspec
def mmrs_constraints() -> Iterable[Constraint]:  # type: ignore[empty-body]
    """Contribute constraints on models; their codes are unique over all plug-ins."""


@hookspec
def mmrs_fixes() -> Iterable[Fix]:  # type: ignore[empty-body]
    """Contribute fixes of problems with one right answer; one fix for a code."""


@hookspec
def mmrs_rules() -> Iterable[Rule]:  # type: ignore[empty-body]
    """Contribute what tasks are made of; one rule for a metaclass."""


@hookspec
def mmrs_robot_kinds() -> Iterable[RobotKind]:  # type: ignore[empty-body]
    """Contribute how robots of a metaclass move; one kind for a metaclass."""


@hookspec
def mmrs_vehicle_timings() -> Iterable[VehicleTiming]:  # type: ignore[empty-body]
    """Contribute how long autopilots take to carry robots; one timing for a class of vehicle."""


@hookspec
def mmrs_move_kinds() -> Iterable[MoveKind]:  # type: ignore[empty-body]
    """Contribute what moves of a metaclass do; one kind for a metaclass."""


@hookspec
def mmrs_element_kinds() -> Iterable[ElementKind]:  # type: ignore[empty-body]
    """Contribute the areas that context elements are to all robots; one kind for a metaclass."""


@hookspec
def mmrs_checks() -> Iterable[Check]:  # type: ignore[empty-body]
    """Contribute checks of behaviours; their names are unique over all plug-ins."""


@hookspec
def mmrs_targets() -> Iterable[Target]:  # type: ignore[empty-body]
    """Contribute what code can be generated for; names are unique over all plug-ins."""


@hookspec
def mmrs_vehicles() -> Iterable[VehicleFactory]:  # type: ignore[empty-body]
    """Contribute what drives robots; names are unique over all plug-ins."""


@hookspec
def mmrs_conditions() -> Iterable[Condition]:  # type: ignore[empty-body]
    """Contribute functions that decide Choices, by condition identifier."""


@hookspec
def mmrs_map_symbols() -> Iterable[MapSymbol]:  # type: ignore[empty-body]
    """Contribute how elements look on maps; one symbol for a metaclass."""


@hookspec
def mmrs_robot_types() -> Iterable[RobotTypeFile]:  # type: ignore[empty-body]
    """Contribute robot types to begin a mission with; names are unique over all plug-ins."""


@hookspec
def mmrs_drawing_readers() -> Iterable[DrawingReader]:  # type: ignore[empty-body]
    """Contribute readers of what map programs draw; names are unique over all plug-ins."""


@hookspec
def mmrs_exporters() -> Iterable[Exporter]:  # type: ignore[empty-body]
    """Contribute formats that map programs read; names are unique over all plug-ins."""


@hookspec
def mmrs_hooks() -> Iterable[Hook]:  # type: ignore[empty-body]
    """Specify hooks for other plug-ins to implement; names are unique over all plug-ins and the core."""


@hookspec
def mmrs_commands() -> Iterable[Command]:  # type: ignore[empty-body]
    """Contribute commands of the command line; names are unique over all plug-ins and the core."""


@hookspec
def mmrs_stage_finished(stage: str, result: object) -> None:
    """Observe that a stage of the pipeline has finished, with its result; exceptions are reported."""


@hookspec
def mmrs_step_executed(record: StepRecord) -> None:
    """Observe a step that the engine executes; exceptions are reported, and end nothing."""
