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
    from mmrs_core.languages.xmi.events import Start, Tell
    from mmrs_core.languages.xmi.shapes import Maker

_OFTEN = 16
"""Compiling costs as much as reading so many elements the careful way."""
_MOST_SHAPES = 2000
_MEANINGLESS = HARMLESS - {XSI_TYPE, f"{XMI} type"}
_NEARLY_DEEPEST = DEEPEST_NESTING - 2

_Key = tuple[Metaclass, str | None, str, int]
"""The owner, ``xsi:type``'s value where that comes first, as all write it, the tag, attributes' length."""
_Shape = tuple[Metaclass | str | None, ...]
"""The same, with the attributes' names instead of their number."""


class QuickReader(XmiReader):
    """Reads as `XmiReader` does, faults included, at a multiple of its speed."""

    def __init__(self, document: Document, draft: Draft, registry: Registry) -> None:
        super().__init__(document, draft, registry)
        self._shapes: dict[_Shape, Maker] = {}
        self._latest: dict[_Key, Maker] = {}
        self._seen: dict[_Shape, int] = {}
        self._quickly = self._quick_handlers()

    def start(self, tag: str, attributes: list[str]) -> None:
        """Take the start of an XML element the careful way."""
        super().start(tag, attributes)
        if len(self._open) + self._ignored + self._wrapped > DEEPEST_NESTING:
            self._document.refuse_depth()
        self._choose()

    def end(self, tag: str) -> None:
        """Take the end of an XML element the careful way."""
        super().end(tag)
        self._choose()

    def _choose(self) -> None:
        """Go the quick way where an element may follow, the careful one in values and in what is ignored."""
        if self._open and not self._ignored and self._open[-1][2] is None:
            self._document.tell(*self._quickly)
        else:
            self._document.tell(self.start, self.end, self.text)

    def _quick_handlers(self) -> tuple[Start, Tell, Tell]:
        # These run once for each element, and take a good part of the time of reading: hence so few calls.
        frames, latest, parser = self._open, self._latest, self._document.parser
        opened, close = frames.append, frames.pop
        wait, source = self._draft.pending.append, self._draft.source
        namespaces, changes = self._document.namespaces, 0

        def start(tag: str, attributes: list[str]) -> None:
            nonlocal changes
            if namespaces.changes != changes:
                changes = namespaces.changes
                self._forget()
            owner, metaclass, _ = frames[-1]
            kind = attributes[1] if attributes and attributes[0] == XSI_TYPE else None
            key = (metaclass, kind, tag, len(attributes))
            make = latest.get(key)
            try:
                if (
                    make is None
                    or len(frames) >= _NEARLY_DEEPEST
                    or not make(owner, attributes, parser.CurrentLineNumber, source, wait, opened)
                ):
                    self._take(key, attributes)
            except ValueError:  # the careful way finds out what is wrong
                self.start(tag, attributes)

        def end(tag: str) -> None:
            close()
            if not frames:
                self._choose()

        def text(text: str) -> None:
            if not text.isspace():
                self.text(text)

        return start, end, text

    def _take(self, key: _Key, attributes: list[str]) -> None:
        """Take the start of an element whose shape is not the latest of its kind."""
        owner, kind, tag, _ = key
        shape = (owner, kind, tag, *attributes[::2])
        make = self._shapes.get(shape)
        if make is None or len(self._open) >= _NEARLY_DEEPEST:
            self.start(tag, attributes)
            self._notice(shape)
        else:
            self._latest[key] = make
            line, draft = self._document.line, self._draft
            make(self._open[-1][0], attributes, line, draft.source, draft.pending.append, self._open.append)

    def _forget(self) -> None:
        """Forget what types mean: a prefix changed its meaning."""
        self._shapes.clear()
        self._latest.clear()
        self._seen.clear()

    def _notice(self, shape: _Shape) -> None:
        """Count an element that was read the careful way; compile its shape once it is worth it."""
        count = self._seen.get(shape, 0) + 1
        if count > 1 or len(self._seen) < _MOST_SHAPES:
            self._seen[shape] = count
        if count == _OFTEN:
            owner, kind, tag, *names = shape
            make = self._compiled(owner, kind, tag, names)  # type: ignore[arg-type]  # as the shape was made
            if make is not None:
                self._shapes[shape] = make

    def _compiled(self, owner: Metaclass, kind: str | None, tag: str, names: list[str]) -> Maker | None:
        """Return what makes elements of a shape, or None where the careful way has to ask more."""
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
        key = (owner, feature, metaclass, *names)
        makers = self._registry.makers
        if key not in makers and len(makers) < _MOST_SHAPES:
            features = tuple(metaclass.by_name.get(name) for name in names)
            implementation = self._registry.implementation(metaclass)
            makers[key] = maker(owner, feature, metaclass, implementation, tuple(names), features)
        return makers.get(key)

    def _known(self, kind: str) -> Metaclass | None:
        prefix, _, name = kind.rpartition(":")
        ns_uri = self._document.namespaces.uri(prefix) or ""
        try:
            return self._registry.metaclass(ns_uri, name)
        except ValueError:
            return None
