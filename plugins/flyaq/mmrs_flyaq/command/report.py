"""The report of a migration: what became of each file and value, and whether the result is valid."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

from mmrs_core.analysis.fixes.repair import Diagnosis
from mmrs_core.cli.diagnosing import Subject, diagnosed_parts
from mmrs_core.cli.output import counted
from mmrs_core.cli.session import Session
from mmrs_core.diagnostics import Diagnostic, has_errors
from mmrs_core.errors import InvalidModelError, UnreadableError
from mmrs_core.languages import behaviour, robot
from mmrs_core.languages.codes import is_refusal
from mmrs_core.languages.element import Element
from mmrs_core.languages.modelset import context_in, model_in
from mmrs_core.languages.references.project import robot_files_in
from mmrs_flyaq.findings import Category, Finding, grouped
from mmrs_flyaq.migrate import Migration

Root = TypeVar("Root", bound=Element)

_ROBOTS = "robots"


@dataclass(frozen=True, slots=True)
class Verdict:
    """The validity of a folder or of a behaviour.

    Attributes:
        path: what ``mmrs validate`` is to be called with.
        alone: whether it is robot types and a context only, which make no mission yet.
        unreadable: why it cannot be judged; empty where it can.
        missing: the robot types that a behaviour names and that are not beside it.
    """

    path: Path
    valid: bool
    faults: tuple[Diagnostic, ...] = ()
    alone: bool = False
    unreadable: str = ""
    missing: tuple[str, ...] = ()

    @property
    def word(self) -> str:
        """The verdict, as ``mmrs validate`` words it."""
        known = "not valid" if self.is_read else "incompletely read"
        return "valid" if self.valid else known

    @property
    def is_read(self) -> bool:
        """Whether all that belongs to it could be read."""
        return not (self.unreadable or any(map(is_refusal, self.faults)))


def verdicts_on(files: Iterable[Path], session: Session) -> tuple[Verdict, ...]:
    """Return what is to be said of the folders that models were written to, and of every behaviour there."""
    folders: dict[Path, list[Path]] = {}
    for file in files:
        folder = file.parent.parent if file.parent.name == _ROBOTS else file.parent
        folders.setdefault(folder, []).append(file)
    return tuple(verdict for folder, own in folders.items() for verdict in _of_folder(folder, own, session))


def _of_folder(folder: Path, files: Sequence[Path], session: Session) -> Iterator[Verdict]:
    behaviours = [file for file in files if file.stem == "behaviour"]
    try:
        if model_in(folder, "mission") is not None:
            yield _judged(Subject(session, folder))
        elif len(behaviours) < len(files) or not behaviours:
            faults = diagnosed_parts(session, _with_rest(folder, files), {}).faults
            yield Verdict(folder, not has_errors(faults), faults, alone=True)
        for file in behaviours:
            yield _judged(Subject(session, file))
    except UnreadableError as fault:
        yield Verdict(folder, valid=False, unreadable=str(fault))


def _judged(subject: Subject) -> Verdict:
    try:
        found = subject.diagnose({})
    except InvalidModelError as error:
        return Verdict(subject.file, valid=False, faults=error.diagnostics)
    valid = found.complete and not has_errors(found.faults)
    return Verdict(subject.file, valid, found.faults, missing=tuple(_missing(found)))


def _missing(found: Diagnosis) -> Iterator[str]:
    """Yield the names of the robot types that a behaviour names and that are unknown."""
    known = {each.name for each in found.robots if isinstance(each, robot.Robot)}
    programs = _of((root for model in found.models for root in model.roots), behaviour.Behaviour)
    named = dict.fromkeys(each.typeName or "" for program in programs for each in program.robots)
    yield from (name for name in named if name and name not in known)


def _with_rest(folder: Path, files: Iterable[Path]) -> list[Path]:
    place = context_in(folder)
    rest = (*robot_files_in(folder / _ROBOTS), *([place] if place else []))
    return [file for file in dict.fromkeys((*files, *rest)) if file.stem != "behaviour"]


def _of(roots: Iterable[Element], kind: type[Root]) -> list[Root]:
    return [root for root in roots if isinstance(root, kind)]


_WORDS = {
    Category.LOST: "not carried over",
    Category.DOUBTFUL: "doubtful: look at it",
    Category.CHANGED: "changed in meaning or unit",
    Category.DEFAULTED: "defaulted, because the source does not say it",
}


def migration_lines(migration: Migration, project: Path) -> Iterator[str]:
    """Yield the report of a migration; every finding is in it."""
    for source in migration.sources:
        found = ", ".join(str(file) for file in source.metamodels.values())
        yield f"{source.file}: {source.what}" + (f" (by {found})" if found else "")
    groups = grouped(migration.findings)
    for category in Category:
        own = [group for group in groups if group.category is category]
        if own:
            yield ""
            yield f"{_WORDS[category]} ({counted(sum(len(group.findings) for group in own), 'value')}):"
            for group in own:
                yield f"  {group.reason}"
                yield from (f"    {line}" for line in _places(group.findings))
    yield ""
    for output in migration.outputs:
        yield f"written: {project / output.path} (from {', '.join(output.sources)})"


def verdict_lines(verdicts: Sequence[Verdict]) -> Iterator[str]:
    """Yield whether what was written is valid, and what a behaviour still needs to be run.

    Of valid robot types beside a behaviour, the line of the behaviour says enough.
    """
    judged = {verdict.path.parent for verdict in verdicts if not verdict.alone}
    for verdict in verdicts:
        if verdict.alone and verdict.valid and verdict.path in judged:
            continue
        for name in verdict.missing:
            yield (
                f"{verdict.path}: to simulate or generate it, the robot type {name!r} is needed: migrate the"
                f" file that describes it into {verdict.path.parent}, too, write"
                f" {verdict.path.parent / 'robots' / name}.xmi, or say by --type which type is meant"
            )
        yield f"{verdict.path}: {verdict.word}{', with no mission beside it yet' * verdict.alone}"
    if not verdicts:
        yield "nothing to migrate, nothing written"


def _places(findings: Iterable[Finding]) -> Iterator[str]:
    """Yield where something happened, and to what; the same thing once for all its lines in a file."""
    lines: dict[tuple[str, str], list[Finding]] = {}
    for finding in findings:
        lines.setdefault((finding.place.file, finding.subject), []).append(finding)
    for (file, subject), same in lines.items():
        where = ",".join(str(finding.place.line) for finding in same)
        path = same[0].place.path if len(same) == 1 and same[0].place.path != "/" else ""
        yield f"{file}:{where}: {subject}" + (f", {path}" if path else "")
