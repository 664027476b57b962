"""XML as a tree of elements with their lines, or as much of a tree as is needed."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping

from mmrs_core.drawings.sheet import Sheet
from mmrs_core.languages.xmi.events import Document

MOST_ELEMENTS = 2_000_000
_BEGINNING = 4096
_ROOT = re.compile(r"<(?:[\w.-]+:)?([A-Za-z][\w.-]*)")


class XmlNode:
    """An element; tags and attributes are known by their local names.

    Attributes:
        gathered: what folded children left here, by their tag.
    """

    __slots__ = ("attributes", "children", "gathered", "line", "parts", "tag")

    def __init__(self, tag: str, attributes: dict[str, str], line: int) -> None:
        self.tag, self.attributes, self.line = tag, attributes, line
        self.children: list[XmlNode] = []
        self.parts: list[str] = []
        self.gathered: dict[str, list[object]] = {}

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


Fold = Callable[[XmlNode, XmlNode], None]
"""Takes an element that ends, and its parent, which it leaves what it has in `gathered`."""


def read_tree(data: bytes, sheet: Sheet, folds: Mapping[str, Fold]) -> XmlNode:
    """Return the root; elements with folds are not kept.

    Raises:
        UnreadableError: if it is not well-formed, has a DOCTYPE, nests too deeply, or has too many elements.
    """
    document = Document(data, sheet.file)
    builder = _Builder(document, sheet, folds)
    document.parse(builder)
    return builder.top.children[0]


class _Builder:
    def __init__(self, document: Document, sheet: Sheet, folds: Mapping[str, Fold]) -> None:
        self.top = XmlNode("", {}, 0)
        self._open, self._count = [self.top], 0
        self._counts: list[int] = []
        self._parser, self._sheet, self._folds = document.parser, sheet, folds

    def start(self, tag: str, attributes: list[str]) -> None:
        self._counts.append(self._count)
        pairs = iter(attributes)
        named = {name.rpartition(" ")[2]: value for name, value in zip(pairs, pairs, strict=True)}
        self._open.append(XmlNode(tag.rpartition(" ")[2], named, self._parser.CurrentLineNumber))

    def end(self, tag: str) -> None:
        node, before = self._open.pop(), self._counts.pop()
        fold = self._folds.get(node.tag)
        if fold is not None:
            fold(node, self._open[-1])
            self._count = before
            return
        self._open[-1].children.append(node)
        self._count += 1
        if self._count > MOST_ELEMENTS:
            self._sheet.refuse(f"more than {MOST_ELEMENTS} elements; split it", node.line)

    def text(self, text: str) -> None:
        if not text.isspace():
            self._open[-1].parts.append(text)


def root_tag(data: bytes) -> str:
    """Return the local name of a document's root from its first bytes; empty where they hold none."""
    wide = data[:2] in (b"\xff\xfe", b"\xfe\xff")
    text = data[:_BEGINNING].decode("utf-16" if wide else "utf-8", "replace")
    text = text.lstrip("\ufeff \t\r\n")
    while text.startswith(("<?", "<!")):
        text = text.partition("-->" if text.startswith("<!--") else ">")[2].lstrip()
    found = _ROOT.match(text)
    return found[1] if found else ""
