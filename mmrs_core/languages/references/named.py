"""The elements of one file by their names, so that a name leads to the nearest of them."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Iterable, Iterator, Sequence

from mmrs_core.languages.element import Element, descendants, label_of
from mmrs_core.languages.metaclass import Metaclass

MOST_NAMED = 5
"""How many elements of one name a message lists."""
LONGEST_COMPARED = 200
"""Comparing two misspelt names takes the product of their lengths."""


class NamedElements:
    """The elements below some roots, by their ``name`` or, where they have none, their ``id``.

    What a name means depends on where it is written, as in programs: the element of that name in the
    innermost element around the reference that holds any. It takes the logarithm of their number to find it.
    """

    def __init__(self, roots: Iterable[Element]) -> None:
        """Take the elements as they are now."""
        self.all: list[Element] = []
        self._places: dict[Element, int] = {}
        self._by_name: dict[str, list[int]] = {}
        self._by_kind: dict[tuple[str, Metaclass], Sequence[int]] = {}
        for root in roots:
            for element in (root, *descendants(root)):
                self._enter(element)
        self._ends = list(range(1, len(self.all) + 1))
        for place in range(len(self.all) - 1, 0, -1):
            around = self._places.get(self.all[place]._mmrs_container)  # type: ignore[arg-type]  # None is none
            if around is not None:
                self._ends[around] = max(self._ends[around], self._ends[place])

    def _enter(self, element: Element) -> None:
        if element in self._places:  # a root that another contains
            return
        self._places[element] = len(self.all)
        name = label_of(element)
        if name:
            self._by_name.setdefault(name, []).append(len(self.all))
        self.all.append(element)

    def nearest(self, name: str, kind: Metaclass, around: Element | None) -> list[Element]:
        """Return the elements that a name means, one more than `MOST_NAMED` at most.

        Args:
            kind: what all of them are.
            around: what refers to them; None for what stands in no element of these.
        """
        found = self._of(name, kind)
        low, high = 0, len(found)
        while around is not None and len(found) > 1:
            place = self._places.get(around)
            if place is not None:
                begin, end = bisect_right(found, place), bisect_left(found, self._ends[place])
                if begin < end:
                    low, high = begin, end
                    break
            around = around._mmrs_container
        return [self.all[place] for place in found[low : min(high, low + MOST_NAMED + 1)]]

    def any(self, name: str) -> Element | None:
        """Return the first element of a name, of whatever kind; None if there is none."""
        return next((self.all[place] for place in self._by_name.get(name, ())), None)

    def names(self, kind: Metaclass) -> Iterator[str]:
        """Yield the names of the elements of a kind, each once."""
        return (name for name in self._by_name if self._of(name, kind))

    def _of(self, name: str, kind: Metaclass) -> Sequence[int]:
        key = name, kind
        if key not in self._by_kind:
            places = self._by_name.get(name, ())
            self._by_kind[key] = [place for place in places if kind.accepts(self.all[place])]
        return self._by_kind[key]
