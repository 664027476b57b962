"""Quick fixes: changes of a model's text that fix an unambiguous problem."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from mmrs_core.languages.json_form.markup import JsonTag, Member, inserted, taken_away, written
from mmrs_core.languages.json_form.stream import quoted
from mmrs_core.languages.xmi.escapes import in_attribute

if TYPE_CHECKING:
    from mmrs_core.diagnostics import Diagnostic
    from mmrs_core.languages.element import Element
    from mmrs_core.languages.modelset import ModelSet
    from mmrs_core.languages.registry import Registry
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

    A JSON text is presented as if it were XMI: objects are tags, plain values attributes, ``$type`` is
    ``xsi:type``, and ``$languages`` declares namespaces. What gives a tag another text knows the difference.

    Attributes:
        fault: the diagnostic to be fixed.
        element: it is about; None where no element could be made.
        tag: of that element in the file's text.
        markup: the whole text.
        models: the project; None where there is no mission, or the file is a standalone behaviour.
        robots: the known robot types, by name; also of a standalone behaviour.
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
        """The tags directly in the element's that begin on the line of the fault, or are named on it."""
        line = self.fault.place.line
        return [child for child in self.tag.children if line in _lines(child)]


def _lines(tag: Tag) -> Iterator[int]:
    yield tag.line
    if isinstance(tag, JsonTag):
        yield tag.lines[0]
        yield from (each.line for each in tag.attributes if isinstance(each, Member))


@dataclass(frozen=True, slots=True)
class Fix:
    """A fix of the diagnostics of one code, where there is one right answer.

    Attributes:
        code: of the diagnostics; one fix for a code.
        title: what it does, in the imperative.
        edits: of the file in which the fault stands; none where there is more than one right answer.
    """

    code: str
    title: str
    edits: Callable[[Wrong], Iterable[Edit]]


def with_value(attribute: Attribute, value: str) -> Edit:
    """Return what gives an attribute another value; one that stands in quotes in JSON keeps them."""
    text = written(value, bare=attribute.bare) if isinstance(attribute, Member) else in_attribute(value)
    return Edit(attribute.value_begin, attribute.value_end, text)


def with_name(attribute: Attribute, name: str) -> Edit:
    """Return what gives an attribute another name."""
    return Edit(attribute.begin, attribute.end, name)


def renamed(tag: Tag, name: str) -> tuple[Edit, ...]:
    """Return what gives a tag another name, where it opens and where it closes."""
    if isinstance(tag, JsonTag):
        return (Edit(*tag.key, quoted(name)[1:-1]),) if tag.key[0] >= 0 else ()
    size = len(tag.name.encode())
    opening = Edit(tag.begin + 1, tag.begin + 1 + size, name)
    return (
        (opening, Edit(tag.closing + 2, tag.closing + 2 + size, name))
        if tag.closing < tag.end
        else (opening,)
    )


def with_attribute(tag: Tag, name: str, value: str, markup: Markup) -> Edit:
    """Return what adds an attribute to a tag, before those that it has."""
    if isinstance(tag, JsonTag):
        begin, text = inserted(tag, name, value, markup.data)
        return Edit(begin, begin, text)
    place = tag.begin + 1 + len(tag.name.encode())
    return Edit(place, place, f' {name}="{in_attribute(value)}"')


def without(tag: Tag, markup: Markup) -> Edit:
    """Return the edit that removes a tag, with its line where nothing else stands there."""
    if isinstance(tag, JsonTag):
        return Edit(*taken_away(tag), "")
    begin, end, data = tag.begin, tag.end, markup.data
    start = data.rfind(b"\n", 0, begin) + 1
    following = data.find(b"\n", end)
    alone = not data[start:begin].strip() and following >= 0 and not data[end:following].strip()
    return Edit(start, following + 1, "") if alone else Edit(begin, end, "")


def referred_to(name: str, markup: Markup) -> bool:
    """Return whether some reference of the text counts elements in features of that name.

    Such a reference would lead to another element if one before it were removed.
    """
    return f"@{name}.".encode() in markup.data or f"@{name}[".encode() in markup.data
