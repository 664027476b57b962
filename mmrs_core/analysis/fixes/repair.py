"""Applies quick fixes to texts, and keeps only those that make the models better."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Container, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

from mmrs_core.contributions.fixes import Edit, Fix, Wrong, with_name
from mmrs_core.diagnostics import Diagnostic, Place, Severity
from mmrs_core.errors import UnreadableError
from mmrs_core.grounding.features import child, children
from mmrs_core.languages.element import Element, Unknown
from mmrs_core.languages.json_form import is_json
from mmrs_core.languages.json_form.markup import JsonMarkup
from mmrs_core.languages.model import Model
from mmrs_core.languages.modelset import ModelSet
from mmrs_core.languages.registry import Registry
from mmrs_core.languages.xmi.events import read_bytes
from mmrs_core.languages.xmi.markup import Markup, below_root

_MOST_TRIALS = 100
"""How often a project is diagnosed again at most."""
_STEP = re.compile(r"/([^/\[\]]+)(?:\[([0-9]+)\])?")
_MEMBER = re.compile(r"[^\[]*\[[0-9]+\]")
_WITHHELD = "withheld-"
_WORSE = "the fix would cause other errors"


@dataclass(frozen=True, slots=True)
class Diagnosis:
    """All that is known of a project.

    Attributes:
        complete: whether there is a whole model to judge.
        models: every file that was read.
        project: None where there is no mission.
        robots: the robot types.
    """

    complete: bool
    faults: tuple[Diagnostic, ...]
    models: tuple[Model, ...] = ()
    project: ModelSet | None = None
    robots: tuple[Element, ...] = ()

    @property
    def wrong(self) -> tuple[Diagnostic, ...]:
        """Return the faults without the notes: fixes are judged by these."""
        return tuple(each for each in self.faults if each.severity is not Severity.NOTE)


@dataclass(frozen=True, slots=True)
class Proposal:
    """A fix of one fault, as changes of the file that the fault stands in.

    Attributes:
        objection: why it was refused; empty if it was not.
    """

    fault: Diagnostic
    title: str
    file: Path
    edits: tuple[Edit, ...]
    objection: str = ""


@dataclass(frozen=True, slots=True)
class FileChange:
    """What a file holds, and what it is to hold; ``name`` is what the user calls it."""

    name: str
    file: Path
    before: bytes
    after: bytes


@dataclass(frozen=True, slots=True)
class Repair:
    """What fixes came to.

    Attributes:
        changes: of files, by name.
        texts: what files are to hold, by real path.
        applied: what was fixed, in order.
        refused: what was not, each with its objection.
        diagnosis: what is left.
    """

    changes: tuple[FileChange, ...]
    texts: Mapping[Path, bytes]
    applied: tuple[Proposal, ...]
    refused: tuple[Proposal, ...]
    diagnosis: Diagnosis


Diagnose = Callable[[Mapping[Path, bytes]], Diagnosis]
"""Reads and checks the project, with other texts for some of its files."""


class Repairer:
    """Finds and tries fixes.

    Args:
        fixes: by code.
        checks: names of all checks of behaviours; asked for when there is something to fix.
    """

    def __init__(
        self, fixes: Mapping[str, Fix], registry: Registry, checks: Iterable[str], diagnose: Diagnose
    ) -> None:
        self._fixes = fixes
        self._registry = registry
        self._named = checks
        self._diagnose = diagnose

    @cached_property
    def _checks(self) -> tuple[str, ...]:
        return tuple(self._named)

    def proposals(
        self, diagnosis: Diagnosis, texts: Mapping[Path, bytes] | None = None
    ) -> Iterator[Proposal]:
        """Yield the fixes of faults that have one.

        Args:
            texts: what files are to hold, where they hold something else.
        """
        files = {str(model.file): model for model in diagnosis.models if isinstance(model.file, Path)}
        markups: dict[Path, Markup | None] = {}
        found: dict[tuple[str, Place], tuple[Edit, ...]] = {}
        for fault in diagnosis.faults:
            fix, model = self._fixes.get(fault.code), files.get(fault.place.file)
            if fix is None or model is None or model.importer:
                continue  # what an imported element became has no text of its own to be fixed
            file = Path(fault.place.file).resolve()
            if file not in markups:
                markups[file] = _markup(file, texts or {})
            about = fault.code, fault.place
            if about not in found:
                found[about] = self._edits(fix, fault, model, markups[file], diagnosis)
            if found[about]:
                yield Proposal(fault, fix.title, file, found[about])

    def _edits(
        self, fix: Fix, fault: Diagnostic, model: Model, markup: Markup | None, diagnosis: Diagnosis
    ) -> tuple[Edit, ...]:
        tag = markup.at(fault.place.path, fault.place.line) if markup is not None else None
        if markup is None or tag is None:
            return ()
        element = _element(model, fault.place.path)
        wrong = Wrong(
            fault, element, tag, markup, self._registry, diagnosis.project, diagnosis.robots, self._checks
        )
        return tuple(dict.fromkeys(fix.edits(wrong)))

    def repair(self, now: Diagnosis, unsaved: Mapping[Path, bytes] | None = None) -> Repair:
        """Return what the project's files are to hold so that they have fewer faults, and no new ones.

        Args:
            now: the diagnosis of the files as they are.
            unsaved: what files hold that are not saved yet, by real path.
        """
        texts = dict(unsaved or {})
        applied: list[Proposal] = []
        refused: dict[tuple[str, str], Proposal] = {}
        trials = 0
        while trials < _MOST_TRIALS:
            found = [each for each in self.proposals(now, texts) if _key(each.fault) not in refused]
            # what hides a part of the model comes first: the part may have faults of its own
            wanted = [each for each in found if _is_reading(each.fault)] or found
            if not wanted:
                break
            pending = [wanted]
            while pending and trials < _MOST_TRIALS:
                batch, trials = pending.pop(), trials + 1
                tried = self._tried(now, texts, batch)
                if not isinstance(tried, str):
                    now, texts = tried
                    applied += batch
                    break  # what else was proposed may stand in another place now
                half = len(batch) // 2
                if half:
                    pending += [batch[half:], batch[:half]]
                else:
                    refused[_key(batch[0].fault)] = replace(batch[0], objection=tried)
        changes = tuple(_changes(texts, now))
        return Repair(changes, texts, tuple(applied), tuple(refused.values()), now)

    def _tried(
        self, now: Diagnosis, texts: Mapping[Path, bytes], batch: Sequence[Proposal]
    ) -> tuple[Diagnosis, dict[Path, bytes]] | str:
        """Return what holds after some fixes; why not, if it is not better than before."""
        after = _edited(texts, batch)
        then = self._diagnosed(after)
        if after is None or then is None or not _is_better(now, then, batch):
            return _WORSE
        elsewhere = _vanished_elsewhere(now, then, batch)
        if elsewhere:
            without = self._diagnosed(_edited(texts, batch, withheld=True))
            # what is there without these values does not stem from them
            hidden = [each for each in elsewhere if without is None or _stays(each, without)]
            if hidden:
                return f"that would hide {hidden[0].code} at {hidden[0].place}, and not fix it"
        return then, after

    def _diagnosed(self, texts: Mapping[Path, bytes] | None) -> Diagnosis | None:
        try:
            return self._diagnose(texts) if texts is not None else None
        except UnreadableError:
            return None


def _edited(
    texts: Mapping[Path, bytes], batch: Iterable[Proposal], *, withheld: bool = False
) -> dict[Path, bytes] | None:
    """Return texts after some fixes, or without the values that these would change; None if that fails."""
    wanted: dict[Path, set[Edit]] = {}
    for each in batch:
        wanted.setdefault(each.file, set()).update(each.edits)
    after = dict(texts)
    for file, edits in wanted.items():
        if withheld:
            edits = set(_withholding(_markup(file, texts), edits))
        changed = with_edits(after[file] if file in after else read_bytes(file), edits)
        if changed is None:
            return None
        after[file] = changed
    return after


def _withholding(markup: Markup | None, edits: Iterable[Edit]) -> Iterator[Edit]:
    """Yield edits so that attributes which are to get other values have names that no metaclass knows."""
    values = {each.begin: each for each in edits}
    for tag in markup.root.everything() if markup is not None else ():
        for attribute in tag.attributes:
            if values.pop(attribute.value_begin, None) is not None:
                yield with_name(attribute, f"{_WITHHELD}{attribute.name}")
    yield from values.values()


def line_ending_of(data: bytes) -> bytes:
    """Return the line ending of a text; that of Unix where it has several, or none."""
    return b"\r\n" if 0 < data.count(b"\r\n") == data.count(b"\n") else b"\n"


def with_edits(data: bytes, edits: Iterable[Edit]) -> bytes | None:
    """Return a text with other parts, in its line endings; None if two edits get into each other's way."""
    ending, parts, end = line_ending_of(data), [], 0
    for edit in sorted(edits):
        if edit.begin < end:
            return None
        text = edit.text.encode().replace(b"\r\n", b"\n").replace(b"\n", ending)
        parts += [data[end : edit.begin], text]
        end = edit.end
    return b"".join((*parts, data[end:]))


def _markup(file: Path, texts: Mapping[Path, bytes]) -> Markup | None:
    """Return the markup of a file; None for what is not in UTF-8."""
    parse = JsonMarkup if is_json(file.name) else Markup
    try:
        return parse(texts[file] if file in texts else read_bytes(file), str(file))
    except UnreadableError:
        return None


def _element(model: Model, path: str) -> Element | None:
    for number, root in enumerate(model.roots):
        element: Element | None = root
        for step in _STEP.finditer(below_root(path, number)):
            element = _inside(element, step[1], step[2]) if element is not None else None
        if element is not None and not isinstance(element, Unknown):
            return element
    return None


def _inside(element: Element, name: str, index: str | None) -> Element | None:
    if index is None:
        return child(element, name)
    inside = children(element, name)
    return inside[int(index)] if int(index) < len(inside) else None


def _is_reading(fault: Diagnostic) -> bool:
    return fault.code.startswith("XMI")


def _key(fault: Diagnostic) -> tuple[str, str]:
    """Return what makes a fault the same before and after: lines and counts may change."""
    return fault.code, f"{fault.place.file}{fault.place.path}: {fault.message}"


def _is_better(before: Diagnosis, after: Diagnosis, fixed: Sequence[Proposal]) -> bool:
    """Return whether faults have gone and no error has come; fixing what hides a part may uncover others."""
    left = Counter(map(_key, after.faults))
    if after.complete < before.complete or any(left[_key(each.fault)] for each in fixed):
        return False
    if all(_is_reading(each.fault) for each in fixed):
        lines = {(each.fault.place.file, each.fault.place.line) for each in fixed}
        return _on_lines(after.faults, lines) <= _on_lines(before.faults, lines)
    known = {(each.code, each.place.file, each.place.path) for each in before.faults}
    errors = (each for each in after.faults if each.severity is Severity.ERROR)
    worse = any((each.code, each.place.file, each.place.path) not in known for each in errors)
    return not worse and len(after.wrong) < len(before.wrong)


def _vanished_elsewhere(before: Diagnosis, after: Diagnosis, fixed: Sequence[Proposal]) -> list[Diagnostic]:
    """Return the faults that are gone though they were not fixed, and are in none of the fixed elements.

    Text that could not be read is fixed by being read: others were judged without it.
    """
    if all(_is_reading(each.fault) for each in fixed):
        return []
    faults = {each.fault for each in fixed}
    changed = {_owner(each) for each in faults}
    return [
        each
        for each in before.wrong
        if each not in faults and _owner(each) not in changed and not _stays(each, after)
    ]


def _owner(fault: Diagnostic) -> tuple[str, str]:
    """Return the file, and the first member of a list on the path: the task, the robot, the area."""
    found = _MEMBER.match(fault.place.path)
    return fault.place.file, found[0] if found else fault.place.path


def _stays(fault: Diagnostic, after: Diagnosis) -> bool:
    """Return whether a fault is still there: its place and its figures may have changed."""
    return any(
        (each.code, each.place.file) == (fault.code, fault.place.file)
        and (each.place.path == fault.place.path or each.message == fault.message)
        for each in after.faults
    )


def _on_lines(faults: Iterable[Diagnostic], lines: Container[tuple[str, int]]) -> int:
    return sum(_is_reading(each) and (each.place.file, each.place.line) in lines for each in faults)


def _changes(texts: Mapping[Path, bytes], diagnosis: Diagnosis) -> Iterator[FileChange]:
    files = (model.file for model in diagnosis.models if isinstance(model.file, Path))
    names = {file.resolve(): str(file) for file in files}
    for file, after in sorted(texts.items()):
        before = read_bytes(file)
        if before != after:
            yield FileChange(names.get(file, str(file)), file, before, after)
