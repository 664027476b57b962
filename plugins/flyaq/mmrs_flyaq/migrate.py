"""Migrate source files to models of the installed languages, with a report of all changes."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from mmrs_core.errors import UnreadableError
from mmrs_core.languages.element import Element
from mmrs_core.languages.registry import Registry
from mmrs_flyaq.building.builder import Builder
from mmrs_flyaq.building.circling import draw_ring
from mmrs_flyaq.building.linking import Linker
from mmrs_flyaq.building.robot_types import RobotTypes
from mmrs_flyaq.findings import Finding, Record
from mmrs_flyaq.outputs import Made, Output, outputs_of
from mmrs_flyaq.recognition import adopt
from mmrs_flyaq.rules.mapping import DialectMapping
from mmrs_flyaq.rules.rules_file import ROBOT_TYPE
from mmrs_flyaq.sources.documents import Opened, open_document
from mmrs_flyaq.sources.metamodels import Reader, metamodels_for, structure_of
from mmrs_flyaq.sources.nodes import SourceDocument
from mmrs_flyaq.sources.structure import Structure


class UnknownTypeError(ValueError):
    """What is said to stand for a robot type occurs nowhere."""


@dataclass(frozen=True, slots=True)
class Source:
    """A file, and what it turned out to be.

    Attributes:
        what: such as "a model", or "a metamodel, http://…: nothing to migrate".
        metamodels: where its metamodels were found, by package; what is missing there is as the mapping says.
        is_model: whether there is something in it to migrate.
        fault: why it cannot be read; empty where it can.
    """

    file: str
    what: str
    metamodels: Mapping[str, Path]
    is_model: bool = False
    fault: str = ""


@dataclass(frozen=True, slots=True)
class Migration:
    """What came of source files.

    Attributes:
        sources: in the order in which they were given.
        outputs: the models, none twice.
        findings: everything that was not carried over just as it was.
    """

    sources: tuple[Source, ...]
    outputs: tuple[Output, ...]
    findings: tuple[Finding, ...]


@dataclass(frozen=True, slots=True)
class Settled:
    """A document whose nodes know their classes."""

    document: SourceDocument
    structure: Structure
    source: Source


def migrate(
    files: Sequence[Path],
    mapping: DialectMapping,
    registry: Registry,
    *,
    metamodels: Sequence[Path] = (),
    types: Mapping[str, str] | None = None,
    present: Mapping[str, Element] | None = None,
) -> Migration:
    """Return what files of a dialect become.

    Args:
        metamodels: .ecore files, or folders of them, that go before those found beside the files.
        types: what the names of robot types in the files stand for; goes before what the mapping says.
        present: robot types that are at hand already, by name.

    A file that cannot be read is listed among the sources; the others are migrated.

    Raises:
        UnreadableError: if one of the given metamodels is none.
        UnknownTypeError: if types name what no file calls a robot type.
    """
    opened = [_opened(path, mapping) for path in files]
    models = [
        _adopted(each, mapping, registry)
        for each in opened
        if isinstance(each, Opened) and each.document is not None
    ]
    settled = {each.file: settle(each, mapping, metamodels) for each in models}
    _refuse_unknown(types or {}, settled.values(), mapping)
    robots = RobotTypes(present or {}, {**mapping.types, **(types or {})})
    record = Record()
    made = build(settled.values(), mapping, registry, robots, record)
    sources = tuple(_source(each, settled) for each in opened)
    return Migration(sources, outputs_of(made, registry, record), tuple(record.findings))


def build(
    documents: Iterable[Settled],
    mapping: DialectMapping,
    registry: Registry,
    robots: RobotTypes,
    record: Record,
) -> list[Made]:
    """Return what documents become, robot types first; these are known to the others then."""
    made: list[Made] = []
    with registry.in_use():
        for each in _types_first(documents, mapping):
            for root in _built(each, mapping, registry, robots, record):
                made.append(root)
                if registry.metaclass(*ROBOT_TYPE).accepts(root.element):
                    robots.known.setdefault(getattr(root.element, "name", None) or "", root.element)
    return made


def _opened(path: Path, mapping: DialectMapping) -> Opened | Source:
    try:
        return open_document(path, mapping.documents)
    except UnreadableError as fault:
        return Source(str(path), "not readable", {}, fault=str(fault))


def _adopted(opened: Opened, mapping: DialectMapping, registry: Registry) -> Opened:
    """Return a document of the dialect, whichever nsURI its metamodels have."""
    assert opened.document is not None  # asked before
    strange = adopt(opened.document, mapping, registry)
    if not strange:
        return opened
    named = ", ".join(strange)
    return replace(
        opened, what=f"{opened.what} by what its classes are called, with an nsURI of its own, {named}"
    )


def _source(opened: Opened | Source, settled: Mapping[str, Settled]) -> Source:
    if isinstance(opened, Source):
        return opened
    return settled[opened.file].source if opened.file in settled else Source(opened.file, opened.what, {})


def settle(opened: Opened, mapping: DialectMapping, given: Sequence[Path], *, stored: bool = True) -> Settled:
    """Return a document whose nodes know their classes, by the metamodels at hand and by the mapping.

    Args:
        stored: whether there is such a file, beside which metamodels may lie.
    """
    document = opened.document
    assert document is not None  # asked before
    found = metamodels_for(document, given, mapping.dialect) if stored else {}
    structure = structure_of(found, mapping.dialect).over(mapping.structure, found)
    Reader(structure, mapping.dialect).settle(document)
    used = {node.kind.partition(".")[0] for root in document.roots for node in root.inside()}
    places = {package: each.file for package, each in found.items() if package in used}
    return Settled(document, structure, Source(opened.file, opened.what, places, is_model=True))


def _refuse_unknown(types: Mapping[str, str], settled: Iterable[Settled], mapping: DialectMapping) -> None:
    """Require that every name that is to stand for a robot type occurs in the files."""
    if not types:
        return
    occurring = {name for each in settled for name in _type_names(each, mapping)}
    for name in types:
        if name not in occurring:
            known = ", ".join(sorted(map(repr, occurring)))
            occur = f"these files name {known}" if known else "these files name none"
            raise UnknownTypeError(f"{name!r}: no robot type of this name occurs; {occur}")


def _type_names(settled: Settled, mapping: DialectMapping) -> Iterator[str]:
    """Yield the robot types that a document names."""
    for root in settled.document.roots:
        for node in root.inside():
            kinds = settled.structure.ancestry(node.kind)
            rules = [rule for rule in mapping.rules.values() if rule.source.partition("/")[0] in kinds]
            for feature, use in ((name, use) for rule in rules for name, use in rule.uses.items()):
                texts = node.texts(feature) if use.robot_type else ()
                yield from (use.values.get(text, text) for text in texts)


def _types_first(settled: Iterable[Settled], mapping: DialectMapping) -> list[Settled]:
    """Return documents with robot types before all others, which may name them."""

    def rank(each: Settled) -> bool:
        kinds = [mapping.rule(root.kind, "", each.structure) for root in each.document.roots]
        return not any(rule is not None and rule.robot_type for rule in kinds)

    return sorted(settled, key=rank)


def _built(
    settled: Settled, mapping: DialectMapping, registry: Registry, types: RobotTypes, record: Record
) -> list[Made]:
    builder = Builder(mapping, settled.structure, registry, types, record)
    draft = builder.build(settled.document.roots)
    Linker(draft, registry, record).complete()
    for node, rule in draft.rings:
        draw_ring(node, rule, draft, types, registry, record)
    nodes = {draft.made[node]: node for node in settled.document.roots if node in draft.made}
    return [Made(element, nodes[element], (settled.document.file,)) for element in draft.roots]
