"""Drawings as a new project, or as additions to one."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from mmrs_core.diagnostics import Diagnostic, Place, in_order
from mmrs_core.drawings.drawing import LeftOut, MapFeature, Role
from mmrs_core.errors import InvalidModelError, UsageError
from mmrs_core.grounding.features import children
from mmrs_core.grounding.frame import frame_of
from mmrs_core.languages.element import descendants, label_of, metaclass_of
from mmrs_core.languages.modelset import project_files
from mmrs_core.languages.xmi.events import read_bytes
from mmrs_core.pipeline import check_models, read_models
from mmrs_core.projects import ALTITUDE
from mmrs_core.projects.building import Basis, Builder, Outcome, UniqueNames, position_of
from mmrs_core.projects.choosing import Assignment, Chooser, Decision
from mmrs_core.projects.heights import Levels, levels_at
from mmrs_core.projects.kinds import CONTEXT, MISSION, ImportKinds
from mmrs_core.projects.shapes import UnfitError, shape
from mmrs_core.projects.team import Home, RobotWanted, TypeFile, homes_for, medium_of
from mmrs_core.projects.texts import text_of, with_added

if TYPE_CHECKING:
    from mmrs_core.contributions.registry import Contributions
    from mmrs_core.languages.element import Element
    from mmrs_core.languages.modelset import ModelSet
    from mmrs_core.languages.registry import Registry

    _Create = Callable[..., Element]

_MEMBER = re.compile(r"/\w+\[\d+\]")


@dataclass(frozen=True, slots=True)
class ImportOptions:
    """What the user wants of an import.

    Attributes:
        choices: of what features become; of those that fit one, the last counts.
        robots: of the team; those that an existing project has are there already.
        types: robot types by name.
        altitude: height above the origin of tasks that are drawn without one, for robots that fly; metres.
        simplify: metres by which simplified borders may be off; None: none is simplified.
        title: name of a new mission.
        complete: sets what else a new mission and its context begin with; returns comments on elements.
    """

    choices: tuple[Assignment, ...] = ()
    robots: tuple[RobotWanted, ...] = ()
    types: Mapping[str, TypeFile] = field(default_factory=dict)
    altitude: float = ALTITUDE
    simplify: float | None = None
    title: str = ""
    complete: Callable[[Element, Element, Registry], Mapping[Element, str]] | None = None


@dataclass(frozen=True, slots=True)
class ImportResult:
    """What an import makes; nothing is written yet.

    Attributes:
        outcomes: one for each feature, in their order, then one for all else that was left out.
        files: the whole content of each file that is to be written.
        diagnostics: of the project; those of imported elements have the lines of features.
        notes: on the whole.
        models: as the files will hold them; None where no mission can be read.
    """

    outcomes: tuple[Outcome, ...]
    files: Mapping[Path, bytes]
    diagnostics: tuple[Diagnostic, ...]
    notes: tuple[str, ...]
    models: ModelSet | None = None


class ImportRefusedError(UsageError):
    """Features that cannot be imported as they are to be.

    Attributes:
        result: what all features would become; without files.
    """

    def __init__(self, faults: tuple[str, ...], result: ImportResult) -> None:
        super().__init__("not imported", faults)
        self.result = result


@dataclass(slots=True)
class _Project:
    """A project in memory: a new one, or one with its files.

    Attributes:
        texts: what files hold now, by file.
        known: the faults that it has already.
    """

    mission: Element
    context: Element
    files: dict[str, Path]
    robots: tuple[Path, ...] = ()
    types: Mapping[str, Element] = field(default_factory=dict)
    texts: Mapping[Path, bytes] = field(default_factory=dict)
    known: frozenset[tuple[str, str]] = frozenset()


def decided(
    features: Sequence[MapFeature], options: ImportOptions, kinds: ImportKinds
) -> tuple[tuple[Decision, ...], tuple[str, ...]]:
    """Return what each feature becomes, and which choices of mapping files match none.

    Raises:
        UsageError: if a choice is wrong, or one that must match something does not.
    """
    chooser = Chooser(kinds, options.choices, [each.where for each in options.robots if each.where])
    decisions = tuple(map(chooser.decide, features))
    unmatched = [(choice, f"{choice.source}: {reason}") for choice, reason in chooser.unmatched()]
    wrong = [words for choice, words in unmatched if choice.strict]
    if wrong:
        names = sorted({each.name for each in features if each.name})
        known = f"; there are {', '.join(names[:20])}{', …' if len(names) > 20 else ''}" if names else ""
        raise UsageError(f"{wrong[0]}{known}", wrong if len(wrong) > 1 else ())
    return decisions, tuple(words for choice, words in unmatched if not choice.strict)


def imported(
    features: Sequence[MapFeature],
    left_out: Sequence[LeftOut],
    options: ImportOptions,
    contributions: Contributions,
    folder: Path,
    *,
    into: bool = False,
) -> ImportResult:
    """Return what features become in a project, and its files.

    Args:
        folder: of the project; with `into` an existing one, or its mission file.

    Raises:
        UsageError: if choices or robots are wrong.
        ImportRefusedError: if attributes are missing or wrong, or an obstacle cannot be imported.
        InvalidModelError: if the project that is to be added to cannot be read, or has no place on the Earth.
    """
    kinds = ImportKinds(contributions)
    lost = [each for each in left_out if each.lost is not None]
    decisions, notes = decided((*features, *(each.lost for each in lost if each.lost)), options, kinds)
    decisions, meant = decisions[: len(features)], decisions[len(features) :]
    drawn = [each for each, decision in zip(features, decisions, strict=True) if decision.kind.name == "home"]
    fine = [each for each in drawn if not _unfit(each)]
    homes = homes_for(options.robots, fine)
    project = _opened(folder, contributions) if into else _blank(folder, options, contributions)
    levels = _levels(project) if into else _new_levels(project.mission, homes)
    names = UniqueNames(
        label_of(each) for root in (project.mission, project.context) for each in descendants(root)
    )
    languages = contributions.languages
    around = _surroundings(project, levels, homes, options, contributions)
    builder = Builder(project.mission, project.context, languages, names, around)
    if not into and options.complete is not None:
        builder.comments |= options.complete(project.mission, project.context, languages)
    team = project.mission.team  # type: ignore[attr-defined]  # a mission
    old = len(team.robots)
    added_types = _add_robots(project, homes, options, builder, names, languages.create)
    outcomes = _built(builder, features, decisions, team, old)
    rest = tuple(Outcome(each.what, each.place, "", reason=each.reason) for each in left_out)
    for each, decision in zip(lost, meant, strict=True):
        builder.refuse_open(
            decision.kind, each.place, each.what, each.reason, each.lost.name if each.lost else ""
        )
    if builder.faults:
        raise ImportRefusedError(tuple(builder.faults), ImportResult((*outcomes, *rest), {}, (), notes))
    ordered = _keep_order(builder, features, outcomes)
    texts = _texts(project, builder, options, languages) | added_types
    files = {file: data for file, data in texts.items() if project.texts.get(file) != data}
    models, found = _diagnosed(project, files, contributions)
    places = {each.path: each.place for each in outcomes if each.path}
    faults = [_at_source(each, places) for each in found if (each.code, each.message) not in project.known]
    notes = (*notes, *_notes(project, levels, features, ordered))
    return ImportResult((*outcomes, *rest), files, in_order(faults), notes, models)


def _unfit(feature: MapFeature) -> str:
    try:
        shape(feature, feature.geometry, None)
    except UnfitError as unfit:
        return str(unfit)
    return ""


def _blank(folder: Path, options: ImportOptions, contributions: Contributions) -> _Project:
    create = contributions.languages.create
    title = UniqueNames(()).unique(options.title, "imported mission")
    mission = create(MISSION, "Mission", name=title, team=create(MISSION, "Team"))
    context = create(CONTEXT, "Context", name=title)
    return _Project(mission, context, {"mission": folder / "mission.xmi", "context": folder / "context.xmi"})


def _opened(folder: Path, contributions: Contributions) -> _Project:
    models, faults = read_models(folder, contributions)
    if models is None:
        raise InvalidModelError(f"{folder}: cannot be added to: its mission is not readable", faults)
    mission_file, context_file, robots = project_files(folder)
    beside = context_file or mission_file.with_name(f"context{mission_file.suffix}")
    if frame_of(models.mission, models.context).latitude is None:
        words = "has no place on the Earth: give it a geographic origin, or its first robot a geographic home"
        raise InvalidModelError(f"{mission_file}: {words}")
    context = models.context or contributions.languages.create(CONTEXT, "Context")
    texts = {file: read_bytes(file) for file in (mission_file, context_file) if file is not None}
    known = frozenset((each.code, each.message) for each in (*faults, *check_models(models, contributions)))
    files = {"mission": mission_file, "context": beside}
    return _Project(models.mission, context, files, robots, models.robots, texts, known)


def _levels(project: _Project) -> Levels:
    frame = frame_of(project.mission, project.context)
    return Levels(frame.altitude_reference, frame.altitude, frame.geoid_separation)


def _new_levels(mission: Element, homes: Sequence[Home]) -> Levels:
    """Return what heights count from in a new mission: the first home."""
    first = homes[0].feature if homes else None
    height = float(first.heights[0][0]) if first is not None and first.heights else None
    levels = levels_at(first.reference, height) if first is not None else Levels()
    mission.altitudeReference = levels.reference  # type: ignore[attr-defined]  # a mission
    return levels


def _surroundings(
    project: _Project,
    levels: Levels,
    homes: Sequence[Home],
    options: ImportOptions,
    contributions: Contributions,
) -> Basis:
    frame = frame_of(project.mission, project.context)
    types = [options.types[each.robot.type].element for each in homes]
    types += [project.types[name] for name in _names_of_types(project.mission) if name in project.types]
    latitude, longitude = homes[0].position if homes else (frame.latitude, frame.longitude)
    return Basis(
        levels,
        options.altitude,
        any(medium_of(each, contributions) == "air" for each in types) if types else True,
        options.simplify,
        None if latitude is None or longitude is None else np.array([latitude, longitude]),
        {"tasks": frame.crs, "context": getattr(project.context, "crs", None) or frame.crs},
    )


def _names_of_types(mission: Element) -> list[str]:
    return [robot.type for robot in children(mission.team, "robots")]  # type: ignore[attr-defined]  # a mission


def _add_robots(
    project: _Project,
    homes: Sequence[Home],
    options: ImportOptions,
    builder: Builder,
    names: UniqueNames,
    create: _Create,
) -> dict[Path, bytes]:
    """Add robots to the team; return the files of types that the project does not have."""
    texts: dict[Path, bytes] = {}
    folder = project.files["mission"].parent / "robots"
    for home in homes:
        name = names.unique(home.robot.name, "robot")
        builder.add_robot(
            create(MISSION, "Robot", name=name, type=home.robot.type), home.position, home.feature
        )
        if home.robot.type in project.types:
            continue
        source = options.types[home.robot.type].file
        data, number, file = read_bytes(source), 1, folder / source.name
        while texts.get(file, data) != data or (file.exists() and read_bytes(file) != data):
            number += 1
            file = folder / f"{source.stem}-{number}{source.suffix}"
        texts[file] = data
    return texts


def _built(
    builder: Builder, features: Sequence[MapFeature], decisions: Sequence[Decision], team: Element, old: int
) -> list[Outcome]:
    """Return what became of each feature; areas come first, since tasks begin off those that are closed.

    Args:
        team: with the added robots behind the first `old` ones.
    """
    begin: dict[object, list[int]] = {}
    for at, robot in enumerate(team.robots):  # type: ignore[attr-defined]  # a team
        begin.setdefault(position_of(robot.home), []).append(at)
    outcomes: dict[int, Outcome] = {}
    pairs = [*zip(features, decisions, strict=True)]
    for number, (feature, decision) in sorted(
        enumerate(pairs), key=lambda each: each[1][1].kind.feature == "tasks"
    ):
        outcome = builder.build(feature, decision)
        if decision.kind.name == "home":
            unfit, (latitude, longitude) = _unfit(feature), map(float, feature.rings[0][0])
            owners = begin.get(position_of(builder.coordinate(latitude, longitude)), []) if not unfit else []
            named = [at for at in owners if at >= old] or owners
            called = ", ".join(team.robots[at].name for at in named)  # type: ignore[attr-defined]
            if named and named[0] >= old:
                outcome = replace(outcome, became="home", called=called, reason="")
            elif owners:
                outcome = replace(outcome, reason=f"it is the home of {called} already")
            else:
                unused = "no robot begins there; --robot NAME=TYPE adds one that does"
                outcome = replace(outcome, reason=unfit or unused)
        outcomes[number] = outcome
    return [outcomes[number] for number in range(len(pairs))]


def _keep_order(builder: Builder, features: Sequence[MapFeature], outcomes: Sequence[Outcome]) -> int:
    """Let tasks at consecutive waypoints of one file begin one after another; return how many do so."""
    count, before = 0, None
    for feature, outcome in zip(features, outcomes, strict=True):
        task = builder.tasks.get(outcome.path)
        if feature.role is not Role.WAYPOINT or task is None:
            continue
        if before is not None and before[0].place.file == feature.place.file:
            builder.add_order(before[1], task)
            count += 1
        before = feature, task
    return count


def _texts(
    project: _Project, builder: Builder, options: ImportOptions, registry: Registry
) -> dict[Path, bytes]:
    """Return the texts of the mission and its context, as far as there is anything in them."""
    texts: dict[Path, bytes] = {}
    for name, root in (("mission", project.mission), ("context", project.context)):
        file = project.files[name]
        added = {key: each for key, each in builder.added.items() if key in metaclass_of(root).by_name}
        if name == "mission" and "robots" in builder.added:
            added["robots"] = builder.added["robots"]
        if file in project.texts:
            texts[file] = with_added(project.texts[file], root, added, file, registry, builder.comments)
        elif name == "mission" or added or not project.texts:
            texts[file] = text_of(root, file, registry, builder.comments)
    return texts


def _diagnosed(
    project: _Project, files: Mapping[Path, bytes], contributions: Contributions
) -> tuple[ModelSet | None, tuple[Diagnostic, ...]]:
    """Return the project as it will be, and its faults."""
    robots = dict.fromkeys((*project.robots, *(file for file in files if file.parent.name == "robots")))
    context = project.files["context"]
    there = context in files or context in project.texts
    models, faults = read_models(
        project.files["mission"],
        contributions,
        context=context if there else None,
        robots=tuple(robots),
        unsaved={file.resolve(): data for file, data in files.items()},
    )
    return models, faults if models is None else (*faults, *check_models(models, contributions))


def _at_source(fault: Diagnostic, places: Mapping[str, Place]) -> Diagnostic:
    """Return a fault of an imported element with the line of the feature that it was made of."""
    found = _MEMBER.match(fault.place.path)
    place = places.get(found[0]) if found is not None else None
    return fault if place is None else replace(fault, place=place)


def _notes(project: _Project, levels: Levels, features: Sequence[MapFeature], ordered: int) -> Iterator[str]:
    origin = "the origin" if project.texts else "the first robot's home"
    yield f"heights count from {origin}; the ground is taken to be level at its height"
    if ordered:
        yield f"waypoints keep their order: {ordered} dependencies between tasks"
