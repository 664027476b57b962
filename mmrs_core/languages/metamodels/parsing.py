"""What an .ecore file says, brought into tables."""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import islice
from pathlib import Path

from mmrs_core.errors import UnreadableError
from mmrs_core.languages.datatypes import ECORE, shown
from mmrs_core.languages.metaclass import Literal
from mmrs_core.languages.metamodels.fragments import Node
from mmrs_core.languages.metamodels.nodes import Tree, read_tree
from mmrs_core.languages.metamodels.tables import (
    ClassTable,
    DataTypeTable,
    EnumTable,
    FeatureTable,
    PackageTable,
)

MOST_REFERENCES = 10_000
"""In one place: the supertypes of a class, above all."""

_WHOLE = re.compile(r"[+-]?[0-9]{1,20}")
_WORDS = {"eClassifiers": "classifier", "eStructuralFeatures": "feature"}
_WORD = re.compile(r"\S+")
_CLASSIFIERS = ("EClass", "EEnum", "EDataType")


def read_tables(path: Path) -> tuple[PackageTable, ...]:
    """Return the packages at the top of an .ecore file.

    Raises:
        UnreadableError: if it cannot be read or is no metamodel.
    """
    return _Parser(read_tree(path)).packages()


def parse_tables(data: bytes, file: str) -> tuple[PackageTable, ...]:
    """Return the packages at the top of the text of an .ecore file, which messages call ``file``."""
    return _Parser(Tree(data, file)).packages()


class _Parser:
    def __init__(self, tree: Tree) -> None:
        self._tree = tree
        self._file = tree.file
        self._parameters: dict[int, dict[str, Node]] = {}

    def packages(self) -> tuple[PackageTable, ...]:
        roots = enumerate(self._tree.roots)
        tables = tuple(self._package(node, index) for index, node in roots if node is not None)
        if not tables:
            reason = f"no metamodel: the root is not an EPackage of {ECORE}"
            raise UnreadableError(f"{self._file}:{self._tree.line}: {reason}")
        return tables

    def _package(self, node: Node, root: int) -> PackageTable:
        name, ns_uri = self._needed(node, "name"), self._needed(node, "nsURI")
        kinds: dict[str, list[Node]] = {kind: [] for kind in _CLASSIFIERS}
        for each, kind in self._classifiers(node):
            kinds[kind].append(each)
        prefix = node.get("nsPrefix")
        return PackageTable(
            ns_uri,
            name,
            name if prefix is None else prefix,
            _documentation(node),
            tuple(map(self._class, kinds["EClass"])),
            tuple(map(self._enum, kinds["EEnum"])),
            tuple(map(self._datatype, kinds["EDataType"])),
            tuple(self._package(each, root) for each in node.all("eSubpackages") if each.get("href") is None),
            tuple(uri for each in node.all("eSubpackages") if (uri := each.get("href"))),
            root,
        )

    def _classifiers(self, node: Node) -> Iterator[tuple[Node, str]]:
        """Yield the classifiers of a package with their kinds, no two of one name."""
        seen: dict[str, Node] = {}
        for each in node.all("eClassifiers"):
            kind = self._kind(each, _CLASSIFIERS)
            name = self._needed(each, "name")
            if name in seen:
                raise self._fault(each, f"{kind} {name} is declared twice, before in line {seen[name].line}")
            seen[name] = each
            yield each, kind

    def _kind(self, node: Node, known: tuple[str, ...]) -> str:
        space, _, kind = (node.get("kind") or "").rpartition(" ")
        if space != ECORE or kind not in known:
            raise self._fault(
                node, f"{kind or 'no xsi:type'}: no kind of {_WORDS[node.tag]} ({', '.join(known)})"
            )
        return kind

    def _class(self, node: Node) -> ClassTable:
        supertypes = [*self._uris(node, "eSuperTypes")]
        for generic in node.all("eGenericSuperTypes"):
            supertypes += self._uris(generic, "eClassifier")
        return ClassTable(
            self._needed(node, "name"),
            _flag(node, "abstract") or _flag(node, "interface"),
            _documentation(node),
            tuple(dict.fromkeys(supertypes)),
            tuple(self._feature(each, node) for each in node.all("eStructuralFeatures")),
            node.get("instanceClassName") or node.get("instanceTypeName") or "",
        )

    def _feature(self, node: Node, owner: Node) -> FeatureTable:
        is_reference = self._kind(node, ("EAttribute", "EReference")) == "EReference"
        opposites = self._uris(node, "eOpposite")
        return FeatureTable(
            name=self._needed(node, "name"),
            type=self._type(node, owner, is_reference),
            is_reference=is_reference,
            documentation=_documentation(node),
            lower=self._whole(node, "lowerBound", 0),
            upper=self._whole(node, "upperBound", 1),
            containment=is_reference and _flag(node, "containment"),
            unsettable=_flag(node, "unsettable"),
            unique=_flag(node, "unique", True),
            is_id=_flag(node, "iD"),
            stored=not _flag(node, "transient"),
            default=node.get("defaultValueLiteral"),
            opposite=opposites[0] if opposites else "",
            keys=self._uris(node, "eKeys"),
        )

    def _type(self, node: Node, owner: Node, is_reference: bool) -> str:
        """Return the type of a feature: of a generic one, what is left of it without its arguments.

        Empty where the file says nothing of it, as descriptions of old dialects do.
        """
        found = self._uris(node, "eType")
        if found:
            return found[0]
        generics = node.all("eGenericType")
        if not generics:
            return ""
        found = self._erased(generics[0], owner)
        return found[0] if found else f"{ECORE}#//{'EObject' if is_reference else 'EJavaObject'}"

    def _erased(self, generic: Node, owner: Node) -> tuple[str, ...]:
        """Return the class that a generic type is, or the first bound of its parameter; empty without one."""
        seen: set[int] = set()
        bounds = [generic]
        while bounds and id(bounds[0]) not in seen:
            generic = bounds[0]
            seen.add(id(generic))
            if direct := self._uris(generic, "eClassifier"):
                return direct
            bounds = []
            for uri in self._uris(generic, "eTypeParameter"):
                parameter = self._parameters_of(owner).get(uri.rpartition("/")[2])
                if parameter is None:
                    raise self._fault(generic, f"{shown(uri)}: no type parameter of {owner.get('name')}")
                bounds = parameter.all("eBounds")
        return ()

    def _parameters_of(self, owner: Node) -> dict[str, Node]:
        if id(owner) not in self._parameters:
            found = {each.get("name") or "": each for each in owner.all("eTypeParameters")}
            self._parameters[id(owner)] = found
        return self._parameters[id(owner)]

    def _uris(self, node: Node, name: str) -> tuple[str, ...]:
        """Return what a reference leads to; EMF writes what is in other files as an element of its own."""
        text = node.get(name)
        words = [] if text is None else list(islice(_words(text), MOST_REFERENCES + 1))
        for child in node.all(name):
            found = [uri for uri in (child.get("href"), *_idref(child)) if uri]
            if not found:
                raise self._fault(child, "leads nowhere: neither href nor xmi:idref")
            words += found
        if len(words) > MOST_REFERENCES:
            raise self._fault(node, f"{name}: more than {MOST_REFERENCES} references")
        return tuple(self._uri(word, node, name) for word in words)

    def _uri(self, word: str, node: Node, name: str) -> str:
        document, _, fragment = word.rpartition("#") if "#" in word else ("", "", word)
        if document:
            return word
        found = self._tree.fragment(fragment)
        if found is None:
            raise self._fault(node, f"{name}: {shown(word)} leads to no element")
        return f"#{found}"

    def _enum(self, node: Node) -> EnumTable:
        literals = []
        for each in node.all("eLiterals"):
            name, value = self._needed(each, "name"), self._whole(each, "value", 0)
            literal = each.get("literal")
            literals.append(Literal(name, name if literal is None else literal, value, _documentation(each)))
        return EnumTable(self._needed(node, "name"), tuple(literals), _documentation(node))

    def _datatype(self, node: Node) -> DataTypeTable:
        java_class = node.get("instanceClassName") or node.get("instanceTypeName") or ""
        serializable = _flag(node, "serializable", True)
        return DataTypeTable(self._needed(node, "name"), java_class, serializable, _documentation(node))

    def _needed(self, node: Node, name: str) -> str:
        value = node.get(name)
        if value:
            return value
        if node.get("href"):
            raise self._fault(
                node, f"{shown(node.get('href') or '')}: in another file, which is not supported"
            )
        raise self._fault(node, f"{name} is missing")

    def _whole(self, node: Node, name: str, usual: int) -> int:
        text = node.get(name)
        if text is None:
            return usual
        if not _WHOLE.fullmatch(text):
            raise self._fault(node, f"{name}: {shown(text)} is not a whole number")
        if not -(1 << 31) <= int(text) < 1 << 31:
            raise self._fault(node, f"{name}: {shown(text)} does not fit into 32 bits")
        return int(text)

    def _fault(self, node: Node, reason: str) -> UnreadableError:
        what = "" if reason.startswith(("lowerBound", "upperBound", "value")) else f"{node.tag}: "
        return UnreadableError(f"{self._file}:{node.line}: {what}{reason}")


def _words(text: str) -> Iterator[str]:
    """Yield the URIs in an attribute that refers, without the types that may stand before them.

    >>> list(_words("#//A ecore:EClass urn:x#//B _1"))
    ['#//A', 'urn:x#//B', '_1']
    """
    return (word[0] for word in _WORD.finditer(text) if "#" in word[0] or ":" not in word[0])


def _idref(node: Node) -> tuple[str, ...]:
    return tuple(_words(node.get("idref") or ""))


def _flag(node: Node, name: str, usual: bool = False) -> bool:
    text = node.get(name)
    return usual if text is None else text.lower() == "true"


def _documentation(node: Node) -> str:
    for annotation in node.all("eAnnotations"):
        for detail in annotation.all("details"):
            return detail.get("value") or ""
    return ""
