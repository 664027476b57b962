"""Reads models of older versions: as trees, migrated, and then as elements."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial

from mmrs_core.diagnostics import Severity
from mmrs_core.errors import UnreadableError
from mmrs_core.languages.evolution.migrating import Lost, Migrating, class_of, every_node
from mmrs_core.languages.evolution.migration import may_be_old
from mmrs_core.languages.evolution.old_xmi import OldXmi
from mmrs_core.languages.json_form.reader import JsonReader
from mmrs_core.languages.json_form.stream import LANGUAGES, ROOTS, TYPE
from mmrs_core.languages.json_form.text import Text
from mmrs_core.languages.json_form.tree import Node, Tree, TreeStream
from mmrs_core.languages.json_form.unknown import XML, kept_languages, scope_of, xml_of
from mmrs_core.languages.references.documents import Draft
from mmrs_core.languages.registry import Registry
from mmrs_core.languages.xmi.events import Document

MIGRATED, LOST = "MIG001", "MIG002"


def read_old_xmi(data: bytes, draft: Draft, registry: Registry) -> None:
    """Read an XMI file that mentions an old version; errors as in `Document.parse`."""
    document = Document(data, draft.source.file)
    old = OldXmi(document, partial(_is_known, registry))
    document.parse(old)
    for what, line in old.ignored:
        message = f"{what}: not read, and not kept when the model is saved"
        draft.fault("XMI011", message, line, severity=Severity.WARNING)
    way = Migrating(old.roots, registry, {}, draft.source.file)
    top = Node({ROOTS: list(old.roots)})
    # XML does not tell the lines of attributes
    stream = TreeStream(draft.source.file, top, lambda node, key: node.line)
    _read(stream, old.roots, way, draft, registry)


def read_json(data: bytes, draft: Draft, registry: Registry) -> None:
    """Read a JSON file, whatever version it is of; errors as in `Text` and `Tree`."""
    file = draft.source.file
    text = Text(data, file)
    kept = any(_is_known(registry, ns_uri) for ns_uri in kept_languages(text))
    if not (kept or may_be_old(data, registry.chains)):
        JsonReader(text, draft, registry).read()
        return
    tree = Tree(data, file)
    top = tree.top
    stream = TreeStream(file, top, tree.line_of)
    if not isinstance(top, Node):
        JsonReader(stream, draft, registry).read()
        return
    listed = top.members.get(ROOTS, [top])
    roots = [each for each in (listed if isinstance(listed, list) else [listed]) if isinstance(each, Node)]
    prefixes = top.members.get(LANGUAGES)
    languages = {k: str(v) for k, v in prefixes.members.items()} if isinstance(prefixes, Node) else {}
    if kept:
        _unpack(roots, registry, languages, file)
    _read(stream, roots, Migrating(roots, registry, languages, file), draft, registry)


def _unpack(roots: Sequence[Node], registry: Registry, languages: Mapping[str, str], file: str) -> None:
    """Read what was kept as XML of elements whose languages are installed by now."""
    is_known = partial(_is_known, registry)
    for node in every_node(roots):
        if XML not in node.members or not is_known(class_of(node, languages)[0]):
            continue
        try:
            xml = xml_of(str(node.members[XML]), scope_of(node))
            document = Document(xml.encode(), file)
        except ValueError as fault:
            raise UnreadableError.of("FIL004", str(fault), file, node.line) from None
        old = OldXmi(document, lambda ns_uri: not ns_uri or is_known(ns_uri))  # its tag is that of a feature
        document.parse(old)
        _release(document)
        inside = old.roots[0]
        kind = node.members[TYPE]
        for each in every_node([inside]):
            each.line = node.line
        node.members = {**inside.members, TYPE: kind}


def _release(document: Document) -> None:
    """Part a document from its listeners: a collector at rest does not free the circle that they are."""
    for event in ("StartElement", "EndElement", "CharacterData", "XmlDecl", "StartDoctypeDecl"):
        setattr(document.parser, f"{event}Handler", None)
    document.parser.StartNamespaceDeclHandler = document.parser.EndNamespaceDeclHandler = None


def _is_known(registry: Registry, ns_uri: str) -> bool:
    return registry.has(ns_uri) or ns_uri in registry.chains


def _read(
    stream: TreeStream, roots: Sequence[Node], way: Migrating, draft: Draft, registry: Registry
) -> None:
    reader = JsonReader(stream, draft, registry)
    reader.read()
    for address, node in way.addresses.items():
        element = reader.made.get(id(node))
        if element is not None:
            draft.found[address] = element  # references in the file still say where things stood before
    _tell(roots, way, draft)


def _tell(roots: Sequence[Node], way: Migrating, draft: Draft) -> None:
    line = roots[0].line if roots else 1
    for start, end in _ends(way):
        message = f"{start}: an older version; migrated to {end} while it was read"
        hint = "the file is as it was; save the model to have it in the new version"
        draft.fault(MIGRATED, message, line, hint=hint, severity=Severity.NOTE)
    for lost in way.lost:
        draft.fault(LOST, _lost(lost), lost.line, hint=_LOST_HINT, severity=Severity.WARNING)


_LOST_HINT = "see whether the mission still means what it did"


def _lost(lost: Lost) -> str:
    return f"{lost.feature}: {lost.value!r} has no place in {lost.version}, and is left out"


def _ends(way: Migrating) -> list[tuple[str, str]]:
    """Return where each chain of steps begins and ends."""
    ends: dict[str, str] = {}
    for step in way.steps:
        start = next((begin for begin, end in ends.items() if end == step.from_uri), step.from_uri)
        ends[start] = step.to_uri
    return list(ends.items())
