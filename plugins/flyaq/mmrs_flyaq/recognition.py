"""Which files are of a dialect: by nsURI, by their form, or by what their classes are called."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from mmrs_core.errors import UnreadableError
from mmrs_core.languages.missing import is_near
from mmrs_core.languages.registry import Registry
from mmrs_core.languages.schema_location import first_kind_in_xmi
from mmrs_flyaq.rules.mapping import DialectMapping
from mmrs_flyaq.sources.documents import Opened, first_letter, open_text
from mmrs_flyaq.sources.nodes import Claim, SourceDocument, SourceNode


@dataclass(frozen=True, slots=True)
class Recognised:
    """A file of a dialect.

    Attributes:
        mapping: of the dialect.
        strange: nsURIs that are none of the dialect's, whose classes are called as the dialect's are.
        is_guess: whether that of a root is one of them.
        stored: whether there is such a file, beside which metamodels may lie.
    """

    opened: Opened
    mapping: DialectMapping
    strange: tuple[str, ...] = ()
    is_guess: bool = False
    stored: bool = True


def recognised(data: bytes, file: str, mapping: DialectMapping, registry: Registry) -> Recognised | None:
    """Return a file all of whose roots are of a dialect; None for any other."""
    try:
        if first_letter(data) == "<" and not _may_be(first_kind_in_xmi(data, file), mapping):
            return None  # to read all of a large file takes long
        opened = open_text(data, file, mapping.documents)
    except UnreadableError:
        return None
    if opened.document is None:
        return Recognised(opened, mapping) if opened.form is not None else None
    roots = opened.document.roots
    stated = {root.claim.document for root in roots if root.claim is not None}
    strange = adopt(opened.document, mapping, registry)
    is_own = bool(roots) and all(_is_own(root, mapping) for root in roots)
    is_guess = not stated.isdisjoint(strange)
    return Recognised(opened, mapping, strange, is_guess) if is_own else None


def adopt(document: SourceDocument, mapping: DialectMapping, registry: Registry) -> tuple[str, ...]:
    """Let elements of metamodels that only have another nsURI count as the dialect's; return these nsURIs.

    They count as of the package that has all classes of that nsURI in the document.
    """
    claiming: dict[str, list[SourceNode]] = {}
    for root in document.roots:
        for node in root.inside():
            if node.claim is not None and not mapping.dialect.has(node.claim.document):
                claiming.setdefault(node.claim.document, []).append(node)
    adopted = []
    for name, nodes in claiming.items():
        package = "" if not name or is_near(name, registry) else _package_of(name, nodes, mapping)
        by_file = name != package == mapping.dialect.package(name)  # so do the dialect's own files in JSON
        if not package or by_file:
            continue
        adopted.append(name)
        for node in nodes:
            node.claim = Claim(package, _class_of(node))
    return tuple(adopted)


def _may_be(kind: tuple[str, str], mapping: DialectMapping) -> bool:
    ns_uri, name = kind
    return mapping.dialect.has(ns_uri) or any(
        each.rpartition(".")[2] == name for each in mapping.structure.classes
    )


def _is_own(root: SourceNode, mapping: DialectMapping) -> bool:
    kind = mapping.dialect.kind(root.claim)
    is_stated = root.claim is not None and mapping.dialect.has(root.claim.document)
    return bool(kind) and (is_stated or mapping.structure.has(kind))


def _package_of(name: str, nodes: Iterable[SourceNode], mapping: DialectMapping) -> str:
    """Return the package that is meant by the nsURI or file of elements' classes; empty if none is."""
    fitting = [
        package for package in mapping.dialect.uris if all(_is_of(package, node, mapping) for node in nodes)
    ]
    meant = mapping.dialect.package(name)
    return meant if meant in fitting else "" if meant else next(iter(fitting), "")


def _is_of(package: str, node: SourceNode, mapping: DialectMapping) -> bool:
    """Return whether a package has the class of an element; of a root, what is in it must fit, too."""
    kind = f"{package}.{_class_of(node)}"
    if node.parent is not None or not mapping.structure.has(kind):
        return mapping.structure.has(kind)
    inside = [feature for feature in node.values if node.nodes(feature)]
    return bool(inside) and all(mapping.structure.feature(kind, each) is not None for each in inside)


def _class_of(node: SourceNode) -> str:
    return node.claim.name.rpartition("/")[2] if node.claim is not None else ""
