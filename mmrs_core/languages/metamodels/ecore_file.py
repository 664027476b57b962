"""An .ecore file as it stands: its elements with their lines, and the ways that lead to them."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import NoReturn
from urllib.parse import unquote

from mmrs_core.errors import UnreadableError
from mmrs_core.languages.datatypes import ECORE, shown
from mmrs_core.languages.naming import nearest
from mmrs_core.languages.xmi.events import DEEPEST_NESTING, XMI, XSI, Document, read_bytes

GENMODEL = "http://www.eclipse.org/emf/2002/GenModel"
LARGEST_METAMODEL = 64 * 1024 * 1024
MOST_REFERENCES = 10_000
"""In one place: the supertypes of a class, above all."""

_TRAITS = ("ordered", "unique", "changeable", "volatile", "transient", "unsettable", "derived")
FLAGS = frozenset((*_TRAITS, "abstract", "interface", "containment", "resolveProxies", "iD", "serializable"))
WHOLE = frozenset(("lowerBound", "upperBound", "value"))
_NAMES = ("name", "nsURI", "nsPrefix", "instanceClassName", "instanceTypeName", "literal", "source", "key")
_TEXTS = FLAGS | WHOLE | {*_NAMES, "defaultValueLiteral"}
"""Attributes that hold a text, which may be given as elements as well."""
_LINKS = frozenset(("eSuperTypes", "eType", "eOpposite", "eKeys", "eClassifier", "eTypeParameter"))
_PARTS = ("eSubpackages", "eClassifiers", "eStructuralFeatures", "eLiterals", "eAnnotations", "details")
_GENERICS = ("eGenericSuperTypes", "eTypeParameters", "eBounds", "eGenericType")
_LEFT_OUT = ("eOperations", "eTypeArguments", "eUpperBound", "eLowerBound", "contents", "references")
_UPWARDS = ("eModelElement", "ePackage", "eSuperPackage", "eContainingClass", "eEnum")
_ELEMENTS = _LINKS | {*_PARTS, *_GENERICS}
_ATTRIBUTES = _TEXTS | _LINKS | {"href"}
_KNOWN = _ATTRIBUTES | _ELEMENTS | {*_LEFT_OUT, *_UPWARDS}
"""All that Ecore's own features are called, as far as files can hold them."""
_NOTHING: Mapping[str, str] = {}
_NAMED = re.compile(r"""@(\w+)\[name=['"](.*)['"]\]""")
_WORD = re.compile(r"\S+")


@dataclass(slots=True, eq=False)
class EcoreNode:
    """An element that declares classes.

    Attributes:
        tag: its name, without a namespace.
        line: where it begins.
        attributes: by name; ``xsi:type`` is ``namespace name`` of the class it says to be of.
    """

    tag: str
    line: int
    attributes: Mapping[str, str]
    children: Sequence[EcoreNode] = ()

    def get(self, name: str, usual: str = "") -> str:
        """Return the value of an attribute."""
        return self.attributes.get(name, usual)

    def all(self, tag: str) -> Iterator[EcoreNode]:
        """Yield the elements of that name directly inside it."""
        return (child for child in self.children if child.tag == tag)


class EcoreFile:
    """An .ecore file.

    Attributes:
        name: what messages call it.
        roots: the packages at its top; None for each other element there.
    """

    def __init__(self, data: bytes, name: str) -> None:
        """Take the file apart.

        Raises:
            UnreadableError: if it is not well-formed, holds no package, or something in it has no nsURI.
        """
        self.name = name
        self.roots: list[EcoreNode | None] = []
        self._ids: dict[str, EcoreNode] = {}
        self._steps: dict[int, dict[str, EcoreNode]] = {}
        document = Document(data, name)
        listener = _Listener(document, self.roots, self._ids)
        document.parse(listener, counts_depth=True)
        if not any(self.roots):
            reason = f"no metamodel: the root is not an EPackage of {ECORE}"
            raise UnreadableError(f"{name}:{listener.line}: {reason}")
        for node, _, _ in self.packages():
            if not node.get("nsURI") or not node.get("name"):
                self.refuse(node, f"{'nsURI' if node.get('name') else 'name'} is missing")

    def packages(self) -> Iterator[tuple[EcoreNode, int, str]]:
        """Yield the packages, outer ones first, with the number of their root and the outer one's nsURI."""
        pending = [(node, index, "") for index, node in enumerate(self.roots) if node is not None][::-1]
        while pending:
            node, root, parent = pending.pop()
            yield node, root, parent
            inner = [each for each in node.all("eSubpackages") if not each.get("href")]
            pending += [(each, root, node.get("nsURI")) for each in reversed(inner)]

    @property
    def ns_uris(self) -> list[str]:
        """The nsURIs of the packages, outer ones first."""
        return [node.get("nsURI") for node, _, _ in self.packages()]

    def documents(self) -> Iterator[str]:
        """Yield the other documents that it refers to."""
        pending: list[EcoreNode] = [node for node in self.roots if node is not None]
        while pending:
            node = pending.pop(0)
            words = [uri for name in _LINKS for uri in words_of(node.get(name))]
            yield from (document for uri in (*words, node.get("href")) if (document := document_of(uri)))
            pending += node.children

    def refuse(self, node: EcoreNode, reason: str) -> NoReturn:
        """Raise the error for an element."""
        raise UnreadableError(f"{self.name}:{node.line}: {node.tag}: {reason}")

    def uris(self, node: EcoreNode, name: str) -> list[str]:
        """Return what a reference leads to; EMF writes what is in other files as an element of its own.

        Raises:
            UnreadableError: if an element leads nowhere, or there are more than `MOST_REFERENCES`.
        """
        found = words_of(node.get(name))
        for child in node.all(name):
            inside = [child.get("href")] if child.get("href") else words_of(child.get("xmi:idref"))
            if not inside:
                self.refuse(child, "leads nowhere: neither href nor xmi:idref")
            found += inside
        if len(found) > MOST_REFERENCES:
            self.refuse(node, f"{name}: more than {MOST_REFERENCES} references")
        return found

    def named(self, fragment: str) -> list[str] | None:
        """Return the number of the root, which may be empty, and the names that lead to an element.

        Args:
            fragment: a path with names, escaped or not, or with positions; or an ``xmi:id``.

        Returns:
            None where there is no such element; for a path of names, it is not looked whether there is.
        """
        if not fragment.startswith("/"):
            return self._identified.get(fragment)
        top, *steps = fragment[1:].split("/")
        if "@" not in fragment and "%" not in fragment:
            return [top, *steps]
        number = int(top or 0) if len(top) < 9 and (not top or top.isdecimal()) else len(self.roots)
        node = self.roots[number] if number < len(self.roots) else None
        names = []
        for step in steps:
            node = self._inside(node).get(_normal(step)) if node is not None else None
            if node is None:
                return None
            names.append(node.get("name"))
        return [top, *names]

    def _inside(self, node: EcoreNode) -> dict[str, EcoreNode]:
        """Return the elements directly inside another by the steps that lead to them."""
        if id(node) not in self._steps:
            steps = self._steps[id(node)] = {}
            counts: dict[str, int] = {}
            for child in node.children:
                name, count = child.get("name"), counts.get(child.tag, 0)
                counts[child.tag] = count + 1
                for step in (name, f"@{child.tag}.{count}", f"@{child.tag} {name}"):
                    steps.setdefault(step, child)
        return self._steps[id(node)]

    @cached_property
    def _identified(self) -> dict[str, list[str]]:
        wanted = {id(node): name for name, node in self._ids.items()}
        pending = [(node, [str(index)]) for index, node in enumerate(self.roots) if node is not None]
        found: dict[str, list[str]] = {}
        while pending and wanted:
            node, names = pending.pop()
            if id(node) in wanted:
                found[wanted[id(node)]] = names
            pending += [(child, [*names, child.get("name")]) for child in node.children]
        return found


class _Listener:
    """Keeps the elements that declare classes, and skips all others."""

    def __init__(self, document: Document, roots: list[EcoreNode | None], ids: dict[str, EcoreNode]) -> None:
        self.line = 0
        self._document = document
        self._roots = roots
        self._ids = ids
        self._open: list[EcoreNode] = []
        self._depth = 0
        self._passed = 0
        self._text: list[str] | None = None

    def start(self, tag: str, attributes: list[str]) -> None:
        """Keep an element, unless it stands in one that was passed over."""
        if self._depth + self._passed >= DEEPEST_NESTING:
            self._document.refuse_depth()
        self.line = self.line or self._document.line
        name = tag.removeprefix(f"{ECORE} ")
        if self._passed:
            self._passed += 1
        elif not self._open and not self._depth and tag == f"{XMI} XMI":
            self._depth = 1
        elif not self._open:
            node = self._node("EPackage", attributes) if tag == f"{ECORE} EPackage" else None
            self._roots.append(node)
            self._enter(node)
        elif name in _ELEMENTS:
            node = self._node(name, attributes)
            outer = self._open[-1]
            if isinstance(outer.children, list):
                outer.children.append(node)
            else:
                outer.children = [node]
            self._enter(node)
        else:
            if not tag.startswith(f"{XMI} "):
                self._refuse_unknown(name)
            self._text = [] if name in _TEXTS else None
            self._passed = 1

    def _refuse_unknown(self, name: str) -> None:
        if name not in _KNOWN:
            hint = nearest(name, _KNOWN)
            place = f"{self._document.file}:{self._document.line}"
            raise UnreadableError(f"{place}: {shown(name)}: Ecore has no such feature{hint and '; ' + hint}")

    def end(self, tag: str) -> None:
        """Close what was opened."""
        if self._passed == 1 and self._text is not None:
            name = tag.removeprefix(f"{ECORE} ")
            outer = self._open[-1]
            outer.attributes = {name: "".join(self._text), **outer.attributes}
            self._text = None
        if self._passed:
            self._passed -= 1
        else:
            self._depth -= 1
            if self._open:
                self._open.pop()

    def text(self, text: str) -> None:
        """Take the text of an attribute that is given as an element."""
        if self._text is not None and self._passed == 1:
            self._text.append(text)

    def _enter(self, node: EcoreNode | None) -> None:
        if node is None:
            self._passed = 1
        else:
            self._depth += 1
            self._open.append(node)

    def _node(self, tag: str, attributes: list[str]) -> EcoreNode:
        found: dict[str, str] = {}
        identifier = ""
        for name, value in zip(attributes[::2], attributes[1::2], strict=True):
            if name in _ATTRIBUTES:
                found[name] = value
            elif name in (f"{XSI} type", f"{XMI} type"):
                prefix, _, local = value.rpartition(":")
                found["xsi:type"] = f"{self._document.namespaces.uri(prefix)} {local}"
            elif name == f"{XMI} idref":
                found["xmi:idref"] = value
            elif name == f"{XMI} id":
                identifier = value
            elif " " not in name:
                self._refuse_unknown(name)
        node = EcoreNode(tag, self._document.line, found or _NOTHING)
        if identifier:
            self._ids.setdefault(identifier, node)
        return node


def read_ecore(path: Path) -> EcoreFile:
    """Return an .ecore file.

    Raises:
        UnreadableError: if it cannot be read, is larger than `LARGEST_METAMODEL`, or is not a metamodel.
    """
    return EcoreFile(read_bytes(path, LARGEST_METAMODEL), str(path))


def document_of(uri: str) -> str:
    """Return what stands before the hash of a URI; nothing of one that has none."""
    return uri.rpartition("#")[0]


def words_of(text: str) -> list[str]:
    """Return the URIs in an attribute that refers, without the types that may stand before them.

    >>> words_of("#//A ecore:EClass urn:x#//B _1")
    ['#//A', 'urn:x#//B', '_1']
    """
    found = []
    for word in _WORD.finditer(text):
        if "#" in word[0] or ":" not in word[0]:
            found.append(word[0])
            if len(found) > MOST_REFERENCES:
                break
    return found


def _normal(step: str) -> str:
    """Return one step of a fragment in the form in which all elements are entered."""
    if named := _NAMED.fullmatch(step):
        return f"@{named[1]} {unquote(named[2])}"
    if not step.startswith("@"):
        return unquote(step)
    tag, _, index = step.partition(".")
    return f"{tag}.{index or 0}"
