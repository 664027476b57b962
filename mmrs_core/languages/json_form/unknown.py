"""Elements whose metamodel is not installed, as JSON keeps them."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from html import unescape
from xml.parsers import expat

from mmrs_core.languages.element import Unknown
from mmrs_core.languages.json_form.stream import END, LANGUAGES, OBJECT, TYPE, texts_in
from mmrs_core.languages.json_form.text import Text
from mmrs_core.languages.json_form.tree import Node, tree_of
from mmrs_core.languages.xmi.unknowns import needed, text_of

XML, SCOPE = "$xml", "$namespaces"
DEEPEST_KEPT = 100
"""Levels of objects and lists that are kept inside an element of an unknown class."""


class UnknownObject(Unknown):
    """An element that stood in JSON, which is kept; no XML can be made of it without its metamodel.

    Attributes:
        _mmrs_json: its text; the prefixes of the types in it are those of `_mmrs_scope`.
    """

    __slots__ = ("_mmrs_json",)

    _mmrs_json: str


@dataclass(slots=True)
class Kept:
    """The text of an object whose element is not read.

    Attributes:
        text: all of it.
        xml: what it says under `$xml`; None where it does not.
        scope: what it says under `$namespaces`.
    """

    text: str
    xml: str | None
    scope: Mapping[str, str]


def kept(found: Kept, claimed: str, languages: Mapping[str, str]) -> Unknown:
    """Return the element that an object stands for, of a metamodel that is not installed.

    Args:
        found: what the object says.
        claimed: its type, as ``nsURI#Name``.
        languages: the prefixes that types in it may use.

    Raises:
        ValueError: if what it keeps is not XML.
    """
    element: Unknown
    if found.xml is not None:
        element = Unknown.__new__(Unknown)
        element._mmrs_xml, element._mmrs_scope = found.xml, found.scope
        xml_of(found.xml, found.scope)
    else:
        element = UnknownObject.__new__(UnknownObject)
        element._mmrs_json, element._mmrs_xml, element._mmrs_scope = found.text, "", languages
    element._mmrs_type = claimed
    return element


def kept_languages(text: Text) -> frozenset[str]:
    """Return the nsURIs of the elements that a file keeps as XML; their languages may be installed by now."""
    if f'"{XML}"'.encode() not in text.data:
        return frozenset()
    languages: Mapping[str, str] = {}
    claims: set[str] = set()
    opened = [["", ""]]
    events = text.events()
    for event in events:
        sort, key, said, _, _ = event
        if key == LANGUAGES and len(opened) == 2:
            languages = texts_in(event, events) or {}
        elif sort == END:
            claimed, xml = opened.pop()
            claims |= {claimed.rpartition("#" if "#" in claimed else ":")[0]} if xml else set()
        elif sort >= OBJECT:
            opened.append(["", ""])
        elif key in (TYPE, XML):
            opened[-1][key == XML] = said
    return frozenset(languages.get(claim, claim) for claim in claims)


def xml_of(xml: str, scope: Mapping[str, str]) -> str:
    """Return the XML that an object keeps of an element, with all namespaces that it needs.

    Raises:
        ValueError: if it is not an element of XML.
    """
    if not xml.startswith("<"):
        raise ValueError(f"{XML}: not well-formed XML: no element found")
    element = Unknown.__new__(Unknown)
    element._mmrs_xml, element._mmrs_scope = xml, scope
    element._mmrs_type = XML
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
    raise ValueError(f"{XML}: DOCTYPE is not accepted")


def scope_of(node: Node) -> Mapping[str, str]:
    """Return the namespaces that an object keeps beside its XML, by prefix."""
    scope = node.members.get(SCOPE)
    return {k: str(v) for k, v in scope.members.items()} if isinstance(scope, Node) else {}


def stated(element: Unknown, typed: Callable[[str], str] = str) -> Node:
    """Return an object with all that is known of an element; `typed` shortens ``nsURI#Name``."""
    if isinstance(element, UnknownObject):
        top = tree_of(element._mmrs_json)
        return _retyped(top, lambda name: typed(_expanded(name, element._mmrs_scope)))
    scope = Node(dict(needed(element._mmrs_xml, element._mmrs_scope)))
    return Node({TYPE: typed(element._mmrs_type), XML: element._mmrs_xml, SCOPE: scope})


def _expanded(name: str, languages: Mapping[str, str]) -> str:
    prefix, _, local = name.rpartition(":")
    return name if "#" in name or prefix not in languages else f"{languages[prefix]}#{local}"


def _retyped(node: Node, typed: Callable[[str], str]) -> Node:
    """Return a copy of an object in which every type is written another way."""
    members = {
        key: typed(value) if key == TYPE and isinstance(value, str) else _within(value, typed)
        for key, value in node.members.items()
    }
    return Node(members, node.line)


def _within(value: object, typed: Callable[[str], str]) -> object:
    if isinstance(value, Node):
        return _retyped(value, typed)
    if isinstance(value, list):
        return [_within(each, typed) for each in value]
    return value


_ATTRIBUTE = re.compile(r"""\s([\w:.-]+)\s*=\s*("[^"]*"|'[^']*')""")
_TAG = re.compile(r"""<[^\s/>]+(?:\s+[\w:.-]+\s*=\s*(?:"[^"]*"|'[^']*'))*""")


def kept_name(element: Unknown) -> str:
    """Return the name that an element gives itself; empty if it gives none."""
    if isinstance(element, UnknownObject):
        name = stated(element).members.get("name")
        return name if isinstance(name, str) else ""
    return name_in_tag(element._mmrs_xml)


def name_in_tag(xml: str) -> str:
    """Return the name that the opening tag of an element gives; empty if it gives none.

    >>> name_in_tag('<tasks name="a &gt; b" x=">"><y name="c"/></tasks>')
    'a > b'
    """
    tag = _TAG.match(xml)
    attributes = _ATTRIBUTE.findall(tag[0]) if tag else []
    return next((unescape(value[1:-1]) for name, value in attributes if name == "name"), "")
