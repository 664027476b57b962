"""Lines up columns of words for a terminal."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

_WIDEST = 44


def table(head: Sequence[str], rows: Sequence[Sequence[str]], indent: str = "  ") -> Iterator[str]:
    """Yield lines of a table; cells that are too long for a terminal are cut.

    >>> list(table(("a", "b"), [("1", "22")]))
    ['  a  b', '  1  22']
    """
    cells = [[_short(cell) for cell in row] for row in (head, *rows)]
    widths = [max(len(row[column]) for row in cells) for column in range(len(head))]
    for row in cells:
        padded = (f"{cell:<{width}}" for cell, width in zip(row, widths, strict=True))
        yield (indent + "  ".join(padded)).rstrip()


def _short(cell: str) -> str:
    one_line = " ".join(cell.split())
    return one_line if len(one_line) <= _WIDEST else one_line[: _WIDEST - 1] + "…"
