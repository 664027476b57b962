"""Messages on standard error that never block a run."""

from __future__ import annotations

import io
import os
import select
import sys
import threading
from collections import deque
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, redirect_stderr, suppress
from typing import Any, TextIO

PATIENCE_SECONDS = 0.2
"""Seconds without a reader before lines are left out."""

ROOM = 1000
"""Characters that whatever takes anything takes without a wait."""


def bear_all_characters() -> None:
    """Make all characters printable on any terminal: those that its encoding lacks, by their codes."""
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="backslashreplace")


def say(line: str) -> None:
    """Print a line to standard error."""
    # Nobody may read any more, or the disk that is written to be full: robots fly on all the same.
    with suppress(OSError, ValueError):
        print(f"{line}\n", end="", file=sys.stderr, flush=True)


@contextmanager
def unfailing() -> Iterator[None]:
    """Within it, what standard error does not take is left out: robots rely on the process, read or not."""
    stream = sys.stderr
    with redirect_stderr(_Unfailing(stream)):
        yield
    try:
        stream.flush()
    except OSError:
        let_end_in_nothing(stream)


def let_end_in_nothing(stream: TextIO) -> None:
    """Redirect a stream to the null device, so that flushing it at the exit does not fail again."""
    nothing = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nothing, stream.fileno())
    os.close(nothing)


class _Unfailing:
    """A stream to people that never fails, and never waits for them for long.

    A terminal that is held takes nothing, nor does a pipe whose reader sleeps or a connection that stalls.
    """

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream
        self._lock = threading.RLock()
        self._left_out = 0
        self._waiting: deque[str] = deque()
        self._writing = False

    def write(self, words: str) -> int:
        with self._lock:
            self._waiting.append(words)
            # What a signal's handler says in the middle of a line follows that line.
            while self._waiting and not self._writing:
                self._writing = True
                try:
                    self._write(self._waiting.popleft())
                finally:
                    self._writing = False
        return len(words)

    def _write(self, words: str) -> None:
        if self._left_out and self._takes(0.0):
            lines, self._left_out = self._left_out, 0
            self._put(f"(lines left out here, which were not read: {lines})\n")
        for begin in range(0, len(words), ROOM):
            if not self._takes(0.0 if self._left_out else PATIENCE_SECONDS):
                self._left_out += max(1, words.count("\n", begin))
                break
            self._put(words[begin : begin + ROOM])

    def flush(self) -> None:
        with suppress(OSError):
            self._stream.flush()

    def _put(self, words: str) -> None:
        try:
            self._stream.write(words)
            self._stream.flush()
        except (
            RuntimeError
        ):  # the stream is in use: a signal's handler interrupted what writes to it directly
            self._left_out += max(1, words.count("\n"))
        except OSError:
            return  # the terminal may be gone

    def _takes(self, seconds: float) -> bool:
        """Return whether something can be written without a wait, now or within some seconds."""
        try:
            poll = select.poll()
            poll.register(self._stream.fileno(), select.POLLOUT)
        except (AttributeError, OSError, ValueError):
            return True  # it is no file, or this system cannot tell
        return bool(poll.poll(seconds * 1000.0))

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)


def words_of(robot: str, name: str, content: Mapping[str, str]) -> str:
    """Return what a robot reports as people read it."""
    pairs = ", ".join(f"{key} {value}" for key, value in content.items())
    return ": ".join(part for part in (robot, name, pairs) if part)
