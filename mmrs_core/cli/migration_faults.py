"""What is wrong with migrated models, with what belongs to them in their folders."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TypeVar

from mmrs_core.analysis.constraints import check_behaviour, check_constraints
from mmrs_core.contributions.registry import Contributions
from mmrs_core.diagnostics import Diagnostic, in_order
from mmrs_core.languages import behaviour, context, mission, robot
from mmrs_core.languages.conformance import check_conformance
from mmrs_core.languages.element import Element
from mmrs_core.languages.modelset import ModelSet, context_in, robot_files_in
from mmrs_core.languages.reading import read_model

Root = TypeVar("Root", bound=Element)

_ROBOTS = "robots"


def faults_in(files: Iterable[Path], contributions: Contributions) -> tuple[Diagnostic, ...]:
    """Return every fault of models that were written, and of the robot types and contexts beside them.

    A context or robot type is judged also where no mission stands in its folder.
    """
    projects: dict[Path, list[Path]] = {}
    for file in files:
        folder = file.parent.parent if file.parent.name == _ROBOTS else file.parent
        projects.setdefault(folder, []).append(file)
    found = (
        fault
        for folder, own in projects.items()
        for fault in _faults_of(_with_rest(folder, own), contributions)
    )
    return in_order(found)


def _with_rest(folder: Path, files: Iterable[Path]) -> list[Path]:
    place = context_in(folder)
    return list(dict.fromkeys((*files, *robot_files_in(folder / _ROBOTS), *([place] if place else []))))


def _faults_of(files: Iterable[Path], contributions: Contributions) -> Iterator[Diagnostic]:
    registry = contributions.languages
    models = [read_model(file, registry) for file in files]
    for model in models:
        yield from model.diagnostics
        yield from check_conformance(model, registry)
    roots = [root for model in models for root in model.roots]
    place = next(iter(_of(roots, context.Context)), None)
    types = {each.name or "": each for each in _of(roots, robot.Robot)}
    # without a mission, a blank one carries the rest; its own faults do not count
    for each in _of(roots, mission.Mission) or [mission.Mission()]:
        checked = check_constraints(
            ModelSet(each, place, types, tuple(models)), contributions.constraints, registry
        )
        yield from (fault for fault in checked if fault.place.file)
    for program in _of(roots, behaviour.Behaviour):
        yield from check_behaviour(program, contributions.constraints, registry, robots=types, place=place)


def _of(roots: Iterable[Element], kind: type[Root]) -> list[Root]:
    return [root for root in roots if isinstance(root, kind)]
