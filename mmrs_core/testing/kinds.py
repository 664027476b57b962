"""What models of a metamodel can be made of: which classes fit where, and which trees end."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Iterator, Mapping
from functools import lru_cache
from math import inf

from mmrs_core.languages.datatypes import ECORE, DataType
from mmrs_core.languages.metaclass import Feature, Metaclass
from mmrs_core.languages.registry import Registry

Step = tuple[Feature, Metaclass]
"""A containment, and the class of what is put into it."""


class Kinds:
    """Concrete classes that trees are made of.

    Attributes:
        height: levels of containment that an element of the class needs at least, by class; inf for
            those that no finite tree holds.
        keys: the attributes with many values by which elements differ that a metamodel tells apart by keys.
    """

    def __init__(self, concrete: Iterable[Metaclass]) -> None:
        self._concrete = tuple(concrete)
        self._fitting: dict[tuple[Metaclass, str], tuple[Metaclass, ...]] = {}
        self.height: Mapping[Metaclass, float] = self._heights()
        features = {feature for kind in self._concrete for feature in kind.features}
        self.keys = frozenset(key for feature in features for key in _keys(feature))

    def fitting(self, wanted: Metaclass, near: str = "") -> tuple[Metaclass, ...]:
        """Return the concrete classes whose elements are of a class, lowest first.

        Args:
            wanted: the class; for Ecore's EObject, which everything is, only classes of one package.
            near: nsURI of that package.
        """
        key = (wanted, near if wanted.key == (ECORE, "EObject") else "")
        if key not in self._fitting:
            found = [kind for kind in self._concrete if fits(kind, wanted, near)]
            self._fitting[key] = tuple(found)
        return self._fitting[key]

    def growable(self, wanted: Metaclass, near: str, room: float) -> tuple[Metaclass, ...]:
        """Return the classes among the fitting ones whose elements need no more levels than there is room.

        Where none does, those that need fewest; nothing if none can be finite.
        """
        finite = [kind for kind in self.fitting(wanted, near) if self.height[kind] < inf]
        low = [kind for kind in finite if self.height[kind] <= room]
        least = min((self.height[kind] for kind in finite), default=inf)
        return tuple(low or [kind for kind in finite if self.height[kind] == least])

    def inside(self, kinds: Iterable[Metaclass]) -> frozenset[Metaclass]:
        """Return all classes that can stand in trees whose root is of one of these, themselves included."""
        found = set(kinds)
        pending = list(found)
        while pending:
            for _, kind in self.steps(pending.pop()):
                if kind not in found:
                    found.add(kind)
                    pending.append(kind)
        return frozenset(found)

    def steps(self, kind: Metaclass) -> Iterator[Step]:
        """Yield what can be put where into an element of a class."""
        for feature in kind.features:
            if feature.containment and isinstance(feature.type, Metaclass):
                for inner in self.growable(feature.type, feature.owner.ns_uri, inf):
                    yield feature, inner

    def way(self, start: Metaclass, wanted: Metaclass, free: Iterable[Feature]) -> tuple[Step, ...]:
        """Return the shortest path down from an element of a class to one of another; empty if none is.

        Args:
            start: class of the element that the path begins at.
            wanted: class that its end is of.
            free: the containments of that element that have room.
        """
        open_features = frozenset(free)
        first = [(step,) for step in self.steps(start) if step[0] in open_features]
        pending: deque[tuple[Step, ...]] = deque(first)
        seen: set[Metaclass] = set()
        while pending:
            path = pending.popleft()
            end = path[-1][1]
            if fits(end, wanted, end.ns_uri):
                return path
            if end not in seen:
                seen.add(end)
                pending.extend((*path, step) for step in self.steps(end))
        return ()

    def _heights(self) -> Mapping[Metaclass, float]:
        heights = dict.fromkeys(self._concrete, inf)
        changed = True
        while changed:
            changed = False
            for kind in self._concrete:
                height = max((1 + self._lowest(each, heights) for each in _needed(kind)), default=0.0)
                if height < heights[kind]:
                    heights[kind], changed = height, True
        return heights

    def _lowest(self, feature: Feature, heights: Mapping[Metaclass, float]) -> float:
        assert isinstance(feature.type, Metaclass)  # it is a reference
        return min((heights[each] for each in self.fitting(feature.type, feature.owner.ns_uri)), default=inf)


def crowds(feature: Feature) -> bool:
    """Return whether several elements in a feature would need different keys, of which there are few."""
    return bool(feature.keys) and not any(_keys(feature))


def _keys(feature: Feature) -> Iterator[Feature]:
    """Yield the key attributes of a feature's elements whose type has many values."""
    if isinstance(feature.type, Metaclass):
        named = (feature.type.by_name.get(name) for name in feature.keys)
        yield from (key for key in named if key is not None and _has_many_values(key))


def _has_many_values(feature: Feature) -> bool:
    kind = feature.type
    return isinstance(kind, DataType) and kind.python is not bool


def all_kinds(registry: Registry) -> list[Metaclass]:
    """Return every class that elements can be made of."""
    return [kind for package in registry.everything for kind in package.metaclasses if kind.implementation]


@lru_cache(64)
def kinds_of(concrete: tuple[Metaclass, ...]) -> Kinds:
    """Return what concrete classes make possible, worked out once for all strategies that draw of them."""
    return Kinds(concrete)


@lru_cache(256)
def kinds_below(registry: Registry, *roots: Metaclass) -> Kinds:
    """Return the classes that valid models with such roots can hold.

    Raises:
        ValueError: if there is no valid model with such roots; says why.
    """
    concrete = all_kinds(registry)
    while True:
        kinds = kinds_of(tuple(concrete))
        for root in roots:
            if kinds.height.get(root, inf) == inf:
                raise ValueError(f"{root.name}: no finite element of it is valid alone")
        inside = kinds.inside(roots)
        lacking = {kind: feature for kind in inside for feature in _unmet(kind, inside)}
        for root in roots:
            if root in lacking:
                raise ValueError(
                    f"{root.name}: no element of it is valid alone: {lacking[root].name} refers to "
                    f"{lacking[root].type.name}, which cannot stand inside it"
                )
        if not lacking:
            return kinds_of(tuple(kind for kind in concrete if kind in inside))
        concrete = [kind for kind in concrete if kind not in lacking]


def _unmet(kind: Metaclass, inside: Iterable[Metaclass]) -> Iterator[Feature]:
    """Yield the references that elements of a class must have, and to which nothing inside the tree fits."""
    for feature in needed_references(kind):
        assert isinstance(feature.type, Metaclass)  # it is a reference
        wanted = feature.type
        if not any(fits(other, wanted, other.ns_uri) for other in inside):
            yield feature


def needed_references(kind: Metaclass) -> Iterator[Feature]:
    """Yield the references across the tree that elements of a class must have."""
    for feature in kind.features:
        if feature.is_reference and feature.required and not feature.containment and not feature.is_container:
            yield feature


def _needed(kind: Metaclass) -> Iterator[Feature]:
    return (feature for feature in kind.features if feature.containment and feature.required)


def fits(kind: Metaclass, wanted: Metaclass, near: str) -> bool:
    """Return whether elements of a class are of another; of Ecore's EObject, those of one package are."""
    if wanted.key == (ECORE, "EObject"):
        return kind.ns_uri == near
    return wanted.key in kind.ancestry
