"""Where everything stands in the text of a JSON model, told as of XMI, so that one fix serves both."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

from mmrs_core.errors import UnreadableError
from mmrs_core.languages.json_form.stream import ID, LANGUAGES, PLACES, REF, ROOTS, TYPE, quoted
from mmrs_core.languages.xmi.events import XSI
from mmrs_core.languages.xmi.markup import Attribute, Markup, Tag, below_root

_TOKEN = re.compile(rb'"[^"\\]*(?:\\.[^"\\]*)*"?|[{}\[\]:,]|[^\s{}\[\]:,"]+', re.DOTALL)
_STEP = re.compile(r"([^/\[\]]+)(?:\[([0-9]+)\])?")
_BARE = re.compile(r"true|false|-?(0|[1-9][0-9]*)(\.[0-9]+)?([eE][+-]?[0-9]+)?")
_MARK = b"\xef\xbb\xbf"
_NAMES = {TYPE: "xsi:type", ID: "xmi:id", REF: "href"}
_KEYS = {name: key for key, name in _NAMES.items()}
_WRAPPER = "xmi:XMI"


@dataclass(frozen=True, slots=True)
class Member(Attribute):
    """A plain value in an object; ``value_begin`` to ``value_end`` has its quotes.

    Attributes:
        line: of its key.
        bare: whether it is a number or a truth value, without quotes.
    """

    line: int = 0
    bare: bool = False


@dataclass(slots=True, eq=False)
class JsonTag(Tag):
    """An object, or a value in a list: as a tag is that is named like the feature.

    Attributes:
        key: bytes of the feature's name, between its quotes; those of a root are none.
        lines: of its key, of its begin, and of its end.
        slot: bytes of all that goes with it; of an object that is not a list's, its key too.
        before, after: where its list or object has something in front of it ending, and something behind it
            beginning; -1 where there is nothing.
        languages: for the outermost one, what declares the prefixes.
    """

    key: tuple[int, int] = (-1, -1)
    lines: tuple[int, int, int] = (0, 0, 0)
    slot: tuple[int, int] = (-1, -1)
    before: int = -1
    after: int = -1
    languages: JsonTag | None = None

    def prefixes(self) -> dict[str, str]:
        """Return the prefixes of languages, and that of the attributes that stand for ``$type``."""
        return {**Tag.prefixes(self), "xsi": XSI}


class JsonMarkup(Markup):
    """The objects of a text, as tags; a list of several roots is an ``xmi:XMI`` around them."""

    def __init__(self, data: bytes, file: str) -> None:
        """Find the objects.

        Raises:
            UnreadableError: if the text is not JSON with an object at its top, or not in UTF-8.
        """
        try:
            json.loads(data.decode("utf-8-sig"))
        except (ValueError, RecursionError):
            raise UnreadableError(f"{file}: not well-formed JSON in UTF-8") from None
        top = _tree_of(data)
        if top.kind != "{":
            raise UnreadableError(f"{file}: no model: its top is not an object")
        self.data = data
        self.root: Tag = _tags_of(data, top)

    def at(self, path: str, line: int) -> Tag | None:
        """Return the object with that path, if it has that line; as for XMI."""
        for number, root in enumerate(self.models()):
            tag: Tag | None = root
            for match in _STEP.finditer(below_root(path, number)):
                same = tag.named(match[1]) if tag is not None else []
                tag = same[int(match[2] or 0)] if int(match[2] or 0) < len(same) else None
            if isinstance(tag, JsonTag) and tag.lines[0] <= line <= tag.lines[2]:
                return tag
        return None


def inserted(tag: JsonTag, name: str, value: str, data: bytes) -> tuple[int, str]:
    """Return where and as what an object gets another plain value, in front of those that it has.

    Args:
        name: as of an attribute in XMI: ``xsi:type``, ``xmlns:`` with a prefix, or a feature.
    """
    place, key, text = tag, _KEYS.get(name, name), written(value, bare=name not in _KEYS)
    if name.startswith("xmlns:") and tag.languages is not None:
        place, key, text = tag.languages, name[6:], quoted(value)
    elif name.startswith("xmlns:"):
        key, text = LANGUAGES, f"{{{quoted(name[6:])}: {quoted(value)}}}"
    begin = place.inside
    gap = data[begin : place.closing]
    gap = gap[: len(gap) - len(gap.lstrip())]
    if begin + len(gap) == place.closing:
        return begin, f"{quoted(key)}: {text}"
    if b"\n" in gap:
        return begin, f"{gap.decode()}{quoted(key)}: {text},"
    return begin + len(gap), f"{quoted(key)}: {text}, "


def written(value: str, *, bare: bool) -> str:
    """Return a text as a JSON value: without quotes if ``bare`` asks for it and they can be done without."""
    return value if bare and _BARE.fullmatch(value) else quoted(value)


def taken_away(tag: JsonTag) -> tuple[int, int]:
    """Return the bytes whose absence leaves a list or object without one of its values."""
    begin, end = tag.slot
    if tag.before >= 0:
        return tag.before, end
    return (begin, tag.after) if tag.after >= 0 else (begin, end)


@dataclass(slots=True, eq=False)
class _Value:
    """A value as it stands: ``kind`` is its first byte as text, of a bare value ``b``."""

    kind: str
    begin: int
    line: int
    end: int = -1
    last: int = 0
    key: tuple[int, int, int] = (-1, -1, 0)
    inside: list[_Value] = field(default_factory=list)


def _tree_of(data: bytes) -> _Value:
    """Return the value at the top of a text that is known to be well-formed."""
    top: _Value | None = None
    opened: list[_Value] = []
    key = (-1, -1, 0)
    line, counted = 1, 0
    for match in _TOKEN.finditer(data, len(_MARK) if data.startswith(_MARK) else 0):
        line, counted = line + data.count(b"\n", counted, match.start()), match.start()
        first = chr(data[match.start()])
        if first in ":,":
            continue
        if first in "}]":
            opened[-1].end, opened.pop().last = match.end(), line
            continue
        if opened and opened[-1].kind == "{" and key[0] < 0:
            key = match.start() + 1, match.end() - 1, line
            continue
        value = _Value(first if first in '{["' else "b", match.start(), line, match.end(), line, key)
        key = (-1, -1, 0)
        if opened:
            opened[-1].inside.append(value)
        top = top or value
        if first in "{[":
            opened.append(value)
    assert top is not None  # there is no well-formed text without a value
    return top


def _tags_of(data: bytes, top: _Value) -> JsonTag:
    root = _tag("", top, None, [top], 0)
    jobs = [(top, root)]
    while jobs:
        value, tag = jobs.pop()
        tag.attributes = tuple(_attributes(data, value, tag))
        for index, each in enumerate(value.inside):
            key = _key(data, each)
            if key == ROOTS and value is top:
                tag.name = _WRAPPER
            if key not in (LANGUAGES, PLACES):
                jobs += _children(key, each, (value.inside, index), tag)
    return root


def _attributes(data: bytes, value: _Value, tag: JsonTag) -> Iterator[Attribute]:
    for index, each in enumerate(value.inside):
        key = _key(data, each)
        if key == LANGUAGES and each.kind == "{" and tag.parent is None:
            tag.languages = _tag(LANGUAGES, each, tag, value.inside, index)
            yield from (_member(f"xmlns:{_key(data, one)}", data, one) for one in each.inside)
        elif each.kind in '"b' and data[each.begin : each.end] != b"null":
            name = _NAMES.get(key, key[1:] if key.startswith("$$") else key)
            yield _member(name, data, each)


def _children(
    key: str, value: _Value, place: tuple[Sequence[_Value], int], parent: JsonTag
) -> Iterator[tuple[_Value, JsonTag]]:
    """Yield the objects of a member, and make them and the values of its list tags of its owner.

    Args:
        place: the values of the owner, and which of them this is.
    """
    around, start = place if value.kind == "{" else (value.inside, 0)
    name = "" if key == ROOTS else key[1:] if key.startswith("$$") else key
    for index, each in enumerate([value] if value.kind == "{" else value.inside, start):
        tag = _tag(name, each, parent, around, index)
        tag.key, tag.lines = value.key[:2], (value.key[2] or each.line, each.line, each.last)
        parent.children.append(tag)
        if each.kind == "{":
            yield each, tag


def _tag(name: str, value: _Value, parent: JsonTag | None, around: Sequence[_Value], index: int) -> JsonTag:
    quotes = 1 if value.kind in '{["' else 0
    return JsonTag(
        name,
        value.line,
        value.begin,
        value.begin + quotes,
        parent,
        (),
        value.end - quotes,
        value.end,
        lines=(value.line, value.line, value.last),
        slot=_slot(value, around),
        before=around[index - 1].end if index else -1,
        after=_slot(around[index + 1], around)[0] if index + 1 < len(around) else -1,
    )


def _slot(value: _Value, around: Sequence[_Value]) -> tuple[int, int]:
    return (value.key[0] - 1 if value.key[0] > 0 else value.begin), value.end


def _member(name: str, data: bytes, value: _Value) -> Member:
    raw = data[value.begin : value.end]
    bare = value.kind == "b"
    text = raw.decode() if bare else str(json.loads(raw)) if value.kind == '"' else ""
    begin, end, line = value.key
    return Member(name, text, begin, end, value.begin, value.end, line, bare)


def _key(data: bytes, value: _Value) -> str:
    return str(json.loads(data[value.key[0] - 1 : value.key[1] + 1]))
