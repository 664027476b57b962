"""Paths from an element to a feature of it, or of an element inside it.

``speed.max`` is the feature ``max`` of what ``speed`` contains; ``batteries[1].voltage`` is that of the
second battery; ``payload[key=note].value`` is that of the entry whose ``key`` is ``note``. What is missing
on the way is made.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from mmrs_core.languages.element import Element, held, metaclass_of
from mmrs_core.languages.metaclass import Feature, Metaclass

_STEP = re.compile(
    r"(?P<name>[^.\[\]=]+)(?:\[(?:(?P<index>\d{1,3})|(?P<key>[^=\]]+)=(?P<text>[^\]]*))\])?", re.ASCII
)


@dataclass(frozen=True, slots=True)
class Step:
    """One step: a feature, and which of its elements where it has several."""

    name: str
    index: int = 0
    key: str = ""
    text: str = ""


def parse_path(text: str) -> tuple[Step, ...]:
    """Return the steps of a path.

    Raises:
        ValueError: if it is none.

    >>> parse_path("batteries[1].voltage")[0]
    Step(name='batteries', index=1, key='', text='')
    """
    steps = []
    for part in re.split(r"\.(?![^\[]*\])", text):
        match = _STEP.fullmatch(part)
        if match is None:
            raise ValueError(f"{text!r}: no path of features such as speed.max or batteries[1].voltage")
        steps.append(Step(match["name"], int(match["index"] or 0), match["key"] or "", match["text"] or ""))
    return tuple(steps)


def feature_at(metaclass: Metaclass, text: str) -> Feature:
    """Return the feature at the end of a path, for elements of a class.

    Raises:
        ValueError: if the path is none, or leads through what the class does not contain.
    """
    *way, last = parse_path(text)
    for step in way:
        feature = metaclass.feature(step.name)
        if not feature.containment or not isinstance(feature.type, Metaclass):
            raise ValueError(f"{text!r}: {step.name} of {metaclass.name} contains no elements")
        metaclass = feature.type
    return metaclass.feature(last.name)


def reach(element: Element, text: str) -> tuple[Element, Feature]:
    """Return the element and feature at the end of a path; elements that are missing on the way are made."""
    *way, last = parse_path(text)
    for step in way:
        element = _inner(element, step)
    return element, metaclass_of(element).feature(last.name)


def _inner(element: Element, step: Step) -> Element:
    feature = metaclass_of(element).feature(step.name)
    assert isinstance(feature.type, Metaclass)  # feature_at was asked before
    present = [value for value in held(element, feature) if isinstance(value, Element)]
    if step.key:
        matching = (each for each in present if str(getattr(each, step.key, None)) == step.text)
        return next(matching, None) or _made(element, feature, {step.key: step.text})
    while len(present) <= step.index:
        present.append(_made(element, feature, {}))
    return present[step.index]


def _made(element: Element, feature: Feature, values: dict[str, str]) -> Element:
    """Put a new element into a feature and return it."""
    assert isinstance(feature.type, Metaclass)  # it contains elements
    made: Element = feature.type.interface(**values)
    if feature.many:
        getattr(element, feature.attribute).append(made)
    else:
        setattr(element, feature.attribute, made)
    return made
