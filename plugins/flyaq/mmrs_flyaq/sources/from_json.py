"""Nodes from the JSON that EMF's JSON exporter wrote, in all its spellings of a class.

A class is ``prefix://Name`` with the prefix in the map ``@ns`` of the root, ``nsURI#//Name``, or
``file:…/name.ecore#//Name``; it may be missing where the feature decides it.
"""

from __future__ import annotations

from collections.abc import Mapping

from mmrs_core.languages.json_form.tree import Node as Object
from mmrs_core.languages.json_form.tree import Tree
from mmrs_flyaq.sources.nodes import DEEPEST_NESTING, Claim, Link, SourceNode, Text, too_deep

CLASS = "eClass"
REFERENCE = "$ref"
NAMESPACES = "@ns"


def node_of(tree: Tree, value: Object) -> SourceNode:
    """Return the element that an object describes.

    Raises:
        UnreadableError: if it nests deeper than 100 levels.
    """
    return _Reader(tree, _namespaces(value)).node(value, 0)


def text_in(value: Object, key: str) -> str:
    """Return the text of a member, or an empty one where it is missing or something else."""
    found = value.members.get(key)
    return found if isinstance(found, str) else ""


def claim_of(text: str, namespaces: Mapping[str, str]) -> Claim | None:
    """Return the class that a text names; None for an empty one.

    >>> claim_of("shop://Order", {"shop": "http://shop"})
    Claim(document='http://shop', name='Order')
    >>> claim_of("file:/C:/models/shop.ecore#//Order", {}).document
    'file:/C:/models/shop.ecore'
    """
    document, _, name = text.rpartition("//")
    if not name:
        return None
    if document.endswith(":"):
        return Claim(namespaces.get(document[:-1], document[:-1]), name)
    return Claim(document.removesuffix("#"), name)


def _namespaces(value: Object) -> dict[str, str]:
    declared = value.members.get(NAMESPACES)
    members = declared.members if isinstance(declared, Object) else {}
    return {prefix: uri for prefix, uri in members.items() if isinstance(uri, str)}


class _Reader:
    def __init__(self, tree: Tree, namespaces: Mapping[str, str]) -> None:
        self._tree = tree
        self._namespaces = namespaces

    def node(self, value: Object, depth: int) -> SourceNode:
        if depth > DEEPEST_NESTING:
            raise too_deep(self._tree.file, value.line)
        node = SourceNode(self._tree.file, value.line, claim_of(text_in(value, CLASS), self._namespaces))
        for key, member in value.members.items():
            if key not in (CLASS, NAMESPACES):
                self._add(node, key, member, self._tree.line_of(value, key), depth)
        return node

    def _add(self, node: SourceNode, key: str, value: object, line: int, depth: int) -> None:
        match value:
            case list():
                for item in value:
                    self._add(node, key, item, line, depth + 1)
            case Object() if REFERENCE in value.members:
                node.add(key, Link(text_in(value, REFERENCE), value.line))
            case Object():
                node.add(key, self.node(value, depth + 1))
            case bool():
                node.add(key, Text("true" if value else "false", line))
            case str():
                node.add(key, Text(str(value), line))
