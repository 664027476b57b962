"""What an .ecore file says, as plain tables; references to types are still texts."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path

from mmrs_core.errors import UnreadableError
from mmrs_core.languages.datatypes import ECORE
from mmrs_core.languages.metaclass import Literal
from mmrs_core.languages.xmi.events import XSI, Document, read_bytes

GENMODEL = "http://www.eclipse.org/emf/2002/GenModel"
MAP_ENTRY = "java.util.Map$Entry"
"""The Java class of an entry of a map."""


@dataclass(frozen=True, slots=True)
class FeatureTable:
    """A structural feature as it stands in its file; ``type`` and ``opposite`` are URIs."""

    name: str
    type: str
    is_reference: bool
    documentation: str = ""
    lower: int = 0
    upper: int = 1
    containment: bool = False
    unsettable: bool = False
    unique: bool = True
    is_id: bool = False
    stored: bool = True
    default: str | None = None
    opposite: str = ""
    keys: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class ClassTable:
    """A class; ``supertypes`` are URIs; ``java_class`` is what Java is to have in its place, if anything."""

    name: str
    abstract: bool = False
    documentation: str = ""
    supertypes: tuple[str, ...] = ()
    features: tuple[FeatureTable, ...] = ()
    java_class: str = ""


@dataclass(frozen=True, slots=True)
class EnumTable:
    """An enumeration."""

    name: str
    literals: tuple[Literal, ...] = ()
    documentation: str = ""


@dataclass(frozen=True, slots=True)
class DataTypeTable:
    """A data type that the package declares itself."""

    name: str
    java_class: str = ""
    serializable: bool = True
    documentation: str = ""


@dataclass(frozen=True, slots=True)
class PackageTable:
    """A package, with the packages inside it."""

    ns_uri: str
    name: str
    prefix: str
    documentation: str = ""
    classes: tuple[ClassTable, ...] = ()
    enums: tuple[EnumTable, ...] = ()
    datatypes: tuple[DataTypeTable, ...] = ()
    subpackages: tuple[PackageTable, ...] = ()


@dataclass(slots=True)
class _Node:
    tag: str
    attributes: dict[str, str]
    line: int
    children: list[_Node] = field(default_factory=list)

    def get(self, name: str, default: str = "") -> str:
        return self.attributes.get(name, default)

    def flag(self, name: str, default: bool = False) -> bool:
        return self.attributes.get(name, str(default)).lower() == "true"

    def all(self, tag: str) -> list[_Node]:
        return [child for child in self.children if child.tag == tag]


class _Tree:
    """Collects a small document whole."""

    def __init__(self, document: Document) -> None:
        self._document = document
        self.top: list[_Node] = []
        self._open: list[_Node] = []

    def start(self, tag: str, attributes: list[str]) -> None:
        named = dict(zip(attributes[::2], attributes[1::2], strict=True))
        if kind := named.get(f"{XSI} type"):
            prefix, _, name = kind.rpartition(":")
            named["kind"] = f"{self._document.namespaces.uri(prefix)} {name}"
        node = _Node(tag, named, self._document.line)
        (self._open[-1].children if self._open else self.top).append(node)
        self._open.append(node)

    def end(self, tag: str) -> None:
        self._open.pop()

    def text(self, text: str) -> None:
        """Take nothing: an .ecore holds no character data."""


def read_tables(path: Path) -> tuple[PackageTable, ...]:
    """Return the packages at the top of an .ecore file.

    Raises:
        UnreadableError: if it cannot be read or is no metamodel.
    """
    return parse_tables(read_bytes(path), str(path))


def parse_tables(data: bytes, file: str) -> tuple[PackageTable, ...]:
    """Return the packages at the top of the text of an .ecore file, which messages call ``file``."""
    document = Document(data, file)
    tree = _Tree(document)
    document.parse(tree)
    root = tree.top[0]
    packages = root.children if root.tag == "http://www.omg.org/XMI XMI" else tree.top
    tables = tuple(_package(node, file) for node in packages if node.tag == f"{ECORE} EPackage")
    if not tables:
        raise UnreadableError(f"{file}:{root.line}: no metamodel: the root is not an EPackage of {ECORE}")
    return tables


def _package(node: _Node, file: str) -> PackageTable:
    name, ns_uri = _needed(node, "name", file), _needed(node, "nsURI", file)
    table = PackageTable(ns_uri, name, node.get("nsPrefix", name), _documentation(node))
    classifiers = node.all("eClassifiers")
    by_kind: dict[str, list[_Node]] = {"EClass": [], "EEnum": [], "EDataType": []}
    for classifier in classifiers:
        kind = classifier.get("kind").rpartition(" ")[2]
        if kind not in by_kind:
            raise UnreadableError(f"{file}:{classifier.line}: {kind or 'no xsi:type'}: no kind of classifier")
        by_kind[kind].append(classifier)
    return replace(
        table,
        classes=tuple(_class(child, file) for child in by_kind["EClass"]),
        enums=tuple(_enum(child, file) for child in by_kind["EEnum"]),
        datatypes=tuple(_datatype(child, file) for child in by_kind["EDataType"]),
        subpackages=tuple(_package(child, file) for child in node.all("eSubpackages")),
    )


def _class(node: _Node, file: str) -> ClassTable:
    generic = [super_.get("eClassifier") for super_ in node.all("eGenericSuperTypes")]
    return ClassTable(
        _needed(node, "name", file),
        node.flag("abstract") or node.flag("interface"),
        _documentation(node),
        (
            *references(node.get("eSuperTypes")),
            *(reference for text in generic for reference in references(text)),
        ),
        tuple(_feature(child, file) for child in node.all("eStructuralFeatures")),
        node.get("instanceClassName") or node.get("instanceTypeName"),
    )


def _feature(node: _Node, file: str) -> FeatureTable:
    is_reference = node.get("kind").endswith(" EReference")
    return FeatureTable(
        name=_needed(node, "name", file),
        type=_type(node) or f"{ECORE}#//{'EObject' if is_reference else 'EString'}",
        is_reference=is_reference,
        documentation=_documentation(node),
        lower=_whole(node, "lowerBound", 0, file),
        upper=_whole(node, "upperBound", 1, file),
        containment=is_reference and node.flag("containment"),
        unsettable=node.flag("unsettable"),
        unique=node.flag("unique", True),
        is_id=node.flag("iD"),
        stored=not node.flag("transient"),
        default=node.attributes.get("defaultValueLiteral"),
        opposite=node.get("eOpposite"),
        keys=tuple(uri.rpartition("/")[2] for uri in references(node.get("eKeys"))),
    )


def _type(node: _Node) -> str:
    generic = [child.get("eClassifier") for child in node.all("eGenericType")]
    found = references(node.get("eType") or " ".join(generic))
    return found[0] if found else ""


def references(text: str) -> tuple[str, ...]:
    """Return the URIs in an attribute that refers, without the types that may stand before them.

    >>> references("#//A ecore:EClass urn:x#//B")
    ('#//A', 'urn:x#//B')
    """
    return tuple(token for token in text.split() if "#" in token or "/" in token)


def _enum(node: _Node, file: str) -> EnumTable:
    literals = []
    for child in node.all("eLiterals"):
        name = _needed(child, "name", file)
        value = _whole(child, "value", 0, file)
        literals.append(Literal(name, child.get("literal") or name, value, _documentation(child)))
    return EnumTable(_needed(node, "name", file), tuple(literals), _documentation(node))


def _datatype(node: _Node, file: str) -> DataTypeTable:
    java_class = node.get("instanceClassName") or node.get("instanceTypeName")
    return DataTypeTable(
        _needed(node, "name", file), java_class, node.flag("serializable", True), _documentation(node)
    )


def _documentation(node: _Node) -> str:
    for annotation in node.all("eAnnotations"):
        if annotation.get("source") == GENMODEL:
            for detail in annotation.all("details"):
                if detail.get("key") == "documentation":
                    return detail.get("value")
    return ""


def _needed(node: _Node, name: str, file: str) -> str:
    value = node.get(name)
    if not value:
        raise UnreadableError(f"{file}:{node.line}: {node.tag.rpartition(' ')[2]}: {name} is missing")
    return value


def _whole(node: _Node, name: str, default: int, file: str) -> int:
    text = node.get(name, str(default))
    try:
        return int(text)
    except ValueError:
        raise UnreadableError(f"{file}:{node.line}: {name}: {text!r} is not a whole number") from None
