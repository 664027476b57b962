"""Reads a behaviour with its robot types and its context."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from mmrs_core.cli.output import report
from mmrs_core.contributions.rules import barriers
from mmrs_core.diagnostics import Diagnostic, has_errors, in_order
from mmrs_core.errors import InvalidModelError, UnreadableError
from mmrs_core.grounding.features import children
from mmrs_core.languages import behaviour as bl
from mmrs_core.languages import context as contexts
from mmrs_core.languages import mission as missions
from mmrs_core.languages import robot as robots_language
from mmrs_core.languages.codes import explained, refusal
from mmrs_core.languages.conformance import check_conformance
from mmrs_core.languages.modelset import context_in, model_in, types_by_name
from mmrs_core.languages.reading import read_model
from mmrs_core.languages.references.project import robot_files_in
from mmrs_core.pipeline import BehaviourContext, program_of, read_models

if TYPE_CHECKING:
    from mmrs_core.behaviour.program import Program
    from mmrs_core.cli.session import Session
    from mmrs_core.languages.model import Model
    from mmrs_core.languages.registry import Registry
    from mmrs_core.scene import Part


@dataclass(frozen=True, slots=True)
class BehaviourFiles:
    """What the files of a behaviour hold, right or wrong.

    Attributes:
        behaviour, context: None where the files hold none, or there is no file.
        types: by name.
        models: every file that was read.
        place: the file that the context stands in, or ought to.
    """

    file: Path
    behaviour: bl.Behaviour | None
    context: contexts.Context | None
    types: Mapping[str, robots_language.Robot]
    models: tuple[Model, ...]
    place: Path | None = None


@dataclass(frozen=True, slots=True)
class Loaded:
    """A valid behaviour.

    Attributes:
        place: with areas None where there is no context.
    """

    program: Program
    place: BehaviourContext


def load_behaviour(
    session: Session, file: Path, *, context: Path | None = None, robots: Sequence[Path] = ()
) -> Loaded:
    """Return a valid behaviour with its robot types and its place; print its warnings.

    Raises:
        UnreadableError: if a file is missing or no model at all.
        InvalidModelError: with all diagnostics, if any is an error.
    """
    files = read_behaviour_files(session, file, context=context, robots=robots)
    program, behaviour = _valid(session, files)
    return Loaded(program, _place(behaviour, files, session))


def read_behaviour_files(
    session: Session,
    file: Path,
    *,
    context: Path | None = None,
    robots: Sequence[Path] = (),
    unsaved: Mapping[Path, bytes] | None = None,
) -> BehaviourFiles:
    """Return the contents of the files.

    Args:
        file: of the behaviour.
        context: the context. Default: ``context.xmi`` in the behaviour's folder, if there is one.
        robots: files of robot types. Default: ``robots/*.xmi`` in the behaviour's folder.
        unsaved: texts to be read instead of files' contents, by real path.

    Raises:
        UnreadableError: if a file is missing or not a model at all.
    """
    place = context if context is not None else context_in(file.parent)
    types = tuple(robots) or robot_files_in(file.parent / "robots")
    registry = session.contributions.languages
    files = (file, *([place] if place else []), *types)
    models = _read_all(files, registry, unsaved)
    if not unsaved:
        session.have_read(models, place)
    return _as_files(file, models, place)


def tasks_beside(session: Session, file: Path, loaded: Loaded) -> Mapping[str, Part]:
    """Return the tasks of the mission in the folder of a behaviour, by name.

    None are known where there is no mission, where it is not valid, or where the behaviour is not of it.
    """
    from mmrs_core.behaviour.as_scene import carries_out
    from mmrs_core.grounding.scenes import ground

    mission = model_in(file.parent, "mission")
    models = read_models(mission, session.contributions)[0] if mission is not None else None
    if models is None:
        return {}
    try:
        scene = ground(models)
    except InvalidModelError:
        return {}
    return {task.name: task.part for task in scene.tasks} if carries_out(loaded.program, scene) else {}


def _read_all(files: Sequence[Path], registry: Registry, unsaved: Mapping[Path, bytes] | None) -> list[Model]:
    """Return the contents of files; all problems are reported at once, even if several cannot be read.

    The last ones, which describe robot types, are read first: models of other tools are imported by these.
    """
    models: list[Model] = []
    refused: list[UnreadableError] = []
    for file in reversed(files):
        known = [root for model in models for root in model.roots]
        try:
            models.insert(0, read_model(file, registry, unsaved=unsaved, known=known))
        except UnreadableError as error:
            refused.insert(0, error)
    if refused:
        faults = [fault for error in refused for fault in refusal(error)]
        faults += [fault for model in models for fault in model.diagnostics]
        raise UnreadableError(str(refused[0]), in_order(faults))
    return models


def _as_files(file: Path, models: Sequence[Model], place: Path | None = None) -> BehaviourFiles:
    roots = [root for model in models for root in model.roots]
    return BehaviourFiles(
        file,
        next((root for root in models[0].roots if isinstance(root, bl.Behaviour)), None),
        next((root for root in roots if isinstance(root, contexts.Context)), None),
        {root.name or "": root for root in roots if isinstance(root, robots_language.Robot)},
        tuple(models),
        place,
    )


def _instead_of_behaviour(files: BehaviourFiles) -> str:
    """Return what is wrong with a file that does not contain exactly one behaviour."""
    roots = files.models[0].roots
    if len(roots) == 1 and isinstance(roots[0], missions.Mission):
        return f"contains a mission, not a behaviour; 'mmrs plan {files.file}' makes one"
    return "expected one behaviour in this file"


def faults_of(session: Session, files: BehaviourFiles) -> tuple[Diagnostic, ...]:
    """Return every fault of the files: of reading, of their metamodels, and of the constraints.

    Raises:
        InvalidModelError: if the behaviour's file holds no behaviour, or more than one.
    """
    from mmrs_core.analysis.constraints import check_behaviour

    contributions = session.contributions
    faults: list[Diagnostic] = []
    reported: list[Diagnostic] = []
    for model in files.models:
        faults += [*model.diagnostics, *check_conformance(model, contributions.languages)]
    if files.behaviour is None or len(files.models[0].roots) != 1:
        raise InvalidModelError(f"{files.file}: {_instead_of_behaviour(files)}", in_order(faults))
    roots = [root for model in files.models for root in model.roots]
    places = [root for root in roots if isinstance(root, contexts.Context)]
    if files.place is not None and len(places) != 1:
        raise InvalidModelError(f"{files.place}: expected one context in this file", in_order(faults))
    types_by_name((root for root in roots if isinstance(root, robots_language.Robot)), reported)
    faults += map(explained, reported)
    faults += check_behaviour(
        files.behaviour,
        contributions.constraints,
        contributions.languages,
        robots=files.types,
        place=files.context,
        files=files.models,
    )
    return in_order(faults)


def is_behaviour(session: Session, path: Path) -> bool:
    """Return whether a path leads to a file that holds a behaviour.

    Raises:
        UnreadableError: if the file is missing or no model at all.
    """
    if path.is_dir():
        return False
    roots = read_model(path, session.contributions.languages).roots
    return any(isinstance(root, bl.Behaviour) for root in roots)


def load_program(session: Session, file: Path) -> Program:
    """Return a behaviour alone, valid by its metamodel and the constraints.

    Raises:
        UnreadableError: if the file is missing or not a model at all.
        InvalidModelError: with all diagnostics, if any is an error.
    """
    return _valid(session, _as_files(file, [read_model(file, session.contributions.languages)]))[0]


def _valid(session: Session, files: BehaviourFiles) -> tuple[Program, bl.Behaviour]:
    faults = faults_of(session, files)
    if files.behaviour is None or has_errors(faults):
        raise InvalidModelError(f"{files.file}: the behaviour, or what belongs to it, is not valid", faults)
    report(faults)
    return program_of(files.behaviour, session.contributions), files.behaviour


def _place(behaviour: bl.Behaviour, files: BehaviourFiles, session: Session) -> BehaviourContext:
    from mmrs_core.grounding.scenes import (
        areas_of,
        corridors_of,
        environment_of,
        ground_of,
        part_of,
        robot_type_of,
    )

    types = {name: robot_type_of(root) for name, root in files.types.items()}
    context, known = files.context, session.contributions
    if context is None:
        return BehaviourContext(types)
    ground = ground_of(behaviour, context)
    if ground.faults:
        raise InvalidModelError("the context has no place beside the behaviour", in_order(ground.faults))
    elements = tuple(part_of(element, ground) for element in children(context, "elements"))
    drawn = areas_of(context, ground)
    barred = barriers(elements, drawn, types.values(), known.robot_kinds, known.element_kinds)
    return BehaviourContext(
        types, (*drawn, *barred), environment_of(context), elements, corridors=corridors_of(context, ground)
    )
