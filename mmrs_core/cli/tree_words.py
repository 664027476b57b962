"""Elements of models in words: as a tree, a line for each."""

from __future__ import annotations

from collections.abc import Iterator

from mmrs_core.languages.datatypes import DataType
from mmrs_core.languages.element import (
    Element,
    Hidden,
    Unknown,
    containing_feature,
    contents,
    get,
    holds,
    label_of,
    metaclass_of,
    path_of,
)
from mmrs_core.languages.json_form.scalars import is_character
from mmrs_core.languages.json_form.unknown import kept_name
from mmrs_core.languages.metaclass import Feature, Metaclass

_LONGEST = 70


def tree(root: Element, depth: int = 0) -> Iterator[str]:
    """Yield the lines of a tree; `depth` levels of it, or all for 0."""
    yield line_of(root)
    yield from _below(root, "", 1, depth)


def _below(element: Element, lead: str, level: int, depth: int) -> Iterator[str]:
    if depth and level > depth:
        return
    inside = list(contents(element))
    for index, child in enumerate(inside):
        last = index == len(inside) - 1
        feature = containing_feature(child)
        role = f"{feature.name}: " if feature else ""
        yield f"{lead}{'└─ ' if last else '├─ '}{role}{line_of(child)}"
        yield from _below(child, lead + ("   " if last else "│  "), level + 1, depth)


def line_of(element: Element) -> str:
    """Return an element in one line: its class, and the attributes and references that are set."""
    if isinstance(element, Unknown):
        return _unknown(element)
    metaclass = metaclass_of(element)
    parts = [metaclass.name]
    for feature in metaclass.features:
        if feature.containment or feature.is_container or not holds(element, feature):
            continue
        found = get(element, feature.name)
        items = list(found) if feature.many and isinstance(found, list | tuple) else [found]
        shown = [f"→ {_label(e)}" if isinstance(e, Element) else words_for(feature, e) for e in items]
        parts.append(f"{feature.name}={','.join(shown)}")
    return " ".join(parts)


def title_of(element: Element) -> str:
    """Return class and name of an element, or else the first text that it says."""
    if isinstance(element, Unknown):
        return _unknown(element)
    metaclass = metaclass_of(element)
    texts = [get(element, each.name) for each in metaclass.features if isinstance(each.type, DataType)]
    said = (text for text in texts if isinstance(text, str) and text.strip("\0"))  # a character that is none
    label = label_of(element) or next(said, "")
    return f"{metaclass.name}{label and f' {value_words(label)}'}"


def words_for(feature: Feature, value: object) -> str:
    """Return a value of an attribute in words: numbers short, all else as files write it."""
    kind = feature.type
    if value is None or isinstance(value, float) or isinstance(kind, Metaclass) or not kind.accepts(value):
        return value_words(value)
    return value_words(value if is_character(kind) else kind.render(value))


def value_words(value: object) -> str:
    """Return a value in words: short, and quoted where its ends would not be seen."""
    if value is None:
        return "null"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float):
        return f"{value:.10g}"
    words = str(value)
    short = words if len(words) <= _LONGEST else words[: _LONGEST - 1] + "…"
    return repr(short) if not short or any(character.isspace() for character in short) else short


def _label(element: Element) -> str:
    """Return the name of an element that is referred to; its path if it has none."""
    own = kept_name(element) if isinstance(element, Unknown) else label_of(element)
    return own or path_of(element)


def _unknown(element: Unknown) -> str:
    """Return what is known of an element whose metamodel is not installed."""
    if isinstance(element, Hidden):
        return f"something inside {_unknown(element._mmrs_outer)}"
    ns_uri, _, name = element._mmrs_type.rpartition("#")
    label = kept_name(element)
    return f"{name}{f' name={value_words(label)}' if label else ''} (unknown, of {ns_uri or 'no language'})"
