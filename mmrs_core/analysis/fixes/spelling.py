"""Misspelt names: of metamodels, prefixes, classes, features, and of what models themselves name."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator

from mmrs_core.contributions.fixes import Edit, Fix, Wrong, renamed, with_attribute, with_name, with_value
from mmrs_core.grounding.features import children, text
from mmrs_core.languages.datatypes import shown
from mmrs_core.languages.element import Element, container_of, is_kind, metaclass_of, root_of
from mmrs_core.languages.metaclass import Feature, Metaclass
from mmrs_core.languages.references.named import LONGEST_COMPARED, NamedElements
from mmrs_core.languages.references.spelling import Name, is_address, references_in, spelt
from mmrs_core.languages.uris import BEHAVIOUR
from mmrs_core.languages.xmi.markup import Tag

_SHORT = 5
"""Letters below which two wrong ones make too much of a word."""


def meant(name: str, known: Iterable[str]) -> str | None:
    """Return the known word that a word can only be meant for; None if there is none, or more than one.

    Words that differ by capitals, blanks and signs are the same; others may differ by a letter put in, left
    out, exchanged, or two swapped; long ones by two.

    >>> meant("Capture_Image", ["CaptureImage", "Capture"]), meant("dorne", ["drone", "stone"])
    ('CaptureImage', 'drone')
    >>> meant("save", ["SAFE", "NORMAL"]), meant("cat", ["car", "cut"]) is None
    ('SAFE', True)
    """
    choices = sorted(set(known) - {name})
    alike = [each for each in choices if _letters(each) == _letters(name)]
    allowed = 0
    while not alike and allowed < (1 if len(name) <= _SHORT else 2):
        allowed += 1
        alike = [each for each in choices if _apart(name.casefold(), each.casefold()) <= allowed]
    return alike[0] if len(alike) == 1 and name.strip() else None


def _letters(word: str) -> str:
    return "".join(letter for letter in word.casefold() if letter.isalnum())


def _apart(one: str, other: str) -> int:
    """Return in how many letters two words differ; two neighbours that are swapped count once."""
    if abs(len(one) - len(other)) > 2:
        return 3
    row = list(range(len(other) + 1))
    for i, letter in enumerate(one, 1):
        above, row = row, [i]
        row += [0] * len(other)
        for j, wanted in enumerate(other, 1):
            row[j] = min(above[j] + 1, row[j - 1] + 1, above[j - 1] + (letter != wanted))
    return min(row[-1], _swapped(one, other))


def _swapped(one: str, other: str) -> int:
    """Return 1 if two neighbouring letters are swapped and all else is the same, else 3."""
    wrong = [i for i, (a, b) in enumerate(zip(one, other, strict=False)) if a != b]
    if len(one) != len(other) or len(wrong) != 2 or wrong[1] != wrong[0] + 1:
        return 3
    i, j = wrong
    return 1 if one[i] == other[j] and one[j] == other[i] else 3


_TYPES = ("xsi:type", "xmi:type")


def _features(wrong: Wrong) -> Iterator[Edit]:
    """Give an attribute or child that its class does not know the name that it was meant to have."""
    if wrong.element is None:
        return
    metaclass = metaclass_of(wrong.element)
    for attribute in wrong.tag.attributes:
        if (
            ":" not in attribute.name
            and attribute.name != "xmlns"
            and attribute.name not in metaclass.by_name
        ):
            name = meant(attribute.name, _free(wrong.tag, metaclass, lambda each: not each.containment))
            if name is not None:
                yield with_name(attribute, name)
    for tag in wrong.children:
        if tag.name not in metaclass.by_name and ":" not in tag.name:
            name = meant(tag.name, _free(wrong.tag, metaclass, _is_written_inside))
            if name is not None:
                yield from renamed(tag, name)


def _is_written_inside(feature: Feature) -> bool:
    """Return whether a feature may be a child: a part, or a value, of which EMF writes many so."""
    return feature.containment or not feature.is_reference


def _free(tag: Tag, metaclass: Metaclass, wanted: Callable[[Feature], bool]) -> list[str]:
    given = tag.content_names()
    found = (each for each in metaclass.features if each.stored and wanted(each))
    return [each.name for each in found if each.many or each.name not in given]


def _classes(wrong: Wrong) -> Iterator[Edit]:
    """Correct the class in an ``xsi:type``, or that of a root."""
    for tag in (wrong.tag, *wrong.children):
        for attribute in tag.attributes:
            if attribute.name in _TYPES:
                prefix, sign, name = _parted(attribute.value)
                ns_uri = prefix if sign == "#" else tag.prefixes().get(prefix, "")
                right = _class(wrong, ns_uri, name)
                if right is not None:
                    yield with_value(attribute, f"{prefix}{sign}{right}")
        prefix, colon, name = tag.name.rpartition(":")
        right = _class(wrong, tag.prefixes().get(prefix, ""), name) if colon else None
        if right is not None:
            yield from renamed(tag, f"{prefix}:{right}")


def _parted(kind: str) -> tuple[str, str, str]:
    """Return prefix, sign and name of a class; JSON also has ``nsURI#Class``."""
    return kind.rpartition("#" if "#" in kind else ":")


def _class(wrong: Wrong, ns_uri: str, name: str) -> str | None:
    if not wrong.registry.has(ns_uri):
        return None
    classes = {each.name for each in wrong.registry.package(ns_uri).metaclasses}
    return None if name in classes else meant(name, classes)


def _metamodels(wrong: Wrong) -> Iterator[Edit]:
    known = [package.ns_uri for package in wrong.registry.packages if package.ns_uri]
    for tag in wrong.markup.root.everything():
        for attribute in tag.attributes:
            foreign = not attribute.name.startswith("xmlns:") or attribute.value.startswith("http://www.")
            if not foreign and not wrong.registry.has(attribute.value):
                right = meant(attribute.value, known)
                if right is not None and _same_numbers(attribute.value, right):
                    yield with_value(attribute, right)


def _same_numbers(one: str, other: str) -> bool:
    """Return whether two names differ in letters only: another version or number is another thing."""
    return [c for c in one if c.isdigit()] == [c for c in other if c.isdigit()]


def _prefixes(wrong: Wrong) -> Iterator[Edit]:
    declared = wrong.tag.prefixes()
    for tag in (wrong.tag, *wrong.children):
        for name in _TYPES:
            attribute = tag.attribute(name)
            prefix = attribute.value.rpartition(":")[0] if attribute is not None else ""
            found = [each for each in wrong.registry.packages if each.prefix == prefix]
            if prefix and prefix not in declared and len(found) == 1:
                yield with_attribute(wrong.markup.root, f"xmlns:{prefix}", found[0].ns_uri, wrong.markup)


def _named(feature: str, known: Callable[[Wrong], Iterable[str]]) -> Callable[[Wrong], Iterator[Edit]]:
    """Return what gives an attribute the one known name that its value was meant for."""

    def edits(wrong: Wrong) -> Iterator[Edit]:
        names = tuple(known(wrong))
        attribute = wrong.tag.attribute(feature)
        if attribute is not None and attribute.value not in names:
            right = meant(attribute.value, names)
            if right is not None:
                yield with_value(attribute, right)

    return edits


def _references(wrong: Wrong) -> Iterator[Edit]:
    """Correct a name by which an element refers to one of the project, or of its own file."""
    if wrong.element is None:
        return
    features, message = metaclass_of(wrong.element).by_name, wrong.fault.message
    for attribute in wrong.tag.attributes:
        feature = features.get(attribute.name)
        if feature is None or feature.containment or not isinstance(feature.type, Metaclass):
            continue
        words = list(references_in(attribute.value, feature.many))
        lost = next(
            (word for word in words if message.startswith(f"{feature.name}: {shown(word)} leads")), ""
        )
        known = _names(wrong, wrong.element, feature.type)
        fit = 0 < len(lost) <= LONGEST_COMPARED and not is_address(lost)
        right = meant(lost, known) if fit else None
        if right is not None and _same_numbers(lost, right):
            words = [Name(right, right) if word == lost else word for word in words]
            said = (spelt(each, feature.many) if isinstance(each, Name) else each for each in words)
            yield with_value(attribute, " ".join(said))


def _names(wrong: Wrong, element: Element, kind: Metaclass) -> Iterator[str]:
    models = wrong.models.models if wrong.models is not None else ()
    return NamedElements((root_of(element), *(root for each in models for root in each.roots))).names(kind)


def _listed(feature: str, known: Callable[[Wrong], Iterable[str]]) -> Callable[[Wrong], Iterator[Edit]]:
    """Return what gives each value of a list the one known name that it was meant for."""

    def edits(wrong: Wrong) -> Iterator[Edit]:
        names = tuple(known(wrong))
        for tag in wrong.tag.named(feature):
            content = wrong.markup.data[tag.inside : tag.closing].decode()
            right = meant(content, names) if content not in names else None
            if right is not None:
                yield Edit(tag.inside, tag.closing, right)
        attribute = wrong.tag.attribute(feature)
        for word in attribute.value.split() if attribute is not None else ():
            right = meant(word, names) if word not in names else None
            if attribute is not None and right is not None:
                words = [right if each == word else each for each in attribute.value.split()]
                yield with_value(attribute, " ".join(words))

    return edits


def _checks(wrong: Wrong) -> Iterable[str]:
    return wrong.checks


def _types(wrong: Wrong) -> Iterator[str]:
    return (text(each, "name") for each in wrong.robots)


def _robot_type(wrong: Wrong) -> Element | None:
    owner = wrong.element
    while owner is not None and not is_kind(owner, BEHAVIOUR, "Robot"):
        owner = container_of(owner)
    name = text(owner, "typeName") if owner is not None else ""
    return next((each for each in wrong.robots if text(each, "name") == name), None)


def _devices(wrong: Wrong) -> list[str]:
    return [text(each, "id") for each in children(_robot_type(wrong), "devices")]


def _actions(wrong: Wrong) -> list[str]:
    device = text(wrong.element, "deviceId") if wrong.element is not None else ""
    found = (each for each in children(_robot_type(wrong), "devices") if text(each, "id") == device)
    return [text(each, "name") for one in found for each in children(one, "supportedActions")]


FIXES = (
    Fix("XMI001", "correct the nsURI", _metamodels),
    Fix("XMI002", "correct the name of the class", _classes),
    Fix("XMI004", "correct the name of the attribute or part", _features),
    Fix("XMI006", "correct the name of the element", _references),
    Fix("XMI014", "declare the prefix", _prefixes),
    Fix("MML004", "correct the name of the robot type", _named("type", _types)),
    Fix("BL035", "correct the name of the robot type", _named("typeName", _types)),
    Fix("BL036", "correct the identifier of the device", _named("deviceId", _devices)),
    Fix("BL037", "correct the name of the action", _named("actionName", _actions)),
    Fix("BL039", "correct the identifier of the device", _named("deviceId", _devices)),
    Fix("CTX027", "correct the name of the robot type", _listed("robotTypes", _types)),
    Fix("MML012", "correct the name of the check", _listed("acceptedUnknowns", _checks)),
    Fix("BL049", "correct the name of the check", _listed("acceptedUnknowns", _checks)),
)
