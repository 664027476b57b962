"""XML as a stream of events, with the line of each, and with bounds that hostile files run into."""

from __future__ import annotations

import re
import stat
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import NoReturn, Protocol
from xml.parsers import expat

from mmrs_core.errors import UnreadableError

LARGEST_FILE = 512 * 1024 * 1024
DEEPEST_NESTING = 400
MOST_ATTRIBUTES = 10_000
LONGEST_NAMESPACE = 2000
"""Messages and types repeat a namespace; ten thousand times a megabyte fills any memory."""
_SHORTEST_ATTRIBUTE = len(' a=""')
_TAG = re.compile(rb"<[^\s<>/=]+")
_WHOLE_TAG = re.compile(rb"""[^>"']*(?:"[^"]*"[^>"']*|'[^']*'[^>"']*)*>""")
_ATTRIBUTE = re.compile(rb"""\s+[^\s<>/="']+\s*=\s*(?:"[^"<]*"|'[^'<]*')""")
Start = Callable[[str, list[str]], None]
Tell = Callable[[str], None]
XMI = "http://www.omg.org/XMI"
XSI = "http://www.w3.org/2001/XMLSchema-instance"
XSI_TYPE = f"{XSI} type"
_SEVEN_BITS = ("ASCII", "US-ASCII")
_OTHER_XMI = re.compile(r"http://schema\.omg\.org/spec/XMI/2\.[0-9]|http://www\.omg\.org/spec/XMI/20[0-9]{6}")
"""How later versions of XMI than 2.0 call it; what we read of them means the same."""
_XMI_NAMES = ("XMI", "type", "id", "idref", "uuid", "version", "label", "Documentation", "Extension")


class Listener(Protocol):
    """What a document tells while it is parsed; a qualified name is ``namespace name``."""

    def start(self, tag: str, attributes: list[str]) -> None:
        """Take the start of an element; the attributes are name, value, name, value in file order."""

    def end(self, tag: str) -> None:
        """Take the end of an element."""

    def text(self, text: str) -> None:
        """Take character data."""


class Namespaces:
    """The prefixes in scope while a document is parsed.

    Attributes:
        changes: how often a prefix was bound or a binding undone.
    """

    def __init__(self) -> None:
        self._bindings: dict[str, list[str]] = {}
        self.changes = 0

    def open(self, prefix: str | None, uri: str | None) -> None:
        """Bind a prefix; None stands for the default namespace."""
        self.changes += 1
        self._bindings.setdefault(prefix or "", []).append(uri or "")

    def close(self, prefix: str | None) -> None:
        """Undo the last binding of a prefix."""
        self.changes += 1
        self._bindings[prefix or ""].pop()

    def uri(self, prefix: str) -> str | None:
        """Return what a prefix is bound to, or None."""
        stack = self._bindings.get(prefix)
        return stack[-1] if stack else None

    def in_scope(self, prefixes: Iterable[str] | None = None) -> dict[str, str]:
        """Return the bindings that hold now, of all prefixes or of some."""
        wanted = self._bindings if prefixes is None else prefixes
        return {prefix: stack[-1] for prefix in wanted if (stack := self._bindings.get(prefix))}


class Document:
    """One XML document and its parser.

    Attributes:
        file: what messages call it.
        data: its bytes, in an encoding that offsets count in.
        namespaces: the prefixes in scope at the current event.
        encoding: the declared one.
        parser: expat's; for listeners that need the line of every element.
    """

    def __init__(self, data: bytes, file: str) -> None:
        self.file = file
        self.data, override = _without_wide_characters(data, file)
        self._declared = override is None
        self.namespaces = Namespaces()
        self.encoding = override or "UTF-8"
        self._depth = 0
        self._begun = False
        self.parser = expat.ParserCreate(override, " ", {XSI_TYPE: XSI_TYPE})
        self.parser.buffer_text = True
        self.parser.ordered_attributes = True
        self.parser.XmlDeclHandler = self._declaration
        self.parser.StartDoctypeDeclHandler = self._doctype
        self.parser.StartNamespaceDeclHandler = self._bind
        self.parser.EndNamespaceDeclHandler = self.namespaces.close

    @property
    def line(self) -> int:
        """The line of the current event, counted from 1."""
        return self.parser.CurrentLineNumber

    @property
    def offset(self) -> int:
        """The position of the current event in ``data``, in bytes."""
        return self.parser.CurrentByteIndex

    def text_from(self, begin: int) -> str:
        """Return the text of the element that begins at an offset and whose end is the current event."""
        end = _end_of_tag(self.data, begin)
        if self.data[end - 2 : end] != b"/>":  # the end of an empty one is told behind its tag
            end = _end_of_tag(self.data, self.offset)
        return self.data[begin:end].decode(self.encoding, "replace")

    def parse(self, listener: Listener, counts_depth: bool = False) -> None:
        """Send all events to the listener.

        Args:
            listener: takes them.
            counts_depth: whether the listener calls `refuse_depth` itself; a call for each element is saved.

        Raises:
            UnreadableError: if it is not well-formed, has a DOCTYPE, nests too deeply, or an element has more
                attributes than any model.
        """
        start = listener.start if counts_depth else self._counted(listener.start)
        end = listener.end if counts_depth else self._uncounted(listener.end)
        self.tell(self._first(start), end, listener.text)
        _refuse_crowds(self.data, self.file)
        try:
            self.parser.Parse(self.data, True)
        except expat.ExpatError as fault:
            raise UnreadableError.of("FIL004", self._reason(fault), self.file, fault.lineno) from None
        except (LookupError, ValueError) as fault:
            if self._begun:
                raise
            raise UnreadableError.of("FIL004", f"not readable as XML: {fault}", self.file) from None

    def _reason(self, fault: expat.ExpatError) -> str:
        if self.encoding.upper() in _SEVEN_BITS and not self.data.isascii():
            return f"not {self.encoding}, as its first line says; save it as UTF-8 and say so"
        return f"not well-formed XML: {expat.errors.messages[fault.code]}"

    def tell(self, start: Start, end: Tell, text: Tell) -> None:
        """Send the following events to these functions; a listener may change its mind at any event."""
        self.parser.StartElementHandler = start
        self.parser.EndElementHandler = end
        self.parser.CharacterDataHandler = text

    def refuse_depth(self) -> NoReturn:
        """Raise the error for an element inside more than `DEEPEST_NESTING` others."""
        raise UnreadableError.of(
            "FIL006", f"nested deeper than {DEEPEST_NESTING} levels", self.file, self.line
        )

    def _first(self, start: Start) -> Start:
        def first(tag: str, attributes: list[str]) -> None:
            self._begun = True
            self.parser.StartElementHandler = start
            start(tag, attributes)

        return first

    def _counted(self, start: Start) -> Start:
        def counted(tag: str, attributes: list[str]) -> None:
            self._depth += 1
            if self._depth > DEEPEST_NESTING:
                self.refuse_depth()
            start(tag, attributes)

        return counted

    def _uncounted(self, end: Tell) -> Tell:
        def uncounted(tag: str) -> None:
            self._depth -= 1
            end(tag)

        return uncounted

    def _bind(self, prefix: str | None, uri: str | None) -> None:
        """Bind a prefix; names of other versions of XMI become those of ours as the parser makes them."""
        if uri and len(uri) > LONGEST_NAMESPACE:  # every element of it would hold it
            message = f"a namespace of more than {LONGEST_NAMESPACE} characters"
            raise UnreadableError.of("FIL006", message, self.file, self.line)
        if uri and _OTHER_XMI.fullmatch(uri):
            self.parser.intern.update({f"{uri} {name}": f"{XMI} {name}" for name in _XMI_NAMES})
        self.namespaces.open(prefix, uri)

    def _declaration(self, version: str, encoding: str | None, standalone: int) -> None:
        if self._declared:
            self.encoding = encoding or self.encoding

    def _doctype(self, *_: object) -> None:
        raise UnreadableError.of("FIL005", "DOCTYPE is not accepted", self.file, self.line)


def _without_wide_characters(data: bytes, file: str) -> tuple[bytes, str | None]:
    """Return UTF-16 as UTF-8, so that offsets mean the same everywhere, and what the parser must assume."""
    if data[:2] not in (b"\xff\xfe", b"\xfe\xff"):
        return data, None
    try:
        return data.decode("utf-16").encode(), "UTF-8"
    except UnicodeDecodeError:
        raise UnreadableError.of("FIL004", "not readable as UTF-16", file) from None


def _refuse_crowds(data: bytes, file: str) -> None:
    """Refuse an element with too many attributes: the parser takes them all in before it reports any."""
    window, begin = MOST_ATTRIBUTES * _SHORTEST_ATTRIBUTE, data.find(b"<")
    while begin >= 0:
        following = data.rfind(b"<", begin + 1, begin + window)
        if following < 0:
            if _attributes_at(data, begin) > MOST_ATTRIBUTES:
                line = data.count(b"\n", 0, begin) + 1
                raise UnreadableError.of(
                    "FIL006", f"more than {MOST_ATTRIBUTES} attributes in one element", file, line
                )
            following = data.find(b"<", begin + window)
        begin = following


def _attributes_at(data: bytes, begin: int) -> int:
    """Return how many attributes the tag there has, counted no further than one too many."""
    tag = _TAG.match(data, begin)
    count = 0
    while tag is not None and count <= MOST_ATTRIBUTES:
        tag = _ATTRIBUTE.match(data, tag.end())
        count += tag is not None
    return count


def _end_of_tag(data: bytes, begin: int) -> int:
    """Return the offset behind the tag that begins there; a ``>`` inside quotes does not end it."""
    tag = _WHOLE_TAG.match(data, begin)
    return tag.end() if tag is not None else len(data)


def read_bytes(path: Path, largest: int = LARGEST_FILE) -> bytes:
    """Return the content of a regular file.

    Raises:
        UnreadableError: if there is none, it is a folder or a device, too large, or not permitted.
    """
    try:
        status = path.stat()
        if not stat.S_ISREG(status.st_mode):
            raise UnreadableError.of("FIL001", "not a file", path)
        if status.st_size > largest:
            raise UnreadableError.of("FIL003", f"larger than {largest // (1024 * 1024)} MB", path)
        return path.read_bytes()
    except FileNotFoundError:
        raise UnreadableError.of("FIL001", "no such file", path) from None
    except (OSError, ValueError) as fault:
        reason = fault.strerror.lower() if isinstance(fault, OSError) and fault.strerror else fault
        raise UnreadableError.of("FIL002", f"cannot be read: {reason}", path) from None
