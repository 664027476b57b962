"""``mmrs validate --fix``: shows what quick fixes would change, asks, and changes it."""

from __future__ import annotations

import difflib
import sys
from collections.abc import Container, Iterable, Iterator
from typing import TYPE_CHECKING

import typer

from mmrs_core.analysis.fixes.repair import Diagnose, FileChange, Proposal, Repair, Repairer
from mmrs_core.cli.output import counted, say, tell
from mmrs_core.cli.protection import ProtectedError
from mmrs_core.errors import UnreadableError
from mmrs_core.languages.writing import replace_files

if TYPE_CHECKING:
    from mmrs_core.contributions.registry import Contributions
    from mmrs_core.languages.model import Model

_COLOURS = {"+": "32", "-": "31", "@": "36"}


def repairer_for(contributions: Contributions, diagnose: Diagnose) -> Repairer:
    """Return what finds and tries the quick fixes of all plug-ins."""
    return Repairer(contributions.fixes, contributions.languages, _names_of_checks(contributions), diagnose)


def _names_of_checks(contributions: Contributions) -> Iterator[str]:
    """Yield them; the checks are imported only when a fix asks."""
    for check in contributions.checks:
        yield check.name


def refuse_foreign(models: Iterable[Model]) -> None:
    """Report models of another dialect, whose files are not fixed.

    Raises:
        ProtectedError: if all are.
    """
    models = tuple(models)
    refused = [
        f"{model.file}: a model of {model.importer.name}, which cannot be fixed; "
        f"{model.importer.advice}, which can be fixed"
        for model in models
        if model.importer
    ]
    if refused and len(refused) == len(models):
        raise ProtectedError(refused[0])
    for words in refused:
        tell(words)


def difference(changes: Iterable[FileChange]) -> str:
    """Return a unified diff of all changes, as ``patch -p1`` takes it; empty if there are none."""
    return "".join(line for change in changes for line in _lines(change))


def _lines(change: FileChange) -> Iterator[str]:
    before, after = (text.decode("utf-8").splitlines(keepends=True) for text in (change.before, change.after))
    name = change.name.lstrip("/")
    for line in difflib.unified_diff(before, after, f"a/{name}", f"b/{name}"):
        yield line if line.endswith("\n") else f"{line}\n\\ No newline at end of file\n"


def show(repair: Repair, fixable: Container[str]) -> None:
    """Print the diff, the problems it fixes, and those it does not fix.

    Args:
        fixable: codes that have a quick fix.
    """
    for line in difference(repair.changes).splitlines():
        heading = line.startswith(("+++", "---"))
        say(line, "1" if heading else _COLOURS.get(line[:1], ""))
    for proposal in repair.applied:
        say(f"{proposal.fault.place}: {proposal.title} [{proposal.fault.code}]")
    for proposal in repair.refused:
        tell(f"{_where(proposal)}: not fixed: {proposal.objection} [{proposal.fault.code}]")
    refused = {proposal.fault for proposal in repair.refused}
    foreign = {str(model.file) for model in repair.diagnosis.models if model.importer}
    for fault in repair.diagnosis.faults:
        if fault.code in fixable and fault not in refused and fault.place.file not in foreign:
            tell(f"{fault.place}: not fixed: several fixes are possible [{fault.code}]")


def _where(proposal: Proposal) -> str:
    return f"{proposal.fault.place}: {proposal.title}"


def agreed(repair: Repair, *, yes: bool, dry_run: bool) -> bool:
    """Return whether to make the changes; ask on a terminal."""
    if dry_run or not repair.changes:
        return False
    if yes:
        return True
    if not (sys.stdin.isatty() and sys.stdout.isatty()):
        tell("nothing is changed: there is no terminal to ask on; --yes changes it without asking")
        return False
    return typer.confirm(f"change {counted(len(repair.changes), 'file')}?", default=False, err=True)


def write(repair: Repair) -> None:
    """Make all changes, or none.

    Raises:
        UnreadableError: if a file was changed since it was examined; nothing is changed.
        OSError: if a file cannot be written; all are as they were before.
    """
    for change in repair.changes:
        if change.file.read_bytes() != change.before:
            raise UnreadableError(f"{change.name}: was changed meanwhile; nothing was fixed")
    replace_files({change.file: change.after for change in repair.changes})
