"""What differs between two versions of a metamodel, and whether models of the older one still load."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from mmrs_core.languages.evolution.feature_rules import feature_differences
from mmrs_core.languages.evolution.migration import Migration, chains
from mmrs_core.languages.evolution.renaming import Renaming
from mmrs_core.languages.evolution.verdicts import Difference, Verdict, changed, refused
from mmrs_core.languages.evolution.versions import Version
from mmrs_core.languages.metaclass import Enumeration, Feature, Metaclass, Package

_NO_CLASS = "older models may have such elements"
_DROPPED = "a migration leaves it out, with a warning"
_NO_FEATURE = "older models may say it"


def differences(old: Version, new: Version, chain: tuple[Migration, ...] = ()) -> tuple[Difference, ...]:
    """Return what differs between two versions, in the order of the newer one.

    Args:
        old: the older version.
        new: the newer one.
        chain: the migrations that lead from one to the other; what they rename counts as the same.
    """
    return tuple(_Comparison(old, new, chain).all())


def steps_between(old: Version, new: Version, migrations: Iterable[Migration]) -> tuple[Migration, ...]:
    """Return the migrations that lead from one version to another; none if they do not."""
    start, end = old.packages[0].ns_uri, new.packages[0].ns_uri
    return chains(migrations, {end}).get(start, ())


class _Comparison:
    def __init__(self, old: Version, new: Version, chain: tuple[Migration, ...]) -> None:
        self._old, self._new, self._chain = old, new, chain
        self._renaming = Renaming({chain[0].from_uri: chain} if chain else {})
        inner = {package.name: package.ns_uri for package in new.packages[1:]}
        self._packages = {old.packages[0].ns_uri: new.packages[0].ns_uri}
        self._packages |= {p.ns_uri: inner[p.name] for p in old.packages[1:] if p.name in inner}

    def all(self) -> Iterator[Difference]:
        yield from self._names()
        for package in self._old.packages:
            if package.ns_uri not in self._packages:
                yield Difference("removed", package.name, Verdict.INCOMPATIBLE, "the package", _NO_CLASS)
        for package in self._new.packages:
            before = [p for p in self._old.packages if self._packages.get(p.ns_uri) == package.ns_uri]
            if before:
                yield from self._classes(before[0], package)
                yield from _enumerations(before[0], package)
            else:
                yield Difference("added", package.name, Verdict.COMPATIBLE, "the package")

    def _image(self, key: tuple[str, str]) -> tuple[str, str]:
        """Return what a class or type of the older version is called in the newer one."""
        ns_uri, name = self._renaming.last(key)
        return self._packages.get(ns_uri, ns_uri), name

    def _names(self) -> Iterator[Difference]:
        old, new = self._old.packages[0], self._new.packages[0]
        if old.ns_uri == new.ns_uri:
            return
        words = f"its nsURI was {old.ns_uri}, is {new.ns_uri}"
        if self._chain:
            yield changed(new.name, words, Verdict.COMPATIBLE, "a migration leads there")
        else:
            yield refused(new.name, words, "older models name the older one, and no migration leads there")

    def _classes(self, old: Package, new: Package) -> Iterator[Difference]:
        images = {self._image(kind.key)[1]: kind for kind in old.metaclasses}
        known = {kind.name for kind in new.metaclasses}
        for name, kind in images.items():
            if name not in known:
                verdict = Verdict.COMPATIBLE if kind.abstract else Verdict.INCOMPATIBLE
                reason = "" if kind.abstract else f"{_NO_CLASS}{_renamed(kind, new, images)}"
                yield Difference("removed", kind.name, verdict, "the class", reason)
        for kind in new.metaclasses:
            if kind.name in images:
                yield from self._class(images[kind.name], kind)
            else:
                yield Difference("added", kind.name, Verdict.COMPATIBLE, "the class")

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
        if any(what in step.dropped for step in self._chain):
            return Difference("removed", what, Verdict.MEANING, words, _DROPPED)
        reason = _NO_FEATURE + self._renamed_to(feature, old, new)
        return Difference("removed", what, Verdict.INCOMPATIBLE, words, reason)

    def _renamed_to(self, feature: Feature, old: Metaclass, new: Metaclass) -> str:
        """Return a guess at the new name of a feature, if one of the same type appeared in its place."""
        kind = self._image((feature.type.ns_uri, feature.type.name))
        come = [each for each in new.features if each.owner is new and each.name not in old.by_name]
        alike = [each.name for each in come if (each.type.ns_uri, each.type.name) == kind]
        return f"; if it is {alike[0]} now, a migration has to say so" if len(alike) == 1 else ""

    def _goes_above(self, feature: Feature) -> bool:
        """Return whether the class that declares a feature has lost it, so that it is told there."""
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
            verdict = Verdict.INCOMPATIBLE if lacking else Verdict.COMPATIBLE
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
            yield Difference("removed", kind.name, Verdict.COMPATIBLE, "the enumeration")
    before = {kind.name for kind in old.enumerations}
    for name in (kind.name for kind in new.enumerations if kind.name not in before):
        yield Difference("added", name, Verdict.COMPATIBLE, "the enumeration")


def _literals(old: Enumeration, new: Enumeration) -> Iterator[Difference]:
    before = {each.literal for each in old.literals}
    after = {each.literal for each in new.literals}
    for literal in (each.literal for each in old.literals if each.literal not in after):
        reason = "older models may say it"
        yield Difference("removed", f"{old.name}.{literal}", Verdict.INCOMPATIBLE, "the literal", reason)
    for literal in (each.literal for each in new.literals if each.literal not in before):
        yield Difference("added", f"{new.name}.{literal}", Verdict.COMPATIBLE, "the literal")
