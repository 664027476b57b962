"""Values that know each other: containment and opposite references stay right on both ends."""

from __future__ import annotations

from collections.abc import Iterable
from typing import SupportsIndex

from mmrs_core.languages.element import Element, label_of
from mmrs_core.languages.metaclass import Feature


class LinkedList(list[Element]):
    """The values of a many-valued containment or opposite reference.

    Adding an element takes it from the container it was in; removing it leaves it without one.
    """

    __slots__ = ("_feature", "_owner", "_positions")

    def __init__(self, owner: Element, feature: Feature) -> None:
        self._owner = owner
        self._feature = feature

    def append(self, value: Element) -> None:
        """Add at the end; an element that is in the list already moves there."""
        link(self._owner, self._feature, value)
        super().append(value)

    def extend(self, values: Iterable[Element]) -> None:
        """Add all of them at the end, in order."""
        for value in tuple(values):
            self.append(value)

    def __iadd__(self, values: Iterable[Element]) -> LinkedList:  # type: ignore[misc,override]
        """Add all of them at the end, in order."""
        self.extend(values)
        return self

    def __imul__(self, times: SupportsIndex) -> LinkedList:
        """Refuse: an element stands in one place only."""
        raise ValueError(f"{self._feature.name}: an element cannot be in it twice")

    def insert(self, index: SupportsIndex, value: Element) -> None:
        """Put it before the one at that place."""
        link(self._owner, self._feature, value)
        super().insert(index, value)

    def remove(self, value: Element) -> None:
        """Take it out; ValueError if it is not in the list."""
        super().remove(value)
        unlink(self._owner, self._feature, value)

    def pop(self, index: SupportsIndex = -1) -> Element:
        """Take out the one at that place and return it."""
        value = super().pop(index)
        unlink(self._owner, self._feature, value)
        return value

    def clear(self) -> None:
        """Take all of them out."""
        self.replace(())

    def __delitem__(self, index: SupportsIndex | slice) -> None:
        """Take out the ones at those places."""
        left = list(self)
        del left[index]
        self.replace(left)

    def __setitem__(self, index: SupportsIndex | slice, value: Element | Iterable[Element]) -> None:
        """Put others in those places."""
        wanted = list(self)
        if isinstance(index, slice):
            assert not isinstance(value, Element)
            wanted[index] = value
        else:
            assert isinstance(value, Element)
            wanted[index] = value
        self.replace(wanted)

    def replace(self, values: Iterable[Element]) -> None:
        """Hold these values and no other."""
        wanted = list(dict.fromkeys(values))
        kept = {id(value) for value in wanted}
        for value in [value for value in self if id(value) not in kept]:
            super().remove(value)
            unlink(self._owner, self._feature, value)
        present = {id(value) for value in self}
        for value in wanted:
            if id(value) not in present:
                link(self._owner, self._feature, value)
        super().clear()
        super().extend(wanted)

    def position(self, value: Element) -> int:
        """Return the index of an element of the list; quick also where many are asked for.

        Raises:
            ValueError: if it is not in the list.
        """
        if self and self[-1] is value:
            return len(self) - 1
        known: dict[int, int] = getattr(self, "_positions", {})
        found = known.get(id(value), len(self))
        if found >= len(self) or self[found] is not value:
            self._positions = known = {id(each): index for index, each in enumerate(self)}
            if id(value) not in known:
                raise ValueError(f"{self._feature.name}: the element is not in it")
            found = known[id(value)]
        return found

    def put(self, value: Element) -> None:
        """Add at the end and notify no other end; for callers that set the other end."""
        super().append(value)

    def drop(self, value: Element) -> None:
        """Take out, if present, and notify no other end."""
        if any(present is value for present in self):
            super().remove(value)


def link(owner: Element, feature: Feature, value: Element) -> None:
    """Make the other end of a reference know that ``owner`` is about to hold ``value``.

    Raises:
        ValueError: if the value is not an element, or would contain itself.
    """
    if not isinstance(value, Element):
        raise ValueError(f"{feature.name}: takes elements, not {value!r}")
    if feature.containment:
        _adopt(owner, feature, value)
    inverse = feature.opposite
    if inverse is None or inverse.attribute not in type(value)._mmrs_slots:
        return
    if inverse.containment:
        _adopt(value, inverse, owner)
    elif not inverse.many:
        previous = raw(value, inverse)
        if isinstance(previous, Element) and previous is not owner:
            take_out(previous, feature, value)
    store(value, inverse, owner)


def settle(owner: Element, feature: Feature, element: Element, occupied: bool = False) -> None:
    """Contain an element that was just read; where the slot is `occupied`, it only knows its owner."""
    if feature.many:
        getattr(owner, feature.attribute).put(element)
    elif not occupied:
        type(owner)._mmrs_slots[feature.attribute].__set__(owner, element)
    element._mmrs_container = owner
    element._mmrs_feature = feature
    opposite = feature.opposite
    if opposite is not None and opposite.attribute in type(element)._mmrs_slots:
        type(element)._mmrs_slots[opposite.attribute].__set__(element, owner)


def unlink(owner: Element, feature: Feature, value: Element) -> None:
    """Make the other end of a reference forget that ``owner`` held ``value``."""
    inverse = feature.opposite
    if feature.containment:
        _disown(value)
    if inverse is None or inverse.attribute not in type(value)._mmrs_slots:
        return
    if inverse.containment:
        _disown(owner)
    take_out(value, inverse, owner)


def raw(element: Element, feature: Feature) -> object:
    """Return what the slot of a feature holds, or None."""
    try:
        value: object = type(element)._mmrs_slots[feature.attribute].__get__(element)
    except AttributeError:
        return None
    return value


def store(element: Element, feature: Feature, value: Element) -> None:
    """Put a value into a reference, unless it is there, and notify no other end."""
    if not feature.many:
        type(element)._mmrs_slots[feature.attribute].__set__(element, value)
        return
    values = getattr(element, feature.attribute)
    if not any(present is value for present in values):
        values.put(value)


def take_out(element: Element, feature: Feature, value: Element) -> None:
    """Take a value out of a reference, if it is there, and notify no other end."""
    current = raw(element, feature)
    if isinstance(current, LinkedList):
        current.drop(value)
    elif current is value:
        type(element)._mmrs_slots[feature.attribute].__delete__(element)


def _adopt(owner: Element, feature: Feature, value: Element) -> None:
    ancestor: Element | None = owner
    while ancestor is not None:
        if ancestor is value:
            label = label_of(value) or type(value).__name__
            raise ValueError(f"{label}: cannot be inside itself, by {feature.name}")
        ancestor = ancestor._mmrs_container
    before, through = value._mmrs_container, value._mmrs_feature
    if before is not None and through is not None:
        take_out(before, through, value)
        if through.opposite is not None and through is not feature:
            take_out(value, through.opposite, before)
    value._mmrs_container = owner
    value._mmrs_feature = feature


def _disown(value: Element) -> None:
    value._mmrs_container = None
    value._mmrs_feature = None
