"""The writer for large models: compiled functions for what occurs often, the careful way for all else."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from pathlib import Path
from typing import NoReturn

from mmrs_core.languages.element import Element
from mmrs_core.languages.metaclass import Feature
from mmrs_core.languages.references.positions import Positions
from mmrs_core.languages.registry import Registry
from mmrs_core.languages.source import Source
from mmrs_core.languages.xmi.emitters import Emitter, Surroundings, UnusualError, emitter
from mmrs_core.languages.xmi.writer import Job, Row, XmiWriter

_OFTEN = 16
"""Compiling costs as much as writing so many elements the careful way."""


def writer_for(roots: Sequence[Element], registry: Registry, file: Path | None) -> XmiWriter:
    """Return the quicker writer, unless what the file said of single elements has to be said again."""
    sources = {root._mmrs_source for root in roots}
    home = sources.pop() if len(sources) == 1 else None
    if sources or (home is not None and (home.ids or home.blanks)):
        return XmiWriter(roots, registry, file)
    return QuickWriter(roots, registry, file, home)


class QuickWriter(XmiWriter):
    """Writes the same bytes as `XmiWriter`, at a multiple of its speed."""

    def __init__(
        self, roots: Sequence[Element], registry: Registry, file: Path | None, home: Source | None
    ) -> None:
        """Take also the source of all roots, which must know of no identifiers and no blanks."""
        super().__init__(roots, registry, file)
        self._tables: dict[Feature, _Table] = defaultdict(_Table)
        self._seen: dict[tuple[Feature, type], int] = defaultdict(int)
        self._places = Positions(roots, home, UnusualError)
        self._surroundings = Surroundings(self._lines.append, home, self._places, self._tables, self._slowly)

    def _row(self, row: Row, jobs: list[Job]) -> None:
        """Write elements until one needs the careful way; leave what follows it as jobs."""
        table, depth = self._tables[row.feature], row.depth
        for child in row.values:
            try:
                table[child.__class__](child, depth)  # type: ignore[arg-type]  # no class but of elements is there
            except (
                UnusualError,
                TypeError,
            ):  # a type that nobody expects: the careful way has the words for it
                jobs.append(row)
                self._child(row, child, jobs)
                self._notice(row.feature, child.__class__)
                return

    def _fragment(self, target: Element) -> str | None:
        try:
            return self._places[target]
        except UnusualError:
            return super()._fragment(target)

    def _slowly(self, owner: Element, feature: Feature, child: Element, depth: int) -> None:
        jobs: list[Job] = []
        self._child(Row(owner, feature, iter(()), depth), child, jobs)
        self._run(jobs)
        self._notice(feature, child.__class__)

    def _notice(self, feature: Feature, kind: type) -> None:
        """Count an element that was written the careful way; compile its class once it is worth it."""
        self._seen[feature, kind] += 1
        if (
            self._seen[feature, kind] != _OFTEN
            or not issubclass(kind, Element)
            or kind._mmrs_metaclass is None
        ):
            return
        metaclass = kind._mmrs_metaclass
        head = f"<{feature.name}"
        if metaclass is not feature.type:
            head += f' xsi:type="{self._kind(metaclass)}"'
        emit = emitter(metaclass, head, feature.name, self._surroundings)
        if emit is not None:
            self._tables[feature][kind] = emit


class _Table(dict[type, Emitter]):
    """The compiled functions of one feature; a class that has none is unusual."""

    def __missing__(self, kind: type) -> Emitter:
        return _unusual


def _unusual(element: Element, depth: int) -> NoReturn:
    raise UnusualError
