"""What differs between two versions of a metamodel, and whether models of the older one still load."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from types import MappingProxyType

from mmrs_core.languages.evolution.effects import Difference, Effect, changed, feature_differences, refused
from mmrs_core.languages.evolution.migration import Migration, Renaming, chains
from mmrs_core.languages.evolution.versions import Version, pairs_of
from mmrs_core.languages.metaclass import Enumeration, Feature, Metaclass, Package

Ways = Mapping[str, tuple[Migration, ...]]
"""Migrations that follow each other, by the nsURI where they begin."""

_NO_WAYS: Ways = MappingProxyType({})
_NO_CLASS = "older models may have such elements"
_DROPPED = "a migration leaves it out, with a warning"
_NO_FEATURE = "older models may say it"


def differences(old: Version, new: Version, ways: Ways = _NO_WAYS) -> tuple[Difference, ...]:
    """Return what differs between two versions, in the order of the newer one; then, in files referred to.

    Args:
        old: the older version.
        new: the newer one.
        ways: the migrations that lead from packages of one to packages of the other, as `ways_between` finds
            them; what they rename counts as the same.
    """
    return tuple(_Comparison(old, new, ways).all())


def ways_between(old: Version, new: Version, migrations: Iterable[Migration]) -> Ways:
    """Return the migrations from older packages to newer ones, by the nsURI where they begin."""
    steps = tuple(migrations)
    changed_uris = [(a.ns_uri, b.ns_uri) for a, b in pairs_of(old, new).same if a.ns_uri != b.ns_uri]
    found = {start: chains(steps, {end}).get(start, ()) for start, end in changed_uris}
    return {start: chain for start, chain in found.items() if chain}


class _Comparison:
    def __init__(self, old: Version, new: Version, ways: Ways) -> None:
        self._old, self._new, self._ways = old, new, ways
        self._steps = tuple(step for chain in ways.values() for step in chain)
        self._renaming = Renaming(ways)
        self._pairs = pairs_of(old, new)
        self._packages = {before.ns_uri: now.ns_uri for before, now in self._pairs.same}

    def all(self) -> Iterator[Difference]:
        for before, now in self._pairs.same:
            yield from self._names(before, now)
        for package in self._pairs.gone:
            if package in self._old.packages:
                yield Difference("removed", package.name, Effect.INCOMPATIBLE, "the package", _NO_CLASS)
            else:  # what referred to it has changed, and is told there
                words = f"the metamodel {package.ns_uri}, to which nothing refers any more"
                yield Difference("removed", package.name, Effect.COMPATIBLE, words)
        for package in self._pairs.come:
            yield Difference("added", package.name, Effect.COMPATIBLE, "the package")
        for before, now in self._pairs.same:
            lead = "" if now in self._new.packages else f"{now.name}:"
            for each in (*self._classes(before, now), *_enumerations(before, now)):
                yield replace(each, what=f"{lead}{each.what}")

    def _image(self, key: tuple[str, str]) -> tuple[str, str]:
        """Return what a class or type of the older version is called in the newer one."""
        ns_uri, name = self._renaming.last(key)
        return self._packages.get(ns_uri, ns_uri), name

    def _names(self, old: Package, new: Package) -> Iterator[Difference]:
        if old.ns_uri == new.ns_uri:
            return
        words = f"its nsURI was {old.ns_uri}, is {new.ns_uri}"
        if old.ns_uri in self._ways:
            yield changed(new.name, words, Effect.COMPATIBLE, "a migration leads there")
        else:
            yield refused(new.name, words, "older models name the older one, and no migration leads there")

    def _classes(self, old: Package, new: Package) -> Iterator[Difference]:
        images = {self._image(kind.key)[1]: kind for kind in old.metaclasses}
        known = {kind.name for kind in new.metaclasses}
        for name, kind in images.items():
            if name not in known:
                verdict = Effect.COMPATIBLE if kind.abstract else Effect.INCOMPATIBLE
                reason = "" if kind.abstract else f"{_NO_CLASS}{_renamed(kind, new, images)}"
                yield Difference("removed", kind.name, verdict, "the class", reason)
        for kind in new.metaclasses:
            if kind.name in images:
                yield from self._class(images[kind.name], kind)
            else:
                yield Difference("added", kind.name, Effect.COMPATIBLE, "the class")

    def _class(self, old: Metaclass, new: Metaclass) -> Iterator[Difference]:
        if new.abstract and not old.abstract:
            yield refused(new.name, "is abstract now", _NO_CLASS)
        if old.abstract and not new.abstract:
            yield changed(new.name, "is not abstract any more")
        lost = [key for key in old.ancestry if not new.is_kind(*self._image(key))]
        for ns_uri, name in lost:
            if self._new.metaclass(*self._image((ns_uri, name))) is not None:
                yield refused(new.name, f"is no {name} any more", f"it may stand where a {name} is needed")
        names = {feature.name: self._renaming.feature(feature.name, old.key, new) for feature in old.features}
        for feature in old.features:
            if feature.stored and not feature.is_container:
                yield from self._feature(old, new, feature, names[feature.name])
        yield from self._new_features(old, new, frozenset(names.values()))

    def _feature(self, old: Metaclass, new: Metaclass, feature: Feature, name: str) -> Iterator[Difference]:
        now = new.by_name.get(name)
        own = feature.owner is old
        if now is not None and (own or now.owner.key != self._image(feature.owner.key)):
            yield from feature_differences(f"{new.name}.{name}", feature, now, self._image)
        elif now is None and (own or not self._goes_above(feature)):
            yield self._gone(old, new, feature, "the feature" if own else "the feature, which it inherited")

    def _gone(self, old: Metaclass, new: Metaclass, feature: Feature, words: str) -> Difference:
        what = f"{old.name}.{feature.name}"
        if any(what in step.dropped for step in self._steps):
            return Difference("removed", what, Effect.MEANING, words, _DROPPED)
        reason = _NO_FEATURE + self._renamed_to(feature, old, new)
        return Difference("removed", what, Effect.INCOMPATIBLE, words, reason)

    def _renamed_to(self, feature: Feature, old: Metaclass, new: Metaclass) -> str:
        """Return a guess at the new name of a feature, if one of the same type appeared in its place."""
        kind = self._image((feature.type.ns_uri, feature.type.name))
        come = [each for each in new.features if each.owner is new and each.name not in old.by_name]
        alike = [each.name for each in come if (each.type.ns_uri, each.type.name) == kind]
        return f"; if it is {alike[0]} now, a migration has to say so" if len(alike) == 1 else ""

    def _goes_above(self, feature: Feature) -> bool:
        """Return whether the class that declares a feature has lost it, which is reported there."""
        above = self._new.metaclass(*self._image(feature.owner.key))
        return above is None or feature.name not in above.by_name

    def _new_features(self, old: Metaclass, new: Metaclass, known: frozenset[str]) -> Iterator[Difference]:
        for feature in new.features:
            own = feature.owner is new
            before = {self._image(key) for key in old.ancestry}
            told_above = not own and feature.owner.key in before
            if feature.name in known or told_above or not feature.stored or feature.is_container:
                continue
            words = "the feature" if own else f"the feature, inherited from {feature.owner.name}"
            lacking = feature.required and (feature.many or feature.default is None)
            verdict = Effect.INCOMPATIBLE if lacking else Effect.COMPATIBLE
            reason = "it is required, and older models do not have it" if lacking else ""
            yield Difference("added", f"{new.name}.{feature.name}", verdict, words, reason)


def _renamed(kind: Metaclass, new: Package, images: dict[str, Metaclass]) -> str:
    """Return a guess at the new name of a class, if one with the same features appeared."""
    features = {feature.name for feature in kind.features}
    for other in new.metaclasses:
        if features and other.name not in images and {each.name for each in other.features} == features:
            return f"; if it is {other.name} now, a migration has to say so"
    return ""


def _enumerations(old: Package, new: Package) -> Iterator[Difference]:
    now = {kind.name: kind for kind in new.enumerations}
    for kind in old.enumerations:
        if kind.name in now:
            yield from _literals(kind, now[kind.name])
        else:
            yield Difference("removed", kind.name, Effect.COMPATIBLE, "the enumeration")
    before = {kind.name for kind in old.enumerations}
    for name in (kind.name for kind in new.enumerations if kind.name not in before):
        yield Difference("added", name, Effect.COMPATIBLE, "the enumeration")


def _literals(old: Enumeration, new: Enumeration) -> Iterator[Difference]:
    before = {each.literal for each in old.literals}
    after = {each.literal for each in new.literals}
    for literal in (each.literal for each in old.literals if each.literal not in after):
        reason = "older models may say it"
        yield Difference("removed", f"{old.name}.{literal}", Effect.INCOMPATIBLE, "the literal", reason)
    for literal in (each.literal for each in new.literals if each.literal not in before):
        yield Difference("added", f"{new.name}.{literal}", Effect.COMPATIBLE, "the literal")
