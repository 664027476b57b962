"""Where everything stands in the text of an XMI file, so that a part can be changed and the rest be kept."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from xml.parsers import expat

from mmrs_core.errors import UnreadableError

_STEP = re.compile(r"([^/\[\]]+)(?:\[([0-9]+)\])?")
_ATTRIBUTE = re.compile(rb"""\s+([^\s<>/="']+)\s*=\s*("[^"<]*"|'[^'<]*')""")
_WRAPPER = "xmi:XMI"


@dataclass(frozen=True, slots=True)
class Attribute:
    """An attribute of a tag.

    Attributes:
        name: as written, with its prefix.
        value: without its quotes, escapes resolved.
        begin, end: bytes of the name.
        value_begin, value_end: bytes of the value between its quotes.
    """

    name: str
    value: str
    begin: int
    end: int
    value_begin: int
    value_end: int


@dataclass(slots=True, eq=False)
class Tag:
    """An XML element.

    Attributes:
        name: as written, with its prefix; of an object in JSON, the feature that it stands in.
        line: on which it begins, from 1.
        parent: the tag that it stands in; None for the outermost one.
        attributes: those written, in order; ``attribute(name)`` returns one of them, or None.
        begin, inside: bytes of its opening tag.
        closing, end: bytes of its closing tag; the same if it has none.
        children: the tags in it, in order: what the element contains.
    """

    name: str
    line: int
    begin: int
    inside: int
    parent: Tag | None
    attributes: tuple[Attribute, ...]
    closing: int = -1
    end: int = -1
    children: list[Tag] = field(default_factory=list)

    def attribute(self, name: str) -> Attribute | None:
        """Return the attribute of that name; None if there is none."""
        return next((each for each in self.attributes if each.name == name), None)

    def named(self, name: str) -> list[Tag]:
        """Return the children of that name."""
        return [child for child in self.children if child.name == name]

    def content_names(self) -> set[str]:
        """Return the names of its attributes and children."""
        return {attribute.name for attribute in self.attributes} | {child.name for child in self.children}

    def prefixes(self) -> dict[str, str]:
        """Return the namespaces in scope, by prefix; the default one has an empty prefix."""
        outer = self.parent.prefixes() if self.parent is not None else {}
        for each in self.attributes:
            if each.name == "xmlns" or each.name.startswith("xmlns:"):
                outer[each.name[6:]] = each.value
        return outer

    def everything(self) -> Iterator[Tag]:
        """Yield it and all tags in it, in the order of the text."""
        pending = [self]
        while pending:
            tag = pending.pop()
            yield tag
            pending.extend(reversed(tag.children))


class Markup:
    """The tags of a text.

    Attributes:
        data: the text, in UTF-8.
        root: its outermost tag.
    """

    def __init__(self, data: bytes, file: str) -> None:
        """Find the tags.

        Raises:
            UnreadableError: if the text is not well-formed, or not in UTF-8.
        """
        self.data = data
        self._open: list[Tag] = []
        self._root: Tag | None = None
        self._parser = expat.ParserCreate()
        self._parser.StartElementHandler = self._start
        self._parser.EndElementHandler = self._end
        self._parser.XmlDeclHandler = self._declaration
        self._file = file
        try:
            self._parser.Parse(data, True)
        except (expat.ExpatError, LookupError, ValueError) as fault:
            raise UnreadableError(f"{file}: not well-formed XML: {fault}") from None
        assert self._root is not None  # the parser demands a root
        self.root: Tag = self._root

    def models(self) -> list[Tag]:
        """Return the tags of the elements at the top of the model."""
        return self.root.children if self.root.name == _WRAPPER else [self.root]

    def at(self, path: str, line: int) -> Tag | None:
        """Return the tag of the element with that path, on that line; None where they do not agree.

        Args:
            path: such as ``/tasks[2]/shell[0]``, or ``/1/shell[0]`` in the second of several models.
            line: where the tag begins, or a tag directly in it, as a fault of its content says.
        """
        for number, root in enumerate(self.models()):
            tag = _follow(root, below_root(path, number))
            if tag is not None and line in (tag.line, *(child.line for child in tag.children)):
                return tag
        return None

    def _declaration(self, version: str, encoding: str | None, standalone: int) -> None:
        if (encoding or "UTF-8").upper() not in ("UTF-8", "ASCII", "US-ASCII"):
            raise UnreadableError(f"{self._file}: its encoding is {encoding}, not UTF-8")

    def _start(self, name: str, attributes: dict[str, str]) -> None:
        begin = self._parser.CurrentByteIndex
        found = tuple(_attributes(self.data, begin, name, attributes))
        inside = self.data.index(b">", found[-1].value_end if found else begin) + 1
        parent = self._open[-1] if self._open else None
        tag = Tag(name, self._parser.CurrentLineNumber, begin, inside, parent, found)
        if parent is None:
            self._root = tag
        else:
            parent.children.append(tag)
        self._open.append(tag)

    def _end(self, name: str) -> None:
        tag = self._open.pop()
        if self.data[tag.inside - 2 : tag.inside] == b"/>":
            tag.closing = tag.end = tag.inside
        else:
            tag.closing = self._parser.CurrentByteIndex
            tag.end = self.data.index(b">", tag.closing) + 1


def _attributes(data: bytes, begin: int, tag: str, values: Mapping[str, str]) -> Iterator[Attribute]:
    place = begin + 1 + len(tag.encode())
    while (match := _ATTRIBUTE.match(data, place)) is not None:
        name = match[1].decode()
        yield Attribute(
            name, values[name], match.start(1), match.end(1), match.start(2) + 1, match.end(2) - 1
        )
        place = match.end()


def below_root(path: str, number: int) -> str:
    """Return a path without the number of the root that it begins at, if it begins with that.

    >>> below_root("/1/shell[0]", 1), below_root("/shell[0]", 1), below_root("/10", 1)
    ('/shell[0]', '/shell[0]', '/10')
    """
    head, _, rest = path.removeprefix("/").partition("/")
    return f"/{rest}" if head == str(number) else path


def _follow(root: Tag, path: str) -> Tag | None:
    tag = root
    for match in _STEP.finditer(path):
        same = tag.named(match[1])
        index = int(match[2] or 0)
        if index >= len(same):
            return None
        tag = same[index]
    return tag
