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
from mmrs_core.errors import UsageError
from mmrs_core.grounding.features import children
from mmrs_core.grounding.frame import frame_of
from mmrs_core.languages.element import descendants, label_of
from mmrs_core.languages.xmi.events import read_bytes
from mmrs_core.projects import ALTITUDE
from mmrs_core.projects.building import Builder, Outcome, UniqueNames
from mmrs_core.projects.choosing import Assignment, Chooser, Decision
from mmrs_core.projects.heights import Levels, levels_at
from mmrs_core.projects.kinds import MISSION, ImportKinds
from mmrs_core.projects.likeness import position_of
from mmrs_core.projects.placing import Basis
from mmrs_core.projects.shapes import UnfitError, shape
from mmrs_core.projects.target import ImportTarget, blank, opened
from mmrs_core.projects.team import Home, RobotWanted, TypeFile, homes_for, medium_of

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
        complete: sets what else a new mission, with its robots, and its context begin with; returns
            comments on elements.
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
        InvalidModelError: if the project that is to be added to cannot be read, or is a local one.
    """
    kinds = ImportKinds(contributions)
    lost = [each for each in left_out if each.lost is not None]
    decisions, notes = decided((*features, *(each.lost for each in lost if each.lost)), options, kinds)
    decisions, meant = decisions[: len(features)], decisions[len(features) :]
    drawn = [each for each, decision in zip(features, decisions, strict=True) if decision.kind.name == "home"]
    fine = [each for each in drawn if not _unfit(each)]
    homes = homes_for(options.robots, fine)
    target = opened(folder, contributions) if into else blank(folder, options.title, contributions)
    is_nowhere = frame_of(target.mission, target.context).latitude is None
    levels = _levels(target, homes)
    names = UniqueNames(
        label_of(each) for root in (target.mission, target.context) for each in descendants(root)
    )
    languages = contributions.languages
    around = _surroundings(target, levels, homes, options, contributions)
    builder = Builder(target.mission, target.context, languages, names, around)
    team = target.mission.team  # type: ignore[attr-defined]  # a mission
    old = len(team.robots)
    added_types = _add_robots(target, homes, options, builder, names, languages.create)
    if not into and options.complete is not None:
        completed = options.complete(target.mission, target.context, languages)
        builder.comments = {**completed, **builder.comments}
    outcomes = _built(builder, features, decisions, team, old)
    rest = tuple(Outcome(each.what, each.place, "", reason=each.reason) for each in left_out)
    for each, decision in zip(lost, meant, strict=True):
        builder.refuse_open(
            decision.kind, each.place, each.what, each.reason, each.lost.name if each.lost else ""
        )
    if builder.faults:
        raise ImportRefusedError(tuple(builder.faults), ImportResult((*outcomes, *rest), {}, (), notes))
    ordered = _keep_order(builder, features, outcomes)
    texts = added_types | target.texts_with(builder.added, languages, builder.comments)
    files = {file: data for file, data in texts.items() if target.texts.get(file) != data}
    models, found = target.diagnosed(files, contributions)
    places = {each.path: each.place for each in outcomes if each.path}
    faults = [_at_source(each, places) for each in found if (each.code, each.message) not in target.known]
    notes = (*notes, *_notes(target, homes, ordered, begun=into and is_nowhere))
    return ImportResult((*outcomes, *rest), files, in_order(faults), notes, models)


def _unfit(feature: MapFeature) -> str:
    try:
        shape(feature, feature.geometry, None)
    except UnfitError as unfit:
        return str(unfit)
    return ""


def _levels(target: ImportTarget, homes: Sequence[Home]) -> Levels:
    """Return what heights count from: the project's origin, or its first home, which begins it."""
    frame = frame_of(target.mission, target.context)
    if frame.latitude is not None:
        return Levels(frame.altitude_reference, frame.altitude, frame.geoid_separation)
    first = homes[0].feature if homes else None
    height = float(first.heights[0][0]) if first is not None and first.heights else None
    levels = levels_at(first.reference, height) if first is not None else Levels()
    if target.mission.tasks and levels.reference != frame.altitude_reference:  # type: ignore[attr-defined]
        return Levels(frame.altitude_reference, None)  # what its tasks count from is not known
    target.mission.altitudeReference = levels.reference  # type: ignore[attr-defined]  # a mission
    target.restated["altitudeReference"] = levels.reference
    return levels


def _surroundings(
    target: ImportTarget,
    levels: Levels,
    homes: Sequence[Home],
    options: ImportOptions,
    contributions: Contributions,
) -> Basis:
    frame = frame_of(target.mission, target.context)
    types = [options.types[each.robot.type].element for each in homes]
    types += [target.types[name] for name in _names_of_types(target.mission) if name in target.types]
    latitude, longitude = homes[0].position if homes else (frame.latitude, frame.longitude)
    return Basis(
        levels,
        options.altitude,
        any(medium_of(each, contributions) == "air" for each in types) if types else True,
        options.simplify,
        None if latitude is None or longitude is None else np.array([latitude, longitude]),
        {"tasks": frame.crs, "context": getattr(target.context, "crs", None) or frame.crs},
    )


def _names_of_types(mission: Element) -> list[str]:
    return [robot.type for robot in children(mission.team, "robots")]  # type: ignore[attr-defined]  # a mission


def _add_robots(
    target: ImportTarget,
    homes: Sequence[Home],
    options: ImportOptions,
    builder: Builder,
    names: UniqueNames,
    create: _Create,
) -> dict[Path, bytes]:
    """Add robots to the team; return the files of types that the project does not have."""
    texts: dict[Path, bytes] = {}
    folder = target.files["mission"].parent / "robots"
    for home in homes:
        name = names.unique(home.robot.name, "robot")
        builder.add_robot(
            create(MISSION, "Robot", name=name, type=home.robot.type), home.position, home.feature
        )
        if home.robot.type in target.types:
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
            owners = (
                begin.get(position_of(builder.placing.coordinate(latitude, longitude)), [])
                if not unfit
                else []
            )
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


def _at_source(fault: Diagnostic, places: Mapping[str, Place]) -> Diagnostic:
    """Return a fault of an imported element with the line of the feature that it was made of."""
    found = _MEMBER.match(fault.place.path)
    place = places.get(found[0]) if found is not None else None
    return fault if place is None else replace(fault, place=place)


def _notes(target: ImportTarget, homes: Sequence[Home], ordered: int, *, begun: bool) -> Iterator[str]:
    origin = "the origin" if target.texts and not begun else "the first robot's home"
    if begun and homes:
        latitude, longitude = homes[0].position
        where = f"{latitude:.7g}, {longitude:.7g}"
        yield f"the project had no place on the Earth; it gets the home of {homes[0].robot.name}: {where}"
    elif begun:
        yield "the project has no place on the Earth yet: it gets the home of its first robot"
    yield f"heights count from {origin}; the ground is taken to be level at its height"
    if ordered:
        many = "dependency" if ordered == 1 else "dependencies"
        yield f"waypoints keep their order: {ordered} {many} between tasks"
