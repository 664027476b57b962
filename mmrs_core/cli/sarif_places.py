"""Where faults and fixes are, as SARIF says it: files, lines and columns, and what stays the same of them."""

from __future__ import annotations

import os
import re
import struct
from collections import Counter
from collections.abc import Iterable
from functools import cached_property
from itertools import accumulate
from pathlib import Path
from typing import TYPE_CHECKING
from urllib.parse import quote

from mmrs_core.diagnostics import Diagnostic

if TYPE_CHECKING:
    from mmrs_core.analysis.fixes.repair import Proposal

ROOT = "PROJECTROOT"
_BLOCK = 100
_BASE = 37
_PARTS = 2**64
_BLANKS = re.compile("[ \t]+")
_LINE_END = re.compile("\r\n?")


class Places:
    """Locates positions in files below a folder, and reads each file once."""

    def __init__(self, base: Path) -> None:
        self.base = base
        self._texts: dict[str, _Text | None] = {}

    def location(self, fault: Diagnostic) -> dict[str, object]:
        """Return where a fault is, as far as it is known."""
        place, location = fault.place, dict[str, object]()
        if place.file:
            physical: dict[str, object] = {"artifactLocation": self.artifact(Path(place.file))}
            if place.line > 0:
                physical["region"] = self._region(fault)
            location["physicalLocation"] = physical
        if place.path:
            location["logicalLocations"] = [{"fullyQualifiedName": place.path, "kind": "element"}]
        return location

    def artifact(self, file: Path) -> dict[str, str]:
        """Return where a file lies: below the base, or anywhere."""
        relative = os.path.relpath(file.absolute(), self.base)
        if Path(relative).parts[:1] == (os.pardir,):
            return {"uri": file.absolute().as_uri()}
        return {"uri": quote(Path(relative).as_posix()), "uriBaseId": ROOT}

    def _region(self, fault: Diagnostic) -> dict[str, int]:
        """Return the culprit, if its line names it once, else what the line holds."""
        text, line = self._text(fault.place.file), fault.place.line
        said = text.line(line) if text is not None else ""
        if not said.strip():
            return {"startLine": line}
        culprit = re.escape(fault.message.partition(":")[0])
        named = list(re.finditer(rf"(?<!\w){culprit}(?!\w)", said)) if culprit else []
        begin, end = (
            named[0].span() if len(named) == 1 else (len(said) - len(said.lstrip()), len(said.rstrip()))
        )
        columns = {"startColumn": _column(said[:begin]), "endColumn": _column(said[:end])}
        return {"startLine": line, "endLine": line, **columns}

    def fix(self, proposal: Proposal) -> dict[str, object]:
        """Return a quick fix as changes of its file; errors as in `Path.read_bytes`."""
        data = proposal.file.read_bytes()
        replacements = [
            {"deletedRegion": _bytes(data, each.begin, each.end), "insertedContent": {"text": each.text}}
            for each in sorted(proposal.edits)
        ]
        change = {
            "artifactLocation": self.artifact(Path(proposal.fault.place.file)),
            "replacements": replacements,
        }
        return {"description": {"text": proposal.title}, "artifactChanges": [change]}

    def fingerprint(self, fault: Diagnostic) -> str:
        """Return what stays the same of a fault's line while other lines change; empty if it has none."""
        text = self._text(fault.place.file) if fault.place.file else None
        return text.fingerprint(fault.place.line) if text is not None else ""

    def _text(self, file: str) -> _Text | None:
        if file not in self._texts:
            self._texts[file] = _text_in(Path(file))
        return self._texts[file]


def _text_in(file: Path) -> _Text | None:
    try:
        return _Text(file.read_bytes().decode())
    except (OSError, UnicodeDecodeError):  # the fault itself says so
        return None


class _Text:
    """A file, by lines."""

    def __init__(self, text: str) -> None:
        self._text = _LINE_END.sub("\n", text)

    def line(self, number: int) -> str:
        lines = self._lines
        return lines[number - 1] if 0 < number <= len(lines) else ""

    def fingerprint(self, number: int) -> str:
        """Return what GitHub calls ``primaryLocationLineHash``, as CodeQL computes it.

        A polynomial of the hundred characters from the line's beginning, blanks left out; and, since lines
        may be alike, the how-manieth of those this one is.
        """
        if not 0 < number <= len(self._blocks):
            return ""
        block, often = self._blocks[number - 1]
        return f"{_hash(block):x}:{often}"

    @cached_property
    def _lines(self) -> list[str]:
        return self._text.split("\n")

    @cached_property
    def _blocks(self) -> list[tuple[str, int]]:
        """The first characters from each line on, and how often they were there by then."""
        lines = [_BLANKS.sub("", line) for line in self._lines]
        whole = "\n".join(lines)
        starts = accumulate((len(line) + 1 for line in lines), initial=0)
        seen: Counter[str] = Counter()
        blocks = []
        for start, _ in zip(starts, lines, strict=False):
            block = whole[start : start + _BLOCK]
            seen[block] += 1
            blocks.append((block, seen[block]))
        return blocks


def _hash(block: str) -> int:
    encoded = block.encode("utf-16-be", "surrogatepass")
    units: Iterable[int] = (*struct.unpack(f">{len(encoded) // 2}H", encoded), 0xFFFF, *[0] * _BLOCK)
    value = 0
    for _, unit in zip(range(_BLOCK), units, strict=False):
        value = (value * _BASE + unit) % _PARTS
    return value


def _bytes(data: bytes, begin: int, end: int) -> dict[str, int]:
    """Return lines and columns from 1."""
    (first, left), (last, right) = _place(data, begin), _place(data, end)
    return {"startLine": first, "startColumn": left, "endLine": last, "endColumn": right}


def _place(data: bytes, offset: int) -> tuple[int, int]:
    start = data.rfind(b"\n", 0, offset) + 1
    return data.count(b"\n", 0, offset) + 1, _column(data[start:offset].decode("utf-8", "replace"))


def _column(before: str) -> int:
    """Return the column after some characters; columns count UTF-16 units, as editors do."""
    return len(before.encode("utf-16-le", "surrogatepass")) // 2 + 1
