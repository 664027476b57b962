"""Figures that were exchanged, that count in the other way round, or that are given twice."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from math import isfinite

from mmrs_core.contributions.fixes import Edit, Fix, Wrong, referred_to, with_value, without
from mmrs_core.languages.xmi.markup import Tag


def exchanged(one: str, other: str) -> Callable[[Wrong], Iterator[Edit]]:
    """Return what exchanges the values of two attributes."""

    def edits(wrong: Wrong) -> Iterator[Edit]:
        first, second = wrong.tag.attribute(one), wrong.tag.attribute(other)
        if first is not None and second is not None:
            yield with_value(first, second.value)
            yield with_value(second, first.value)

    return edits


def _places_exchanged(wrong: Wrong) -> Iterator[Edit]:
    for tag in wrong.tag.everything():
        yield from exchanged("latitude", "longitude")(replace(wrong, tag=tag))


def _places_turned(name: str) -> Callable[[Wrong], Iterator[Edit]]:
    """Return what gives a number the other sign in every place of an element."""

    def edits(wrong: Wrong) -> Iterator[Edit]:
        for tag in wrong.tag.everything():
            attribute = tag.attribute(name)
            if attribute is not None and _number(tag, name):
                word = attribute.value.strip()
                yield with_value(attribute, word[1:] if word.startswith("-") else f"-{word.lstrip('+')}")

    return edits


def as_part(*names: str) -> Callable[[Wrong], Iterator[Edit]]:
    """Return what writes per cent as a part of the whole: 20 can only be 0.2."""

    def edits(wrong: Wrong) -> Iterator[Edit]:
        for name in names:
            attribute = wrong.tag.attribute(name)
            value = _number(wrong.tag, name)
            if attribute is not None and value is not None and _LEAST_PER_CENT <= value < 100.0:
                yield with_value(attribute, f"{value / 100.0:.12g}")

    return edits


_LEAST_PER_CENT = 2.0
"""Between 1 and 2, a part that is a little too large is as likely."""


def _directions(wrong: Wrong) -> Iterator[Edit]:
    """Turn directions by whole circles until they lie between 0 and 360 degrees."""
    for name in ("windDirection", "currentDirection"):
        attribute, value = wrong.tag.attribute(name), _number(wrong.tag, name)
        if attribute is not None and value is not None and not 0.0 <= value <= 360.0 and abs(value) <= 720.0:
            yield with_value(attribute, f"{value % 360.0:.12g}")


def _unsigned(name: str) -> Callable[[Wrong], Iterator[Edit]]:
    """Return what takes the sign from a negative number."""

    def edits(wrong: Wrong) -> Iterator[Edit]:
        attribute, value = wrong.tag.attribute(name), _number(wrong.tag, name)
        if attribute is not None and value is not None and value < 0.0:
            yield with_value(attribute, attribute.value.strip().removeprefix("-"))

    return edits


def _vertices(name: str) -> Callable[[Wrong], Iterator[Edit]]:
    """Return what takes away vertices that repeat an earlier one to the letter."""

    def edits(wrong: Wrong) -> Iterator[Edit]:
        if referred_to(name, wrong.markup):
            return
        seen: set[object] = set()
        for tag in wrong.tag.named(name):
            said = tuple(sorted((each.name, each.value) for each in tag.attributes))
            if said in seen and not tag.children and tag.attribute("xmi:id") is None:
                yield without(tag, wrong.markup)
            seen.add(said)

    return edits


def _dependency(wrong: Wrong) -> Iterator[Edit]:
    """Take away a dependency that says again, to the letter, what an earlier one says."""
    tag = wrong.tag
    if tag.parent is None or tag.children or referred_to("taskDependencies", wrong.markup):
        return
    said = {(each.name, each.value) for each in tag.attributes}
    before = (each for each in tag.parent.named(tag.name) if each.begin < tag.begin)
    if any({(each.name, each.value) for each in other.attributes} == said for other in before):
        yield without(tag, wrong.markup)


def _circle(wrong: Wrong) -> Iterator[Edit]:
    tag = wrong.tag
    same = tag.attribute("from") is not None and _text(tag, "from") == _text(tag, "to")
    if tag.name == "taskDependencies" and same and not referred_to("taskDependencies", wrong.markup):
        yield without(tag, wrong.markup)


def _text(tag: Tag, name: str) -> str:
    attribute = tag.attribute(name)
    return attribute.value if attribute is not None else ""


def _number(tag: Tag, name: str) -> float | None:
    try:
        value = float(_text(tag, name))
    except ValueError:
        return None
    return value if isfinite(value) else None


FIXES = (
    Fix("RL017", "exchange min and max", exchanged("min", "max")),
    Fix("CTX007", "exchange minHeight and maxHeight", exchanged("minHeight", "maxHeight")),
    Fix("CTX018", "write the width without its sign", _unsigned("width")),
    Fix("CTX019", "exchange minHeight and maxHeight", exchanged("minHeight", "maxHeight")),
    Fix("MML027", "exchange latitude and longitude", _places_exchanged),
    Fix("MML029", "give the latitude the other sign", _places_turned("latitude")),
    Fix("MML030", "give the longitude the other sign", _places_turned("longitude")),
    Fix("MML005", "write the reserve as a part of the whole", as_part("reserve")),
    Fix("BL046", "write the reserve as a part of the whole", as_part("reserve")),
    Fix("CTX012", "turn the direction by a whole circle", _directions),
    Fix("MML072", "remove the repeated vertices", _vertices("shell")),
    Fix("CTX006", "remove the repeated vertices", _vertices("shell")),
    Fix("MML042", "remove the repeated dependency", _dependency),
    Fix("MML041", "remove the dependency on itself", _circle),
)
