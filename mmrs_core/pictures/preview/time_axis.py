"""How seconds become pixels, and the marks beneath."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from mmrs_core.pictures.figures import clock
from mmrs_core.pictures.preview.markup import element, text

LEFT = 172.0
RIGHT = 24.0
WIDTH = 1000.0
_STEPS = (1, 2, 5, 10, 15, 30, 60, 120, 300, 600, 900, 1800, 3600, 7200, 14400, 28800, 86400)
_MOST_MARKS = 12


@dataclass(frozen=True, slots=True)
class TimeAxis:
    """Time from 0 to `end` seconds, along the width of a chart."""

    end: float

    def at(self, seconds: float) -> float:
        """Return the pixel of a time."""
        return LEFT + (WIDTH - LEFT - RIGHT) * seconds / max(self.end, 1e-9)

    def marks(self) -> Iterator[float]:
        """Yield round times, at most about a dozen."""
        step = next((step for step in _STEPS if self.end / step <= _MOST_MARKS), self.end / _MOST_MARKS)
        count = int(self.end // step)
        return (i * step for i in range(count + 1))

    def markup(self, top: float, bottom: float) -> str:
        """Return the lines and words of the axis for a chart between two heights in pixels."""
        name = {"x": LEFT - 28, "y": bottom + 15, "text_anchor": "end"}
        marks = (self._mark(at, top, bottom) for at in self.marks())
        return element("g", {"class": "axis"}, element("text", name, "time"), marks)

    def _mark(self, seconds: float, top: float, bottom: float) -> str:
        x = self.at(seconds)
        line = element("line", {"x1": x, "x2": x, "y1": top, "y2": bottom})
        words = {"x": x, "y": bottom + 15, "text_anchor": "middle"}
        return line + element("text", words, text(clock(seconds)))
