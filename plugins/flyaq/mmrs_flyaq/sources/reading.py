"""From a file to nodes whose classes are known and whose references lead somewhere."""

from __future__ import annotations

import re
from dataclasses import dataclass

from mmrs_flyaq.sources.metamodels import Dialect
from mmrs_flyaq.sources.nodes import Link, SourceDocument, SourceNode, Text
from mmrs_flyaq.sources.structure import Sort, Structure

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
