"""JSON as a tree whose objects know their lines, for models that change before they become elements."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterable

from mmrs_core.languages.json_form.stream import END, LIST, NUMBER, OBJECT, TYPE, WORD, Event, Place
from mmrs_core.languages.json_form.text import Text

_STRING = rb'"[^"\\]*(?:\\.[^"\\]*)*"?'
_MEMBER = re.compile(rb"(" + _STRING + rb")|[{}\[\]]", re.DOTALL)
_COLON = re.compile(rb"\s*:")
_WORDS = {"true": True, "false": False, "null": None}
_SHORTEST_OBJECT = 40
"""A tree takes half a kilobyte for the smallest object."""


class Number(str):
    """A number as it stands in a file, so that its type decides what it is worth."""

    __slots__ = ()


class Words(str):
    """The text of an XML attribute, in which blanks separate the values of a list."""

    __slots__ = ()


class Leaf(str):
    """What stands in an XML element that has neither attributes nor elements inside.

    Attributes:
        line: where the element begins.
    """

    line: int = 0


class Node:
    """A JSON object.

    Attributes:
        members: text, `Number`, bool, None, `Node`, or a list of these, by key in file order.
        line: where it begins, counted from 1.
        offset: where it begins, in bytes; -1 where it was not read from JSON.
    """

    __slots__ = ("line", "members", "offset")

    def __init__(self, members: dict[str, object], line: int = 0, offset: int = -1) -> None:
        self.members = members
        self.line = line
        self.offset = offset

    @property
    def kind(self) -> str:
        """The name of its class, without the language; empty where it does not say it."""
        claimed = self.members.get(TYPE)
        return re.split("[#:]", claimed)[-1].removeprefix("//") if isinstance(claimed, str) else ""


class Tree:
    """A whole file.

    Attributes:
        file: what messages call it.
        top: what stands at its top.
    """

    def __init__(self, data: bytes, file: str) -> None:
        """Read the text of a file.

        Raises:
            UnreadableError: if it is no JSON, says a key twice in one object, or nests too deeply.
        """
        self.file = file
        self._text = Text(data, file, _SHORTEST_OBJECT)
        self._keys: dict[int, dict[str, int]] = {}
        self.top = built(self._text.events(), self._text.line)

    def line_of(self, node: Node, key: str) -> int:
        """Return the line on which an object says something."""
        if node.offset < 0:
            return node.line
        if node.offset not in self._keys:
            self._keys[node.offset] = _keys_of(self._text.data, node.offset)
        return self._text.line(self._keys[node.offset].get(key, node.offset))


def tree_of(text: str) -> Node:
    """Return the object that a text is, which was read before."""
    source = Text(text.encode(), "", shortest=0)
    top = built(source.events(), source.line)
    assert isinstance(top, Node)  # only objects are kept as text
    return top


def built(events: Iterable[Event], line: Callable[[Place], int]) -> object:
    """Return what stands at the top of a stream, with all inside it."""
    top: object = None
    opened: list[dict[str, object] | list[object]] = []
    for sort, key, text, _, begin in events:
        if sort == END:
            opened.pop()
            continue
        value, inside = _value(sort, text, begin, line)
        holder = opened[-1] if opened else None
        if isinstance(holder, dict):
            holder[key] = value
        elif holder is not None:
            holder.append(value)
        else:
            top = value
        if inside is not None:
            opened.append(inside)
    return top


def _value(
    sort: int, text: str, begin: Place, line: Callable[[Place], int]
) -> tuple[object, dict[str, object] | list[object] | None]:
    """Return a value, and what takes that which comes inside it."""
    if sort == OBJECT:
        assert isinstance(begin, int)  # trees are made of texts
        node = Node({}, line(begin), begin)
        return node, node.members
    if sort == LIST:
        values: list[object] = []
        return values, values
    if sort == WORD:
        return _WORDS[text], None
    return Number(text) if sort == NUMBER else text, None


def _keys_of(text: bytes, begin: int) -> dict[str, int]:
    """Return where the members of the object that begins there stand, by key."""
    found: dict[str, int] = {}
    depth = 0
    for match in _MEMBER.finditer(text, begin):
        token = match.group()
        if match[1] is not None:
            if depth == 1 and _COLON.match(text, match.end()):
                found[str(json.loads(match[1]))] = match.start()
        elif token in (b"{", b"["):
            depth += 1
        elif token in (b"}", b"]"):
            depth -= 1
            if depth == 0:
                break
    return found
