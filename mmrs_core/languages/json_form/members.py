"""The members of a JSON object: values, references and identifiers of its element."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import NamedTuple

from mmrs_core.languages.element import Element, label_of
from mmrs_core.languages.json_form.scalars import is_character, parsed, takes_numbers
from mmrs_core.languages.json_form.stream import (
    END,
    HEAD,
    ID,
    LIST,
    OBJECT,
    REF,
    TEXT,
    TYPE,
    WORD,
    Event,
    Place,
    Stream,
    is_own,
    key_of,
    skip,
)
from mmrs_core.languages.json_form.tree import Words
from mmrs_core.languages.metaclass import Enumeration, Feature, Metaclass, is_null
from mmrs_core.languages.naming import nearest
from mmrs_core.languages.references.documents import Draft, Pending
from mmrs_core.languages.references.spelling import as_address, is_type, one_of_many
from mmrs_core.languages.values.texts import words_of

_HELPED_FAULTS = 200
"""Beyond this many faults no name is suggested: looking for it takes time."""
_MOST_WORDS = 500
"""References that wait as one text."""
_A_TYPE = "a:type"
"""Stands between two of them where the first would be taken for the type of the second, as XMI has it."""


class FeatureReader(NamedTuple):
    """How the members of one feature are read.

    Attributes:
        feature: the feature.
        put: sets its bare slot.
        usual: for each sort of event, what reads the text of a value; None where that takes more.
        links: whether a text is a reference.
    """

    feature: Feature
    put: Callable[[Element, object], None]
    usual: tuple[Callable[[str], object] | None, ...]
    links: bool


def feature_readers(metaclass: Metaclass) -> Mapping[str, FeatureReader]:
    """Return how the features of a class that has elements are read, by their keys."""
    return {key_of(each.name): _feature_reader(metaclass, each) for each in metaclass.features}


def _feature_reader(metaclass: Metaclass, feature: Feature) -> FeatureReader:
    assert metaclass.implementation is not None  # it has elements
    kind = feature.type
    text = number = None
    if not (isinstance(kind, Metaclass) or feature.many or feature.is_id):
        text = None if is_character(kind) else kind.parse
        number = kind.parse if takes_numbers(kind) else None
    put = metaclass.implementation._mmrs_slots[feature.attribute].__set__
    links = feature.is_reference and not feature.containment
    return FeatureReader(feature, put, (text, number, None, None, None), links)


class Members:
    """Reads members into elements, from one file; elements inside are read elsewhere."""

    def __init__(self, stream: Stream, events: Iterator[Event], draft: Draft) -> None:
        self._stream = stream
        self._events = events
        self._draft = draft

    def other(self, element: Element, metaclass: Metaclass, event: Event, at_top: bool) -> None:
        """Take a member that is not a feature: `$id`, a key of the file's top, or a fault."""
        key, line = event[1], self._stream.line(event[3])
        skip(event, self._events)
        if key == ID and event[0] == TEXT and event[2]:
            self._draft.identify(element, event[2], element._mmrs_line, own=False)
        elif key == ID:
            self._draft.fault("XMI010", f"{ID}: takes a text", line, element)
        elif not is_own(key):
            label = label_of(element)
            message = f"{key}: no feature of {metaclass.name}{label and f' {label!r}'}"
            helps = len(self._draft.diagnostics) < _HELPED_FAULTS
            hint = nearest(key, metaclass.by_name) if helps else ""
            self._draft.fault("XMI004", message, line, element, hint)
        elif key != TYPE and not (at_top and key in HEAD):
            message = f"{key}: no key of this form, and no feature of {metaclass.name}"
            self._draft.fault("XMI004", message, line, element, nearest(key, (TYPE, ID, REF)))

    def feature(self, element: Element, feature: Feature, event: Event) -> None:
        """Take a member that is an attribute, or a reference that does not contain."""
        if not feature.is_reference:
            self._attribute(element, feature, event)
        elif event[0] == WORD and event[2] == "null":
            self.nothing(element, feature)
        else:
            self._reference(element, feature, event)

    def nothing(self, element: Element, feature: Feature) -> None:
        """Take note that nothing is said to be in a feature, which differs from silence for some."""
        if feature.unsettable:
            self._draft.source.blanks.add((element, feature))

    def link(self, element: Element, feature: Feature, text: str, place: Place) -> None:
        """Take note of a reference that stands alone."""
        line = self._stream.line(place)
        text = _one_of(text, feature)
        made = Pending(element, feature, text, line) if feature.linked else (element, feature, text, line)
        self._draft.pending.append(made)

    def unfit(
        self,
        element: Element,
        feature: Feature,
        reason: str,
        place: Place,
        code: str = "XMI005",
        hint: str = "",
    ) -> None:
        """Report what cannot be the value of an attribute."""
        self._draft.fault(code, f"{feature.name}: {reason}", self._stream.line(place), element, hint, feature)

    def no_object(self, element: Element, feature: Feature, line: int) -> None:
        """Report what stands where only elements can."""
        self._draft.fault("XMI010", f"{feature.name}: takes objects", line, element, broken=feature)

    # attributes

    def _attribute(self, element: Element, feature: Feature, event: Event) -> None:
        first, count = event, 0
        for count, each in enumerate(self._values(event, feature), 1):
            if feature.many:
                self._value(element, feature, each, event[3])
            first = each if count == 1 else first
        if not count:
            self.nothing(element, feature)
        elif not feature.many and count == 1:
            self._value(element, feature, first, event[3])
        elif not feature.many:
            self.unfit(element, feature, f"a list of {count} values, takes one", event[3], "XMI009")

    def _values(self, event: Event, feature: Feature) -> Iterator[Event]:
        """Yield the values of a list, or the one that is there; what stands inside them is passed over."""
        sort, key, text, place, begin = event
        if isinstance(text, Words) and feature.many:
            yield from ((sort, key, part, place, begin) for part in words_of(text))
            return
        for each in self._opened(event):
            skip(each, self._events)
            yield each

    def _value(self, element: Element, feature: Feature, event: Event, place: Place) -> None:
        kind = feature.type
        assert not isinstance(kind, Metaclass)  # it is an attribute
        sort, _, text, _, _ = event
        if sort == WORD and text == "null":
            self._null(element, feature, place)
            return
        try:
            found = parsed(kind, sort, text)
        except ValueError as fault:
            hint = kind.meant(text) if isinstance(kind, Enumeration) else ""
            self.unfit(element, feature, str(fault), place, hint=hint)
            return
        if feature.many:
            getattr(element, feature.attribute).append(found)
        else:
            type(element)._mmrs_slots[feature.attribute].__set__(element, found)
        if feature.is_id:
            self._draft.identify(element, text, element._mmrs_line, own=True)

    def _null(self, element: Element, feature: Feature, place: Place) -> None:
        if is_null(feature, None):
            getattr(element, feature.attribute).append(None)
        elif feature.many or getattr(feature.type, "primitive", True):
            self.unfit(element, feature, "cannot be null", place)
        elif feature.default is not None:
            type(element)._mmrs_slots[feature.attribute].__set__(element, None)
        else:
            self.nothing(element, feature)

    # references

    def _reference(self, element: Element, feature: Feature, event: Event) -> None:
        line = self._stream.line(event[3])
        if feature.many:
            self._listed(element, feature, event, line)
            return
        links = self._links(event, feature, line)
        first = next(links, None)
        count = 1 + sum(1 for _ in links)
        if first is None:
            self.nothing(element, feature)
        elif count > 1:
            message = f"{feature.name}: a list of {count}, takes one"
            self._draft.fault("XMI009", message, line, element, broken=feature)
        elif first[0] is None:
            self._no_link(element, feature, line)
        else:
            self._wait(element, feature, [first[0]], first[1])

    def _listed(self, element: Element, feature: Feature, event: Event, line: int) -> None:
        """Take references of which there may be many: those that follow each other become one, as in XMI."""
        words: list[str] = []
        place, said = line, False
        for text, at in self._links(event, feature, line):
            said = True
            if text is None:
                self._no_link(element, feature, line)
                continue
            if at != place or len(words) >= _MOST_WORDS:
                self._wait(element, feature, words, place)
                words.clear()
            if words and is_type(words[-1], text.partition(" ")[0]):
                words.append(_A_TYPE)
            place = at
            words.append(text)
        self._wait(element, feature, words, place)
        if not said:
            self.nothing(element, feature)

    def _wait(self, element: Element, feature: Feature, words: list[str], line: int) -> None:
        if words:
            self._draft.pending.append(Pending(element, feature, " ".join(words), line))

    def _no_link(self, element: Element, feature: Feature, line: int) -> None:
        message = f"{feature.name}: takes the names or paths of elements, such as //@tasks.0"
        self._draft.fault("XMI010", message, line, element, broken=feature)

    def _links(self, event: Event, feature: Feature, line: int) -> Iterator[tuple[str | None, int]]:
        """Yield each reference with its line; None where it is none."""
        for each in self._opened(event):
            if each[0] == OBJECT:
                at = self._stream.line(each[4])
                yield self._stated(), at
            else:
                skip(each, self._events)
                yield _one_of(each[2], feature) if each[0] == TEXT else None, line

    def _stated(self) -> str | None:
        """Return the reference that an object is which has begun; None where it says anything else."""
        said: list[Event] = []
        for event in self._rest():
            skip(event, self._events)
            said = [*said[:1], event]
        return as_address(said[0][2]) if len(said) == 1 and said[0][:2] == (TEXT, REF) else None

    def _opened(self, event: Event) -> Iterator[Event]:
        """Yield the values of a list, or the one that is there; who takes them goes to the end of each."""
        if event[0] == LIST:
            yield from self._rest()
        else:
            yield event

    def _rest(self) -> Iterator[Event]:
        """Yield what comes until the object or list ends that is open."""
        while (event := next(self._events))[0] != END:
            yield event


def _one_of(text: str, feature: Feature) -> str:
    """Return a reference as XMI would have it among those of a feature."""
    return one_of_many(text) if feature.many and not isinstance(text, Words) else text
