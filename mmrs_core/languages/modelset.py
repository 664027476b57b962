"""All models of a project: the mission, its context, its robot types, and a behaviour if there is one."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from mmrs_core.diagnostics import Diagnostic, Place, Severity
from mmrs_core.errors import UnreadableError
from mmrs_core.languages import behaviour, context, mission, robot
from mmrs_core.languages.codes import explained, refusal
from mmrs_core.languages.conformance import check_conformance
from mmrs_core.languages.element import Element, Unknown, descendants, held, metaclass_of, place_of
from mmrs_core.languages.model import Model
from mmrs_core.languages.reading import Reading
from mmrs_core.languages.references.documents import Draft
from mmrs_core.languages.references.project import MODEL_ENDINGS, robot_files_in
from mmrs_core.languages.registry import Registry

if TYPE_CHECKING:
    from mmrs_core.languages.metaclass import Metaclass


MOST_PARTS = 10_000
"""The most child elements in one feature: tasks of a mission, vertices of a border, robots of a team.

So many tasks of one robot take half a minute to plan, so many vertices of a grid 12 s and of an obstacle 7 s
(measured on a busy machine); ten times as many take more than a hundred times as long.
"""


def crowds(root: Element) -> Iterator[Diagnostic]:
    """Yield a fault for whatever holds more parts of one kind than can be worked through."""
    for element in (root, *descendants(root)):
        if isinstance(element, Unknown):
            continue
        for feature in metaclass_of(element).features:
            if feature.containment and feature.many and (count := len(held(element, feature))) > MOST_PARTS:
                message = (
                    f"{metaclass_of(element).name}: holds {count} {feature.name}, more than {MOST_PARTS}"
                )
                hint = f"divide it, or simplify it until it has at most {MOST_PARTS} {feature.name}"
                yield Diagnostic("FIL006", Severity.ERROR, message, place_of(element), hint)


@dataclass(frozen=True, slots=True)
class ModelSet:
    """The models that belong together.

    Attributes:
        mission: an empty one where there is none, as when a behaviour is validated alone.
        context: None where there is none.
        behaviour: None where only a mission is validated.
        robots: the robot types, by name.
        models: every file that was read, in the order in which they were read.
    """

    mission: mission.Mission
    context: context.Context | None
    robots: Mapping[str, robot.Robot]
    models: tuple[Model, ...]
    behaviour: behaviour.Behaviour | None = None


def project_files(
    place: Path, context: Path | None = None, robots: Sequence[Path] = ()
) -> tuple[Path, Path | None, tuple[Path, ...]]:
    """Return the files of mission, context and robot types that a folder or a mission file stands for.

    What is not given is looked for beside the mission: the context, and the files in ``robots`` by name.
    Each may be XMI or JSON, by its ending.

    Raises:
        UnreadableError: if a folder has no mission, or two; or its context has another name.
    """
    mission_file = place
    if place.is_dir():
        found = model_in(place, "mission")
        if found is None or not found.is_file():
            raise UnreadableError.of("PRJ003", "no mission.xmi in this folder", place)
        mission_file = found
    folder = mission_file.parent
    if context is None:
        context = context_in(folder)
    return mission_file, context, tuple(robots) or robot_files_in(folder / "robots")


def model_in(folder: Path, name: str) -> Path | None:
    """Return the file of that name in a folder, such as ``mission.xmi`` or ``mission.json``; None if none.

    Raises:
        UnreadableError: if there are both, of which one would go unnoticed.
    """
    found = [file for ending in MODEL_ENDINGS if os.path.lexists(file := folder / f"{name}{ending}")]
    if len(found) > 1:
        both = f"has both {found[0].name} and {found[1].name}; keep one of them"
        raise UnreadableError.of("PRJ003", both, folder)
    return found[0] if found else None


def context_in(folder: Path) -> Path | None:
    """Return the context of a folder, readable or not; None if the folder has none.

    Raises:
        UnreadableError: if it leads nowhere, or differs from its name by capitals only: a context that
            goes unnoticed is an obstacle that is flown into. If there are two.
    """
    file = model_in(folder, "context")
    if file is not None and file.is_symlink() and not file.exists():
        raise UnreadableError.of("FIL001", "a link that leads nowhere", file)
    if file is not None:
        return file
    for other in sorted(folder.iterdir()) if folder.is_dir() else ():
        wanted = other.name.casefold()
        if wanted in ("context.xmi", "context.json"):
            raise UnreadableError.of("PRJ003", f"is taken for no context unless its name is {wanted}", other)
    return None


def read_project(
    mission: Path,
    *,
    context: Path | None = None,
    robots: Sequence[Path] = (),
    registry: Registry,
    unsaved: Mapping[Path, bytes] | None = None,
) -> tuple[ModelSet | None, tuple[Diagnostic, ...]]:
    """Return the models of a project and the faults of their files.

    There are no models if there is no mission among them, the mission or its context holds more than can be
    worked through, or a file cannot be read at all: then whatever the others say is checked on its own, and
    not against each other.

    Args:
        mission: the project's folder, or the mission's file.
        context: by default the file ``context`` beside the mission, if there is one.
        robots: the robot types; by default the models in ``robots`` beside the mission.
        registry: the metamodels they may use.
        unsaved: texts to be read instead of what files hold, by real path.

    Raises:
        UnreadableError: if it is ambiguous which files belong to the project.
    """
    mission_file, context_file, robot_files = project_files(mission, context, robots)
    files = [mission_file, *([context_file] if context_file else []), *robot_files]
    reading = Reading(registry, _common_folder(files), unsaved, complete=True)
    opened = [_opened(reading, file) for file in files]
    reading.follow()
    drafts = [draft for draft in opened if isinstance(draft, Draft)]
    if len(drafts) < len(files):
        refused = [fault for each in opened if isinstance(each, UnreadableError) for fault in refusal(each)]
        return None, (*refused, *_separate_faults(reading, drafts, registry))
    main = reading.model(drafts[0])
    models = (main, *main.linked)
    faults = [fault for model in models for fault in model.diagnostics]
    found = _single(drafts[0], registry.metaclass("urn:mmrs:mission:1.0", "Mission"), faults)
    where = registry.metaclass("urn:mmrs:context:1.0", "Context")
    place = _single(drafts[1], where, faults) if context_file else None
    crowded = [fault for root in (found, place) if root is not None for fault in crowds(root)]
    if crowded:
        return None, tuple(map(explained, (*faults, *crowded)))
    types = types_by_name(_robot_roots(drafts[len(files) - len(robot_files) :], registry, faults), faults)
    if found is None:
        return None, tuple(map(explained, faults))
    return ModelSet(found, place or None, types, models), tuple(map(explained, faults))  # type: ignore[arg-type]


def _opened(reading: Reading, file: Path) -> Draft | UnreadableError:
    """Return a file, or why it cannot be read."""
    try:
        return reading.open(file)
    except UnreadableError as refused:
        return refused


def _separate_faults(reading: Reading, drafts: Sequence[Draft], registry: Registry) -> Iterator[Diagnostic]:
    """Yield the faults of files that are not checked against each other."""
    if not drafts:
        return
    main = reading.model(drafts[0])
    for model in (main, *main.linked):
        yield from model.diagnostics
        yield from check_conformance(model, registry)


def _common_folder(files: Sequence[Path]) -> Path:
    """Return the folder that references may not leave: the mission's, or one above that holds all files."""
    folders = [file.resolve().parent for file in files]
    folder = folders[0]
    while not all(other.is_relative_to(folder) for other in folders):
        folder = folder.parent
    return folder


def _single(draft: Draft, metaclass: Metaclass, faults: list[Diagnostic]) -> Element | None:
    """Return the first root of that metaclass, after a fault for everything else at the top."""
    chosen = None
    for root in draft.source.roots:
        if chosen is None and metaclass.accepts(root):
            chosen = root
        elif not isinstance(root, Unknown):
            message = f"{metaclass_of(root).name}: expected one {metaclass.name} in this file, nothing else"
            faults.append(Diagnostic("PRJ002", Severity.ERROR, message, place_of(root)))
    return chosen


def types_by_name(roots: Iterable[robot.Robot], faults: list[Diagnostic]) -> Mapping[str, robot.Robot]:
    """Return the first robot type of each name, after a fault for every other of that name."""
    types: dict[str, robot.Robot] = {}
    for root in roots:
        name = root.name or ""
        if name in types:
            first = place_of(types[name])
            message = f"{name or 'a nameless type'}: two robot types have this name; the first is at {first}"
            faults.append(
                Diagnostic("PRJ001", Severity.ERROR, message, place_of(root), "give each type its own name")
            )
        else:
            types[name] = root
    return types


def _robot_roots(
    drafts: Sequence[Draft], registry: Registry, faults: list[Diagnostic]
) -> Iterator[robot.Robot]:
    metaclass = registry.metaclass("urn:mmrs:robot:1.0", "Robot")
    for draft in drafts:
        for root in draft.source.roots:
            if isinstance(root, robot.Robot):
                yield root
            elif not isinstance(root, Unknown):
                message = f"{metaclass_of(root).name}: expected robot types in this file, nothing else"
                faults.append(Diagnostic("PRJ002", Severity.ERROR, message, place_of(root)))
        if not draft.source.roots and not draft.diagnostics:
            message = f"{metaclass.name}: the file holds none"
            faults.append(Diagnostic("PRJ002", Severity.ERROR, message, Place(draft.source.file, 1)))
