"""Which class an object of JSON is of, by what it says, and what is wrong with that."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from mmrs_core.languages.element import Element
from mmrs_core.languages.json_form.stream import LANGUAGES, TEXT, TYPE, Event, Stream, texts_in
from mmrs_core.languages.metaclass import Metaclass
from mmrs_core.languages.missing import hint_for
from mmrs_core.languages.naming import nearest
from mmrs_core.languages.references.documents import Draft
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
