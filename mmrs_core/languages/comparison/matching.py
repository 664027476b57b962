"""Which element of one model is which of another: by identity, by likeness, by position."""

from __future__ import annotations

from collections import defaultdict, deque
from collections.abc import Callable, Hashable, Iterable, Iterator, Sequence

from mmrs_core.languages.comparison.features import (
    attributes_of,
    features_of,
    fingerprints,
    identity_of,
    kind_of,
    said_by,
    traits_of,
    values_in,
)
from mmrs_core.languages.element import Element, contents, descendants

_LIKE = 0.5
"""The least share of equal attributes by which two elements are taken for one."""
_MOST_PAIRS = 40_000
"""The most pairs of elements of one list to compare for likeness; beyond it, position decides."""

Key = Callable[[Element], Hashable]


class Matching:
    """The pairs of two models.

    Attributes:
        before: all elements of the first model, in document order.
        after: all of the second.
        second: the element of the second model for each matched one of the first, by `id`.
        first: the reverse.
    """

    def __init__(self, before: Sequence[Element], after: Sequence[Element]) -> None:
        """Match two models, given their roots."""
        self.second: dict[int, Element] = {}
        self.first: dict[int, Element] = {}
        self.before, self.after = tuple(every(before)), tuple(every(after))
        self._prints = fingerprints(self.before) | fingerprints(self.after)
        self._pending: deque[tuple[Element, Element]] = deque()
        self._match_lists(before, after)
        self._match_contents()
        self._match_moved()
        self._match_contents()

    def says_the_same(self, one: Element, other: Element) -> bool:
        """Return whether two elements, with all inside them, are equal but for references."""
        return self._prints[id(one)] == self._prints[id(other)]

    def _pair(self, one: Element, other: Element) -> None:
        self.second[id(one)] = other
        self.first[id(other)] = one
        self._pending.append((one, other))

    def _match_contents(self) -> None:
        while self._pending:
            one, other = self._pending.popleft()
            there = {slot[0].name: slot for slot in traits_of(other.__class__).inside}
            for slot in traits_of(one.__class__).inside:
                if slot[0].name in there:
                    self._match_lists(values_in(one, slot), values_in(other, there[slot[0].name]))

    def _match_lists(self, before: Sequence[Element], after: Sequence[Element]) -> None:
        """Match what one feature holds: equal names first, then equal contents, likeness, and position."""
        if not before or not after:
            return
        if self._are_alike(before, after):
            for one, other in zip(before, after, strict=True):
                self._pair(one, other)
            return
        self._by_key(before, after, _called)
        self._by_key(before, after, lambda each: (kind_of(each), self._prints[id(each)]), unique=False)
        self._by_likeness(before, after)
        for one, other in zip(before, after, strict=False):
            if self._free(one, other) and kind_of(one) == kind_of(other) and _may_be_one(one, other):
                self._pair(one, other)

    def _are_alike(self, before: Sequence[Element], after: Sequence[Element]) -> bool:
        """Return whether each element of a list equals the one in the same place, so that nothing moved."""
        prints = self._prints
        return len(before) == len(after) and all(
            prints[id(one)] == prints[id(other)] and self._free(one, other) and _is_called_alike(one, other)
            for one, other in zip(before, after, strict=True)
        )

    def _match_moved(self) -> None:
        """Match what was not found where it had been with what came elsewhere."""
        gone = [each for each in self.before if id(each) not in self.second]
        come = [each for each in self.after if id(each) not in self.first]
        self._by_key(gone, come, _called)
        self._by_key(
            gone, come, lambda each: (kind_of(each), self._prints[id(each)]) if _tells(each) else None
        )

    def _by_key(
        self, before: Iterable[Element], after: Iterable[Element], key: Key, unique: bool = True
    ) -> None:
        """Pair elements of equal keys; with `unique`, only where each model has just one of them."""
        left, right = self._grouped(before, self.second, key), self._grouped(after, self.first, key)
        for value, ones in left.items():
            others = right.get(value, [])
            if unique and (len(ones) != 1 or len(others) != 1):
                continue
            for one, other in zip(ones, others, strict=False):
                self._pair(one, other)

    def _grouped(
        self, elements: Iterable[Element], matched: dict[int, Element], key: Key
    ) -> dict[Hashable, list[Element]]:
        groups: dict[Hashable, list[Element]] = defaultdict(list)
        for each in elements:
            if id(each) not in matched and (value := key(each)) is not None:
                groups[value].append(each)
        return groups

    def _by_likeness(self, before: Sequence[Element], after: Sequence[Element]) -> None:
        left = [(place, each) for place, each in enumerate(before) if id(each) not in self.second]
        right = [(place, each) for place, each in enumerate(after) if id(each) not in self.first]
        if len(left) * len(right) > _MOST_PAIRS:
            return
        likely = [
            (-share, abs(i - j), i, j, one, other)
            for i, one in left
            for j, other in right
            if kind_of(one) == kind_of(other) and (share := _likeness(one, other)) >= _LIKE
        ]
        for *_, one, other in sorted(likely, key=lambda row: row[:4]):
            if self._free(one, other):
                self._pair(one, other)

    def _free(self, one: Element, other: Element) -> bool:
        return id(one) not in self.second and id(other) not in self.first


def every(roots: Iterable[Element]) -> Iterator[Element]:
    """Yield all elements of a model, given its roots."""
    for root in roots:
        yield root
        yield from descendants(root)


def _called(element: Element) -> Hashable:
    identity = identity_of(element)
    return (kind_of(element), identity) if identity else None


def _is_called_alike(one: Element, other: Element) -> bool:
    """Return whether neither of two equal elements has an identifier that it does not say itself."""
    ours, theirs = one._mmrs_source, other._mmrs_source
    return (ours is None or not ours.ids) and (theirs is None or not theirs.ids)


def _likeness(one: Element, other: Element) -> float:
    """Return the share of attributes and contained elements that two elements of one class have in common."""
    features = [each for each in features_of(one).values() if not each.is_reference and each.stored]
    said = [(said_by(one, feature), said_by(other, feature)) for feature in features]
    reported = [pair for pair in said if pair != (None, None)]
    ours, theirs = set(map(_title, contents(one))), set(map(_title, contents(other)))
    most = len(reported) + len(ours | theirs)
    return (sum(a == b for a, b in reported) + len(ours & theirs)) / most if most else 0.0


def _title(element: Element) -> Hashable:
    return kind_of(element), identity_of(element), tuple(attributes_of(element))


def _may_be_one(one: Element, other: Element) -> bool:
    """Return whether elements in the same place may be the same: not if both have names, and these differ."""
    return not (identity_of(one) and identity_of(other))


def _tells(element: Element) -> bool:
    """Return whether there is enough in an element to recognise it in quite another place."""
    return len(list(attributes_of(element))) > 1 or any(True for _ in contents(element))
