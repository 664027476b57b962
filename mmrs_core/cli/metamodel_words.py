"""What differs between two versions of a metamodel, in words."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from mmrs_core.cli.output import counted
from mmrs_core.languages.evolution.effects import Difference, Effect
from mmrs_core.languages.evolution.migration import Migration

_SIGNS = {"added": "+", "removed": "-", "changed": "~"}
_COLOURS = {Effect.COMPATIBLE: "32", Effect.MEANING: "33", Effect.INCOMPATIBLE: "31"}


def difference_lines(found: Sequence[Difference]) -> Iterator[tuple[str, str]]:
    """Yield a line for each difference, with its colour."""
    for each in found:
        verdict = f"{each.verdict.value}: {each.reason}" if each.reason else each.verdict.value
        yield f"{_SIGNS[each.sort]} {each.what}: {each.words} ({verdict})", _COLOURS[each.verdict]


def verdict_line(found: Sequence[Difference], chain: Sequence[Migration]) -> str:
    """Return whether old models still load.

    >>> verdict_line([], [])
    'nothing differs for models: old models load'
    """
    bad = sum(each.verdict is Effect.INCOMPATIBLE for each in found)
    doubtful = sum(each.verdict is Effect.MEANING for each in found)
    way = f", by {counted(len(chain), 'migration')}" if chain else ""
    if bad:
        unless = "; a function of a migration may see to it" if any(step.rewrite for step in chain) else ""
        return f"{counted(bad, 'incompatible change')}: not all old models load{way}{unless}"
    if doubtful:
        return f"old models load{way}, but {counted(doubtful, 'change')} may give them another meaning"
    return f"old models load{way}" if found else "nothing differs for models: old models load"
