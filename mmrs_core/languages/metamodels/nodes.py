"""The elements of an .ecore file that say what classes there are; all others are passed over."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from urllib.parse import unquote

from mmrs_core.errors import UnreadableError
from mmrs_core.languages.datatypes import ECORE, shown
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
_NAMED = re.compile(r"""@(\w+)\[name=['"](.*)['"]\]""")


class Node:
    """An element.

    Attributes:
        tag: its name, without a namespace.
        line: where it begins.
    """

    __slots__ = ("_attributes", "_children", "line", "tag")

    def __init__(self, tag: str, attributes: tuple[str, ...], line: int) -> None:
        """Take the attributes as name, value, name, value."""
        self.tag = tag
        self.line = line
        self._attributes = attributes
        self._children: tuple[Node, ...] | list[Node] = ()

    def get(self, name: str) -> str | None:
        """Return the value of an attribute; ``kind`` is ``namespace name`` of the class it says to be of."""
        names = self._attributes[::2]
        return self._attributes[names.index(name) * 2 + 1] if name in names else None

    def put(self, name: str, value: str) -> None:
        """Add an attribute, unless there is one of that name already."""
        if name not in self._attributes[::2]:
            self._attributes += (name, value)

    def add(self, child: Node) -> None:
        """Add an element inside it."""
        if isinstance(self._children, list):
            self._children.append(child)
        else:
            self._children = [child]

    def all(self, tag: str) -> list[Node]:
        """Return the elements of that name directly inside it."""
        return [child for child in self._children if child.tag == tag]

    def __iter__(self) -> Iterator[Node]:
        """Yield the elements directly inside it."""
        return iter(self._children)


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
        self._named: dict[str, Node] = {}
        self._ids: dict[str, str] | None = None
        self._steps: dict[int, dict[str, Node]] = {}
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
        """Return where an element stands, by names, such as ``//sub/A``.

        Args:
            fragment: that, or a path with positions, or an ``xmi:id``.

        Returns:
            None where there is no such element; for a path of names, it is not looked whether there is.
        """
        if not fragment.startswith("/"):
            return self._identified().get(fragment)
        if "@" not in fragment and "%" not in fragment:
            return fragment
        top, *steps = fragment[1:].split("/")
        number = int(top or 0) if len(top) < 9 and (not top or top.isdecimal()) else len(self.roots)
        node = self.roots[number] if number < len(self.roots) else None
        names = []
        for step in steps:
            node = self._inside_of(node).get(_normal(step)) if node is not None else None
            if node is None:
                return None
            names.append(node.get("name") or "")
        return "/".join(("", top, *names))

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
            self._named.setdefault(identifier, node)
        return node

    def _sound(self, name: str, value: str, line: int) -> str:
        """Return the value of an attribute, unless it says neither yes nor no where it must."""
        if name in _FLAGS and value.lower() not in ("true", "false"):
            raise UnreadableError(f"{self.file}:{line}: {name}: {shown(value)}: not true or false")
        return value

    def _kind(self, text: str) -> str:
        prefix, _, name = text.rpartition(":")
        return f"{self._document.namespaces.uri(prefix)} {name}"

    def _inside_of(self, node: Node) -> dict[str, Node]:
        """Return the elements directly inside another by the steps that lead to them."""
        if id(node) not in self._steps:
            steps = self._steps[id(node)] = {}
            counts: dict[str, int] = {}
            for child in node:
                name, count = child.get("name") or "", counts.get(child.tag, 0)
                counts[child.tag] = count + 1
                for step in (name, f"@{child.tag}.{count}", f"@{child.tag} {name}"):
                    steps.setdefault(step, child)
        return self._steps[id(node)]

    def _identified(self) -> dict[str, str]:
        """Return where the elements with an id stand; worked out when the first is asked for."""
        if self._ids is None:
            self._ids = {}
            wanted = {id(node): name for name, node in self._named.items()}
            pending = [(node, f"/{index or ''}") for index, node in enumerate(self.roots) if node is not None]
            while pending and wanted:
                node, fragment = pending.pop()
                if id(node) in wanted:
                    self._ids[wanted[id(node)]] = fragment
                pending += [(child, f"{fragment}/{child.get('name') or ''}") for child in node]
        return self._ids


def _matters(tag: str, attributes: list[str]) -> bool:
    """Return whether an element is worth keeping: of annotations, only the documentation."""
    wanted = {"eAnnotations": ("source", GENMODEL), "details": ("key", "documentation")}.get(tag)
    return wanted is None or wanted in zip(attributes[::2], attributes[1::2], strict=True)


def _normal(step: str) -> str:
    """Return one step of a fragment in the form in which all elements are entered."""
    if named := _NAMED.fullmatch(step):
        return f"@{named[1]} {unquote(named[2])}"
    if not step.startswith("@"):
        return unquote(step)
    tag, _, index = step.partition(".")
    return f"{tag}.{index or 0}"


def read_tree(path: Path) -> Tree:
    """Return an .ecore file.

    Raises:
        UnreadableError: if it cannot be read, is larger than `LARGEST_METAMODEL`, or is no sound XML.
    """
    return Tree(read_bytes(path, LARGEST_METAMODEL), str(path))
