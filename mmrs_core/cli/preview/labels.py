"""Places words on a picture so that they do not cover each other."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

from mmrs_core.cli.preview.markup import element, text, title
from mmrs_core.scene import Point

FONT = 12.0
_WIDTH_OF_A_LETTER = 0.58
_LONGEST = 34
_STEP = FONT * 1.25


def shortened(words: str, longest: int = _LONGEST) -> str:
    """Return the words, cut with an ellipsis where they are too long."""
    return words if len(words) <= longest else words[: longest - 1] + "…"


def width_of(words: str, size: float = FONT) -> float:
    """Return about how many pixels wide words are."""
    return len(words) * size * _WIDTH_OF_A_LETTER


@dataclass(slots=True)
class Labels:
    """Words placed so far, within a picture of that width in pixels."""

    width: float
    _taken: list[tuple[float, float, float, float]] = field(default_factory=list)
    _markup: list[str] = field(default_factory=list)

    def keep_off(self, at: Point, reach: float) -> None:
        """Keep later words off a square around a point."""
        self._taken.append((at[0] - reach, at[1] - reach, at[0] + reach, at[1] + reach))

    def put(self, words: str, at: Point, kind: str, *, colour: str | None = None, tip: str = "") -> None:
        """Place words centred near a point: where they cover nothing, as near as can be."""
        shown = shortened(words)
        half = width_of(shown) / 2
        places = [self._inside(place, half) for place in _places(at, half)]
        x, y = next((place for place in places if self._free(place, half)), places[0])
        self._taken.append((x - half, y - FONT, x + half, y + 3))
        hint = title(tip) if tip else ""
        attributes = {"class": f"label {kind}", "x": x, "y": y, "fill": colour, "text_anchor": "middle"}
        self._markup.append(element("text", attributes, text(shown), hint))

    def markup(self) -> str:
        """Return all of them."""
        return "".join(self._markup)

    def _inside(self, place: Point, half: float) -> Point:
        return min(max(place[0], half + 4), max(self.width - half - 4, half + 4)), place[1]

    def _free(self, place: Point, half: float) -> bool:
        left, top, right, bottom = place[0] - half, place[1] - FONT, place[0] + half, place[1] + 3
        return all(
            right < taken[0] or left > taken[2] or bottom < taken[1] or top > taken[3]
            for taken in self._taken
        )


def _places(at: Point, half: float) -> Iterator[Point]:
    """Yield places for words, the best first: at the point, then around it, ever farther away."""
    yield at
    for ring in range(1, 5):
        for side in (1, -1):
            yield at[0], at[1] + side * ring * _STEP
        for side in (1, -1):
            yield at[0] + side * (half + ring * FONT), at[1]
            yield at[0] + side * (half + ring * FONT), at[1] - ring * _STEP
