"""From the beginning of a JSON object to the element that it stands for."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from mmrs_core.errors import UnreadableError
from mmrs_core.languages.element import Element
from mmrs_core.languages.json_form.members import Members
from mmrs_core.languages.json_form.stream import (
    END,
    LANGUAGES,
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
from mmrs_core.languages.json_form.unknown import DEEPEST_KEPT, SCOPE, XML, Kept, kept
from mmrs_core.languages.links import settle
from mmrs_core.languages.metaclass import Feature, Metaclass
from mmrs_core.languages.missing import hint_for
from mmrs_core.languages.naming import nearest
from mmrs_core.languages.references.documents import Draft, Pending
from mmrs_core.languages.references.spelling import as_address
from mmrs_core.languages.registry import Registry
from mmrs_core.languages.xmi.events import LONGEST_NAMESPACE


class Types:
    """The languages of one file, and their classes.

    Attributes:
        languages: the nsURI of each prefix that the file declares.
    """

    def __init__(self, stream: Stream, draft: Draft, registry: Registry) -> None:
        self.languages: Mapping[str, str] = {}
        self._stream = stream
        self._draft = draft
        self._registry = registry
        self._known: dict[str, Metaclass] = {}
        self._hints: dict[str, str] = {}

    def declare(self, event: Event, events: Iterator[Event]) -> None:
        """Take what the file says under `$languages`."""
        line = self._stream.line(event[3])
        found = texts_in(event, events)
        if found is None:
            self._draft.fault("XMI010", f"{LANGUAGES}: takes an object of texts", line)
            return
        for prefix in [prefix for prefix, ns_uri in found.items() if len(ns_uri) > LONGEST_NAMESPACE]:
            message = f"{LANGUAGES}: the nsURI of {prefix} is longer than {LONGEST_NAMESPACE} characters"
            self._draft.fault("XMI010", message, line)
            del found[prefix]
        self.languages = found

    def claimed(self, event: Event | None, line: int, owner: Element | None) -> tuple[str, str]:
        """Return nsURI and name of the class that an object says it is of; empty texts where it does not.

        Args:
            event: its `$type`; None where it has none.
            line: of the object.
            owner: what it stands in.
        """
        if event is None or event[0] != TEXT:
            code = "XMI015" if event is None else "XMI010"
            message = f"{TYPE}: the name of a class, such as mission:Mission, is needed"
            self._draft.fault(code, message, line, owner)
            return "", ""
        text = event[2]
        if "#" in text:
            ns_uri, _, name = text.rpartition("#")
            return ns_uri, name.removeprefix("//")
        prefix, _, name = text.rpartition(":")
        if prefix not in self.languages:
            hint = nearest(prefix, self.languages) or f"say in {LANGUAGES} which language {prefix!r} is"
            message = f"{text}: the prefix {prefix!r} is not declared"
            self._draft.fault("XMI014", message, self._stream.line(event[3]), owner, hint)
        return self.languages.get(prefix, ""), name

    def implementation(self, metaclass: Metaclass) -> type[Element] | None:
        """Return the class of a metaclass's elements; None for an abstract one."""
        return self._registry.implementation(metaclass)

    def known(self, event: Event | None) -> Metaclass | None:
        """Return the class of that `$type` if it was asked for before."""
        return self._known.get(event[2]) if event is not None else None

    def metaclass(self, ns_uri: str, name: str, event: Event, owner: Element | None) -> Metaclass | None:
        """Return the class of that nsURI and name, which a `$type` claims; without one it is a fault."""
        try:
            found = self._registry.metaclass(ns_uri, name)
        except ValueError as fault:
            message, _, hint = str(fault).partition("; ")
            self._draft.fault("XMI002", message, self._stream.line(event[3]), owner, hint)
            return None
        self._known[event[2]] = found
        return found

    def is_missing(self, ns_uri: str, name: str, event: Event, owner: Element | None) -> bool:
        """Return whether a language is not installed, which is a fault."""
        if self._registry.has(ns_uri):
            return False
        if ns_uri not in self._hints:
            self._hints[ns_uri] = hint_for(ns_uri, self._registry)
        message = f"{ns_uri}: no such metamodel, needed for {name}"
        self._draft.fault("XMI001", message, self._stream.line(event[3]), owner, self._hints[ns_uri])
        return True


@dataclass(slots=True)
class Begun:
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
        said: its own keys, such as `$type`; their content was skipped.
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


class Beginnings:
    """Makes the elements of one file.

    Attributes:
        made: the element that was made of each object of a tree, by its `id`.
    """

    def __init__(
        self, stream: Stream, events: Iterator[Event], draft: Draft, members: Members, types: Types
    ) -> None:
        self.made: dict[int, Element] = {}
        self._stream = stream
        self._events = events
        self._draft = draft
        self._members = members
        self._types = types
        self._quick: dict[tuple[str, Feature | None], type[Element]] = {}

    def object(
        self, owner: Element | None, feature: Feature | None, begin: Place, above: int
    ) -> tuple[Element | None, Event]:
        """Read an object up to its first feature.

        Args:
            owner: the element that it stands in; None at the top.
            feature: of the owner.
            begin: its bracket.
            above: the line on which the owner says it.

        Returns:
            Its element and what follows; where there is none, the object has ended.
        """
        late, event = self._stream.late(TYPE), next(self._events)
        kind = event[2] if event[:2] == (TEXT, TYPE) else ""
        following = next(self._events) if kind else event
        line = self._stream.line(begin)
        made = self._quick.get((kind, feature))
        if made is not None and late is None and following[1][:1] != "$":
            element = made.__new__(made)
            self._stands(element, owner, feature, begin, line)
            return element, following
        start = Begun(begin, line, late, owner, feature, above, said=[event] if kind else [])
        found, following = self.element(start, self.head(start, following))
        if found is not None and late is None and all(event[1] == TYPE for event in start.said):
            self._quick[kind, feature] = type(found)
        return found, following

    def head(self, start: Begun, event: Event) -> Event:
        """Take the leading own keys of an object, from an event on, and return what follows."""
        while is_own(event[1]) and not (start.at_top and event[1] == ROOTS):
            sort, key, _, place, begin = event
            if key == LANGUAGES and start.declares:
                self._types.declare(event, self._events)
            elif key == SCOPE:
                start.scope = texts_in(event, self._events) or {}
            else:
                start.deepest = max(start.deepest, skip(event, self._events))
            start.said.append(event if sort < OBJECT else (WORD, key, "null", place, begin))
            event = next(self._events)
        return event

    def element(self, start: Begun, event: Event) -> tuple[Element | None, Event]:
        """Make the element that an object stands for, given what follows its head; returns as `object`."""
        feature, claimed = start.feature, start.type()
        if claimed is None and feature is not None:
            if event[0] == END and [each[1] for each in start.said] == [REF]:
                self._refer(start, start.said[0], feature)
                return None, event
            metaclass = feature.type
        else:
            found = self._types.known(claimed) or self._claimed(start, claimed, event)
            if found is None:
                return None, event
            metaclass = found
        if not isinstance(metaclass, Metaclass):
            self._pass(event)
            return None, event
        if not self._may_be(start, metaclass, claimed is not None):
            if start.owner is not None:
                self._keep(start, event, f"{metaclass.ns_uri}#{metaclass.name}")
            else:
                self._pass(event)
            return None, event
        return self._made(start, metaclass), event

    def _made(self, start: Begun, metaclass: Metaclass) -> Element:
        made = self._types.implementation(metaclass)
        assert made is not None  # it was asked before
        element = made.__new__(made)
        self._stands(element, start.owner, start.feature, start.begin, start.line)
        for event in start.said:
            if event[1] != TYPE:
                self._members.other(element, metaclass, event, start.at_top)
        return element

    def _claimed(self, start: Begun, claimed: Event | None, event: Event) -> Metaclass | None:
        """Return the class that an object says it is of; None where the object was kept, or passed over."""
        ns_uri, name = self._types.claimed(claimed, start.line, start.owner)
        if claimed is not None and ns_uri:
            if self._types.is_missing(ns_uri, name, claimed, start.owner):
                self._keep(start, event, f"{ns_uri}#{name}")
                return None
            metaclass = self._types.metaclass(ns_uri, name, claimed, start.owner)
            if metaclass is not None:
                return metaclass
        if start.owner is not None:
            self._keep(start, event, f"{ns_uri}#{name}")
        else:
            self._pass(event)
        return None

    def _may_be(self, start: Begun, metaclass: Metaclass, is_claimed: bool) -> bool:
        """Return whether an element of a class may stand there; it is a fault otherwise."""
        feature = start.feature
        if metaclass.implementation is None:
            message = f"{metaclass.name}: abstract; state a concrete subclass by {TYPE}"
            self._draft.fault("XMI003", message, start.line, start.owner)
            return False
        if is_claimed and feature is not None and not _fits(feature, metaclass):
            message = f"{metaclass.name}: not a {feature.type.name}, which {feature.name} takes"
            self._draft.fault("XMI008", message, start.line, start.owner)
            return False
        return True

    def _stands(
        self, element: Element, owner: Element | None, feature: Feature | None, begin: Place, line: int
    ) -> None:
        if begin.__class__ is not int:
            self.made[id(begin)] = element
        element._mmrs_line = line
        element._mmrs_source = self._draft.source
        if owner is None or feature is None:
            self._draft.roots.append(element)
            return
        settle(owner, feature, element)

    def _refer(self, start: Begun, event: Event, feature: Feature) -> None:
        """Take note that what stands in another file is contained here."""
        assert start.owner is not None  # there is a feature
        if event[0] == TEXT:
            self._draft.pending.append(Pending(start.owner, feature, as_address(event[2]), start.line))
        else:
            self._members.no_object(start.owner, feature, start.above)

    def _pass(self, event: Event) -> None:
        """Go to the end of the object that is open, from an event in it."""
        while event[0] != END:
            skip(event, self._events)
            event = next(self._events)

    def _keep(self, start: Begun, event: Event, claimed: str) -> None:
        """Keep an object of an unknown, wrong or abstract class, which holds its place; go to its end."""
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
            raise UnreadableError.of("FIL006", str(fault), self._stream.file, start.line) from None
        self._stands(unknown, start.owner, start.feature, start.begin, start.line)


def _fits(feature: Feature, metaclass: Metaclass) -> bool:
    kind, made = feature.type, metaclass.implementation
    # by interface, since every element is an EObject, though no metamodel says so
    return isinstance(kind, Metaclass) and made is not None and issubclass(made, kind.interface)
