"""What an owner of slots must not forget, on the disk before it answers."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator, Mapping
from errno import ENOSPC
from pathlib import Path
from typing import Any, Protocol


class Journal(Protocol):
    """Keeps lines."""

    def lines(self) -> Iterator[Mapping[str, Any]]:
        """Yield what was kept before, oldest first."""
        ...

    def keep(self, line: Mapping[str, Any]) -> None:
        """Keep a line; it survives whatever happens when this returns."""
        ...


class NoJournal:
    """Keeps nothing: for slots that live as long as the process that all robots share."""

    def lines(self) -> Iterator[Mapping[str, Any]]:
        """Yield nothing."""
        yield from ()

    def keep(self, line: Mapping[str, Any]) -> None:
        """Do nothing."""


class FileJournal:
    """Keeps JSON lines in a file that only grows; it appears with the first line."""

    def __init__(self, path: Path) -> None:
        """Keep the path; nothing is opened yet."""
        self._path = path
        self._made = path.exists()
        self._whole: int | None = None

    def __str__(self) -> str:
        """Return where the file is."""
        return str(self._path)

    def lines(self) -> Iterator[Mapping[str, Any]]:
        """Yield the lines of the file; a last one that was cut off while it was written is none.

        What was cut off is taken away, so that the next line stands alone.

        Raises:
            OSError: the file cannot be read.
            ValueError: a whole line is damaged; says where.
        """
        if not self._made:
            return
        content = self._path.read_bytes()
        whole = content.rfind(b"\n") + 1
        if whole < len(content):
            os.truncate(self._path, whole)
        for number, line in enumerate(content[:whole].splitlines(), start=1):
            yield self._line(number, line)

    def keep(self, line: Mapping[str, Any]) -> None:
        """Append a line and have it written to the disk, the file's name included.

        What a try that fails leaves of the line is taken away, at the latest before the next one.

        Raises:
            OSError: it cannot be.
        """
        new = not self._made
        if self._whole is not None:
            os.truncate(self._path, self._whole)
        with self._path.open("ab", buffering=0) as file:
            self._whole = file.tell()
            content = json.dumps(line, ensure_ascii=True).encode() + b"\n"
            if file.write(content) != len(content):
                raise OSError(ENOSPC, os.strerror(ENOSPC), str(self._path))
            os.fsync(file.fileno())
        if new:
            _sync_folder(self._path.parent)
        self._made, self._whole = True, None

    def _line(self, number: int, line: bytes) -> Mapping[str, Any]:
        try:
            found = json.loads(line)
        except (ValueError, RecursionError) as error:
            raise ValueError(f"{self._path}:{number}: damaged: {error}") from error
        if not isinstance(found, dict):
            raise ValueError(f"{self._path}:{number}: damaged: no object")
        return found


def _sync_folder(folder: Path) -> None:
    if os.name != "posix":
        return
    handle = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
