"""What elements whose metamodel is not installed are called, as far as their text tells it."""

from __future__ import annotations

import re

from mmrs_core.languages.element import Unknown
from mmrs_core.languages.json_form.unknown import UnknownObject, stated

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
    from html import unescape

    tag = _TAG.match(xml)
    attributes = _ATTRIBUTE.findall(tag[0]) if tag else []
    return next((unescape(value[1:-1]) for name, value in attributes if name == "name"), "")
