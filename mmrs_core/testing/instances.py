"""Hypothesis strategies for models: random valid instances of any metamodel."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

from hypothesis import reject
from hypothesis import strategies as st

from mmrs_core.languages.datatypes import ECORE
from mmrs_core.languages.element import Element, held, metaclass_of
from mmrs_core.languages.metaclass import Feature, Metaclass
from mmrs_core.languages.registry import Registry
from mmrs_core.testing.kinds import Kinds, Step, all_kinds, fits, kinds_below, needed_references
from mmrs_core.testing.values import Values, values_of, writable

_MOST_ROUNDS = 20
_NO_ELEMENT = "{}#{}: no class that elements can be made of"
_MAP_ENTRY = (ECORE, "EStringToStringMapEntry")


def instances_of(
    registry: Registry, ns_uri: str, name: str = "", *, levels: int = 2, values: Values | None = None
) -> st.SearchStrategy[Element]:
    """Draw valid elements of a metaclass, with random contents.

    What is drawn conforms to the metamodel: bounds, types, opposites and identifiers are right, and
    references lead to elements inside the tree. Constraints beyond the metamodel may well be broken.

    Args:
        registry: the metamodels.
        ns_uri: of the metamodel whose class is wanted.
        name: of the class; instances of its subclasses are drawn as well. Empty: any class of the
            metamodel whose elements are valid by themselves.
        levels: of containment that are filled at random; below, only what must be is there.
        values: strategies for data types by (nsURI, name), where any text would not do.

    Raises:
        ValueError: if there is no such class, or none of its elements can be valid by itself.
    """
    roots = _roots(registry, ns_uri, name)

    @st.composite
    def tree(draw: st.DrawFn) -> Element:
        root = draw(st.sampled_from(sorted(roots, key=lambda each: each.key)))
        return _Growth(draw, roots[root], levels, values).forest([root])[0]

    return tree()


def drafts_of(
    registry: Registry, ns_uri: str, name: str = "", *, levels: int = 2, values: Values | None = None
) -> st.SearchStrategy[Element]:
    """Draw elements of a metaclass that may be half done, as models are while somebody works on them.

    Values are of their types and references lead into the tree, but anything that must be there may be
    missing.

    Args:
        registry: the metamodels.
        ns_uri: of the metamodel whose class is wanted.
        name: of the class; those of its subclasses are drawn as well. Empty: any class of the metamodel.
        levels: as for `instances_of`.
        values: as for `instances_of`.

    Raises:
        ValueError: if there is no such class, or no element can be of it.
    """
    candidates = sorted(_candidates(registry, ns_uri, name), key=lambda each: each.key)
    if not candidates:
        raise ValueError(_NO_ELEMENT.format(ns_uri, name))
    kinds = Kinds(all_kinds(registry))

    @st.composite
    def tree(draw: st.DrawFn) -> Element:
        root = draw(st.sampled_from(candidates))
        return _Growth(draw, kinds, levels, values, whole=False).forest([root])[0]

    return tree()


def models_of(
    registry: Registry, *roots: tuple[str, str], levels: int = 2, values: Values | None = None
) -> st.SearchStrategy[tuple[Element, ...]]:
    """Draw valid models whose roots are of these metaclasses, as `instances_of` does.

    References lead from each tree into all of them, so that elements can be drawn that are not valid
    without others beside them.

    Args:
        registry: the metamodels.
        roots: nsURI and name of the class of each root, in order.
        levels: as for `instances_of`.
        values: as for `instances_of`.

    Raises:
        ValueError: if there is no such class, or no valid model.
    """
    metaclasses = [registry.metaclass(*root) for root in roots]
    kinds = kinds_below(registry, *metaclasses)

    @st.composite
    def forest(draw: st.DrawFn) -> tuple[Element, ...]:
        return _Growth(draw, kinds, levels, values).forest(metaclasses)

    return forest()


def _candidates(registry: Registry, ns_uri: str, name: str) -> list[Metaclass]:
    if not name:
        return [kind for kind in registry.package(ns_uri).metaclasses if kind.implementation]
    wanted = registry.metaclass(ns_uri, name)
    return [kind for kind in all_kinds(registry) if fits(kind, wanted, ns_uri)]


def _roots(registry: Registry, ns_uri: str, name: str) -> dict[Metaclass, Kinds]:
    found, reason = {}, _NO_ELEMENT.format(ns_uri, name)
    for kind in _candidates(registry, ns_uri, name):
        try:
            found[kind] = kinds_below(registry, kind)
        except ValueError as fault:
            reason = str(fault)
    if not found:
        raise ValueError(reason)
    return found


class _Growth:
    """Trees while they grow."""

    def __init__(
        self, draw: st.DrawFn, kinds: Kinds, levels: int, values: Values | None, *, whole: bool = True
    ) -> None:
        self._draw = draw
        self._whole = whole
        self._kinds = kinds
        self._levels = levels
        self._values = values
        self._elements: list[Element] = []
        self._identifiers: set[object] = set()

    def forest(self, roots: Iterable[Metaclass]) -> tuple[Element, ...]:
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
            most += 2 if feature.upper < 0 else min(2, feature.upper - least)
        for _ in range(self._draw(st.integers(least, most)) if choices else 0):
            _put(element, feature, self._grow(self._draw(st.sampled_from(choices)), max(room - 1, 0)))

    def _set(self, element: Element, feature: Feature) -> None:
        is_key = feature.name == "key" and metaclass_of(element).key == _MAP_ENTRY
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
        most = 2 if feature.upper < 0 else min(2, feature.upper - len(held(element, feature)))
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
        """Return an element for a reference to lead to, put where a tree has room; else nothing."""
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
    return feature.upper < 0 or len(held(element, feature)) < feature.upper


def _free(element: Element) -> Iterator[Feature]:
    features = metaclass_of(element).features
    return (feature for feature in features if feature.containment and _has_room(element, feature))
