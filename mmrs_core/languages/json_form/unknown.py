"""Elements whose metamodel is not installed, as JSON keeps them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from xml.parsers import expat

from mmrs_core.languages.element import Unknown
from mmrs_core.languages.json_form.tree import Node
from mmrs_core.languages.xmi.unknowns import needed, text_of

_TYPE, _SCOPE = "$type", "$namespaces"
XML = "$xml"
DEEPEST_KEPT = 100
"""Levels of objects and lists that are kept inside an element of an unknown class."""


class UnknownObject(Unknown):
    """An element that stood in JSON, which is kept; no XML can be made of it without its metamodel.

    Attributes:
        _mmrs_json: the object; the types in it are written ``nsURI#Name``.
    """

    __slots__ = ("_mmrs_json",)

    _mmrs_json: Node


def kept(node: Node, claimed: str, languages: Mapping[str, str]) -> Unknown:
    """Return the element that an object stands for, of a metamodel that is not installed.

    Args:
        node: the object.
        claimed: its type, as ``nsURI#Name``.
        languages: the prefixes that types in it may use.

    Raises:
        ValueError: if it nests deeper than anything that is kept, or what it keeps is no XML.
    """
    element: Unknown
    if _depth(node) > DEEPEST_KEPT:
        raise ValueError(f"{claimed}: nested deeper than {DEEPEST_KEPT} levels")
    if XML in node.members:
        element = Unknown.__new__(Unknown)
        element._mmrs_xml, element._mmrs_scope = str(node.members[XML]), _scope_of(node)
        xml_of(node)
    else:
        element = UnknownObject.__new__(UnknownObject)
        element._mmrs_json = _retyped(node, lambda name: _expanded(name, languages))
        element._mmrs_xml = ""
        element._mmrs_scope = languages
    element._mmrs_type = claimed
    return element


def xml_of(node: Node) -> str:
    """Return the XML that an object keeps of an element, with all namespaces that it needs.

    Raises:
        ValueError: if it is no element of XML.
    """
    element = Unknown.__new__(Unknown)
    element._mmrs_xml, element._mmrs_scope = str(node.members[XML]), _scope_of(node)
    element._mmrs_type = "$xml"
    text = text_of(element, lambda prefix, ns_uri: False)
    parser = expat.ParserCreate(None, " ")
    parser.StartDoctypeDeclHandler = _no_doctype
    try:
        parser.Parse(text.encode(errors="replace"), True)
    except expat.ExpatError as fault:
        reason = expat.errors.messages[fault.code]
        raise ValueError(f"{XML}: not well-formed XML: {reason}") from None
    return text


def _no_doctype(*_: object) -> None:
    raise ValueError(f"{XML}: DOCTYPE is not accepted in a model")


def _scope_of(node: Node) -> Mapping[str, str]:
    scope = node.members.get(_SCOPE)
    return {k: str(v) for k, v in scope.members.items()} if isinstance(scope, Node) else {}


def stated(element: Unknown, typed: Callable[[str], str]) -> Node:
    """Return the object that says what is known of an element; `typed` shortens ``nsURI#Name``."""
    if isinstance(element, UnknownObject):
        return _retyped(element._mmrs_json, typed)
    scope = Node(dict(needed(element._mmrs_xml, element._mmrs_scope)))
    return Node({_TYPE: typed(element._mmrs_type), XML: element._mmrs_xml, _SCOPE: scope})


def _depth(node: Node) -> int:
    level: list[Iterable[object]] = [node.members.values()]
    depth = 0
    while level:
        depth += 1
        level = [inner for values in level for each in values if (inner := _inside(each)) is not None]
    return depth


def _inside(value: object) -> Iterable[object] | None:
    if isinstance(value, Node):
        return value.members.values()
    return value if isinstance(value, list) else None


def _expanded(name: str, languages: Mapping[str, str]) -> str:
    prefix, _, local = name.rpartition(":")
    return name if "#" in name or prefix not in languages else f"{languages[prefix]}#{local}"


def _retyped(node: Node, typed: Callable[[str], str]) -> Node:
    """Return a copy of an object in which every type is written another way."""
    members = {
        key: typed(value) if key == _TYPE and isinstance(value, str) else _within(value, typed)
        for key, value in node.members.items()
    }
    return Node(members, node.line)


def _within(value: object, typed: Callable[[str], str]) -> object:
    if isinstance(value, Node):
        return _retyped(value, typed)
    if isinstance(value, list):
        return [_within(each, typed) for each in value]
    return value
