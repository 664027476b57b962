"""JSON as a tree whose objects know their lines: read from a text, read as a stream, and laid out again."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterable, Iterator, Sequence

from mmrs_core.languages.json_form.stream import (
    END,
    LIST,
    NUMBER,
    OBJECT,
    TEXT,
    TYPE,
    WORD,
    Event,
    Place,
    is_own,
    quoted,
)
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
            UnreadableError: if it is not JSON, says a key twice in one object, or nests too deeply.
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


WIDEST = 110


def laid_out(members: Sequence[str], depth: int) -> str:
    """Return an object on one line, or where that is too long, with a line for each member."""
    line = f"{{{', '.join(members)}}}"
    if len(line) + 2 * depth <= WIDEST or not members:
        return line
    margin = "  " * (depth + 1)
    return "{\n" + ",\n".join(margin + member for member in members) + "\n" + "  " * depth + "}"


def formatted(value: object, depth: int) -> str:
    """Return what is kept of an element whose metamodel is not installed, in the same form as all else."""
    if isinstance(value, Node):
        members = [f"{quoted(key)}: {formatted(each, depth + 1)}" for key, each in value.members.items()]
        plain = not any(_holds_objects(each) for each in value.members.values())
        margin = "  " * (depth + 1)
        if plain:
            return laid_out(members, depth)
        return "{\n" + ",\n".join(margin + member for member in members) + "\n" + "  " * depth + "}"
    if isinstance(value, list):
        parts = [formatted(each, depth + 1) for each in value]
        if not _holds_objects(value):
            return f"[{', '.join(parts)}]"
        margin = "  " * (depth + 1)
        return "[\n" + ",\n".join(margin + part for part in parts) + "\n" + "  " * depth + "]"
    if isinstance(value, Number):
        return str(value)
    if isinstance(value, str):
        return quoted(value)
    return {None: "null", True: "true", False: "false"}[value]  # type: ignore[index]  # JSON has no other


def _holds_objects(value: object) -> bool:
    return isinstance(value, Node) or (isinstance(value, list) and any(map(_holds_objects, value)))


_Pending = tuple[Iterator[tuple[str, object]], Node | None, Place]
"""What is still to come of an object or a list, the object, and where a list stands."""


class TreeStream:
    """A tree.

    Attributes:
        file: what messages call the file.
    """

    def __init__(self, file: str, top: object, line_of: Callable[[Node, str], int]) -> None:
        """Take what stands at the top, and what tells the line on which an object says something."""
        self.file = file
        self._top = top
        self._line_of = line_of

    def events(self) -> Iterator[Event]:
        """Yield what is said, the own keys of an object first; as `Stream` has it."""
        pending: list[_Pending] = [(iter([("", self._top)]), None, self._top)]
        while pending:
            members, owner, place = pending[-1]
            key, value = next(members, ("", pending))
            if value is pending:
                pending.pop()
                if pending:
                    yield END, "", "", place, place
                continue
            at = (owner, key) if owner is not None else place
            yield _event(key, value, at)
            if isinstance(value, Node):
                pending.append((iter(sorted(value.members.items(), key=_is_other)), value, at))
            elif isinstance(value, list):
                pending.append((iter([("", each) for each in value]), None, at))

    def late(self, key: str) -> Iterator[Event] | None:
        """Return None: nothing stands late."""
        return None

    def line(self, place: Place) -> int:
        """Return the line of an object, or on which it says something; as `Stream` has it."""
        if isinstance(place, tuple):
            return self._line_of(*place)
        return place.line if isinstance(place, Node) else 1

    def source(self, begin: Place, end: Place) -> str:
        """Return an object as JSON writes it; as `Stream` has it."""
        return formatted(begin, 0)


def _is_other(member: tuple[str, object]) -> bool:
    return not is_own(member[0])


def _event(key: str, value: object, place: Place) -> Event:
    if isinstance(value, Node):
        return OBJECT, key, "", place, value
    if isinstance(value, list):
        return LIST, key, "", place, place
    if isinstance(value, str) and not isinstance(value, Number):
        return TEXT, key, value, place, None
    if value is None or isinstance(value, bool):
        return WORD, key, "null" if value is None else str(value).lower(), place, None
    return NUMBER, key, str(value), place, None
