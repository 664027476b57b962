"""All colours of pages and pictures, for light and for dark screens.

Robots have the colours that Okabe and Ito proposed for colour-blind readers, without yellow, which is too
faint on paper. Dashes differ as well, so that a black-and-white print still works.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass

_VARIABLE = re.compile(r"var\(--([a-z0-9-]+)\)")
_DASHES = ("", "9 3", "2 3", "12 3 2 3", "6 2 2 2 2 2")
_SERIES = (
    ("#0072b2", "#3d9be0"),
    ("#d55e00", "#ff8534"),
    ("#009e73", "#1fc997"),
    ("#cc79a7", "#e39cc4"),
    ("#e69f00", "#f2b632"),
    ("#56b4e9", "#7cc9f5"),
    ("#5a4fa2", "#9d92e6"),
    ("#4d4d4d", "#b5b5b5"),
)
COLOURS: Mapping[str, tuple[str, str]] = {
    "ink": ("#20211f", "#e8e7e1"),
    "soft": ("#5b5b57", "#a9a89f"),
    "faint": ("#77776f", "#8b8a82"),
    "line": ("#dddcd3", "#3b3c38"),
    "grid": ("#e6e6df", "#35362f"),
    "paper": ("#f4f3ee", "#181917"),
    "sheet": ("#ffffff", "#222320"),
    "ground": ("#fbfbf8", "#272824"),
    "disc": ("#ffffff", "#f4f3ee"),
    "good": ("#1b7837", "#6cc28a"),
    "fair": ("#9a5b00", "#e3a548"),
    "bad": ("#b2182b", "#ff8478"),
    "forbidden": ("#b2182b", "#e4606e"),
    "forbidden-name": ("#8c1020", "#ff9d92"),
    "obstacle": ("#6b5d4f", "#a39483"),
    "obstacle-edge": ("#4a4036", "#c9bbab"),
    "emergency": ("#1b7837", "#4fae6c"),
    "emergency-name": ("#14602b", "#8fd6a6"),
    "surface": ("#2b7bba", "#5aa9e6"),
    "on-bar": ("#ffffff", "#ffffff"),
    "under-words": ("#000000b3", "#000000b3"),
    "contains": ("#0072b2", "#3d9be0"),
    "abstract": ("#f3f5ee", "#2a2c27"),
    "foreign": ("#ececea", "#303130"),
    **{f"series-{index}": pair for index, pair in enumerate(_SERIES)},
}
"""Colours by name, on light screens and paper, and on dark screens; ``var(--name)`` in style sheets."""
SYMBOL = "#3f4a3a"
"""The colour of symbols that choose none, before a dark screen lifts it."""
_LIFT = "brightness(1.9) saturate(.8)"
"""What a dark screen makes of colours that plug-ins chose for their symbols."""


@dataclass(frozen=True, slots=True)
class Style:
    """How a robot is drawn: the name of its colour, and its dashes as SVG writes them (empty: solid)."""

    colour: str
    dashes: str


def style_of(index: int) -> Style:
    """Return the style of the robot at that index; styles repeat after forty robots.

    >>> style_of(0).dashes, style_of(1)
    ('', Style(colour='series-1', dashes='9 3'))
    """
    return Style(f"series-{index % len(_SERIES)}", _DASHES[index % len(_DASHES)])


def variables() -> str:
    """Return the style sheet that defines all colours for a page, on light and on dark screens."""
    light, dark = ("".join(f"--{name}: {pair[i]}; " for name, pair in COLOURS.items()) for i in (0, 1))
    return (
        f":root {{ {light}--lift: none; }}\n"
        f"@media screen and (prefers-color-scheme: dark) {{ :root {{ {dark}--lift: {_LIFT}; }} }}\n"
    )


def fixed(sheet: str) -> str:
    """Return a style sheet with light colours in place of variables, for viewers that know no variables.

    >>> fixed("fill: var(--sheet); filter: var(--lift)")
    'fill: #ffffff; filter: none'
    """
    return _VARIABLE.sub(lambda found: "none" if found[1] == "lift" else COLOURS[found[1]][0], sheet)
