"""Values that can only mean one thing, and classes that only one class can be."""

from __future__ import annotations

import re
from collections.abc import Iterator

from mmrs_core.analysis.fixes.spelling import meant
from mmrs_core.contributions.fixes import Edit, Fix, Wrong, with_attribute, with_value
from mmrs_core.languages.datatypes import DataType
from mmrs_core.languages.element import metaclass_of
from mmrs_core.languages.json_form.markup import Member
from mmrs_core.languages.json_form.scalars import written
from mmrs_core.languages.json_form.stream import quoted
from mmrs_core.languages.metaclass import Enumeration, Metaclass
from mmrs_core.languages.xmi.events import XSI
from mmrs_core.languages.xmi.markup import Attribute, Tag

_COMMA = re.compile(r"[+-]?[0-9]+,(?:[0-9]{1,2}|[0-9]{4,})")
"""A decimal comma; with three digits behind it, it may part thousands."""
_TRUTH = {"yes": "true", "on": "true", "no": "false", "off": "false"}
_SYSTEMS = {"4326": "EPSG:4326", "4979": "EPSG:4979", "4258": "EPSG:4258", "4269": "EPSG:4269"}
_ALIASES = {"wgs84": "EPSG:4326", "gps": "EPSG:4326", "etrs89": "EPSG:4258", "nad83": "EPSG:4269"}


def _value(wrong: Wrong) -> Iterator[Edit]:
    if wrong.element is None:
        return
    for name, feature in metaclass_of(wrong.element).by_name.items():
        attribute = wrong.tag.attribute(name)
        if attribute is not None and not feature.many and not feature.is_reference:
            yield from _written(attribute, feature.type)


def _written(attribute: Attribute, kind: DataType | Enumeration | Metaclass) -> Iterator[Edit]:
    if isinstance(kind, Metaclass):
        return
    begin, end = attribute.value_begin, attribute.value_end
    if isinstance(attribute, Member) and attribute.bare and _is_text(kind):
        yield Edit(begin, end, quoted(attribute.value))
        return
    right = _meant_by(attribute.value, kind)
    if right is not None and isinstance(attribute, Member):
        yield Edit(begin, end, written(kind, kind.parse(right)))
    elif right is not None:
        yield with_value(attribute, right)


def _is_text(kind: DataType | Enumeration) -> bool:
    return isinstance(kind, DataType) and kind.python is str


def _meant_by(given: str, kind: DataType | Enumeration) -> str | None:
    """Return what a value that its type does not take can only mean."""
    if _parses(given, kind):
        return None
    if isinstance(kind, Enumeration):
        return meant(given, [literal.literal for literal in kind.literals])
    word = given.strip()
    candidates = [word, word.lower() if kind.python is bool else word, _TRUTH.get(word.lower(), word)]
    if kind.python is float and _COMMA.fullmatch(word):
        candidates.append(word.replace(",", "."))
    return next((each for each in candidates if _parses(each, kind)), None)


def _parses(text: str, kind: DataType | Enumeration) -> bool:
    try:
        kind.parse(text)
    except ValueError:
        return False
    return True


def _kind(wrong: Wrong) -> Iterator[Edit]:
    """State by ``xsi:type`` the one class that an element of an abstract class can be of."""
    if wrong.element is None:
        return
    metaclass = metaclass_of(wrong.element)
    for tag in wrong.children:
        feature = metaclass.by_name.get(tag.name)
        if feature is None or not feature.containment or tag.attribute("xsi:type") is not None:
            continue
        assert isinstance(feature.type, Metaclass)  # it is a containment
        if feature.type.implementation is None:
            yield from _typed(tag, feature.type, wrong)


def _typed(tag: Tag, general: Metaclass, wrong: Wrong) -> Iterator[Edit]:
    """Yield what types a tag, by a class of a metamodel that the file uses anyway or of the feature's own."""
    prefixes = {uri: prefix for prefix, uri in tag.prefixes().items() if prefix}
    given = {name for name in tag.content_names() if ":" not in name}
    found = [
        each
        for package in wrong.registry.packages
        if package.ns_uri in prefixes or package.ns_uri == general.ns_uri
        for each in package.metaclasses
        if each.implementation is not None and each.is_kind(*general.key) and given <= set(each.by_name)
    ]
    if len(found) != 1 or not given:
        return
    chosen = found[0]
    package = wrong.registry.package(chosen.ns_uri)
    prefix = prefixes.get(chosen.ns_uri)
    if prefix is None:
        if package.prefix in tag.prefixes():
            return
        prefix = package.prefix
        yield with_attribute(wrong.markup.root, f"xmlns:{prefix}", chosen.ns_uri, wrong.markup)
    if XSI not in prefixes:
        yield with_attribute(wrong.markup.root, "xmlns:xsi", XSI, wrong.markup)
    yield with_attribute(tag, "xsi:type", f"{prefix}:{chosen.name}", wrong.markup)


def _system(wrong: Wrong) -> Iterator[Edit]:
    attribute = wrong.tag.attribute("crs")
    if attribute is None:
        return
    word = "".join(letter for letter in attribute.value.casefold() if letter.isalnum())
    right = _ALIASES.get(word) or _SYSTEMS.get(word.removeprefix("epsg"))
    if right is not None and right != attribute.value:
        yield with_value(attribute, right)


FIXES = (
    Fix("XMI003", "state the class by xsi:type", _kind),
    Fix("XMI005", "write the value as the attribute takes it", _value),
    Fix("MML001", "name the coordinate reference system by its EPSG code", _system),
    Fix("CTX001", "name the coordinate reference system by its EPSG code", _system),
    Fix("BL016", "name the coordinate reference system by its EPSG code", _system),
)
