"""JSON with the lines of the parts that matter, at the speed of Python's own decoder."""

from __future__ import annotations

import json
from collections.abc import Collection
from json.decoder import JSONDecodeError
from sys import get_int_max_str_digits

from mmrs_core.drawings.sheet import Sheet

MOST_VALUES, MOST_COMMAS = 5_000_000, 20_000_000


class JsonObject(dict[str, object]):
    """An object that knows where it begins.

    Attributes:
        line: counted from 1.
    """

    line = 0


def read_object(data: bytes, sheet: Sheet, walked: Collection[str]) -> JsonObject:
    """Return the object that a file holds.

    It, the objects and arrays in it under the keys that are `walked`, and the objects in these arrays
    are `JsonObject`.

    Raises:
        UnreadableError: if it is not JSON, says a key twice, nests too deeply, or has too many values.
    """
    walk = _Walk(_text_of(data, sheet), sheet, walked)
    value, end = walk.value(walk.blank(0), walk=True)
    if (rest := walk.blank(end)) < len(walk.text):
        lines = "one object a line is not read: save a FeatureCollection" if walk.text[rest] == "{" else ""
        sheet.refuse(lines or "not JSON: more text after its end", walk.line(rest))
    if not isinstance(value, JsonObject):
        sheet.refuse("an object is expected", 1)
    return value


def _text_of(data: bytes, sheet: Sheet) -> str:
    try:
        text = data.decode("utf-8-sig" if data[:3] == b"\xef\xbb\xbf" else json.detect_encoding(data))
    except UnicodeDecodeError as fault:
        sheet.refuse(
            f"not {fault.encoding.upper()}, as JSON has to be", data.count(b"\n", 0, fault.start) + 1
        )
    if text.count("[") + text.count("{") > MOST_VALUES or text.count(",") > MOST_COMMAS:
        sheet.refuse(f"more than {MOST_VALUES} arrays and objects, or {MOST_COMMAS} values; split it")
    return text


class _FaultyObjectError(ValueError):
    """What Python's decoder reads though it is not JSON."""


class _Walk:
    def __init__(self, text: str, sheet: Sheet, walked: Collection[str]) -> None:
        self.text, self._sheet, self._walked = text, sheet, walked
        self._at, self._line = 0, 1
        self._decoder = json.JSONDecoder(object_pairs_hook=_unique, parse_constant=_refuse_constant)

    def blank(self, at: int) -> int:
        """Return the next position that is not blank."""
        text, end = self.text, len(self.text)
        while at < end and text[at] in " \t\r\n":
            at += 1
        return at

    def line(self, at: int) -> int:
        """Return the line of a position, which is not before that of the last call."""
        self._line += self.text.count("\n", self._at, at)
        self._at = max(at, self._at)
        return self._line

    def value(self, at: int, *, walk: bool) -> tuple[object, int]:
        """Return the value at a position, and the position behind it."""
        begin, line = self.text[at : at + 1], self.line(at)
        if walk and begin == "{":
            return self._object(at, line)
        if walk and begin == "[":
            return self._array(at)
        try:
            value, end = self._decoder.raw_decode(self.text, at)
        except JSONDecodeError as fault:
            self._sheet.refuse(f"not JSON: {fault.msg.lower()}", fault.lineno)
        except RecursionError:
            self._sheet.refuse("nested too deeply", line)
        except _FaultyObjectError as fault:
            self._sheet.refuse(f"not JSON: {fault}", line)
        except ValueError:  # Python's limit for whole numbers
            self._sheet.refuse(f"a number has more than {get_int_max_str_digits()} digits", line)
        if isinstance(value, dict):
            value = JsonObject(value)
            value.line = line
        return value, end

    def _object(self, at: int, line: int) -> tuple[JsonObject, int]:
        result = JsonObject()
        result.line = line
        at = self.blank(at + 1)
        while self.text[at : at + 1] != "}":
            if result:
                at = self._take(at, ",")
            if self.text[at : at + 1] != '"':
                self._sheet.refuse("not JSON: expecting a key in double quotes", self.line(at))
            key, at = self.value(at, walk=False)
            if key in result:
                self._sheet.refuse(f"'{key}' is given twice in one object", self.line(at))
            at = self._take(self.blank(at), ":")
            result[str(key)], at = self.value(at, walk=key in self._walked)
            at = self.blank(at)
        return result, at + 1

    def _array(self, at: int) -> tuple[list[object], int]:
        result: list[object] = []
        at = self.blank(at + 1)
        while self.text[at : at + 1] != "]":
            if result:
                at = self._take(at, ",")
            value, at = self.value(at, walk=False)
            result.append(value)
            at = self.blank(at)
        return result, at + 1

    def _take(self, at: int, mark: str) -> int:
        if self.text[at : at + 1] != mark:
            self._sheet.refuse(f"not JSON: expecting '{mark}'", self.line(at))
        return self.blank(at + 1)


def _unique(pairs: list[tuple[str, object]]) -> dict[str, object]:
    result = dict(pairs)
    if len(result) < len(pairs):
        keys = [key for key, _ in pairs]
        twice = next(key for key in keys if keys.count(key) > 1)
        raise _FaultyObjectError(f"'{twice}' is given twice in one object")
    return result


def _refuse_constant(name: str) -> object:
    raise _FaultyObjectError(f"{name} is not a number")
