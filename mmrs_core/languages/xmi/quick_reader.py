"""The reader for large files: what occurs often goes through compiled functions, all else the careful way."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mmrs_core.languages.metaclass import Metaclass
from mmrs_core.languages.references.documents import Draft
from mmrs_core.languages.registry import Registry
from mmrs_core.languages.xmi.events import DEEPEST_NESTING, XMI, XSI_TYPE, Document
from mmrs_core.languages.xmi.reader import HARMLESS, XmiReader
from mmrs_core.languages.xmi.shapes import maker

if TYPE_CHECKING:
    from mmrs_core.languages.xmi.shapes import Maker

_OFTEN = 16
"""Compiling costs as much as reading so many elements the careful way."""
_MOST_SHAPES = 2000
_MEANINGLESS = HARMLESS - {XSI_TYPE, f"{XMI} type"}

_Shape = tuple["Maker", Metaclass]
_Key = tuple[Metaclass | str | None, ...]
"""The owner, ``xsi:type``'s value where that comes first, as all write it, the tag, the attributes' names."""


class QuickReader(XmiReader):
    """Reads as `XmiReader` does, faults included, at a multiple of its speed."""

    def __init__(self, document: Document, draft: Draft, registry: Registry) -> None:
        super().__init__(document, draft, registry)
        self._parser = document.parser
        self._namespaces = document.namespaces
        self._wait = draft.pending.append
        self._source = draft.source
        self._changes = 0
        self._shapes: dict[_Key, _Shape] = {}
        self._seen: dict[_Key, int] = {}

    def start(self, tag: str, attributes: list[str]) -> None:
        """Take the start of an XML element."""
        # This runs once for each element, and takes a good part of the time of reading: hence no calls.
        frames = self._open
        if self._ignored or not frames or frames[-1][2] is not None:
            super().start(tag, attributes)
            self._bound_depth()
            return
        if self._namespaces.changes != self._changes:
            self._forget()
        owner, metaclass, _ = frames[-1]
        kind = attributes[1] if attributes and attributes[0] == XSI_TYPE else None
        key = (metaclass, kind, tag, *attributes[::2])
        shape = self._shapes.get(key)
        if shape is None:
            super().start(tag, attributes)
            self._notice(key)
        else:
            make, metaclass = shape
            try:
                element = make(owner, attributes, self._parser.CurrentLineNumber, self._source, self._wait)
                frames.append((element, metaclass, None))
            except ValueError:  # the careful way finds out what is wrong
                super().start(tag, attributes)
        if len(frames) >= DEEPEST_NESTING:
            self._bound_depth()

    def _bound_depth(self) -> None:
        if len(self._open) + self._ignored + self._wrapped > DEEPEST_NESTING:
            self._document.refuse_depth()

    def _forget(self) -> None:
        """Forget what types mean: a prefix changed its meaning."""
        self._changes = self._namespaces.changes
        self._shapes.clear()
        self._seen.clear()

    def _notice(self, key: _Key) -> None:
        """Count an element that was read the careful way; compile its shape once it is worth it."""
        count = self._seen.get(key, 0) + 1
        if count > 1 or len(self._seen) < _MOST_SHAPES:
            self._seen[key] = count
        if count == _OFTEN:
            owner, kind, tag, *names = key
            shape = self._compiled(owner, kind, tag, names)  # type: ignore[arg-type]  # as the key was made
            if shape is not None:
                self._shapes[key] = shape

    def _compiled(self, owner: Metaclass, kind: str | None, tag: str, names: list[str]) -> _Shape | None:
        """Return what the key means, or None where the careful way has to ask more."""
        feature = owner.by_name.get(tag)
        if feature is None or not feature.containment or not isinstance(feature.type, Metaclass):
            return None
        metaclass = feature.type if kind is None else self._known(kind)
        if metaclass is None or not issubclass(metaclass.interface, feature.type.interface):
            return None
        given = names if kind is None else names[1:]
        if (
            any(name not in metaclass.by_name and name not in _MEANINGLESS for name in given)
            or "href" in given
        ):
            return None
        features = (metaclass.by_name.get(name) for name in names)
        make = maker(owner, feature, metaclass, tuple(features))
        return None if make is None else (make, metaclass)

    def _known(self, kind: str) -> Metaclass | None:
        prefix, _, name = kind.rpartition(":")
        ns_uri = self._document.namespaces.uri(prefix) or ""
        try:
            return self._registry.metaclass(ns_uri, name)
        except ValueError:
            return None
