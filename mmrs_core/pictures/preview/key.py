"""Lists the signs of a map with their meanings, for its key on a page and its legend as a picture."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

from mmrs_core.contributions.symbols import MapSymbol
from mmrs_core.pictures.palette import Style, style_of
from mmrs_core.pictures.preview.labels import shortened, width_of
from mmrs_core.pictures.preview.picture import Picture

_ROW = 24.0
_SAMPLE = 34.0
_GAP = 22.0
_MARGIN = 18.0
_MOST_GAPS = 200
_MOST_BENEATH = 12
"""Gaps that a page lists, and the legend of a picture."""
_PLANNED_SIGNS = (
    ("work", "thick line: task"),
    ("transit", "thin line: transit"),
    ("action", "dot: device action"),
    ("stay", "ring: stays here"),
)
_SIGNS = (
    ("home", "home"),
    ("forbidden", "forbidden area"),
    ("obstacle", "obstacle"),
    ("kept", "clearance"),
    ("emergency", "emergency area"),
)
_RANGE_SIGNS = (("range", "radio range"),)
_FLOWN_SIGNS = (
    ("planned", "pale: as planned"),
    ("response", "dotted: off-plan"),
    ("photo", "photo"),
    ("missing", "photo not confirmed"),
    ("fault", "fault"),
)


class KeyEntry(NamedTuple):
    """A sign and its meaning: `sample` names what the template draws, which may need a style or symbol."""

    sample: str
    words: str
    style: Style | None = None
    symbol: MapSymbol | None = None


@dataclass(frozen=True, slots=True)
class Legend:
    """What is placed beneath a map, in pixels from its upper edge: (x, y, entry), and lines of (y, words)."""

    height: float
    entries: tuple[tuple[float, float, KeyEntry], ...]
    lines: tuple[tuple[float, str], ...]


def key_of(picture: Picture) -> tuple[KeyEntry, ...]:
    """Return the signs of a map and the symbols that it shows; robots are listed elsewhere on a page."""
    planned, flown = _PLANNED_SIGNS if picture.planned else (), _FLOWN_SIGNS if picture.flown else ()
    ranges = _RANGE_SIGNS if picture.ranges else ()
    signs = (*planned, *_SIGNS, *ranges, *flown)
    problems = [KeyEntry("problem", "problem, by its number")] if picture.problems else []
    if any(gap.drawn for gap in picture.gaps):
        problems.append(KeyEntry("incomplete", "incomplete"))
    symbols = (KeyEntry("badge", shortened(each.label), symbol=each) for each in symbols_in(picture))
    return (*(KeyEntry(sample, words) for sample, words in signs), *problems, *symbols)


def legend_of(picture: Picture, width: float) -> Legend:
    """Return the legend of a picture that stands alone: robots, signs and symbols, in rows that wide."""
    robots = (
        KeyEntry("robot", shortened(robot.name), style_of(index))
        for index, robot in enumerate(picture.robots)
    )
    placed: list[tuple[float, float, KeyEntry]] = []
    x, row = _MARGIN, 0
    for entry in (*robots, *key_of(picture)):
        needed = _SAMPLE + 8 + width_of(entry.words) + _GAP
        if x > _MARGIN and x + needed > width:
            x, row = _MARGIN, row + 1
        placed.append((x, _MARGIN / 2 + (row + 0.5) * _ROW, entry))
        x += needed
    below = _MARGIN + _ROW * (row + 1)
    longest = int((width - 2 * _MARGIN) / width_of("m"))
    lines = [shortened(words, longest) for words in gaps_in_words(picture, _MOST_BENEATH)]
    return Legend(
        below + _ROW * len(lines),
        tuple(placed),
        tuple((below + _ROW * index, words) for index, words in enumerate(lines)),
    )


def gaps_in_words(picture: Picture, most: int = _MOST_GAPS) -> list[str]:
    """Return a line for each gap of a picture: so many at most, and how many more there are."""
    more = len(picture.gaps) - most
    lines = [
        f"{'incomplete' if gap.drawn else 'not drawn'}: {gap.what}"
        + (f" ({gap.source})" if gap.source else "")
        + f": {gap.reason}"
        for gap in picture.gaps[:most]
    ]
    return [*lines, f"and {more} more"] if more > 0 else lines


def symbols_in(picture: Picture) -> tuple[MapSymbol, ...]:
    """Return the symbols of the tasks and elements that have a position, each once, tasks' first."""
    return tuple(dict.fromkeys(_symbols(picture)))


def _symbols(picture: Picture) -> Iterator[MapSymbol]:
    for task in picture.tasks:
        if task.drawn:
            yield task.symbol
    for element in picture.elements:
        if element.points:
            yield element.symbol
