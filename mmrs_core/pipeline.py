"""The stages from models to behaviours, code and runs, in order; one short function each.

Stages print nothing, read no clock and no environment; only `write` and `save` touch the disk.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from mmrs_core.contributions.checks import CheckInput
from mmrs_core.contributions.targets import TargetInput
from mmrs_core.diagnostics import Diagnostic, has_errors, in_order
from mmrs_core.errors import InternalError, InvalidModelError, PluginError, UnreadableError, UsageError
from mmrs_core.generation.overrides import overrides_in
from mmrs_core.languages.codes import is_refusal
from mmrs_core.languages.conformance import check_conformance
from mmrs_core.languages.modelset import read_project
from mmrs_core.languages.naming import nearest
from mmrs_core.languages.writing import write_model
from mmrs_runtime.conditions import question_of
from mmrs_runtime.engine.decisions import assumed, standard_conditions

if TYPE_CHECKING:
    from mmrs_core.behaviour.program import Program
    from mmrs_core.contributions.checks import Verdict
    from mmrs_core.contributions.execution import Condition
    from mmrs_core.contributions.registry import Contributions
    from mmrs_core.contributions.targets import GeneratedFile
    from mmrs_core.contributions.vehicles import VehicleFactory
    from mmrs_core.generation.capabilities.judging import TargetCapability
    from mmrs_core.languages import behaviour as bl
    from mmrs_core.languages.modelset import ModelSet
    from mmrs_core.planning.effort import Effort
    from mmrs_core.planning.explaining import PlanExplanation
    from mmrs_core.scene import Area, Corridor, Part, Plan, RobotType, Scene
    from mmrs_core.simulation.run import SimulatedRun
    from mmrs_core.transformation.engine import Trace
    from mmrs_runtime.records.steps import StepRecord

Contributed = TypeVar("Contributed")
CORE_DISTRIBUTION = "mmrs-core"


@dataclass(frozen=True, slots=True)
class BehaviourContext:
    """What a behaviour is checked against and rendered for, beside itself.

    Attributes:
        types: robot types by name.
        areas: of the context as drawn, and those that its elements make; None where no context is given.
        environment: weather and water, by attribute name.
        elements: context elements of plug-ins.
        tasks: of the mission, by name; empty where no mission is given.
        corridors: of the context as drawn.
    """

    types: Mapping[str, RobotType]
    areas: tuple[Area, ...] | None = None
    environment: Mapping[str, float] | None = None
    elements: tuple[Part, ...] = ()
    tasks: Mapping[str, Part] = field(default_factory=dict)
    corridors: tuple[Corridor, ...] = ()


def read_models(
    mission: Path,
    contributions: Contributions,
    *,
    context: Path | None = None,
    robots: Sequence[Path] = (),
    unsaved: Mapping[Path, bytes] | None = None,
) -> tuple[ModelSet | None, tuple[Diagnostic, ...]]:
    """Return a mission with its context and robot types, and every fault that reading found.

    Args:
        mission: a project folder, or the mission's file; what is not named lies beside it.
        unsaved: texts to be read instead of what files hold, by real path.

    Raises:
        UnreadableError: if a file is missing or no model at all.
    """
    return read_project(
        mission, context=context, robots=robots, registry=contributions.languages, unsaved=unsaved
    )


def check_models(models: ModelSet, contributions: Contributions) -> tuple[Diagnostic, ...]:
    """Return every fault of the models: conformance to the metamodels, then constraints."""
    from mmrs_core.analysis.constraints import check_constraints

    registry = contributions.languages
    faults = [fault for model in models.models for fault in check_conformance(model, registry)]
    faults.extend(check_constraints(models, contributions.constraints, registry))
    return in_order(faults)


def valid_models(
    mission: Path, contributions: Contributions, *, context: Path | None = None, robots: Sequence[Path] = ()
) -> tuple[ModelSet, tuple[Diagnostic, ...]]:
    """Return models without errors, and their warnings.

    Raises:
        UnreadableError: with all diagnostics, if a file cannot be read at all.
        InvalidModelError: with all diagnostics, if any is an error.
    """
    models, faults = read_models(mission, contributions, context=context, robots=robots)
    refused = next(filter(is_refusal, faults), None)
    if refused is not None:
        raise UnreadableError(f"{refused.place}: {refused.message}", in_order(faults))
    if models is not None:
        faults = in_order((*faults, *check_models(models, contributions)))
    if models is None or has_errors(faults):
        raise InvalidModelError(f"{mission}: the mission is not valid", faults)
    return models, faults


def ground(models: ModelSet) -> Scene:
    """Return the mission in the local frame."""
    from mmrs_core.grounding.scenes import ground as grounded

    return grounded(models)


def expand(scene: Scene, contributions: Contributions) -> Scene:
    """Return the scene with the kinematics of every robot and the work of every task."""
    from mmrs_core.transformation.expand import expand as expanded

    return expanded(scene, contributions.rules, contributions.robot_kinds, contributions.element_kinds)


def plan(scene: Scene, *, seed: int = 0, effort: Effort | None = None) -> Plan:
    """Return who does what, when and by which way, for an expanded scene."""
    from mmrs_core.planning.planner import plan as planned

    return planned(scene, seed=seed, effort=effort)


def explain(scene: Scene, plan: Plan, timed: Plan | None = None) -> PlanExplanation:
    """Return why a plan is as it is: what alternatives would cost, and which limits bind.

    `timed`: the plan with the times to tell; None: the planner's.
    """
    from mmrs_core.planning.explaining import explain as explained

    return explained(scene, plan, timed)


def transform(scene: Scene, plan: Plan, contributions: Contributions) -> tuple[bl.Behaviour, Trace]:
    """Return the behaviour of every robot, and what each of its moves is for."""
    from mmrs_core.transformation.engine import transform as transformed

    return transformed(
        scene,
        plan,
        rules=contributions.rules,
        robot_kinds=contributions.robot_kinds,
        registry=contributions.languages,
    )


def place_of_scene(scene: Scene) -> BehaviourContext:
    """Return what the behaviour of a scene is checked against."""
    types = {robot.type.name: robot.type for robot in scene.robots}
    tasks = {task.name: task.part for task in scene.tasks}
    return BehaviourContext(types, scene.areas, scene.environment, scene.elements, tasks, scene.corridors)


def program_of(behaviour: bl.Behaviour, contributions: Contributions) -> Program:
    """Return a behaviour as engines use it."""
    from mmrs_core.behaviour.reading import program_of as program

    return program(behaviour, registry=contributions.languages)


def verify(program: Program, place: BehaviourContext, contributions: Contributions) -> tuple[Verdict, ...]:
    """Return what is known of every property of a behaviour."""
    from mmrs_core.analysis.verdicts import verify as verified
    from mmrs_core.generation.safety import rally_points_by_policy

    asked, unasked = rally_points_by_policy(
        program, place.types, contributions.robot_kinds, place.areas or ()
    )
    given = CheckInput(
        program=program,
        types=place.types,
        robot_kinds=contributions.robot_kinds,
        move_kinds=contributions.move_kinds,
        areas=place.areas,
        environment=place.environment or {},
        elements=place.elements,
        corridors=place.corridors,
        tasks=place.tasks,
        rally_points=asked,
        unasked_rally_points=unasked,
    )
    return verified(given, contributions.checks)


def refusals(verdicts: Iterable[Verdict], program: Program) -> tuple[Verdict, ...]:
    """Return the verdicts that make a behaviour unsafe: violations, and unknowns that were not accepted."""
    from mmrs_core.analysis.verdicts import refuses

    return refuses(verdicts, program.accepted_unknowns)


def input_of(program: Program, place: BehaviourContext, contributions: Contributions) -> TargetInput:
    """Return what targets and vehicles may use of a behaviour."""
    return TargetInput(
        program=program,
        types=place.types,
        robot_kinds=contributions.robot_kinds,
        move_kinds=contributions.move_kinds,
        areas=place.areas or (),
        extensions=contributions.extensions,
        environment=place.environment or {},
        elements=place.elements,
    )


def render(
    program: Program,
    place: BehaviourContext,
    target: str,
    contributions: Contributions,
    *,
    allow_lossy: bool = False,
    templates: Path | None = None,
) -> tuple[GeneratedFile, ...]:
    """Return the code of every robot for a target.

    Args:
        program: the behaviour.
        place: its surroundings.
        target: its name.
        contributions: of the plug-ins.
        allow_lossy: leave out what the target cannot express; the manifest lists it.
        templates: a folder of files that replace the targets' own.

    Raises:
        UsageError: if there is no such target.
        UnsupportedError: if it cannot express all of the behaviour.
        UnreadableError: if there is no such folder of templates.
        MmrsError: if that folder holds something unknown or broken.
        PluginError: if the target is a plug-in's, and its templates are broken.
    """
    from mmrs_core.generation.render import render as rendered

    chosen = _named("target", target, contributions.targets)
    given = input_of(program, place, contributions)
    provider = contributions.distribution_of("targets", chosen)
    overrides = overrides_in(templates, chosen, contributions.targets) if templates is not None else None
    try:
        return rendered(chosen, given, allow_lossy=allow_lossy, provider=provider, overrides=overrides)
    except InternalError as error:
        if provider == CORE_DISTRIBUTION:
            raise
        raise PluginError(f"{contributions.source_of('targets', chosen)}: {error}") from error


def capabilities(target: str | None, contributions: Contributions) -> dict[str, tuple[TargetCapability, ...]]:
    """Return what a target can express, or each target where None is named, by name; found by trying.

    Raises:
        UsageError: if there is no such target.
    """
    from mmrs_core.generation.capabilities.judging import capabilities_of

    names = sorted(contributions.targets) if target is None else [target]
    chosen = {name: _named("target", name, contributions.targets) for name in names}
    return {name: capabilities_of(each, contributions) for name, each in chosen.items()}


def write(files: Iterable[GeneratedFile], directory: Path) -> tuple[Path, ...]:
    """Write generated files below a directory; return their paths."""
    from mmrs_core.generation.writing import write as written

    return written(files, directory)


def save(
    behaviour: bl.Behaviour,
    path: Path,
    contributions: Contributions,
    schema_location: Mapping[str, str] | None = None,
) -> None:
    """Write a behaviour model, wholly or not at all.

    Args:
        schema_location: for Eclipse, where the .ecore of each nsURI lies, relative to the file.
    """
    write_model((behaviour,), path, contributions.languages, schema_location=schema_location)


def simulate(
    program: Program,
    place: BehaviourContext,
    contributions: Contributions,
    *,
    backend: str = "simulation",
    own_backends: Mapping[str, str] | None = None,
    options: Mapping[str, str] | None = None,
    assume: Mapping[str, bool] | None = None,
    observe: Callable[[StepRecord], None] | None = None,
) -> SimulatedRun:
    """Return the simulated run of a behaviour, in still air and water unless the environment defines others.

    Args:
        backend: name of the robots' backend; its time is simulated.
        own_backends: by robot, that of those with another one.
        options: of the backends; ``ROBOT:KEY`` is for that of one robot.
        assume: fixed answers by condition identifier, which take precedence over contributed conditions.
        observe: called with each step before it has an effect, to write a log.

    Raises:
        UsageError: if there is no such backend, or it does not simulate or know an option, or no Choice asks
            for what is assumed.
        UnsupportedError: if the behaviour contains what no plug-in provides.
    """
    from mmrs_core.simulation.run import simulate as simulated
    from mmrs_runtime.engine.terms import Terms

    return simulated(
        input_of(program, place, contributions),
        backend_for(program, contributions, backend, own_backends or {}),
        options=options,
        conditions=conditions_for(program, contributions, assume or {}, asks=False),
        terms=Terms(observe=observe),
    )


def conditions_for(
    program: Program, contributions: Contributions, assume: Mapping[str, bool], *, asks: bool
) -> dict[str, Condition]:
    """Return what decides the Choices of a program: what is assumed, then what is contributed or standard.

    Args:
        assume: fixed answers, by condition identifier.
        asks: whether there is an operator who answers questions.

    Raises:
        UsageError: if no Choice asks for what is assumed.
    """
    from mmrs_core.simulation.run import asked_by, refuse_unasked

    refuse_unasked(program, assume)
    asked = (each for each in asked_by(program) if asks or not question_of(each))
    standard = standard_conditions(asked)
    return {**standard, **contributions.conditions, **assumed(assume)}


def backend_named(name: str, contributions: Contributions) -> VehicleFactory:
    """Return the backend of that name.

    Raises:
        UsageError: if there is none.
    """
    return _named("backend", name, contributions.vehicles)


def backend_for(
    program: Program, contributions: Contributions, usual: str, own: Mapping[str, str]
) -> VehicleFactory:
    """Return what moves the robots of a program: the usual backend, or their own, by names.

    Raises:
        UsageError: if there is no such backend or robot, or simulated time would meet real time.
    """
    if not own:
        return backend_named(usual, contributions)
    from mmrs_core.simulation.run import mixed

    owned = {robot: backend_named(name, contributions) for robot, name in own.items()}
    return mixed(backend_named(usual, contributions), owned, [robot.id for robot in program.robots])


def _named(sort: str, name: str, contributed: Mapping[str, Contributed]) -> Contributed:
    """Return what was contributed under a name; the nearest one is suggested where there is none."""
    if name not in contributed:
        known, guess = ", ".join(sorted(contributed)), nearest(name, contributed)
        raise UsageError(f"{sort} '{name}': unknown; there are {known}{guess and '; ' + guess}")
    return contributed[name]
