"""JSON as a tree whose objects know their lines, with bounds that hostile files run into."""

from __future__ import annotations

import json
import re
from bisect import bisect_left
from collections import Counter
from typing import NoReturn, TypeGuard

from mmrs_core.errors import UnreadableError
from mmrs_core.languages.xmi.events import DEEPEST_NESTING

_STRING = r'"[^"\\]*+(?:\\.[^"\\]*+)*+"'
_TOKEN = re.compile(rf"{_STRING}|[{{}}\[\]]", re.DOTALL)
_MEMBER = re.compile(rf"({_STRING})\s*:|{_STRING}|[{{}}\[\]]", re.DOTALL)
_CONSTANT = re.compile(rf"{_STRING}|(NaN|-?Infinity)", re.DOTALL)
_MANY = 10_000
_SHORTEST_OBJECT = len('{"x":1},')
_DEEPEST = 2 * DEEPEST_NESTING
"""An element inside another stands in an object and, mostly, in a list."""


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


def is_text(value: object) -> TypeGuard[str]:
    """Return whether a value is a text, and not a number, whose figures are kept as text."""
    return isinstance(value, str) and not isinstance(value, Number)


class Node:
    """A JSON object.

    Attributes:
        members: text, `Number`, bool, None, `Node`, or a list of these, by key in file order.
        line: where it begins, counted from 1.
        offset: where it begins, in characters; -1 where it was not read from JSON.
    """

    __slots__ = ("line", "members", "offset")

    def __init__(self, members: dict[str, object], line: int = 0, offset: int = -1) -> None:
        self.members = members
        self.line = line
        self.offset = offset

    @property
    def kind(self) -> str:
        """The name of its class, without the language; empty where it does not say it."""
        claimed = self.members.get("$type")
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
        _refuse_crowds(data, file)
        self._text = _decoded(data, file)
        self._lines = [match.start() for match in re.finditer("\n", self._text)]
        self._keys: dict[int, dict[str, int]] = {}
        self._twice: list[tuple[Node, str]] = []
        nodes: list[Node] = []
        self.top = self._parsed(nodes)
        self._give_places(nodes)
        for node, key in self._twice:
            line = self.line_of(node, key)
            raise UnreadableError(f"{file}:{line}: {key!r}: given twice in one object")

    def line_of(self, node: Node, key: str) -> int:
        """Return the line on which an object says something."""
        if node.offset < 0:
            return node.line
        if node.offset not in self._keys:
            self._keys[node.offset] = _keys_of(self._text, node.offset)
        return self._line(self._keys[node.offset].get(key, node.offset))

    def _line(self, offset: int) -> int:
        return bisect_left(self._lines, offset) + 1

    def _parsed(self, nodes: list[Node]) -> object:
        def made(pairs: list[tuple[str, object]]) -> Node:
            node = Node(dict(pairs))
            if len(node.members) < len(pairs):
                often = Counter(key for key, _ in pairs)
                self._twice.append((node, often.most_common(1)[0][0]))
            nodes.append(node)
            return node

        try:
            return json.loads(
                self._text,
                object_pairs_hook=made,
                parse_int=Number,
                parse_float=Number,
                parse_constant=self._no_constant,
            )
        except json.JSONDecodeError as fault:
            reason = fault.msg[:1].lower() + fault.msg[1:]
            raise UnreadableError(f"{self.file}:{fault.lineno}: not well-formed JSON: {reason}") from None
        except RecursionError:
            raise UnreadableError(f"{self.file}: nested deeper than {_DEEPEST} levels") from None

    def _no_constant(self, word: str) -> NoReturn:
        offset = next((match.start() for match in _CONSTANT.finditer(self._text) if match[1]), 0)
        place = f"{self.file}:{self._line(offset)}"
        raise UnreadableError(f'{place}: not well-formed JSON: {word} is no number; write "{word}"')

    def _give_places(self, nodes: list[Node]) -> None:
        """Tell every object where it begins; they were made in the order in which they end."""
        made, opened, depth = iter(nodes), [], 0
        for match in _TOKEN.finditer(self._text):
            token = match.group()
            if token in ("{", "["):
                depth += 1
                opened.append(match.start())
                if depth > _DEEPEST:
                    line = self._line(match.start())
                    raise UnreadableError(f"{self.file}:{line}: nested deeper than {_DEEPEST} levels")
            elif token in ("}", "]"):
                depth -= 1
                begin = opened.pop()
                if token == "}":
                    node = next(made)
                    node.offset, node.line = begin, self._line(begin)


def _refuse_crowds(data: bytes, file: str) -> None:
    """Refuse what is nearly nothing but brackets: in memory it would take a hundred times its size."""
    count = data.count(b"{") + data.count(b"[")
    if count > _MANY and count * _SHORTEST_OBJECT > len(data):
        raise UnreadableError(f"{file}: {count} objects and lists with next to nothing in them")


def _decoded(data: bytes, file: str) -> str:
    try:
        return data.decode(json.detect_encoding(data))
    except UnicodeDecodeError as fault:
        line = data.count(b"\n", 0, fault.start) + 1
        raise UnreadableError(f"{file}:{line}: not readable as UTF-8 text") from None


def _keys_of(text: str, begin: int) -> dict[str, int]:
    """Return where the members of the object that begins there stand, by key."""
    found: dict[str, int] = {}
    depth = 0
    for match in _MEMBER.finditer(text, begin):
        token = match.group()
        if match[1] is not None:
            if depth == 1:
                found[json.loads(match[1])] = match.start()
        elif token in ("{", "["):
            depth += 1
        elif token in ("}", "]"):
            depth -= 1
            if depth == 0:
                break
    return found


def is_json(file: str) -> bool:
    """Return whether a file is one of JSON, by the ending of its name."""
    return file.lower().endswith(".json")
