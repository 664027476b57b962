"""Lines up columns of words for a terminal."""

from __future__ import annotations

from collections.abc import Iterator, Sequence


def table(head: Sequence[str], rows: Sequence[Sequence[str]], *, widest: int = 200) -> Iterator[str]:
    """Yield the lines of a table; cells longer than `widest` characters are cut.

    >>> list(table(("a", "b"), [("1", "22")]))
    ['  a  b', '  1  22']
    """
    cells = [[_short(cell, widest) for cell in row] for row in (head, *rows)]
    widths = [max(len(row[column]) for row in cells) for column in range(len(head))]
    for row in cells:
        padded = (f"{cell:<{width}}" for cell, width in zip(row, widths, strict=True))
        yield ("  " + "  ".join(padded)).rstrip()


def _short(cell: str, widest: int) -> str:
    one_line = " ".join(cell.split())
    return one_line if len(one_line) <= widest else one_line[: widest - 1] + "…"
