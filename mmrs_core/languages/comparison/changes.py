"""The changes that make one model another."""

from __future__ import annotations

from bisect import bisect_left
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from enum import Enum

from mmrs_core.languages.collector import collector_at_rest
from mmrs_core.languages.comparison.features import (
    Paths,
    address_of,
    features_of,
    raw_text,
    said_by,
    traits_of,
    values_in,
)
from mmrs_core.languages.comparison.matching import Matching
from mmrs_core.languages.element import Element, Hidden, containing_feature, held
from mmrs_core.languages.metaclass import Feature


class Sort(Enum):
    """What became of an element, or of something it says."""

    ADDED = "added"
    REMOVED = "removed"
    MOVED = "moved"
    CHANGED = "changed"


@dataclass(frozen=True, slots=True)
class Change:
    """One change.

    Attributes:
        sort: what happened.
        element: of the second model; of the first if it was removed.
        before: its path in the first model; empty if it was added.
        after: its path in the second model; empty if it was removed.
        feature: whose value changed, or whose values changed their order; empty for a whole element.
        old: the values before, as files write them; None if a file would not say them.
        new: the values after.
    """

    sort: Sort
    element: Element
    before: str = ""
    after: str = ""
    feature: str = ""
    old: tuple[str, ...] | None = None
    new: tuple[str, ...] | None = None


def changes_between(before: Sequence[Element], after: Sequence[Element]) -> tuple[Change, ...]:
    """Return all changes from one model to another, given their roots.

    Elements are matched by their ids and names, else by likeness and position. What was added or removed is
    told by its outermost element; an element in another container or at another place among its like was
    moved, unless it only made way.
    """
    with collector_at_rest():
        return tuple(_Comparison(before, after).changes())


class _Comparison:
    def __init__(self, before: Sequence[Element], after: Sequence[Element]) -> None:
        self._before, self._after = before, after
        self._matching = Matching(before, after)
        self._old, self._new = Paths(before), Paths(after)
        self._ours = {id(element) for element in self._matching.before}
        self._theirs = {id(element) for element in self._matching.after}

    def changes(self) -> Iterator[Change]:
        for one in self._matching.before:
            if id(one) not in self._matching.second and self._is_outermost(one, self._matching.second):
                yield Change(Sort.REMOVED, one, before=self._old.of(one))
        yield from self._moved_among(self._before, self._after)
        for other in self._matching.after:
            one_ = self._matching.first.get(id(other))
            if one_ is None:
                if self._is_outermost(other, self._matching.first):
                    yield Change(Sort.ADDED, other, after=self._new.of(other))
            elif not self._agree(one_, other):
                yield from self._pair(one_, other)

    def _is_outermost(self, element: Element, matched: dict[int, Element]) -> bool:
        container = element._mmrs_container
        return container is None or id(container) in matched

    def _agree(self, one: Element, other: Element) -> bool:
        """Return whether two elements that were matched certainly agree; most of a large model does."""
        known = type(one)._mmrs_metaclass
        if known is None or known is not type(other)._mmrs_metaclass:
            return False
        if not self._matching.says_the_same(one, other) or self._changed_container(one, other):
            return False
        second = self._matching.second
        for slot in traits_of(one.__class__).targets:
            here, there = values_in(one, slot), values_in(other, slot)
            if len(here) != len(there):
                return False
            for each, partner in zip(here, there, strict=True):
                if second.get(id(each)) is not partner:
                    return False
        return True

    def _pair(self, one: Element, other: Element) -> Iterator[Change]:
        before, after = self._old.of(one), self._new.of(other)
        if self._changed_container(one, other):
            yield Change(Sort.MOVED, other, before, after)
        if raw_text(one) != raw_text(other):
            yield Change(Sort.CHANGED, other, before, after, "content", (raw_text(one),), (raw_text(other),))
        ours, theirs = features_of(one), features_of(other)
        same = self._matching.says_the_same(one, other)
        for name in dict.fromkeys((*ours, *theirs)):
            feature = theirs.get(name) or ours[name]
            if feature.containment:
                known = (held(e, f[name]) if name in f else () for e, f in ((one, ours), (other, theirs)))
                yield from self._moved_among(*map(_elements, known))
            elif feature.stored and not feature.is_container and (feature.is_reference or not same):
                old, new = self._said(one, ours.get(name)), self._said(other, theirs.get(name))
                if old != new:
                    sort = Sort.MOVED if old and new and Counter(old) == Counter(new) else Sort.CHANGED
                    yield Change(sort, other, before, after, name, old, new)

    def _changed_container(self, one: Element, other: Element) -> bool:
        ours, theirs = one._mmrs_container, other._mmrs_container
        if ours is None or theirs is None:
            return ours is not theirs
        here, there = containing_feature(one), containing_feature(other)
        same = here is not None and there is not None and here.name == there.name
        if same and id(ours) not in self._ours and id(theirs) not in self._theirs:
            return False  # both stand at the top of their files, and parts of others contain them
        return not (same and self._matching.second.get(id(ours)) is theirs)

    def _said(self, element: Element, feature: Feature | None) -> tuple[str, ...] | None:
        """Return what a feature says, references by the paths of the second model where they have one."""
        if feature is None:
            return None
        if not feature.is_reference:
            return said_by(element, feature)
        return tuple(self._target(value, element) for value in _elements(held(element, feature))) or None

    def _target(self, target: Element, referrer: Element) -> str:
        if isinstance(target, Hidden):
            return f"{self._target(target._mmrs_outer, referrer)} {target._mmrs_rest}"
        if id(target) in self._theirs:
            return self._new.of(target)
        if id(target) not in self._ours:
            return address_of(target, referrer)
        match = self._matching.second.get(id(target))
        return self._new.of(match) if match is not None else f"{self._old.of(target)} (removed)"

    def _moved_among(self, before: Sequence[Element], after: Sequence[Element]) -> Iterator[Change]:
        """Yield the fewest moves that bring the common elements of a list into their new order."""
        places = {id(each): place for place, each in enumerate(after)}
        matched = [(each, self._matching.second.get(id(each))) for each in before]
        common = [(one, other) for one, other in matched if other is not None and id(other) in places]
        staying = _longest_rise([places[id(other)] for _, other in common])
        for place, (one, other) in enumerate(common):
            if place not in staying:
                yield Change(Sort.MOVED, other, self._old.of(one), self._new.of(other))


def _elements(values: Sequence[object]) -> list[Element]:
    return [value for value in values if isinstance(value, Element)]


def _longest_rise(numbers: Sequence[int]) -> frozenset[int]:
    """Return the places of a longest rising subsequence (patience sorting, n log n).

    >>> sorted(_longest_rise([2, 0, 1, 3]))
    [1, 2, 3]
    """
    ends: list[int] = []
    tops: list[int] = []
    below: list[int] = []
    for place, number in enumerate(numbers):
        pile = bisect_left(tops, number)
        below.append(ends[pile - 1] if pile else -1)
        if pile == len(tops):
            tops.append(number)
            ends.append(place)
        else:
            tops[pile], ends[pile] = number, place
    chosen = set()
    place = ends[-1] if ends else -1
    while place >= 0:
        chosen.add(place)
        place = below[place]
    return frozenset(chosen)
