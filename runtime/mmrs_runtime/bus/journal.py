"""What an owner of slots must not forget, on the disk before it answers.

A robot whose owner cannot keep that does not answer, and is out of reach until it can.
"""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterator, Mapping
from errno import ENOSPC
from pathlib import Path
from typing import Any, Protocol, TypeAlias

from .threads import Net

PROBE_SECONDS = 1.0
"""How often it is tried whether something can be kept again."""


Line: TypeAlias = Mapping[str, Any]
"""A word that an owner obeyed, or that a robot was started or takes part."""


class Journal(Protocol):
    """Keeps lines."""

    def lines(self) -> Iterator[Line]:
        """Yield what was kept before, oldest first."""
        ...

    def keep(self, line: Line) -> None:
        """Keep a line; it survives whatever happens when this returns."""
        ...


class NoJournal:
    """Keeps nothing: for slots that live as long as the process that all robots share."""

    def lines(self) -> Iterator[Line]:
        """Yield nothing."""
        yield from ()

    def keep(self, line: Line) -> None:
        """Drop a line: there is no file."""


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

    def lines(self) -> Iterator[Line]:
        """Yield the lines of the file, without a last one that was cut off during writing.

        The cut-off part is removed, so that the next line stands alone.

        Raises:
            OSError: the file cannot be read.
            ValueError: a whole line is damaged; names its line.
        """
        if not self._made:
            return
        content = self._path.read_bytes()
        whole = content.rfind(b"\n") + 1
        if whole < len(content):
            os.truncate(self._path, whole)
        for number, line in enumerate(content[:whole].splitlines(), start=1):
            yield self._line(number, line)

    def keep(self, line: Line) -> None:
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

    def _line(self, number: int, line: bytes) -> Line:
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


class Keeping:
    """Tracks which robots' journals are writable. Not thread-safe: its holder guards it."""

    def __init__(self, net: Net, now: Callable[[], float]) -> None:
        """Create without journals; `now`: seconds of a monotonic clock."""
        self._net, self._now = net, now
        self._journals: dict[str, Journal] = {}
        self._wrong: dict[str, str] = {}
        self._shown: set[str] = set()
        self._probe = float("inf")

    def watched(self, robot: str, journal: Journal) -> Journal:
        """Return a journal that does the same, and reports whether it succeeds."""
        self._journals[robot] = journal
        return _Watched(robot, journal, self)

    def why(self, robot: str) -> str:
        """Return why a robot's journal cannot be written; empty: it can."""
        return self._wrong.get(robot, "")

    @property
    def due(self) -> float:
        """Return when there is something to do; inf: never."""
        return float("-inf") if self._shown != set(self._wrong) else self._probe

    def look(self) -> tuple[list[str], list[str]]:
        """Try again where it is time; return the robots that go out of reach, and those that are back."""
        if self._now() >= self._probe:
            for robot in list(self._wrong):
                self._try(robot)
        wrong = set(self._wrong)
        gone, back = sorted(wrong - self._shown), sorted(self._shown - wrong)
        self._shown = wrong
        return gone, back

    def failed(self, robot: str, error: OSError) -> None:
        """Take note that a journal could not be written."""
        why = error.strerror or str(error)
        self._wrong[robot] = f"its slots cannot be kept: {why}"
        self._probe = self._now() + PROBE_SECONDS
        self._net.tell(self._words(robot, why))

    def kept(self, robot: str) -> None:
        """Take note that a journal was written."""
        if (why := self._wrong.pop(robot, None)) is None:
            return
        self._net.forget(self._words(robot, why.rpartition(": ")[2]))
        if not self._wrong:
            self._probe = float("inf")

    def _try(self, robot: str) -> None:
        try:
            self._journals[robot].keep({"again": robot})
        except OSError as error:
            self.failed(robot, error)
        else:
            self.kept(robot)

    def _words(self, robot: str, why: str) -> str:
        return f"{robot!r} does not answer until its slots can be kept again: {why}"


class _Watched:
    """A journal of a robot, and who wants to know whether it can be written."""

    def __init__(self, robot: str, journal: Journal, keeping: Keeping) -> None:
        self._robot, self._journal, self._keeping = robot, journal, keeping

    def __str__(self) -> str:
        """Return where the journal is."""
        return str(self._journal)

    def lines(self) -> Iterator[Line]:
        """Yield what was kept before."""
        return self._journal.lines()

    def keep(self, line: Line) -> None:
        """Keep a line.

        Raises:
            OSError: it cannot be.
        """
        try:
            self._journal.keep(line)
        except OSError as error:
            self._keeping.failed(self._robot, error)
            raise
        self._keeping.kept(self._robot)
