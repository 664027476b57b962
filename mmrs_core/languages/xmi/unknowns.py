"""Elements of languages that are not installed, written back as they were read."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping

from mmrs_core.languages.element import Unknown, path_of
from mmrs_core.languages.xmi.escapes import in_attribute

_BEGIN = re.compile(r"<[^\s/>!?]+")
_PREFIX = re.compile(r"(?<![\w.-])([\w.-]+):")
_OPENING = re.compile(r"""<[^\s/>]+(?:\s+[^\s=>/]+\s*=\s*(?:"[^"]*"|'[^']*'))*""")
_DECLARED = re.compile(r"""xmlns(?::([\w.-]+))?\s*=""")


def text_of(element: Unknown, declare: Callable[[str, str], bool]) -> str:
    """Return the text of an element, with the namespaces it needs and that are not declared elsewhere.

    Args:
        element: as it was read.
        declare: asked whether a prefix (first) is, or can be, declared for an nsURI at the root of the file.

    Raises:
        ValueError: if it was not read from XML, so that its XML is unknown.
    """
    text = element._mmrs_xml
    begin = _BEGIN.match(text)
    if begin is None:
        message = f"{path_of(element)}: {element._mmrs_type} is not installed, and its form in XML not known"
        raise ValueError(f"{message}; install what brings it, or keep the model as JSON")
    own = "".join(
        f' xmlns{prefix and ":" + prefix}="{in_attribute(uri)}"'
        for prefix, uri in needed(text, element._mmrs_scope)
        if not (prefix and declare(prefix, uri))
    )
    return f"{begin.group()}{own}{text[begin.end() :]}"


def needed(text: str, scope: Mapping[str, str]) -> Iterator[tuple[str, str]]:
    """Yield the prefixes that a text uses, or may use, and that it does not declare at its beginning."""
    opening = _OPENING.match(text)
    declared = {match[1] or "" for match in _DECLARED.finditer(opening.group() if opening else "")}
    for prefix in prefixes_in(text):
        uri = scope.get(prefix)
        if uri and prefix not in declared and prefix != "xml":
            yield prefix, uri


def prefixes_in(text: str) -> tuple[str, ...]:
    """Return the prefixes that a text uses, or may use; the empty one stands for the default namespace."""
    return tuple(dict.fromkeys(("", *(match[1] for match in _PREFIX.finditer(text)))))
