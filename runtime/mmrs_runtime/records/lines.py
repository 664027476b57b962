"""Whole lines of logs: a break may have cut the last one off, or left what a disk had in its place."""

from __future__ import annotations

import json
import os
from contextlib import suppress
from pathlib import Path
from typing import IO


def whole_lines(data: bytes) -> list[bytes]:
    """Return the lines up to the last that was written whole: behind it nothing ends, or is text of JSON."""
    lines = data.split(b"\n")[:-1]
    while lines and _is_rubbish(lines[-1]):
        lines.pop()
    return lines


def keep_whole_lines(path: Path) -> None:
    """Take away what lies behind the last whole line of a file.

    Raises:
        OSError: it cannot be read or written.
    """
    data = path.read_bytes()
    whole = sum(len(line) + 1 for line in whole_lines(data))
    if whole < len(data):
        os.truncate(path, whole)


def append_whole(file: IO[bytes], line: bytes) -> None:
    """Append a line to a file without a buffer, whole or not at all.

    Args:
        file: at its end.
        line: with its end.

    Raises:
        OSError: it cannot be written; nothing of it is left in the file then. It names the file.
    """
    end = file.tell()
    try:
        left = line
        while left:
            left = left[file.write(left) :]
    except OSError as error:
        # What follows must not become part of half a line.
        with suppress(OSError):
            file.truncate(end)
            file.seek(end)
        if error.filename is None:
            error.filename = str(file.name)
        raise


def _is_rubbish(line: bytes) -> bool:
    try:
        json.loads(line)
    except ValueError:
        return True
    except RecursionError:
        return False
    return False
