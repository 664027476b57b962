"""Quick fixes: changes of a model's text that mend a fault in the one right way."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from mmrs_core.diagnostics import Diagnostic
from mmrs_core.languages.element import Element
from mmrs_core.languages.modelset import ModelSet
from mmrs_core.languages.registry import Registry
from mmrs_core.languages.xmi.escapes import in_attribute
from mmrs_core.languages.xmi.markup import Attribute, Markup, Tag


@dataclass(frozen=True, slots=True, order=True)
class Edit:
    """Other text for the bytes ``begin`` to ``end`` of a file."""

    begin: int
    end: int
    text: str


@dataclass(frozen=True, slots=True)
class Wrong:
    """What is wrong, in the model and in its text.

    Attributes:
        fault: the diagnostic to be mended.
        element: it is about; None where no element could be made.
        tag: of that element in the file's text.
        markup: the whole text.
        models: the project; None where there is no mission, or the file is a behaviour by itself.
        robots: the types of robot that are known, by name; also beside a behaviour.
        registry: all metamodels.
        checks: names of all checks of behaviours.
    """

    fault: Diagnostic
    element: Element | None
    tag: Tag
    markup: Markup
    registry: Registry
    models: ModelSet | None = None
    robots: tuple[Element, ...] = ()
    checks: tuple[str, ...] = ()

    @property
    def children(self) -> list[Tag]:
        """The tags directly in the element's that begin on the line of the fault."""
        return [child for child in self.tag.children if child.line == self.fault.place.line]


@dataclass(frozen=True, slots=True)
class Fix:
    """What mends the faults of a code, where there is one right answer.

    Attributes:
        code: of the diagnostics it mends; one fix for a code.
        title: what it does, in the imperative.
        edits: of the file in which the fault stands; none where there is more than one right answer.
    """

    code: str
    title: str
    edits: Callable[[Wrong], Iterable[Edit]]


def with_value(attribute: Attribute, value: str) -> Edit:
    """Return what gives an attribute another value."""
    return Edit(attribute.value_begin, attribute.value_end, in_attribute(value))


def with_name(attribute: Attribute, name: str) -> Edit:
    """Return what gives an attribute another name."""
    return Edit(attribute.begin, attribute.end, name)


def with_attribute(tag: Tag, name: str, value: str) -> Edit:
    """Return what adds an attribute to a tag, before those that it has."""
    place = tag.begin + 1 + len(tag.name.encode())
    return Edit(place, place, f' {name}="{in_attribute(value)}"')


def without(tag: Tag, markup: Markup) -> Edit:
    """Return what takes a tag away, with its line where nothing else stands there."""
    begin, end, data = tag.begin, tag.end, markup.data
    start = data.rfind(b"\n", 0, begin) + 1
    following = data.find(b"\n", end)
    alone = not data[start:begin].strip() and following >= 0 and not data[end:following].strip()
    return Edit(start, following + 1, "") if alone else Edit(begin, end, "")


def referred_to(name: str, markup: Markup) -> bool:
    """Return whether some reference of the text counts elements in features of that name.

    Such a reference would lead to another element if one before it were taken away.
    """
    return f"@{name}.".encode() in markup.data or f"@{name}[".encode() in markup.data
