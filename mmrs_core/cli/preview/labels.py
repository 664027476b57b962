"""Places words on a picture so that they do not cover each other."""

from __future__ import annotations

from dataclasses import dataclass, field

from mmrs_core.cli.preview.markup import element, text
from mmrs_core.scene import Point

FONT = 12.0
_WIDTH_OF_A_LETTER = 0.58
_LONGEST = 34
_SHIFTS = (0, -1, 1, -2, 2, -3, 3, -4, 4)


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

    def put(self, words: str, at: Point, kind: str, *, colour: str | None = None, tip: str = "") -> None:
        """Place words centred near a point, moved up or down until they cover no others."""
        shown = shortened(words)
        half = width_of(shown) / 2
        x = min(max(at[0], half + 4), max(self.width - half - 4, half + 4))
        y = next(
            (
                at[1] + shift * FONT * 1.25
                for shift in _SHIFTS
                if self._free(x, at[1] + shift * FONT * 1.25, half)
            ),
            at[1],
        )
        self._taken.append((x - half, y - FONT, x + half, y + 3))
        title = element("title", None, text(tip)) if tip else ""
        attributes = {"class": f"label {kind}", "x": x, "y": y, "fill": colour, "text_anchor": "middle"}
        self._markup.append(element("text", attributes, text(shown), title))

    def markup(self) -> str:
        """Return all of them."""
        return "".join(self._markup)

    def _free(self, x: float, y: float, half: float) -> bool:
        left, top, right, bottom = x - half, y - FONT, x + half, y + 3
        return all(
            right < taken[0] or left > taken[2] or bottom < taken[1] or top > taken[3]
            for taken in self._taken
        )
