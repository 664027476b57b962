"""From a stream of JSON to elements: all faults reported, references left as texts."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from mmrs_core.languages.element import Element, metaclass_of
from mmrs_core.languages.json_form.beginnings import Beginnings, Begun, Types
from mmrs_core.languages.json_form.members import FeatureReader, Members, feature_readers
from mmrs_core.languages.json_form.stream import (
    END,
    HEAD,
    LANGUAGES,
    LIST,
    OBJECT,
    ROOTS,
    TEXT,
    TYPE,
    WORD,
    Event,
    Place,
    Stream,
    skip,
)
from mmrs_core.languages.metaclass import Feature, Metaclass
from mmrs_core.languages.references.documents import Draft
from mmrs_core.languages.registry import Registry

_Readers = Mapping[str, FeatureReader]


@dataclass(slots=True)
class _Open:
    """An object or a list that is being read.

    Attributes:
        element: that the object is, or that the list's elements go into.
        metaclass: of the element.
        readers: how members of the object are read; of a list, none.
        feature: that the list's elements go into; None for an object.
        line: where the list stands.
        count: how many values of the list there were.
        at_top: whether it is the whole file.
    """

    element: Element
    metaclass: Metaclass
    readers: _Readers
    feature: Feature | None = None
    line: int = 0
    count: int = 0
    at_top: bool = False


class JsonReader:
    """Reads one stream into a draft.

    Attributes:
        made: the element that was made of each object of a tree, by its `id`.
    """

    def __init__(self, stream: Stream, draft: Draft, registry: Registry) -> None:
        self._stream = stream
        self._events = stream.events()
        self._draft = draft
        self._members = Members(stream, self._events, draft)
        self._types = Types(stream, draft, registry)
        self._beginnings = Beginnings(stream, self._events, draft, self._members, self._types)
        self.made: Mapping[int, Element] = self._beginnings.made
        self._readers: dict[Metaclass, _Readers] = {}
        self._open: list[_Open] = []

    def read(self) -> None:
        """Make all elements of the file."""
        event = next(self._events)
        if event[0] == OBJECT:
            self._top(event[4])
        else:
            self._draft.fault("XMI015", "the file: no model: its top is not an object", 1)
        for _ in self._events:  # what is not read must be sound nevertheless
            pass

    # the file

    def _top(self, begin: Place) -> None:
        languages, several = self._stream.late(LANGUAGES), self._stream.late(ROOTS) is not None
        start = Begun(begin, self._stream.line(begin), self._stream.late(TYPE), at_top=True)
        if languages is not None:
            self._types.declare(next(languages), languages)
        start.declares = languages is None
        event = self._beginnings.head(start, next(self._events))
        if several or event[1] == ROOTS:
            self._several(start, event)
        elif start.late is not None or start.type() is not None:
            self._read_on(self._opened(*self._beginnings.element(start, event), at_top=True))
        else:
            self._no_model(start.line)

    def _no_model(self, line: int) -> None:
        hint = f"state its class by {TYPE}"
        self._draft.fault("XMI015", f"the root: no model: it has no {TYPE}", line, hint=hint)

    def _several(self, start: Begun, event: Event) -> None:
        """Read the object at the top that holds a list of elements; nothing else may stand beside it."""
        for each in start.said:
            self._beside(each)
        while event[0] != END:
            if event[:3] == (WORD, ROOTS, "null"):
                self._no_model(start.line)
            elif event[1] == ROOTS:
                self._roots(event)
            else:
                self._beside(event)
                skip(event, self._events)
            event = next(self._events)

    def _beside(self, event: Event) -> None:
        if event[1] not in HEAD:
            line = self._stream.line(event[3])
            self._draft.fault("XMI004", f"{event[1]}: not beside {ROOTS}", line)

    def _roots(self, event: Event) -> None:
        line = self._stream.line(event[3])
        each = next(self._events) if event[0] == LIST else event
        while each[0] != END:
            if each[0] == OBJECT:
                self._read_on(self._object(None, None, each[4], line))
            else:
                skip(each, self._events)
                self._draft.fault("XMI010", f"{ROOTS}: takes a list of objects", line)
            if event[0] != LIST:
                return
            each = next(self._events)

    # elements

    def _object(
        self, owner: Element | None, feature: Feature | None, begin: Place, above: int
    ) -> Event | None:
        return self._opened(*self._beginnings.object(owner, feature, begin, above))

    def _opened(self, element: Element | None, following: Event, at_top: bool = False) -> Event | None:
        """Open an element, and return what follows; None where the object has ended without one."""
        if element is None:
            return None
        metaclass = metaclass_of(element)
        readers = self._readers.get(metaclass)
        if readers is None:
            readers = self._readers[metaclass] = feature_readers(metaclass)
        self._open.append(_Open(element, metaclass, readers, at_top=at_top))
        return following

    def _read_on(self, event: Event | None) -> None:
        """Read all that is open to its end, from an event on, or from the next."""
        opened = self._open
        while opened:
            top = opened[-1]
            event = event or next(self._events)
            if top.feature is None:
                event = self._members_of(top, event)
            elif event[0] == END:
                self._end(opened.pop())
                event = None
            else:
                event = self._item(top, top.feature, event)

    def _members_of(self, top: _Open, event: Event) -> Event | None:
        """Read the members of an object, from an event on, until another object or list is open, or none."""
        # this runs for every member of a large file
        element, readers, events, members, opened = (
            top.element,
            top.readers,
            self._events,
            self._members,
            self._open,
        )
        while event[0] != END:
            sort, key, text, place, _ = event
            reader = readers.get(key)
            if reader is None:
                members.other(element, top.metaclass, event, top.at_top)
            elif (read := reader.usual[sort]) is not None:
                try:
                    reader.put(element, read(text))
                except ValueError as fault:
                    members.unfit(element, reader.feature, str(fault), place)
            elif reader.links and sort == TEXT:
                members.link(element, reader.feature, text, place)
            elif reader.feature.containment:
                following = self._inside(top, reader.feature, event)
                if following is not None or opened[-1] is not top:
                    return following
            else:
                members.feature(element, reader.feature, event)
            event = next(events)
        opened.pop()
        return None

    def _inside(self, top: _Open, feature: Feature, event: Event) -> Event | None:
        """Take what stands in a feature that contains elements."""
        sort, _, text, place, begin = event
        line = self._stream.line(place)
        if sort == OBJECT:
            return self._object(top.element, feature, begin, line)
        if sort == LIST:
            self._open.append(_Open(top.element, top.metaclass, {}, feature, line))
        elif sort == WORD and text == "null":
            self._members.nothing(top.element, feature)
        else:
            self._members.no_object(top.element, feature, line)
        return None

    def _item(self, top: _Open, feature: Feature, event: Event) -> Event | None:
        """Take a value of a list of elements; where one is taken only, the first."""
        top.count += 1
        if event[0] == OBJECT and (feature.many or top.count == 1):
            return self._object(top.element, feature, event[4], top.line)
        skip(event, self._events)
        if event[0] != OBJECT:
            self._members.no_object(top.element, feature, top.line)
        return None

    def _end(self, ended: _Open) -> None:
        feature = ended.feature
        if feature is not None and not ended.count:
            self._members.nothing(ended.element, feature)
        elif feature is not None and ended.count > 1 and not feature.many:
            message = f"{feature.name}: a list of {ended.count}, takes one"
            self._draft.fault("XMI009", message, ended.line, ended.element, broken=feature)
