"""``mmrs diff``: what differs between two models."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from mmrs_core.cli.any_model import Metamodels, is_metamodel, is_mistake, read_foreign
from mmrs_core.cli.diff_words import change_as_json, change_lines, colour_of, summary_line
from mmrs_core.cli.metamodel import diff as between_metamodels
from mmrs_core.cli.output import report, say, say_json
from mmrs_core.cli.session import Session
from mmrs_core.cli.settings import Json, settings_of
from mmrs_core.errors import UnreadableError
from mmrs_core.languages.comparison.changes import Change, changes_between

if TYPE_CHECKING:
    from mmrs_core.languages.element import Element

_ENDINGS = (".xmi", ".json")

Pair = tuple[str, Path | None, Path | None]
"""What two files are called, and where each is, if it is there."""


def diff(
    call: typer.Context,
    before: Annotated[Path, typer.Argument(metavar="A", help="Old model, or project folder.")],
    after: Annotated[Path, typer.Argument(metavar="B", help="New model, or project folder.")],
    metamodel: Metamodels = None,
    json: Json = False,
) -> int:
    """Compare two models.

    Lists added, removed, moved and changed elements. Formatting, comments, explicit defaults and the format
    (XMI or JSON) are ignored. Two .ecore files are compared as by 'mmrs metamodel diff'. Exit codes: 0 equal,
    1 different, 3 incompletely read.

    Example: mmrs diff mission-of-yesterday.xmi mission.xmi
    """
    if is_metamodel(before) or is_metamodel(after):
        return _metamodels(call, before, after, json)
    session = Session(settings_of(call))
    found: list[tuple[str, tuple[Change, ...]]] = []
    for name, *files in _pairs(before, after):
        roots = [_roots(session, file, metamodel) for file in files]
        found.append((name, changes_between(*roots)))
    counts = Counter(change.sort.value for _, changes in found for change in changes)
    if json:
        encoded = [{"model": name, **change_as_json(each)} for name, changes in found for each in changes]
        say_json({"equal": not counts, "counts": _counts(counts), "changes": encoded})
    else:
        for name, changes in found:
            if changes and name:
                say(f"{name}:")
            for line in change_lines(changes):
                say(line, colour_of(line))
        say(summary_line(counts))
    return 1 if counts else 0


def _metamodels(call: typer.Context, before: Path, after: Path, json: bool) -> int:
    """Do what ``mmrs metamodel diff`` does."""
    if not (is_metamodel(before) and is_metamodel(after)):
        one, other = (before, after) if is_metamodel(before) else (after, before)
        raise UnreadableError(f"{one}: a metamodel, which is not compared with the model {other}")
    return between_metamodels(call, str(before), str(after), json)


def _counts(counts: Mapping[str, int]) -> Mapping[str, int]:
    return {sort: counts.get(sort, 0) for sort in ("added", "removed", "moved", "changed")}


def _pairs(before: Path, after: Path) -> Iterator[Pair]:
    """Yield the files to be compared; those of folders by their names, whatever their endings."""
    if before.is_dir() != after.is_dir():
        folder, file = (before, after) if before.is_dir() else (after, before)
        raise UnreadableError(f"{folder}: a folder, which is not compared with the file {file}")
    if not before.is_dir():
        yield "", before, after
        return
    ours, theirs = _models_in(before), _models_in(after)
    for name in sorted({*ours, *theirs}):
        yield name, ours.get(name), theirs.get(name)


def _models_in(folder: Path) -> dict[str, Path]:
    """Return the models of a project by path without ending.

    Raises:
        UnreadableError: if the folder has none.
    """
    files = sorted([*folder.glob("*.*"), *(folder / "robots").glob("*.*")])
    models = {
        file.relative_to(folder).with_suffix("").as_posix(): file
        for file in files
        if file.suffix.lower() in _ENDINGS and not file.name.startswith(".")
    }
    if not models:
        raise UnreadableError(f"{folder}: no model (*.xmi, *.json) in this folder")
    return models


def _roots(session: Session, file: Path | None, metamodels: Sequence[Path] | None) -> tuple[Element, ...]:
    if file is None:
        return ()
    model = read_foreign(session, file, metamodels).model
    report(model.diagnostics)
    if any(map(is_mistake, model.diagnostics)):
        raise UnreadableError(f"{file}: not compared, since something of it cannot be read")
    return model.roots
