"""Changes of models in words, and as JSON."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import groupby

from mmrs_core.cli.tree_words import title_of, value_words
from mmrs_core.languages.comparison.changes import Change, Sort
from mmrs_core.languages.comparison.features import features_of
from mmrs_core.languages.metaclass import Metaclass

_WHOLE = 60
"""Characters of a value that are told whole."""
_AROUND = 15
"""Characters told in front of and behind a difference."""
_SIGNS = {Sort.ADDED: "+", Sort.REMOVED: "-", Sort.MOVED: ">", Sort.CHANGED: "~"}
_COLOURS = {Sort.ADDED: "32", Sort.REMOVED: "31", Sort.MOVED: "36", Sort.CHANGED: "33"}


def change_lines(changes: Sequence[Change]) -> Iterator[str]:
    """Yield the lines that tell of changes: one for an element, and below it one for each of its values."""
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
    told = [f"{counts[sort.value]} {sort.value}" for sort in Sort if counts.get(sort.value)]
    return ", ".join(told) or "the models say the same"


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
