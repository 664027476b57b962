"""``mmrs show``: a model as a tree."""

from __future__ import annotations

import re
from collections.abc import Iterator
from html import unescape
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from mmrs_core.cli.output import report, say, say_json
from mmrs_core.cli.settings import Json, settings_of

if TYPE_CHECKING:
    from mmrs_core.diagnostics import Diagnostic
    from mmrs_core.languages.element import Element, Unknown

NOT_INSTALLED = "XMI001"
_LONGEST = 70
_ATTRIBUTE = re.compile(r"""([\w:.-]+)\s*=\s*("[^"]*"|'[^']*')""")
_TAG = re.compile(r"""<[^\s/>]+(?:\s+[\w:.-]+\s*=\s*(?:"[^"]*"|'[^']*'))*""")


def show(
    call: typer.Context,
    model: Annotated[
        Path, typer.Argument(metavar="MODEL", help="Any model: mission, context, robot type, behaviour.")
    ],
    depth: Annotated[int, typer.Option("--depth", min=0, help="How deep to go; 0 goes all the way.")] = 0,
    json: Json = False,
) -> int:
    """Print a model as a tree of its elements.

    What belongs to a plug-in that is not installed is shown as unknown.
    """
    from mmrs_core.cli.journey import Workshop
    from mmrs_core.languages.reading import read_model

    workshop = Workshop(settings_of(call))
    found = read_model(model, workshop.contributions.languages)
    report(found.diagnostics)
    if json:
        say_json({"file": model, "roots": found.roots})
    else:
        for root in found.roots:
            for line in tree(root, depth):
                say(line)
    return 1 if any(_is_mistake(each) for each in found.diagnostics) else 0


def _is_mistake(fault: Diagnostic) -> bool:
    """Return whether a fault is one of the model, not of a plug-in that is missing here."""
    return fault.severity.value == "error" and fault.code != NOT_INSTALLED


def tree(root: Element, depth: int = 0) -> Iterator[str]:
    """Yield the lines of a tree; `depth` levels of it, or all for 0."""
    yield line_of(root)
    yield from _below(root, "", 1, depth)


def _below(element: Element, lead: str, level: int, depth: int) -> Iterator[str]:
    from mmrs_core.languages.element import containing_feature, contents

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
    from mmrs_core.languages.element import Element, Unknown, get, is_set, metaclass_of

    if isinstance(element, Unknown):
        return _unknown(element)
    metaclass = metaclass_of(element)
    parts = [metaclass.name]
    for feature in metaclass.features:
        if feature.containment or feature.is_container or not is_set(element, feature.name):
            continue
        found = get(element, feature.name)
        items = list(found) if feature.many and isinstance(found, list | tuple) else [found]
        shown = [f"→ {_label(item)}" if isinstance(item, Element) else _value(item) for item in items]
        parts.append(f"{feature.name}={','.join(shown)}")
    return " ".join(parts)


def _label(element: Element) -> str:
    """Return the name of an element that is referred to; its path if it has none."""
    from mmrs_core.languages.element import Unknown, label_of, path_of

    own = name_of_unknown(element._mmrs_xml) if isinstance(element, Unknown) else label_of(element)
    return own or path_of(element)


def _unknown(element: Unknown) -> str:
    """Return what is known of an element whose metamodel is not installed."""
    ns_uri, _, name = element._mmrs_type.rpartition("#")
    label = name_of_unknown(element._mmrs_xml)
    return f"{name}{f' name={_value(label)}' if label else ''} (unknown, of {ns_uri or 'no language'})"


def name_of_unknown(xml: str) -> str:
    """Return the name that the opening tag of an element gives; empty if it gives none.

    >>> name_of_unknown('<tasks name="a &gt; b" x=">"><y name="c"/></tasks>')
    'a > b'
    """
    tag = _TAG.match(xml)
    attributes = _ATTRIBUTE.findall(tag[0]) if tag else []
    return next((unescape(value[1:-1]) for name, value in attributes if name == "name"), "")


def _value(value: object) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float):
        return f"{value:.10g}"
    words = str(value)
    short = words if len(words) <= _LONGEST else words[: _LONGEST - 1] + "…"
    return repr(short) if not short or any(character.isspace() for character in short) else short
