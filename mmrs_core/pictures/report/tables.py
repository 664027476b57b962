"""Writes tables that are wide on paper and stacked on a phone."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from mmrs_core.pictures.preview.markup import element, text

MOST_ROWS = 5000
"""Rows of a table that are shown; a page of more is of no use to people."""


class Markup(str):
    """What is markup already, and not to be escaped."""

    __slots__ = ()


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a table; every cell carries the title of its column, for narrow screens."""
    listed = list(rows)
    titles = element("tr", None, (element("th", None, text(title)) for title in head))
    body = (element("tr", None, _cells(head, row)) for row in listed[:MOST_ROWS])
    more = len(listed) - MOST_ROWS
    rest = element("p", {"class": "soft"}, f"{more} more rows are in the JSON form only.") if more > 0 else ""
    return element("table", None, element("thead", None, titles), element("tbody", None, body)) + rest


def _cells(head: Sequence[str], row: Sequence[str]) -> Iterable[str]:
    for title, cell in zip(head, row, strict=True):
        shown = cell if isinstance(cell, Markup) else f"<bdi>{text(cell)}</bdi>"
        yield element("td", {"data-label": title}, shown or " ")


def badge(words: str, kind: str) -> Markup:
    """Return words as a coloured badge; `kind` is ``good``, ``fair``, ``bad`` or ``none``."""
    return Markup(element("span", {"class": f"state {kind}"}, text(words)))


def section(title: str, *inside: str, note: str = "") -> str:
    """Return a section with a title; nothing where there is nothing inside."""
    if not any(inside):
        return ""
    notes = element("p", {"class": "soft"}, text(note)) if note else ""
    return element("section", None, element("h2", None, text(title)), notes, *inside)


def folded(title: str, inside: str) -> str:
    """Return what is shown, on paper too, when somebody has asked for it."""
    return element("details", None, element("summary", None, text(title)), inside) if inside else ""
