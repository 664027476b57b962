"""The text of a JSON file as a stream, read member by member, with bounds that hostile files run into."""

from __future__ import annotations

import json
import re
from array import array
from collections.abc import Iterator
from typing import NoReturn

from mmrs_core.errors import UnreadableError
from mmrs_core.languages.json_form.stream import (
    END,
    LANGUAGES,
    LIST,
    NUMBER,
    OBJECT,
    ROOTS,
    TEXT,
    TYPE,
    WORD,
    Event,
    Place,
    is_own,
)
from mmrs_core.languages.xmi.events import DEEPEST_NESTING

_SPACE = rb"[ \t\n\r]*+"
_INSIDE = rb'[^"\\\x00-\x1f]*+(?:\\[^\x00-\x1f][^"\\\x00-\x1f]*+)*+'
_FIGURES = rb"-?(?:0|[1-9][0-9]*+)(?:\.[0-9]++)?(?:[eE][-+]?[0-9]++)?"
_VALUE = (
    rb'(?:(?:"(' + _INSIDE + rb')"|(' + _FIGURES + rb")|(true|false|null))"
    rb"(?:" + _SPACE + rb"([,}\]]))?|([{\[]))"
)
_ITEM = re.compile(_SPACE + _VALUE)
_KEY = re.compile(_SPACE + rb'"(' + _INSIDE + rb')"')
_MEMBER = re.compile(_KEY.pattern + _SPACE + b":" + _SPACE + _VALUE)
_BLANK = re.compile(_SPACE)
_COLON = re.compile(_SPACE + b":" + _SPACE)
_CLOSING = {True: re.compile(_SPACE + rb"(\})"), False: re.compile(_SPACE + rb"(\])")}
_FOLLOWING = re.compile(_SPACE + rb"([,}\]])")
_NO_NUMBER = re.compile(rb"NaN|-?Infinity")
_SOUND = re.compile(rb'"' + _INSIDE)

_LATE_TYPE = re.compile(rb',\s*+"\$type"')
_TOP = re.compile(
    rb'(?:\xef\xbb\xbf)?\s*+\{\s*+(?:"\$(?:languages|schemaLocation|schema)"\s*+:\s*+'
    rb'(?:"[^"\\]*+"|\{[^{}]*+\})\s*+,\s*+)*+"\$(?:type|roots)"'
)
_DISGUISED = re.compile(rb'"\$\w*+\\')

DEEPEST = 2 * DEEPEST_NESTING
"""An element inside another stands in an object and, mostly, in a list."""
MOST_MEMBERS = 10_000
"""The most members of one object: far more than any class has features."""
_MANY = 10_000
_SHORTEST_OBJECT = 10
_MOST_SHORT, _SHORT = 4096, 40
"""Texts that are kept to be used again, and how long they may be."""


class Text:
    """A whole file.

    Attributes:
        file: what messages call it.
        data: its bytes, in UTF-8.
    """

    def __init__(self, data: bytes, file: str, shortest: int = _SHORTEST_OBJECT) -> None:
        """Take the bytes of a file.

        Args:
            data: in UTF-8, UTF-16 or UTF-32.
            file: what messages call it.
            shortest: bytes that an object or list of many must have on average.

        Raises:
            UnreadableError: if they are not a text, or nearly nothing but brackets.
        """
        self.file = file
        _refuse_crowds(data, file, shortest)
        self.data = _as_utf8(data, file)
        self._start = 3 if self.data.startswith(b"\xef\xbb\xbf") else 0
        self._short: dict[bytes, str] = {}
        self._offset, self._line = 0, 1
        self._begun = -1
        self._late_types: array[int] | None = None
        self._late_heads: dict[str, int] = {}
        if not _is_orderly(self.data):
            self._look_ahead()

    def events(self) -> Iterator[Event]:
        """Yield what is said; as `Stream` has it."""
        self._begun = -1
        match = _ITEM.match(self.data, self._start)
        if match is None:
            self._refuse_value(self._start)
        return self._alone(match) if match[5] is None else self._inside(self._start, inner=False)

    def _alone(self, match: re.Match[bytes]) -> Iterator[Event]:
        """Yield the only value of the file."""
        yield TEXT if match[1] is not None else WORD, "", "", self._start, 0
        self._expect_nothing(match.end() if match[4] is None else match.start(4))

    def late(self, key: str) -> Iterator[Event] | None:
        """Return what the object that began last says late; as `Stream` has it."""
        if self._late_types is None:
            return None
        place = self._late_types[self._begun] if key == TYPE else 0
        place = place or (self._late_heads.get(key, 0) if self._begun == 0 else 0)
        return self._inside(place, inner=True) if place else None

    def line(self, place: Place) -> int:
        """Return the line on which the member or value begins that stands at an offset, or behind blanks."""
        assert isinstance(place, int)  # it comes from here
        offset = place
        if self.data[place : place + 1].isspace():
            blank = _BLANK.match(self.data, place)
            offset = blank.end() if blank is not None else place
        if offset >= self._offset:  # places are asked for in file order, or nearly so
            self._line += self.data.count(b"\n", self._offset, offset)
        else:
            self._line -= self.data.count(b"\n", offset, self._offset)
        self._offset = offset
        return self._line

    def source(self, begin: Place, end: Place) -> str:
        """Return the text between two offsets."""
        assert isinstance(begin, int)  # they come from here
        assert isinstance(end, int)
        return self.data[begin:end].decode()

    def _inside(self, pos: int, *, inner: bool) -> Iterator[Event]:
        """Yield what comes from an offset on: the whole file, or with `inner`, from a member on."""
        # This runs for every member of a large file, and takes most of the time of reading.
        data, short, text_of = self.data, self._short, self._text
        keys: set[str] | None = set() if inner else None
        opened: list[set[str] | None] = []
        while True:
            key = ""
            if keys is None:
                match = _ITEM.match(data, pos)
                if match is None:
                    self._refuse_value(pos)
                text, number, word, close, bracket = match.groups()
            else:
                match = _MEMBER.match(data, pos)
                if match is None:
                    self._refuse_member(pos)
                raw, text, number, word, close, bracket = match.groups()
                key = short.get(raw) or text_of(raw, pos, keys)
                if key in keys:
                    self._refuse("FIL007", f"{key!r}: given twice in one object", pos)
                keys.add(key)
            place, pos = pos, match.end()
            if text is not None:
                value = short.get(text)
                if value is None:
                    usual = len(short) >= _MOST_SHORT and b"\\" not in text
                    value = text.decode() if usual else text_of(text, place)
                yield TEXT, key, value, place, 0
            elif number is not None:
                yield NUMBER, key, short.get(number) or text_of(number, place), place, 0
            elif word is not None:
                yield WORD, key, text_of(word, place), place, 0
            else:
                opened.append(keys)
                if len(opened) > DEEPEST:
                    self._refuse("FIL006", f"nested deeper than {DEEPEST} levels", pos - 1)
                is_object = bracket == b"{"
                keys = set() if is_object else None
                self._begun += is_object and not inner
                yield OBJECT if is_object else LIST, key, "", place, pos - 1
                closing = _CLOSING[is_object].match(data, pos)
                if closing is None:
                    continue
                close, pos = closing[1], closing.end()
            while close != b",":
                if close != (b"]" if keys is None else b"}"):
                    self._refuse_malformed("expecting ',' delimiter", pos if close is None else pos - 1)
                yield END, "", "", pos - 1, pos
                keys = opened.pop()
                if not opened:
                    if not inner:
                        self._expect_nothing(pos)
                    return
                following = _FOLLOWING.match(data, pos)
                close, pos = (following[1], following.end()) if following is not None else (None, pos)

    def _text(self, raw: bytes, place: int, keys: set[str] | None = None) -> str:
        """Return what stands between quotes; short texts are the same object each time."""
        if keys is not None and len(keys) >= MOST_MEMBERS:
            self._refuse("FIL006", f"more than {MOST_MEMBERS} members in one object", place)
        if b"\\" in raw:
            try:
                text = str(json.loads(b'"%b"' % raw))
            except json.JSONDecodeError as fault:
                self._refuse_malformed(fault.msg[:1].lower() + fault.msg[1:], place)
        else:
            text = raw.decode()
        if len(raw) <= _SHORT and len(self._short) < _MOST_SHORT:
            self._short[raw] = text
        return text

    def _look_ahead(self) -> None:
        """Find what stands late; most files have nothing of that kind."""
        types, heads = array("Q"), dict[str, int]()
        opened: list[tuple[int, list[bool]]] = []
        events = self.events()
        for event in events:
            sort, key, _, place, _ = event
            assert isinstance(place, int)  # it comes from here
            if sort == END:
                opened.pop()
                continue
            number, others = opened[-1] if opened else (-1, [])
            if number >= 0 and not is_own(key):
                others[:] = [True]
            elif number >= 0 and key == TYPE and (others or number == 0):
                types[number] = place
            elif number == 0 and key in (LANGUAGES, ROOTS):
                heads[key] = place
            if sort == OBJECT:
                types.append(0)
            if sort in (OBJECT, LIST):
                opened.append((len(types) - 1 if sort == OBJECT else -1, []))
        self._late_types, self._late_heads = types, heads

    def _expect_nothing(self, pos: int) -> None:
        blank = _BLANK.match(self.data, pos)
        if blank is not None and blank.end() < len(self.data):
            self._refuse_malformed("extra data", pos)

    # what is wrong

    def _refuse_member(self, pos: int) -> NoReturn:
        """Raise the error for a malformed member."""
        key = _KEY.match(self.data, pos)
        if key is None:
            self._refuse_text(pos, "expecting property name enclosed in double quotes")
        self._text(key[1], pos)
        colon = _COLON.match(self.data, key.end())
        if colon is None:
            self._refuse_malformed("expecting ':' delimiter", key.end())
        self._refuse_value(colon.end())

    def _refuse_value(self, pos: int) -> NoReturn:
        """Raise the error for a malformed value."""
        blank = _BLANK.match(self.data, pos)
        word = _NO_NUMBER.match(self.data, blank.end() if blank is not None else pos)
        if word is not None:
            name = word.group().decode()
            self._refuse_malformed(f'{name} is not a number; write "{name}"', pos)
        self._refuse_text(pos, "expecting value")

    def _refuse_text(self, pos: int, expected: str) -> NoReturn:
        blank = _BLANK.match(self.data, pos)
        sound = _SOUND.match(self.data, blank.end() if blank is not None else pos)
        if sound is None:
            self._refuse_malformed(expected, pos)
        if self.data[sound.end() :] in (b"", b"\\"):
            self._refuse_malformed("unterminated string starting at", pos)
        escaped = self.data[sound.end() : sound.end() + 1] == b"\\"
        self._refuse_malformed("invalid \\escape" if escaped else "invalid control character at", pos)

    def _refuse_malformed(self, reason: str, pos: int) -> NoReturn:
        self._refuse("FIL007", f"not well-formed JSON: {reason}", pos)

    def _refuse(self, code: str, what: str, pos: int) -> NoReturn:
        raise UnreadableError.of(code, what, self.file, self.line(pos))


def _is_orderly(data: bytes) -> bool:
    """Return whether every ``$type``, and the keys of the file's top, certainly precede all other members."""
    top = _TOP.match(data)
    if top is None or b"\\u0024" in data or _DISGUISED.search(data) is not None:
        return False
    begin = top.end()
    if any(data.find(f'"{key}"'.encode(), begin) >= 0 for key in (LANGUAGES, ROOTS)):
        return False
    return _LATE_TYPE.search(data, begin) is None


def _refuse_crowds(data: bytes, file: str, shortest: int) -> None:
    """Refuse what is nearly nothing but brackets: in memory it would take a hundred times its size."""
    count = data.count(b"{") + data.count(b"[")
    if count > _MANY and count * shortest > len(data):
        raise UnreadableError.of("FIL006", f"{count} objects and lists with next to nothing in them", file)


def _as_utf8(data: bytes, file: str) -> bytes:
    encoding = json.detect_encoding(data)
    try:
        if encoding in ("utf-8", "utf-8-sig"):
            if not data.isascii():
                data.decode(encoding)
            return data
        return data.decode(encoding).encode()
    except UnicodeDecodeError as fault:
        line = data.count(b"\n", 0, fault.start) + 1
        raise UnreadableError.of("FIL007", f"not readable as {encoding.upper()} text", file, line) from None
