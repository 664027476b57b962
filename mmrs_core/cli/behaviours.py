"""Reads a behaviour with the robot types and the place that belong to it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from mmrs_core.behaviour.program import Program
from mmrs_core.cli.journey import Workshop
from mmrs_core.cli.output import report
from mmrs_core.diagnostics import Diagnostic, has_errors, in_order
from mmrs_core.errors import InvalidModelError
from mmrs_core.languages import behaviour as bl
from mmrs_core.languages import context as contexts
from mmrs_core.languages import robot as robots_language
from mmrs_core.languages.conformance import check_conformance
from mmrs_core.languages.element import Element, metaclass_of
from mmrs_core.languages.grounding import area_of, ground_of, robot_type_of
from mmrs_core.languages.grounding_values import children, number
from mmrs_core.languages.model import Model
from mmrs_core.languages.reading import read_model
from mmrs_core.pipeline import Place, program_of
from mmrs_core.scene import Area, RobotType

_AREAS = ("forbiddenAreas", "obstacles", "emergencyAreas")


@dataclass(frozen=True, slots=True)
class Loaded:
    """A behaviour that was read from files.

    Attributes:
        file: of the behaviour.
        place: with areas None where there is no context.
    """

    file: Path
    behaviour: bl.Behaviour
    program: Program
    place: Place


def load_behaviour(
    workshop: Workshop, file: Path, *, context: Path | None = None, robots: Sequence[Path] = ()
) -> Loaded:
    """Return a behaviour, valid by its metamodel, with its robot types and its place.

    Args:
        file: of the behaviour.
        context: the place; else ``context.xmi`` in the behaviour's folder, if there is one.
        robots: files of robot types; else ``robots/*.xmi`` in the behaviour's folder.

    Raises:
        UnreadableError: if a file is missing or no model at all.
        InvalidModelError: with all diagnostics, if any is an error.
    """
    folder = file.resolve().parent
    beside = folder / "context.xmi"
    context_file = context if context is not None else (beside if beside.is_file() else None)
    robot_files = tuple(robots) or tuple(sorted((folder / "robots").glob("*.xmi")))
    behaviour_model = _read(workshop, file)
    context_model = _read(workshop, context_file) if context_file is not None else None
    robot_models = [_read(workshop, each) for each in robot_files]
    models = [behaviour_model, *([context_model] if context_model else []), *robot_models]
    _require_valid(workshop, models, file)
    behaviour = _only(behaviour_model, bl.Behaviour)
    program = program_of(behaviour, workshop.contributions)
    place = _place(behaviour, context_model, robot_models)
    return Loaded(file, behaviour, program, place)


def load_program(workshop: Workshop, file: Path) -> Program:
    """Return a behaviour by itself, valid by its metamodel.

    Raises:
        UnreadableError: if the file is missing or no model at all.
        InvalidModelError: with all diagnostics, if any is an error.
    """
    model = _read(workshop, file)
    _require_valid(workshop, [model], file)
    return program_of(_only(model, bl.Behaviour), workshop.contributions)


def _read(workshop: Workshop, file: Path) -> Model:
    return read_model(file, workshop.contributions.languages)


def _require_valid(workshop: Workshop, models: Sequence[Model], file: Path) -> None:
    registry = workshop.contributions.languages
    faults: list[Diagnostic] = []
    for model in models:
        faults += [*model.diagnostics, *check_conformance(model, registry)]
    found = in_order(faults)
    if has_errors(found):
        raise InvalidModelError(f"{file}: the behaviour, or what belongs to it, is not valid", found)
    report(found)


def _only(model: Model, kind: type[bl.Behaviour]) -> bl.Behaviour:
    found = [root for root in model.roots if isinstance(root, kind)]
    if len(found) != 1:
        raise InvalidModelError(f"{model.file}: holds {len(found)} behaviours, expected one")
    return found[0]


def _place(behaviour: bl.Behaviour, context: Model | None, robots: Sequence[Model]) -> Place:
    types = {found.name: found for model in robots for found in _types(model)}
    if context is None:
        return Place(types)
    root = next((each for each in context.roots if isinstance(each, contexts.Context)), None)
    if root is None:
        raise InvalidModelError(f"{context.file}: holds no context")
    return Place(types, tuple(_areas(behaviour, root)), _environment(root))


def _types(model: Model) -> Iterator[RobotType]:
    return (robot_type_of(root) for root in model.roots if isinstance(root, robots_language.Robot))


def _areas(behaviour: Element, context: Element) -> Iterator[Area]:
    laid = ground_of(behaviour, context)
    if laid.faults:
        raise InvalidModelError("the context has no place beside the behaviour", in_order(laid.faults))
    for feature in _AREAS:
        for index, area in enumerate(children(context, feature)):
            yield area_of(area, laid, f"{feature}[{index}]")


def _environment(context: contexts.Context) -> Mapping[str, float]:
    environment = context.environment
    if environment is None:
        return {}
    known = (
        (feature.name, number(environment, feature.name)) for feature in metaclass_of(environment).features
    )
    return {name: value for name, value in known if value is not None}
