"""XML as a tree of elements with their lines, and as rows of texts where there are many."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from html import escape

from mmrs_core.drawings.sheet import Sheet
from mmrs_core.errors import UnreadableError
from mmrs_core.languages.xmi.events import DEEPEST_NESTING, Document, Start

MOST_ELEMENTS = 2_000_000
_BEGINNING = 4096
XML = '<?xml version="1.0" encoding="UTF-8"?>'
_ROOT = re.compile(r"<(?:[\w.-]+:)?([A-Za-z][\w.-]*)")


class XmlNode:
    """An element; tags and attributes are known by their local names.

    Attributes:
        gathered: columns of the rows that children left here, by their tag.
    """

    __slots__ = ("attributes", "children", "gathered", "line", "parts", "tag")

    def __init__(self, tag: str, attributes: dict[str, str], line: int) -> None:
        self.tag, self.attributes, self.line = tag, attributes, line
        self.children: list[XmlNode] = []
        self.parts: list[str] = []
        self.gathered: dict[str, list[list[str]]] = {}

    @property
    def text(self) -> str:
        """All text in it, without spaces around it."""
        if not self.children:
            return "".join(self.parts).strip()
        return " ".join([*self.parts, *(child.text for child in self.children)]).strip()

    def child(self, tag: str) -> XmlNode | None:
        """Return the first child of a tag."""
        return next(self.all(tag), None)

    def all(self, *tags: str) -> Iterator[XmlNode]:
        """Yield all children of some tags."""
        return (child for child in self.children if child.tag in tags)

    def of(self, tag: str) -> str:
        """Return the text of the first child of a tag; empty if there is none."""
        child = self.child(tag)
        return child.text if child is not None else ""


Row = tuple[str, ...]
"""What is kept of an element: ``@name`` its attributes, then names for the texts of its first children that
are called so, and an empty name for its own text."""


def read_tree(data: bytes, sheet: Sheet, rows: Mapping[str, Row]) -> XmlNode:
    """Return the root; elements with these tags are rows of texts, since a million make a large tree.

    Raises:
        UnreadableError: if it is not well-formed, has a DOCTYPE, nests too deeply, or has too many elements.
    """
    document = Document(data, sheet.file)
    builder = _Builder(document, sheet, rows)
    try:
        document.parse(builder, counts_depth=True)
    except UnreadableError as fault:
        sheet.refuse(fault.reason, fault.line)
    return builder.top.children[0]


class _Builder:
    def __init__(self, document: Document, sheet: Sheet, rows: Mapping[str, Row]) -> None:
        self.top = XmlNode("", {}, 0)
        self.open, self._count = [self.top], 0
        self._document, self._sheet = document, sheet
        self._rows = {tag: _row_start(self, document, row) for tag, row in rows.items()}

    def start(self, tag: str, attributes: list[str]) -> None:
        local = tag.rpartition(" ")[2]
        if local in self._rows and len(self.open) > 1:
            self._rows[local](tag, attributes)
            return
        if len(self.open) > DEEPEST_NESTING:
            self._document.refuse_depth()
        names = (name.rpartition(" ")[2] for name in attributes[::2])
        named = dict(zip(names, attributes[1::2], strict=True))
        self.open.append(XmlNode(local, named, self._document.line))

    def end(self, tag: str) -> None:
        node = self.open.pop()
        if node.tag != (local := tag.rpartition(" ")[2]):
            self._sheet.refuse(f"'{local}' in another", self._document.line)
        self.open[-1].children.append(node)
        self._count += 1
        if self._count > MOST_ELEMENTS:
            self._sheet.refuse(f"more than {MOST_ELEMENTS} elements; split it", node.line)

    def text(self, text: str) -> None:
        if not text.isspace():
            self.open[-1].parts.append(text)


def _row_start(builder: _Builder, document: Document, row: Row) -> Start:
    """Return what takes the start of a row, and then the ends of its children and its own.

    Closures, and no event that is not needed, since there may be millions.
    """
    own, parent, empty = "", builder.top, [""] * len(row)
    adders: list[Callable[[str], None]] = []
    named = {name[1:]: at for at, name in enumerate(row) if name[:1] == "@"}
    known: dict[str, int] = {}
    values: list[str] = []
    parts: list[str] = []

    def begin(tag: str, attributes: list[str]) -> None:
        nonlocal own, known, values
        if tag != own:
            own, (namespace, space, local) = tag, tag.rpartition(" ")
            known = {f"{namespace}{space}{name or local}": at for at, name in enumerate(row)}
        values = empty.copy()
        for name, value in zip(attributes[::2], attributes[1::2], strict=True):
            if name in named:
                values[named[name]] = value
        parts.clear()
        document.parser.StartElementHandler = None
        document.parser.EndElementHandler = end
        document.parser.CharacterDataHandler = parts.append

    def end(tag: str) -> None:
        nonlocal adders, parent
        if (at := known.get(tag)) is not None and not values[at]:
            values[at] = "".join(parts).strip()
        parts.clear()
        if tag == own:
            if parent is not builder.open[-1]:
                parent = builder.open[-1]
                kept = parent.gathered.setdefault(own.rpartition(" ")[2], [[] for _ in row])
                adders = [column.append for column in kept]
            for add, value in zip(adders, values, strict=True):
                add(value)
            document.tell(builder.start, builder.end, builder.text)

    return begin


def tagged(tag: str, text: str, **attributes: str) -> str:
    """Return an element that holds a text.

    >>> tagged("value", "a < b", name="c")
    '<value name="c">a &lt; b</value>'
    """
    stated = "".join(f' {name}="{escape(value)}"' for name, value in attributes.items())
    return f"<{tag}{stated}>{escape(text)}</{tag}>"


def root_tag(data: bytes) -> str:
    """Return the local name of a document's root from its first bytes; empty where they hold none."""
    wide = data[:2] in (b"\xff\xfe", b"\xfe\xff")
    text = data[:_BEGINNING].decode("utf-16" if wide else "utf-8", "replace")
    text = text.lstrip("\ufeff \t\r\n")
    while text.startswith(("<?", "<!")):
        text = text.partition("-->" if text.startswith("<!--") else ">")[2].lstrip()
    found = _ROOT.match(text)
    return found[1] if found else ""
