"""Paths from an element to a feature of it, or of an element inside it.

``speed.max`` is the feature ``max`` of what ``speed`` contains; ``batteries[1].voltage`` is that of the
second battery; ``payload[key=note].value`` is that of the entry whose ``key`` is ``note``. What is missing
on the way is made; ``home:GeoCoordinate.latitude`` states its class.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace

from mmrs_core.languages.element import Element, held, metaclass_of
from mmrs_core.languages.metaclass import Feature, Metaclass
from mmrs_core.languages.registry import Registry


@dataclass(frozen=True, slots=True)
class Classes:
    """Classes of ours by the names that a mapping gives them.

    Attributes:
        languages: nsURIs by the short names of the mapping.
    """

    registry: Registry
    languages: Mapping[str, str]

    def named(self, text: str) -> Metaclass:
        """Return the class that ``language:Name`` means.

        Raises:
            ValueError: if there is none, or no element can be made of it.
        """
        prefix, _, name = text.partition(":")
        if prefix not in self.languages:
            raise ValueError(f"{text!r}: {prefix!r} is none of the languages ({', '.join(self.languages)})")
        metaclass = self.registry.metaclass(self.languages[prefix], name)
        if metaclass.abstract:
            raise ValueError(f"{text} is abstract")
        return metaclass

    def within(self, feature: Feature, text: str) -> Metaclass:
        """Return the class of what a path makes in a feature; an empty text leaves it to the feature.

        Raises:
            ValueError: if it is none that the feature takes, or one that no element can be made of.
        """
        kind = feature.type
        assert isinstance(kind, Metaclass)  # asked before
        if ":" in text:
            found = self.named(text)
        elif text:
            found = self.registry.metaclass(kind.ns_uri, text)
        else:
            found = kind
        if not found.is_kind(*kind.key):
            raise ValueError(f"{found.name} is no {kind.name}, which {feature.name} takes")
        if found.abstract:
            raise ValueError(self._abstract(feature, found))
        return found

    def _abstract(self, feature: Feature, kind: Metaclass) -> str:
        uris = (kind.ns_uri, *self.languages.values())
        packages = [self.registry.package(uri) for uri in dict.fromkeys(uris)]
        names = [
            each.name
            for package in packages
            for each in package.metaclasses
            if each.is_kind(*kind.key) and not each.abstract
        ]
        example = f"{feature.name}:{names[0]}" if names else f"{feature.name}:CLASS"
        known = ", ".join(dict.fromkeys(names))
        return f"{kind.name} is abstract: state a concrete class ({known}), as in {example}"


_BREAK = re.compile(r"\.|\[[^\]]*")
_STEP = re.compile(
    r"(?P<name>[^.\[\]=:]+)(?::(?P<kind>[^.\[\]=]+))?"
    r"(?:\[(?:(?P<index>\d{1,3})|(?P<key>[^=\]]+)=(?P<text>[^\]]*))\])?",
    re.ASCII,
)


@dataclass(frozen=True, slots=True)
class Step:
    """One step: a feature, which of its elements where it has several, and the class of one that is made.

    Attributes:
        kind: the name of that class, with ``language:`` before it or not; empty: the feature decides it.
        made: the class itself; None until the path is known to lead somewhere.
    """

    name: str
    index: int = 0
    key: str = ""
    text: str = ""
    kind: str = ""
    made: Metaclass | None = None


@dataclass(frozen=True, slots=True)
class FeaturePath:
    """A path that leads from elements of one class to a feature; as text, it is as it was written."""

    way: tuple[Step, ...]
    last: str
    written: str

    def __str__(self) -> str:
        """Return it as it was written."""
        return self.written

    @property
    def place(self) -> tuple[object, ...]:
        """What is the same for two paths to one feature, however they are written."""
        return *((step.name, step.index, step.key, step.text) for step in self.way), self.last

    def end(self, metaclass: Metaclass) -> Feature:
        """Return the feature that it leads to from elements of the class that it was read for."""
        made = self.way[-1].made if self.way else metaclass
        assert made is not None  # it was read for a class
        return made.feature(self.last)


def _parts(text: str) -> Iterator[str]:
    """Yield what stands between the points outside brackets."""
    begin = 0
    for found in _BREAK.finditer(text):
        if found[0] == ".":
            yield text[begin : found.start()]
            begin = found.end()
    yield text[begin:]


def parse_path(text: str) -> tuple[Step, ...]:
    """Return the steps of a path.

    Raises:
        ValueError: if it is none.

    >>> parse_path("batteries[1].voltage")[0].index
    1
    """
    steps = []
    for part in _parts(text):
        match = _STEP.fullmatch(part)
        if match is None:
            raise ValueError(f"{text!r}: no path of features such as speed.max or batteries[1].voltage")
        found = Step(match["name"], int(match["index"] or 0), match["key"] or "", match["text"] or "")
        steps.append(replace(found, kind=match["kind"] or ""))
    return tuple(steps)


def path_from(metaclass: Metaclass, text: str, classes: Classes, *, hoisted: bool = False) -> FeaturePath:
    """Return a path that leads somewhere from elements of a class.

    Args:
        hoisted: whether it may lead through what is referred to, since that has a place elsewhere.

    Raises:
        ValueError: if it is none, or leads through what the class does not contain.
    """
    *steps, last = parse_path(text)
    way: list[Step] = []
    for step in steps:
        feature = metaclass.feature(step.name)
        if not isinstance(feature.type, Metaclass) or not (feature.containment or hoisted):
            raise ValueError(f"{text!r}: {step.name} of {metaclass.name} contains no elements")
        metaclass = _made_by(step, feature, text, classes)
        if step.key:
            metaclass.feature(step.key)
        way.append(replace(step, made=metaclass))
    metaclass.feature(last.name)
    if last.kind or last.key or last.index:
        raise ValueError(f"{text!r}: {last.name} is the end, so nothing is made or chosen there")
    return FeaturePath(tuple(way), last.name, text)


def _made_by(step: Step, feature: Feature, text: str, classes: Classes) -> Metaclass:
    try:
        return classes.within(feature, step.kind)
    except ValueError as fault:
        raise ValueError(f"{text!r}: {fault}") from None


Keep = Callable[[Element], None]
"""Gives a place to an element that is made and only referred to."""


def reach(element: Element, path: FeaturePath, keep: Keep | None = None) -> tuple[Element, Feature]:
    """Return the element and feature at the end of a path; elements that are missing on the way are made."""
    for step in path.way:
        element = _inner(element, step, keep)
    return element, metaclass_of(element).feature(path.last)


def _inner(element: Element, step: Step, keep: Keep | None) -> Element:
    feature = metaclass_of(element).feature(step.name)
    present = [value for value in held(element, feature) if isinstance(value, Element)]
    if step.key:
        matching = (each for each in present if str(getattr(each, step.key, None)) == step.text)
        return next(matching, None) or _made(element, feature, step, keep)
    while len(present) <= step.index:
        present.append(_made(element, feature, step, keep))
    return present[step.index]


def _made(element: Element, feature: Feature, step: Step, keep: Keep | None) -> Element:
    """Put a new element into a feature and return it."""
    assert step.made is not None  # path_from was asked before
    made: Element = step.made.interface(**({step.key: step.text} if step.key else {}))
    if feature.many:
        getattr(element, feature.attribute).append(made)
    else:
        setattr(element, feature.attribute, made)
    if keep is not None and not feature.containment:
        keep(made)
    return made
