"""The elements of an .ecore file that say what classes there are; all others are passed over."""

from __future__ import annotations

from pathlib import Path

from mmrs_core.errors import UnreadableError
from mmrs_core.languages.datatypes import ECORE, shown
from mmrs_core.languages.metamodels.fragments import Fragments, Node
from mmrs_core.languages.xmi.events import DEEPEST_NESTING, XSI, Document, read_bytes

GENMODEL = "http://www.eclipse.org/emf/2002/GenModel"
LARGEST_METAMODEL = 64 * 1024 * 1024

_WRAPPERS = ("http://www.omg.org/", "http://schema.omg.org/spec/")
"""How the namespaces of XMI begin, of all its versions."""
_KEPT = ("eSubpackages", "eClassifiers", "eStructuralFeatures", "eLiterals", "eAnnotations", "details")
_LINKS = ("eSuperTypes", "eType", "eOpposite", "eKeys", "eClassifier", "eTypeParameter")
_GENERICS = ("eGenericSuperTypes", "eTypeParameters", "eBounds", "eGenericType")
_ELEMENTS = frozenset((*_KEPT, *_LINKS, *_GENERICS))
_TRAITS = ("ordered", "unique", "changeable", "volatile", "transient", "unsettable", "derived")
_FLAGS = frozenset((*_TRAITS, "abstract", "interface", "containment", "resolveProxies", "iD", "serializable"))
_NAMES = ("name", "nsURI", "nsPrefix", "instanceClassName", "instanceTypeName", "value", "literal")
_TEXTS = frozenset((*_FLAGS, *_NAMES, "lowerBound", "upperBound", "defaultValueLiteral"))
"""Attributes that hold a text, which may be given as elements as well."""
_ATTRIBUTES = _TEXTS | {*_LINKS, "href"}


class Tree:
    """An .ecore file.

    Attributes:
        file: what messages call it.
        line: where its first element begins.
        roots: the packages at its top; None for each other element there.
    """

    def __init__(self, data: bytes, file: str) -> None:
        """Take the file apart.

        Raises:
            UnreadableError: if it is not well-formed, or an attribute that says yes or no says neither.
        """
        self.file = file
        self.line = 0
        self.roots: list[Node | None] = []
        self._document = Document(data, file)
        self._open: list[Node] = []
        self._inside = 0
        self._passed = 0
        self._text: list[str] | None = None
        self._ids: dict[str, Node] = {}
        self._fragments = Fragments(self.roots, self._ids)
        self._document.parse(self, counts_depth=True)
        del self._document

    def start(self, tag: str, attributes: list[str]) -> None:
        """Keep an element, unless it stands in one that was passed over."""
        if self._passed:
            if self._inside + self._passed >= DEEPEST_NESTING:
                self._document.refuse_depth()
            self._passed += 1
        elif self._open:
            self._start_inside(tag, attributes)
        else:
            self._start_at_top(tag, attributes)

    def end(self, tag: str) -> None:
        """Close what was opened."""
        if self._text is not None and self._passed == 1:
            name = tag.removeprefix(f"{ECORE} ")
            self._open[-1].put(name, self._sound(name, "".join(self._text), self._document.line))
            self._text = None
        if self._passed:
            self._passed -= 1
        else:
            self._inside -= 1
            if self._open:
                self._open.pop()

    def text(self, text: str) -> None:
        """Take the text of an attribute that is given as an element."""
        if self._text is not None:
            self._text.append(text)

    def fragment(self, fragment: str) -> str | None:
        """Return where an element stands, by names; see `Fragments.named`."""
        return self._fragments.named(fragment)

    def _start_at_top(self, tag: str, attributes: list[str]) -> None:
        self.line = self.line or self._document.line
        if not self._inside and tag.startswith(_WRAPPERS) and tag.endswith(" XMI"):
            self._inside = 1
        elif tag == f"{ECORE} EPackage":
            node = self._node("EPackage", attributes)
            self.roots.append(node)
            self._enter(node)
        else:
            self.roots.append(None)
            self._passed = 1

    def _start_inside(self, tag: str, attributes: list[str]) -> None:
        name = tag.removeprefix(f"{ECORE} ")
        if name in _TEXTS:
            self._passed, self._text = 1, []
        elif name in _ELEMENTS and _matters(name, attributes):
            node = self._node(name, attributes)
            self._open[-1].add(node)
            self._enter(node)
        else:
            self._passed = 1

    def _enter(self, node: Node) -> None:
        if self._inside >= DEEPEST_NESTING:
            self._document.refuse_depth()
        self._inside += 1
        self._open.append(node)

    def _node(self, tag: str, attributes: list[str]) -> Node:
        found: list[str] = []
        line = self._document.line
        identifier = ""
        for name, value in zip(attributes[::2], attributes[1::2], strict=True):
            if name in _ATTRIBUTES:
                found += (name, self._sound(name, value, line))
            elif " " in name:
                space, _, local = name.rpartition(" ")
                if local == "type" and (space == XSI or space.startswith(_WRAPPERS)):
                    found += ("kind", self._kind(value))
                elif local in ("id", "idref") and space.startswith(_WRAPPERS):
                    identifier = value if local == "id" else identifier
                    found += (local, value) if local == "idref" else ()
        node = Node(tag, tuple(found), line)
        if identifier:
            self._ids.setdefault(identifier, node)
        return node

    def _sound(self, name: str, value: str, line: int) -> str:
        """Return the value of an attribute, unless it says neither yes nor no where it must."""
        if name in _FLAGS and value.lower() not in ("true", "false"):
            raise UnreadableError(f"{self.file}:{line}: {name}: {shown(value)}: not true or false")
        return value

    def _kind(self, text: str) -> str:
        prefix, _, name = text.rpartition(":")
        return f"{self._document.namespaces.uri(prefix)} {name}"


def _matters(tag: str, attributes: list[str]) -> bool:
    """Return whether an element is worth keeping: of annotations, only the documentation."""
    wanted = {"eAnnotations": ("source", GENMODEL), "details": ("key", "documentation")}.get(tag)
    return wanted is None or wanted in zip(attributes[::2], attributes[1::2], strict=True)


def read_tree(path: Path) -> Tree:
    """Return an .ecore file.

    Raises:
        UnreadableError: if it cannot be read, is larger than `LARGEST_METAMODEL`, or is no sound XML.
    """
    return Tree(read_bytes(path, LARGEST_METAMODEL), str(path))
