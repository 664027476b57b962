"""XMI as a tree of objects, read without its metamodel; what an element is may still be open."""

from __future__ import annotations

from collections.abc import Callable

from mmrs_core.languages.json_form.stream import TYPE, key_of
from mmrs_core.languages.json_form.tree import Leaf, Node, Words
from mmrs_core.languages.xmi.events import XMI, XSI, Document

_HARMLESS = frozenset(
    (f"{XMI} version", f"{XMI} uuid", f"{XSI} schemaLocation", f"{XSI} noNamespaceSchemaLocation")
)
_TYPES = (f"{XSI} type", f"{XMI} type")


class OldXmi:
    """Listens to a document and makes a tree of it.

    Attributes:
        roots: what stands at its top.
        ignored: (what, line) of each extension of XMI, which is not read.
    """

    def __init__(self, document: Document, is_known: Callable[[str], bool]) -> None:
        """Take a document, and what tells which languages are known; others are kept as they are."""
        self.roots: list[Node] = []
        self.ignored: list[tuple[str, int]] = []
        self._document = document
        self._is_known = is_known
        self._open: list[tuple[str, Node]] = []
        self._text: list[str] = []
        self._skipped = 0
        self._wrapped = False
        self._raw: tuple[Node, int] | None = None

    def start(self, tag: str, attributes: list[str]) -> None:
        """Take the start of an element."""
        self._text.clear()
        ns_uri, _, name = tag.rpartition(" ")
        if self._skipped:
            self._skipped += 1
        elif ns_uri == XMI and name == "XMI" and not self._open and not self.roots:
            self._open.append(("", Node({})))
            self._wrapped = True
        elif ns_uri == XMI:
            self.ignored.append((f"xmi:{name}", self._document.line))
            self._skipped = 1
        else:
            self._element(ns_uri, name, attributes)

    def end(self, tag: str) -> None:
        """Take the end of an element."""
        if self._skipped:
            self._skipped -= 1
            if not self._skipped and self._raw is not None:
                node, begin = self._raw
                node.members["$xml"] = self._document.text_from(begin)
                node.members["$namespaces"] = Node(dict(self._document.namespaces.in_scope()))
                self._raw = None
            return
        name, node = self._open.pop()
        if name and self._open and not node.members:
            values = self._open[-1][1].members[name]
            assert isinstance(values, list)  # made when the element began
            values[-1] = leaf = Leaf("".join(self._text))
            leaf.line = node.line
        self._text.clear()

    def text(self, text: str) -> None:
        """Take character data."""
        if not self._skipped:
            self._text.append(text)

    def _element(self, ns_uri: str, name: str, attributes: list[str]) -> None:
        named = dict(zip(attributes[::2], attributes[1::2], strict=True))
        is_root = len(self._open) == (1 if self._wrapped else 0)
        kind = next((self._expanded(named[key]) for key in _TYPES if key in named), "")
        if is_root:
            kind = f"{ns_uri}#{name}"
        node = Node({TYPE: kind} if kind else {}, self._document.line)
        value: object = node
        known = not kind or self._is_known(kind.rpartition("#")[0])
        if known and "href" in named and not is_root:
            node.members = {"$ref": named["href"]}
        elif known and named.get(f"{XSI} nil") in ("true", "1") and not is_root:
            value = None
        elif known:
            node.members |= _said(named)
        self._put(name, value, is_root)
        if known:
            self._open.append((name if value is node and not is_root else "", node))
        else:
            self._raw, self._skipped = (node, self._document.offset), 1

    def _put(self, name: str, value: object, is_root: bool) -> None:
        if is_root:
            assert isinstance(value, Node)  # a root is not nil
            self.roots.append(value)
            return
        members = self._open[-1][1].members
        key = key_of(name)
        before = members.setdefault(key, [])
        if not isinstance(before, list):
            before = members[key] = [before]
        before.append(value)

    def _expanded(self, kind: str) -> str:
        prefix, _, name = kind.rpartition(":")
        return f"{self._document.namespaces.uri(prefix) or ''}#{name}"


def _said(named: dict[str, str]) -> dict[str, object]:
    said: dict[str, object] = {}
    for name, text in named.items():
        if name == f"{XMI} id":
            said["$id"] = text
        elif name not in _HARMLESS and name not in _TYPES and name != f"{XSI} nil":
            local = name.rpartition(" ")[2]
            said[key_of(local)] = Words(text)
    return said
