"""Colours and line styles that people with any colour vision can tell apart.

The colours are those that Okabe and Ito proposed for colour-blind readers, without yellow, which is
too faint on paper. Dashes change with every robot too, so that a black-and-white print still works.
"""

from __future__ import annotations

from dataclasses import dataclass

_COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#5a4fa2", "#4d4d4d")
_DASHES = ("", "9 3", "2 3", "12 3 2 3", "6 2 2 2 2 2")


@dataclass(frozen=True, slots=True)
class Style:
    """How a robot is drawn: its colour, and its dashes as SVG writes them (empty: solid)."""

    colour: str
    dashes: str


def style_of(index: int) -> Style:
    """Return the style of the robot at that index; styles repeat after forty robots.

    >>> style_of(0).dashes, style_of(1).dashes
    ('', '9 3')
    """
    return Style(_COLOURS[index % len(_COLOURS)], _DASHES[index % len(_DASHES)])
