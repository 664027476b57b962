"""``mmrs diff``: what differs between two models."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from mmrs_core.cli.any_model import Metamodels, is_metamodel, is_mistake, models_in, read_foreign
from mmrs_core.cli.metamodel import diff as between_metamodels
from mmrs_core.cli.output import report, say, say_json
from mmrs_core.cli.session import Session
from mmrs_core.cli.settings import Json, settings_of
from mmrs_core.cli.tree_words import title_of, value_words
from mmrs_core.errors import UnreadableError
from mmrs_core.languages.comparison.changes import Change, Sort, changes_between
from mmrs_core.languages.comparison.features import features_of
from mmrs_core.languages.metaclass import Metaclass

if TYPE_CHECKING:
    from mmrs_core.languages.element import Element

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
        raise UnreadableError(f"{one}: is a metamodel, {other} is a model; name two of a kind")
    return between_metamodels(call, str(before), str(after), json)


def _counts(counts: Mapping[str, int]) -> Mapping[str, int]:
    return {sort: counts.get(sort, 0) for sort in ("added", "removed", "moved", "changed")}


def _pairs(before: Path, after: Path) -> Iterator[Pair]:
    """Yield the files to be compared; those of folders by their names, whatever their endings."""
    for path in (before, after):
        if not path.exists():
            raise UnreadableError(f"{path}: no such file or folder")
    if before.is_dir() != after.is_dir():
        folder, file = (before, after) if before.is_dir() else (after, before)
        raise UnreadableError(f"{folder}: is a folder, {file} is a file; name two files or two folders")
    if not before.is_dir():
        yield "", before, after
        return
    ours, theirs = _by_name(before), _by_name(after)
    for name in sorted({*ours, *theirs}):
        yield name, ours.get(name), theirs.get(name)


def _by_name(folder: Path) -> dict[str, Path]:
    """Return the models of a project by path without ending."""
    return {file.relative_to(folder).with_suffix("").as_posix(): file for file in models_in(folder)}


def _roots(session: Session, file: Path | None, metamodels: Sequence[Path] | None) -> tuple[Element, ...]:
    if file is None:
        return ()
    model = read_foreign(session, file, metamodels).model
    report(model.diagnostics)
    if any(map(is_mistake, model.diagnostics)):
        raise UnreadableError(f"{file}: not compared, since something of it cannot be read")
    return model.roots


_WHOLE = 60
"""Characters of a value that are printed in full."""
_AROUND = 15
"""Characters told in front of and behind a difference."""
_SIGNS = {Sort.ADDED: "+", Sort.REMOVED: "-", Sort.MOVED: ">", Sort.CHANGED: "~"}
_COLOURS = {Sort.ADDED: "32", Sort.REMOVED: "31", Sort.MOVED: "36", Sort.CHANGED: "33"}


def change_lines(changes: Sequence[Change]) -> Iterator[str]:
    """Yield the lines that describe changes: one for an element, and below it one for each of its values."""
    for (_, _, is_whole), group in groupby(changes, key=lambda c: (c.before, c.after, not c.feature)):
        listed = list(group)
        if is_whole:
            yield from (_whole(change) for change in listed)
            continue
        first = listed[0]
        yield _marked(Sort.CHANGED, f"{first.after} {title_of(first.element)}")
        for change in listed:
            yield f"    {change.feature}: {_values(change)}"


def _whole(change: Change) -> str:
    where = change.after or change.before
    if change.sort is Sort.MOVED:
        where = f"{change.before} → {change.after}"
    return _marked(change.sort, f"{where} {title_of(change.element)}")


def _marked(sort: Sort, words: str) -> str:
    return f"{_SIGNS[sort]} {words}"


def colour_of(line: str) -> str:
    """Return the colour of the sign that a line begins with; empty for none."""
    return next((_COLOURS[sort] for sort, sign in _SIGNS.items() if line.startswith(f"{sign} ")), "")


def _values(change: Change) -> str:
    if change.sort is Sort.MOVED:
        return f"other order: {_joined(change.new)}"
    if change.old and change.new and len(change.old) == len(change.new) == 1:
        before, now = differing(change.old[0], change.new[0])
        return f"{value_words(before)} → {value_words(now)}"
    return f"{_stated(change, change.old)} → {_stated(change, change.new)}"


def differing(before: str, now: str) -> tuple[str, str]:
    """Return two texts; of long ones, the part in which they differ, with a little of what is around it.

    >>> differing("a" * 50 + "1" + "b" * 50, "a" * 50 + "2" + "b" * 50)
    ('…aaaaaaaaaaaaaaa1bbbbbbbbbbbbbbb…', '…aaaaaaaaaaaaaaa2bbbbbbbbbbbbbbb…')
    """
    if max(len(before), len(now)) <= _WHOLE:
        return before, now
    same = _alike(before, now)
    alike = _alike(before[same:][::-1], now[same:][::-1])
    begin = max(0, same - _AROUND)
    return _part(before, begin, len(before) - alike), _part(now, begin, len(now) - alike)


def _alike(one: str, other: str) -> int:
    """Return how many characters two texts have in common at their beginning."""
    pairs = enumerate(zip(one, other, strict=False))
    return next((place for place, (a, b) in pairs if a != b), min(len(one), len(other)))


def _part(text: str, begin: int, end: int) -> str:
    """Return a text from one place to a little behind another, cut where it is long."""
    end = min(end + _AROUND, begin + _WHOLE, len(text))
    return f"{'…' if begin else ''}{text[begin:end]}{'…' if end < len(text) else ''}"


def _stated(change: Change, values: tuple[str, ...] | None) -> str:
    if values is not None:
        return _joined(values)
    feature = features_of(change.element).get(change.feature)
    if feature is None or feature.default is None or isinstance(feature.type, Metaclass):
        return "not set"
    return f"{value_words(feature.type.render(feature.default))} (the default)"


def _joined(values: tuple[str, ...] | None) -> str:
    return ", ".join(map(value_words, values or ()))


def summary_line(counts: Mapping[str, int]) -> str:
    """Return how many changes of each sort there are.

    >>> summary_line({"added": 1, "changed": 2})
    '1 added, 2 changed'
    """
    reported = [f"{counts[sort.value]} {sort.value}" for sort in Sort if counts.get(sort.value)]
    return ", ".join(reported) or "the models say the same"


def change_as_json(change: Change) -> Mapping[str, object]:
    """Return a change as plain data."""
    line = change.element._mmrs_line
    return {
        "sort": change.sort.value,
        "element": title_of(change.element),
        "before": change.before,
        "after": change.after,
        "line": line,
        "feature": change.feature,
        "old": change.old,
        "new": change.new,
    }
