"""References into elements whose metamodel is not installed: kept, but not resolved."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from html import unescape

from mmrs_core.languages.element import Element, Hidden, Unknown, descendants
from mmrs_core.languages.json_form.unknown import UnknownObject
from mmrs_core.languages.references.documents import Draft
from mmrs_core.languages.references.spelling import Name, spelt
from mmrs_core.languages.sources import Source

_LEAVE_UNKNOWN = frozenset(("XMI001", "XMI002", "XMI003", "XMI008", "XMI014", "XMI015"))
"""The faults that each unknown element goes with, one or the other."""
_PATH = re.compile(r"""(?<=["'\s#])/[0-9]*(?:/@[^\s"'/#@]+)+""")
_BEFORE = re.compile(r"""[^\s"']#\Z""")
_IN_XML = re.compile(r"""=\s*(?:"([^"<]*)"|'([^'<]*)')""")
_IN_JSON = re.compile(r""":\s*"((?:[^"\\]|\\.)*)\"""")


def hidden_in(draft: Draft, fragment: str, claimed: str = "") -> Hidden | None:
    """Return what a fragment that leads to no element known here may mean inside one that was kept as text.

    Args:
        draft: the file that the fragment is about.
        fragment: a path such as ``//@tasks.0/@point``, an identifier or a name.
        claimed: the class that the reference says it is of, as ``nsURI#Name``; empty where it says nothing.

    Returns:
        None if the path leads past all such elements, or none of them says the identifier.
    """
    if isinstance(fragment, Name):
        outer, rest = _said(draft).get(fragment), spelt(fragment, many=True)
    elif fragment.startswith("/"):
        outer, rest = draft.entered(fragment)
    else:
        outer, rest = _said(draft).get(fragment), fragment
    if outer is None:
        return None
    hidden = Hidden.__new__(Hidden)
    hidden._mmrs_outer, hidden._mmrs_rest = outer, rest
    hidden._mmrs_type, hidden._mmrs_xml, hidden._mmrs_scope = claimed, "", outer._mmrs_scope
    hidden._mmrs_line, hidden._mmrs_source = outer._mmrs_line, outer._mmrs_source
    return hidden


def note_links(draft: Draft) -> None:
    """Let each unknown element of a file know the elements that paths in its text lead to.

    The text is written as it was read: then the paths must still lead there.
    """
    if not any(fault.code in _LEAVE_UNKNOWN for fault in draft.diagnostics):
        return  # going over a large model takes its time
    for element in _unknown(draft.roots):
        text = _json_of(element) or element._mmrs_xml
        found = {path: draft.find(path) for path in _paths(text)}
        links = tuple((path, target) for path, target in found.items() if target is not None)
        if links:
            element._mmrs_links = links


def strayed(element: Unknown, roots: Sequence[Element]) -> str:
    """Return a path in an unknown element's text that leads to another element than once; empty for none.

    Args:
        element: as it was read.
        roots: of the file that is being written.
    """
    if not element._mmrs_links:
        return ""
    now = Draft(Source("", None), list(roots))
    return next((path for path, target in element._mmrs_links if now.find(path) is not target), "")


def _paths(text: str) -> Iterator[str]:
    """Yield the paths in a text that are about its own file."""
    for match in _PATH.finditer(text):
        if _BEFORE.search(text, max(0, match.start() - 2), match.start()) is None:
            yield unescape(match.group())


def _said(draft: Draft) -> dict[str, Unknown]:
    """Return all texts that unknown elements say, each with the first that says it; worked out once."""
    if draft.said_within is None:
        draft.said_within = {}
        for element in _unknown(draft.roots):
            for text in _texts(element):
                draft.said_within.setdefault(text, element)
    return draft.said_within


def _unknown(roots: Iterable[Element]) -> Iterator[Unknown]:
    for root in roots:
        yield from (each for each in (root, *descendants(root)) if isinstance(each, Unknown))


def _json_of(element: Unknown) -> str:
    """Return the text of an element that was kept as JSON, else nothing."""
    return element._mmrs_json if isinstance(element, UnknownObject) else ""


def _texts(element: Unknown) -> Iterator[str]:
    yield from (match[1] for match in _IN_JSON.finditer(_json_of(element)))
    for match in _IN_XML.finditer(element._mmrs_xml):
        yield unescape(match[1] if match[1] is not None else match[2])
