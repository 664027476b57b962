"""From a stream of JSON to elements: all faults reported, references left as texts."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field

from mmrs_core.errors import UnreadableError
from mmrs_core.languages.element import Element, Unknown
from mmrs_core.languages.json_form.members import Members, Usual, usual
from mmrs_core.languages.json_form.stream import (
    END,
    HEAD,
    LANGUAGES,
    LIST,
    NUMBER,
    OBJECT,
    REF,
    ROOTS,
    TEXT,
    TYPE,
    WORD,
    Event,
    Place,
    Stream,
    is_own,
    skip,
    texts_in,
)
from mmrs_core.languages.json_form.types import Types
from mmrs_core.languages.json_form.unknown import DEEPEST_KEPT, SCOPE, XML, Kept, kept
from mmrs_core.languages.metaclass import Feature, Metaclass
from mmrs_core.languages.references.documents import Draft, Pending
from mmrs_core.languages.registry import Registry

_Ways = Mapping[str, tuple[Feature, Usual | None]]
"""The features of a class, by key, and how their usual values are read."""


@dataclass(slots=True)
class _Open:
    """An object or a list that is being read.

    Attributes:
        element: that the object is, or that the list's elements go into.
        metaclass: of the element.
        ways: of the object; of a list, none.
        feature: that the list's elements go into; None for an object.
        line: where the list stands.
        count: how many values of the list there were.
        at_top: whether it is the whole file.
    """

    element: Element
    metaclass: Metaclass
    ways: _Ways
    feature: Feature | None = None
    line: int = 0
    count: int = 0
    at_top: bool = False


@dataclass(slots=True)
class _Begun:
    """An object whose class is still to be found out.

    Attributes:
        begin: its bracket.
        line: of that.
        late: what says its class behind other members.
        owner: the element that it stands in; None at the top.
        feature: of the owner.
        above: the line on which the owner says it.
        at_top: whether it is the whole file.
        declares: whether its `$languages` are still to be read.
        said: what it says of itself, such as `$type`; what stands inside that was passed over.
        scope: the texts in its `$namespaces`.
        deepest: levels of objects and lists inside it, as far as they were passed over.
    """

    begin: Place
    line: int
    late: Iterator[Event] | None
    owner: Element | None = None
    feature: Feature | None = None
    above: int = 0
    at_top: bool = False
    declares: bool = False
    said: list[Event] = field(default_factory=list)
    scope: Mapping[str, str] = field(default_factory=dict)
    deepest: int = 0

    def type(self) -> Event | None:
        """Return what it says under `$type`, wherever that stands."""
        found = next((event for event in self.said if event[1] == TYPE), None)
        return next(self.late) if found is None and self.late is not None else found


class JsonReader:
    """Reads one stream into a draft.

    Attributes:
        made: the element that was made of each object of a tree, by its `id`.
    """

    def __init__(self, stream: Stream, draft: Draft, registry: Registry) -> None:
        self.made: dict[int, Element] = {}
        self._stream = stream
        self._events = stream.events()
        self._draft = draft
        self._members = Members(stream, self._events, draft)
        self._types = Types(stream, draft, registry)
        self._ways: dict[Metaclass, _Ways] = {}
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
        start = _Begun(begin, self._stream.line(begin), self._stream.late(TYPE), at_top=True)
        if languages is not None:
            self._types.declare(next(languages), languages)
        start.declares = languages is None
        event = self._head(start)
        if several or event[1] == ROOTS:
            self._several(start, event)
        elif start.late is not None or start.type() is not None:
            self._read_on(self._element(start, event))
        else:
            self._no_model(start.line)

    def _no_model(self, line: int) -> None:
        hint = f"say which class it is of by {TYPE}; 'mmrs migrate' reads the JSON of another platform"
        self._draft.fault("XMI015", f"the root: no model: it has no {TYPE}", line, hint=hint)

    def _several(self, start: _Begun, event: Event) -> None:
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

    def _head(self, start: _Begun) -> Event:
        """Take what an object says of itself before all else, and return what follows."""
        while is_own((event := next(self._events))[1]) and not (start.at_top and event[1] == ROOTS):
            sort, key, _, place, begin = event
            if key == LANGUAGES and start.declares:
                self._types.declare(event, self._events)
            elif key == SCOPE:
                start.scope = texts_in(event, self._events) or {}
            else:
                start.deepest = max(start.deepest, skip(event, self._events))
            start.said.append(event if sort < OBJECT else (WORD, key, "null", place, begin))
        return event

    def _element(self, start: _Begun, event: Event) -> Event | None:
        """Make the element that an object stands for, given what follows its head, and return that."""
        feature, claimed = start.feature, start.type()
        if claimed is None and feature is not None:
            if event[0] == END and [each[1] for each in start.said] == [REF]:
                self._refer(start, start.said[0], feature)
                return None
            metaclass = feature.type
        else:
            found = self._types.known(claimed) or self._claimed(start, claimed, event)
            if found is None:
                return None
            metaclass = found
        if not isinstance(metaclass, Metaclass) or not self._may_be(start, metaclass, claimed is not None):
            self._pass(event)
            return None
        self._begin(start, metaclass)
        return event

    def _claimed(self, start: _Begun, claimed: Event | None, event: Event) -> Metaclass | None:
        """Return the class that an object says it is of; None where the object was kept, or passed over."""
        ns_uri, name = self._types.claimed(claimed, start.line, start.owner)
        if claimed is not None and ns_uri:
            if self._types.is_missing(ns_uri, name, claimed, start.owner):
                self._keep(start, event, f"{ns_uri}#{name}")
                return None
            metaclass = self._types.metaclass(ns_uri, name, claimed, start.owner)
            if metaclass is not None:
                return metaclass
        self._pass(event)
        return None

    def _may_be(self, start: _Begun, metaclass: Metaclass, is_claimed: bool) -> bool:
        """Return whether an element of a class may stand there; it is a fault otherwise."""
        feature = start.feature
        if metaclass.implementation is None:
            message = f"{metaclass.name}: abstract; say which kind of it by {TYPE}"
            self._members.fault("XMI003", message, start.line, start.owner)
            return False
        if is_claimed and feature is not None and not _fits(feature, metaclass):
            message = f"{metaclass.name}: not a {feature.type.name}, which {feature.name} takes"
            self._members.fault("XMI008", message, start.line, start.owner, broken=feature)
            return False
        return True

    def _begin(self, start: _Begun, metaclass: Metaclass) -> None:
        assert metaclass.implementation is not None  # it was asked before
        element = metaclass.implementation.__new__(metaclass.implementation)
        self._stands(element, start)
        ways = self._ways.get(metaclass)
        if ways is None:
            ways = self._ways[metaclass] = _ways_of(metaclass)
        self._open.append(_Open(element, metaclass, ways, at_top=start.at_top))
        for event in start.said:
            if event[1] != TYPE:
                self._members.other(element, metaclass, event, start.at_top)

    def _stands(self, element: Element, start: _Begun) -> None:
        owner, feature = start.owner, start.feature
        if not isinstance(start.begin, int):
            self.made[id(start.begin)] = element
        element._mmrs_line = start.line
        element._mmrs_source = self._draft.source
        if owner is None or feature is None:
            self._draft.roots.append(element)
            return
        if feature.many:
            getattr(owner, feature.attribute).put(element)
        else:
            type(owner)._mmrs_slots[feature.attribute].__set__(owner, element)
        element._mmrs_container = owner
        element._mmrs_feature = feature
        opposite = feature.opposite
        if opposite is not None and not isinstance(element, Unknown):
            type(element)._mmrs_slots[opposite.attribute].__set__(element, owner)

    def _refer(self, start: _Begun, event: Event, feature: Feature) -> None:
        """Take note that what stands in another file is contained here."""
        assert start.owner is not None  # there is a feature
        if event[0] == TEXT:
            self._draft.pending.append(Pending(start.owner, feature, event[2], start.line))
        else:
            self._no_object(start.owner, feature, start.above)

    def _no_object(self, owner: Element, feature: Feature, line: int) -> None:
        self._members.fault("XMI010", f"{feature.name}: takes objects", line, owner, broken=feature)

    def _pass(self, event: Event) -> None:
        """Go to the end of the object that is open, from an event in it."""
        while event[0] != END:
            skip(event, self._events)
            event = next(self._events)

    def _keep(self, start: _Begun, event: Event, claimed: str) -> None:
        """Keep an object whose language is not installed, and go to its end."""
        xml = next((each[2] for each in start.said if each[1] == XML), None)
        scope = start.scope
        while event[0] != END:
            if event[1] == SCOPE:
                scope = texts_in(event, self._events) or {}
            else:
                start.deepest = max(start.deepest, skip(event, self._events))
            xml = event[2] if event[1] == XML else xml
            event = next(self._events)
        try:
            if start.deepest >= DEEPEST_KEPT:
                raise ValueError(f"{claimed}: nested deeper than {DEEPEST_KEPT} levels")
            text = self._stream.source(start.begin, event[4]) if xml is None else ""
            unknown = kept(Kept(text, xml, scope), claimed, self._types.languages)
        except ValueError as fault:
            raise UnreadableError(f"{self._stream.file}:{start.line}: {fault}") from None
        self._stands(unknown, start)

    # what elements say

    def _read_on(self, event: Event | None) -> None:
        """Read all that is open to its end, from an event on, or from the next."""
        opened, members = self._open, self._members
        while opened:
            # this runs for every member of a large file
            event = event or next(self._events)
            sort, key, text, place, _ = event
            top = opened[-1]
            element, way = top.element, top.ways.get(key)
            following = None
            if sort == END:
                self._end(opened.pop())
            elif top.feature is not None:
                following = self._item(top, top.feature, event)
            elif way is None:
                members.other(element, top.metaclass, event, top.at_top)
            else:
                feature, usual = way
                read = None if usual is None else _reading(usual, sort)
                if usual is not None and read is not None:
                    try:
                        usual.put(element, read(text))
                    except ValueError as fault:
                        members.unfit(element, feature, str(fault), place)
                elif feature.containment:
                    following = self._inside(top, feature, event)
                elif sort == TEXT and feature.is_reference:
                    members.link(element, feature, text, place)
                else:
                    members.feature(element, feature, event)
            event = following

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
            self._no_object(top.element, feature, line)
        return None

    def _item(self, top: _Open, feature: Feature, event: Event) -> Event | None:
        """Take a value of a list of elements; where one is taken only, the first."""
        top.count += 1
        if event[0] == OBJECT and (feature.many or top.count == 1):
            return self._object(top.element, feature, event[4], top.line)
        skip(event, self._events)
        if event[0] != OBJECT:
            self._no_object(top.element, feature, top.line)
        return None

    def _end(self, ended: _Open) -> None:
        feature = ended.feature
        if feature is not None and not ended.count:
            self._members.nothing(ended.element, feature)
        elif feature is not None and ended.count > 1 and not feature.many:
            message = f"{feature.name}: a list of {ended.count}, takes one"
            self._members.fault("XMI009", message, ended.line, ended.element, broken=feature)

    def _object(
        self, owner: Element | None, feature: Feature | None, begin: Place, above: int
    ) -> Event | None:
        """Read an object up to its first feature, which is returned; None where it has ended already."""
        start = _Begun(begin, self._stream.line(begin), self._stream.late(TYPE), owner, feature, above)
        return self._element(start, self._head(start))


def _reading(usual: Usual, sort: int) -> Callable[[str], object] | None:
    if sort == TEXT:
        return usual.text
    return usual.number if sort == NUMBER else None


def _ways_of(metaclass: Metaclass) -> _Ways:
    return {
        f"${each.name}" if each.name.startswith("$") else each.name: (each, usual(metaclass, each))
        for each in metaclass.features
    }


def _fits(feature: Feature, metaclass: Metaclass) -> bool:
    kind, made = feature.type, metaclass.implementation
    # by interface, since every element is an EObject, though no metamodel says so
    return isinstance(kind, Metaclass) and made is not None and issubclass(made, kind.interface)
