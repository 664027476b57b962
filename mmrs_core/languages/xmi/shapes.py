"""Functions compiled for start tags that occur again and again: the same feature, type and attribute names.

A large model has a few dozen such shapes and a million elements. What a shape means is worked out once; the
function that is made of it, as dataclasses make theirs, sets the slots of an element one after the other and
asks nothing. No text of a metamodel or a model gets into the source: slots are numbered, all else is bound.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from mmrs_core.languages.classes import bare_name
from mmrs_core.languages.datatypes import DataType, parse_real
from mmrs_core.languages.links import LinkedList
from mmrs_core.languages.metaclass import Feature, Metaclass
from mmrs_core.languages.references.documents import Pending
from mmrs_core.languages.values.real import LARGEST_SINGLE, parse_single

if TYPE_CHECKING:
    from mmrs_core.languages.element import Element
    from mmrs_core.languages.sources import Source

    Frame = tuple[Element, Metaclass, Feature | None]
    Waiting = Callable[[Pending | tuple[Element, Feature, str, int]], None]
    Opening = Callable[[Frame], None]
    Maker = Callable[[Element, list[str], int, Source, Waiting, Opening], bool]
    """Makes an element inside its owner; takes attributes, line, source, what waits and what is open.

    It returns False if the attributes have other names, and raises ValueError if a value cannot be read or
    the owner's place is taken; then it has changed nothing.
    """


def maker(
    owner: Metaclass,
    feature: Feature,
    metaclass: Metaclass,
    implementation: type[Element] | None,
    names: tuple[str, ...],
    features: tuple[Feature | None, ...],
) -> Maker | None:
    """Return the function for elements of a metaclass in a containment feature of an owner.

    Args:
        implementation: the class of the elements.
        names: those of the attributes, in order.
        features: what each of them gives; None where it says nothing of the element.

    Returns:
        None if the shape needs more than that: identifiers, lists of values, containment by reference.
    """
    if implementation is None or not all(each is None or _simple(each) for each in features):
        return None
    bound: dict[str, object] = {
        "new": object.__new__,
        "cls": implementation,
        "feature": feature,
        "LinkedList": LinkedList,
        "append": list.append,
        "Pending": Pending,
        "metaclass": metaclass,
    }
    check = [] if feature.many else _vacancy(owner, feature)
    lines = [
        *_unpacking(names, bound),
        *check,
        *_body(metaclass, features, bound),
        *_attachment(owner, feature, metaclass),
        "    opened((e, metaclass, None))",
        "    return True",
    ]
    source = "\n".join(["def make(owner, attributes, line, source, wait, opened):", *lines])
    exec(compile(source, f"<reader of {metaclass.name}>", "exec"), bound)  # noqa: S102  # no foreign text in it
    made: Maker = bound["make"]  # type: ignore[assignment]  # the source above defines it
    return made


def _simple(feature: Feature) -> bool:
    """Whether one text is all there is to say about the value."""
    if feature.is_reference:
        return not feature.containment and not (feature.many and feature.unsettable)
    return not (feature.many or feature.is_id)


def _unpacking(names: tuple[str, ...], bound: dict[str, object]) -> list[str]:
    """Return the lines that take the attributes apart, if they have these names."""
    if not names:
        return []
    bound |= {f"name{at}": name for at, name in enumerate(names)}
    parts = ", ".join(f"n{at}, v{at}" for at in range(len(names)))
    differs = " or ".join(f"n{at} != name{at}" for at in range(len(names)))
    return [f"    {parts} = attributes", f"    if {differs}: return False"]


def _body(metaclass: Metaclass, features: tuple[Feature | None, ...], bound: dict[str, object]) -> list[str]:
    """Return the lines that make the element and set its slots, values before anything else can see it."""
    given = {feature: f"v{at}" for at, feature in enumerate(features) if feature is not None}
    lines = ["    e = new(cls)"]
    shared: list[str] = []
    for index, feature in enumerate(metaclass.features):
        text, slot = given.get(feature), f"e.{bare_name(index)}"
        if text is None or feature.is_reference:
            if not feature.nullable:
                lines.append(f"    {slot} = None")
        elif isinstance(feature.type, DataType) and feature.type.parse is str:
            # one element's text is often that of the one before: then they share it
            bound[f"s{index}"] = ""
            lines += [f"    s = s{index}", f"    if {text} == s: {text} = s", f"    else: s{index} = {text}"]
            lines.append(f"    {slot} = {text}")
            shared.append(f"s{index}")
        elif isinstance(feature.type, DataType) and feature.type.parse in (parse_real, parse_single):
            # of what Python takes, Java refuses these and words, and words are not finite
            usual = f"{text}.isascii() and '_' not in {text} and r - r == 0.0"
            if feature.type.parse is parse_single:
                usual += f" and -{LARGEST_SINGLE!r} <= r <= {LARGEST_SINGLE!r}"
            bound[f"p{index}"] = feature.type.parse
            lines += [f"    r = float({text})", f"    {slot} = r if {usual} else p{index}({text})"]
        else:
            bound[f"p{index}"] = feature.type.parse  # type: ignore[union-attr]  # it is an attribute
            lines.append(f"    {slot} = p{index}({text})")
    if shared:
        lines.insert(0, f"    global {', '.join(shared)}")
    base = {"container": "owner", "feature": "feature", "line": "line", "source": "source"}
    lines += [f"    e._mmrs_{name} = {value}" for name, value in base.items()]
    for feature, text in given.items():
        if feature.is_reference:
            bound[f"f{text}"] = feature
            lines.append(f"    wait({'Pending' if feature.linked else ''}(e, f{text}, {text}, line))")
    return lines


def _vacancy(owner: Metaclass, feature: Feature) -> list[str]:
    place = f"owner.{bare_name(owner.features.index(feature))}"
    return [f"    if {place} is not None:", "        raise ValueError"]


def _attachment(owner: Metaclass, feature: Feature, metaclass: Metaclass) -> list[str]:
    place = f"owner.{bare_name(owner.features.index(feature))}"
    lines = []
    if feature.many:
        lines += [
            f"    values = {place}",
            "    if values is None:",
            f"        values = {place} = LinkedList(owner, feature)",
            "    append(values, e)",
        ]
    else:
        lines += [f"    {place} = e"]
    if feature.opposite is not None:
        lines.append(f"    e.{bare_name(metaclass.features.index(feature.opposite))} = owner")
    return lines
