"""The metamodels of a dialect, and documents settled by them: classes found, references resolved."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from os.path import isfile
from pathlib import Path
from typing import Any

from mmrs_core.errors import PluginError, UnreadableError
from mmrs_core.languages.metamodels.loading import load_alone
from mmrs_flyaq.sources.nodes import Claim, Link, SourceDocument, SourceNode, Text
from mmrs_flyaq.sources.structure import Sort, SourceClass, SourceFeature, Structure


@dataclass(frozen=True, slots=True)
class Dialect:
    """How the packages of a dialect are called.

    Attributes:
        uris: every spelling of the nsURI, by package.
        files: names of its .ecore files, by package.
    """

    uris: Mapping[str, tuple[str, ...]]
    files: Mapping[str, tuple[str, ...]]

    def has(self, ns_uri: str) -> bool:
        """Return whether an nsURI is that of a package, in any spelling."""
        return any(ns_uri in uris for uris in self.uris.values())

    def package(self, document: str) -> str:
        """Return the package that an nsURI, a prefix or an .ecore file means, or an empty text."""
        name = document.replace("\\", "/").rpartition("/")[2]
        for package, uris in self.uris.items():
            if document in uris or document == package or name in self.files.get(package, ()):
                return package
        return ""

    def kind(self, claim: Claim | None) -> str:
        """Return ``package.Class`` of a claim, or an empty text where the package is unknown."""
        package = self.package(claim.document) if claim is not None else ""
        return f"{package}.{claim.name.rpartition('/')[2]}" if claim is not None and package else ""


@dataclass(frozen=True, slots=True)
class Found:
    """A metamodel at hand, with the EPackage that pyecore loaded."""

    file: Path
    epackage: Any


def candidates(given: Sequence[Path], document: SourceDocument) -> Iterator[Path]:
    """Yield the .ecore files that may describe a document: those given, those it names, those beside it."""
    for path in given:
        yield from sorted(path.glob("*.ecore")) if path.is_dir() else (path,)
    folder = Path(document.file).parent
    for _, location in document.locations:
        file = folder / location.partition("#")[0]
        if "://" not in location and isfile(file):  # noqa: PTH113  is_file raises for a name that is too long
            yield file
    if folder.is_dir():
        yield from sorted(folder.glob("*.ecore"))


def metamodels_for(document: SourceDocument, given: Sequence[Path], dialect: Dialect) -> dict[str, Found]:
    """Return the metamodels at hand by package, those that are given before those that the document leads to.

    Of several, the one whose nsURI or file the document names is taken, else the first.

    Raises:
        UnreadableError: if a metamodel that was given is none; one that only lies beside the model is
            passed over.
    """
    named = _named_by(document)
    chosen: dict[str, tuple[tuple[bool, bool], Found]] = {}
    for found in _readable(dict.fromkeys(candidates(given, document)), frozenset(given)):
        package = dialect.package(found.epackage.nsURI)
        exact = found.epackage.nsURI in named or found.file.name in named
        rank = (_is_given(found.file, given), exact)
        if package and (package not in chosen or rank > chosen[package][0]):
            chosen[package] = (rank, found)
    return {package: found for package, (_, found) in chosen.items()}


def _named_by(document: SourceDocument) -> set[str]:
    """Return the nsURIs, and the names of the .ecore files, by which a document names its metamodels."""
    claims = {node.claim.document for root in document.roots for node in root.inside() if node.claim}
    locations = {text.partition("#")[0] for pair in document.locations for text in pair}
    files = {text.replace("\\", "/").rpartition("/")[2] for text in claims | locations}
    return claims | locations | {file for file in files if file.endswith(".ecore")}


def _is_given(file: Path, given: Iterable[Path]) -> bool:
    return any(file == each or file.parent == each for each in given)


def _readable(files: Iterable[Path], given: frozenset[Path]) -> Iterator[Found]:
    for file in files:
        try:
            yield from (Found(file, epackage) for epackage in load_alone(file))
        except (UnreadableError, PluginError):
            if _is_given(file, given):
                raise


def structure_of(metamodels: Mapping[str, Found], dialect: Dialect) -> Structure:
    """Return the classes of metamodels."""
    classes = {
        f"{package}.{eclass.name}": _class(package, eclass, dialect)
        for package, found in metamodels.items()
        for eclass in found.epackage.eClassifiers
        if hasattr(eclass, "eStructuralFeatures")
    }
    return Structure(classes)


def _class(package: str, eclass: Any, dialect: Dialect) -> SourceClass:
    supertypes = tuple(_kind(above, dialect) for above in eclass.eSuperTypes)
    features = tuple(_feature(feature, dialect) for feature in eclass.eStructuralFeatures)
    return SourceClass(f"{package}.{eclass.name}", supertypes, features)


def _feature(feature: Any, dialect: Dialect) -> SourceFeature:
    contained = feature.is_reference and feature.containment
    sort = Sort.CONTAINED if contained else Sort.REFERENCE if feature.is_reference else Sort.ATTRIBUTE
    return SourceFeature(feature.name, _kind(feature.eType, dialect), sort, feature.many)


def _kind(classifier: Any, dialect: Dialect) -> str:
    if classifier is None:
        return "."
    document = classifier.ePackage.nsURI
    return f"{dialect.package(document) or document}.{classifier.name}"


_STEP = re.compile(r"@(?P<name>[^.]+)(?:\.(?P<index>\d{1,9}))?", re.ASCII)


@dataclass(frozen=True, slots=True)
class Reader:
    """Gives the nodes of a document their classes.

    Attributes:
        structure: the classes of the dialect.
    """

    structure: Structure
    dialect: Dialect

    def settle(self, document: SourceDocument) -> None:
        """Find the class of every node, split references, and resolve them."""
        for root in document.roots:
            root.kind = root.kind or self.dialect.kind(root.claim)
            root.many = len(document.roots) > 1
            pending = [root]
            while pending:
                pending += self._settle(pending.pop())
        for root in document.roots:
            for node in root.inside():
                for values in node.values.values():
                    for value in values:
                        if isinstance(value, Link):
                            value.target = _target(value.text, document, root)

    def _settle(self, node: SourceNode) -> list[SourceNode]:
        """Give what a node holds its classes; return the nodes that are known so far."""
        if not self.structure.has(node.kind):
            return []
        known: list[SourceNode] = []
        for name in tuple(node.values):
            feature = self.structure.feature(node.kind, name)
            if feature is None:
                continue
            if feature.sort is Sort.REFERENCE:
                node.values[name] = [link for value in node.values[name] for link in _links(value)]
            for inner in node.nodes(name):
                inner.many = feature.many
                inner.kind = self.dialect.kind(inner.claim) if inner.claim else feature.type
                known.append(inner)
        return known


def _links(value: Text | Link | SourceNode) -> list[Text | Link | SourceNode]:
    """Return the references in a text that refers, with the types left out that may stand before them."""
    if not isinstance(value, Text):
        return [value]
    words = value.text.split()
    paths = [word for word in words if "/" in word or "#" in word]
    return [Link(word, value.line) for word in paths or words]


def _target(text: str, document: SourceDocument, root: SourceNode) -> SourceNode | None:
    """Return the node that a path means, such as ``//@drones.0/@slots.2``, or an id; None for all else."""
    path = text.partition("#")[2] if "#" in text else text
    if text.partition("#")[0] and "#" in text:
        return None
    if "/" not in path:
        return document.ids.get(path)
    head, *steps = path.removeprefix("/").split("/")
    roots = document.roots
    node: SourceNode | None = root
    if head:
        number = int(head) if head.isascii() and head.isdigit() and len(head) < 10 else len(roots)
        node = roots[number] if number < len(roots) else None
    for step in steps:
        match = _STEP.fullmatch(step)
        if match is None or node is None:
            return None
        inner = node.values.get(match["name"], [])
        index = int(match["index"] or 0)
        found = inner[index] if index < len(inner) else None
        node = found if isinstance(found, SourceNode) else None
    return node
