"""The texts of models with elements added, in which everything else stays as people wrote it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING

from mmrs_core.analysis.fixes.repair import line_ending_of, with_edits
from mmrs_core.contributions.fixes import Edit
from mmrs_core.languages.element import Element
from mmrs_core.languages.json_form import is_json
from mmrs_core.languages.writing import to_json, to_xmi
from mmrs_core.languages.xmi.escapes import in_attribute
from mmrs_core.languages.xmi.markup import Markup, Tag
from mmrs_core.languages.xmi.writer import XmiWriter

if TYPE_CHECKING:
    from mmrs_core.languages.registry import Registry


def text_of(root: Element, file: Path, registry: Registry, comments: Mapping[Element, str]) -> bytes:
    """Return the text of a model in a new file; JSON has no comments."""
    if is_json(file.name):
        return to_json((root,), registry, file=file)
    return to_xmi((root,), registry, file=file, comments=comments)


def with_added(
    data: bytes,
    root: Element,
    added: Mapping[str, Iterable[Element]],
    file: Path,
    registry: Registry,
    comments: Mapping[Element, str],
    restated: Mapping[str, str] = MappingProxyType({}),
) -> bytes:
    """Return the text of a model with elements that were added to its root, behind others of their features.

    Args:
        data: the text before, whose line endings stay.
        root: with the elements at the end of its features.
        added: the elements, by feature of the root; robots are those of a mission's team.
        file: that the text is of; all of one in JSON is written again.
        registry: the metamodels.
        comments: on elements.
        restated: attributes of the root that have another value than in the text before.

    Raises:
        UnreadableError: if the text is not in UTF-8.
    """
    if is_json(file.name):
        return to_json((root,), registry, file=file).replace(b"\n", line_ending_of(data))
    markup = Markup(data, str(file))
    tag = markup.models()[0]
    prefixes = tag.prefixes()
    edits, texts = [_restated(tag, name, value) for name, value in restated.items()], []
    for name, elements in added.items():
        outer = tag.named("team")[0] if name == "robots" else tag
        depth = 1 if outer is tag else 2
        text, needed = XmiWriter((root,), registry, file, comments).parts(elements, prefixes, depth)
        prefixes |= needed
        edits += [_declared(tag, prefix, ns_uri) for prefix, ns_uri in needed.items()]
        before = outer.named(name)
        if before:
            edits.append(_after(before[-1], text, data))
        elif outer is not tag:
            edits.append(_inside(outer, text, data))
        else:
            texts.append(text)
    if texts:
        edits.append(_inside(tag, "".join(texts), data))
    changed = with_edits(data, edits)
    assert changed is not None  # they are at different places
    return changed


def _restated(tag: Tag, name: str, value: str) -> Edit:
    before = tag.attribute(name)
    if before is not None:
        return Edit(before.value_begin, before.value_end, in_attribute(value))
    place = tag.attributes[-1].value_end + 1
    return Edit(place, place, f' {name}="{in_attribute(value)}"')


def _declared(tag: Tag, prefix: str, ns_uri: str) -> Edit:
    place = tag.attributes[-1].value_end + 1
    return Edit(place, place, f' xmlns:{prefix}="{in_attribute(ns_uri)}"')


def _after(tag: Tag, text: str, data: bytes) -> Edit:
    """Return what adds lines behind a tag, and behind a comment on its last line."""
    line = data.find(b"\n", tag.end)
    rest = data[tag.end : line].strip() if line >= 0 else b"x"
    if not rest or (rest.startswith(b"<!--") and rest.endswith(b"-->")):
        return Edit(line + 1, line + 1, text)
    return Edit(tag.end, tag.end, f"\n{text.rstrip()}")


def _inside(tag: Tag, text: str, data: bytes) -> Edit:
    """Return what adds lines at the end of a tag, which may have no inside yet."""
    if tag.closing == tag.end:
        before = data[data.rfind(b"\n", 0, tag.begin) + 1 : tag.begin].decode()
        indent = "" if before.strip() else before
        return Edit(tag.inside - 2, tag.inside, f">\n{text}{indent}</{tag.name}>")
    start = data.rfind(b"\n", 0, tag.closing) + 1
    if data[start : tag.closing].strip():
        return Edit(tag.closing, tag.closing, f"\n{text}")
    return Edit(start, start, text)
