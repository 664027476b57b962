"""How random models grow: trees first, then the references that must lead somewhere, then others."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

from hypothesis import reject
from hypothesis import strategies as st

from mmrs_core.languages.element import Element, held, metaclass_of
from mmrs_core.languages.metaclass import Feature, Metaclass
from mmrs_core.testing.kinds import Kinds, Step, crowds, needed_references
from mmrs_core.testing.strategies import Values, values_of, writable

_MOST_ROUNDS = 20
"""Rounds in which elements that a reference needs are made, each of which may need others."""


class Growth:
    """Trees while they grow, made of random choices."""

    def __init__(
        self, draw: st.DrawFn, kinds: Kinds, levels: int, values: Values | None, *, whole: bool = True
    ) -> None:
        """Begin without any tree.

        Args:
            draw: makes the choices.
            kinds: what the trees can hold.
            levels: of containment that are filled at random.
            values: strategies for data types.
            whole: whether everything is there that must be.
        """
        self._draw = draw
        self._whole = whole
        self._kinds = kinds
        self._levels = levels
        self._values = values
        self._elements: list[Element] = []
        self._identifiers: set[object] = set()

    def forest(self, roots: Iterable[Metaclass]) -> tuple[Element, ...]:
        """Return elements of these classes, one after another, with all that is in them."""
        made = tuple(self._grow(root, self._levels) for root in roots)
        for _ in range(_MOST_ROUNDS if self._whole else 0):
            for element, feature in list(self._unmet()):
                self._meet(element, feature)
        if self._whole and any(self._unmet()):
            reject()
        for element in self._elements:
            for feature in metaclass_of(element).features:
                if _refers(feature) and feature.stored and self._draw(st.booleans()):
                    self._refer(element, feature)
        return made

    def _grow(self, kind: Metaclass, room: int) -> Element:
        element: Element = kind.interface()
        self._elements.append(element)
        for feature in kind.features:
            if feature.containment:
                self._fill(element, feature, room)
            elif not feature.is_reference and (feature.required or writable(feature)):
                self._set(element, feature)
        return element

    def _fill(self, element: Element, feature: Feature, room: int) -> None:
        assert isinstance(feature.type, Metaclass)  # it is a containment
        choices = self._kinds.growable(feature.type, feature.owner.ns_uri, room - 1)
        least = most = feature.lower if self._whole else 0
        if room > 0 and choices and feature.stored:
            most += 2 if feature.most < 0 else min(2, feature.most - least)
        most = min(most, max(least, 1)) if crowds(feature) else most
        for _ in range(self._draw(st.integers(least, most)) if choices else 0):
            _put(element, feature, self._grow(self._draw(st.sampled_from(choices)), max(room - 1, 0)))

    def _set(self, element: Element, feature: Feature) -> None:
        is_key = feature in self._kinds.keys
        must = is_key or (self._whole and feature.required and (feature.many or feature.default is None))
        if not must and not self._draw(st.booleans()):
            return
        drawn = values_of(feature, self._values)
        if feature.is_id or is_key:
            drawn = drawn.filter(lambda value: value not in self._identifiers)
        value = self._draw(drawn)
        if feature.is_id or is_key:
            self._identifiers.add(value)
        setattr(element, feature.attribute, value)

    def _unmet(self) -> Iterator[tuple[Element, Feature]]:
        for element in self._elements:
            for feature in needed_references(metaclass_of(element)):
                if len(held(element, feature)) < feature.lower:
                    yield element, feature

    def _meet(self, element: Element, feature: Feature) -> None:
        """Let a reference lead to as many elements as it must."""
        while (count := len(held(element, feature))) < feature.lower:
            targets = self._targets(element, feature) or self._made_for(feature)
            if not targets:
                reject()
            _put(element, feature, self._draw(st.sampled_from(targets)))
            if len(held(element, feature)) == count:
                reject()

    def _refer(self, element: Element, feature: Feature) -> None:
        """Let a reference lead to some more elements, as far as its bounds allow."""
        most = 2 if feature.most < 0 else min(2, feature.most - len(held(element, feature)))
        for _ in range(self._draw(st.integers(0, max(most, 0)))):
            targets = self._targets(element, feature)
            if targets:
                _put(element, feature, self._draw(st.sampled_from(targets)))

    def _targets(self, element: Element, feature: Feature) -> list[Element]:
        """Return the elements that a reference may lead to without taking them from another."""
        present = {id(value) for value in held(element, feature)}
        return [
            target
            for target in self._elements
            if feature.type.accepts(target)
            and id(target) not in present
            and (feature.opposite is None or _has_room(target, feature.opposite))
        ]

    def _made_for(self, feature: Feature) -> list[Element]:
        """Return an element as the target of a reference, put where a tree has room; otherwise nothing."""
        assert isinstance(feature.type, Metaclass)  # it is a reference
        best: tuple[Element, tuple[Step, ...]] | None = None
        for element in self._elements:
            way = self._kinds.way(metaclass_of(element), feature.type, _free(element))
            if way and (best is None or len(way) < len(best[1])):
                best = element, way
        return [self._extend(*best)] if best else []

    def _extend(self, element: Element, way: tuple[Step, ...]) -> Element:
        for feature, kind in way:
            inner = self._grow(kind, 0)
            _put(element, feature, inner)
            element = inner
        return element


def _refers(feature: Feature) -> bool:
    return feature.is_reference and not feature.containment and not feature.is_container


def _put(element: Element, feature: Feature, value: Element) -> None:
    if feature.many:
        values: list[Any] = getattr(element, feature.attribute)
        values.append(value)
    else:
        setattr(element, feature.attribute, value)


def _has_room(element: Element, feature: Feature) -> bool:
    return feature.most < 0 or len(held(element, feature)) < feature.most


def _free(element: Element) -> Iterator[Feature]:
    features = metaclass_of(element).features
    containments = (feature for feature in features if feature.containment)
    return (
        feature
        for feature in containments
        if _has_room(element, feature) and not (crowds(feature) and held(element, feature))
    )
