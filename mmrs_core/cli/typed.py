"""Lines that people type while a command runs."""

from __future__ import annotations

import queue
import signal
import sys
import threading
from collections.abc import Sequence
from contextlib import suppress

EVERYBODY = "all"
"""Stands for every robot, where a line begins with a robot's name."""


def typed_lines() -> queue.SimpleQueue[str]:
    """Return what is typed, line by line, as it comes; nothing where nobody can type."""
    lines: queue.SimpleQueue[str] = queue.SimpleQueue()

    def read() -> None:
        with suppress(OSError):  # in the background of a terminal nobody can type
            for line in sys.stdin:
                lines.put(line)

    if hasattr(signal, "SIGTTIN"):
        signal.signal(signal.SIGTTIN, signal.SIG_IGN)
    if sys.stdin is not None and not sys.stdin.closed:
        threading.Thread(target=read, name="typed lines", daemon=True).start()
    return lines


def addressed(text: str, names: Sequence[str]) -> tuple[tuple[str, ...], str, tuple[str, ...]]:
    """Return whom a line concerns, and its other words: ``ROBOT WORD [WORD…]``, or ``all`` for every robot.

    Args:
        text: of the line.
        names: of the robots there are.

    Raises:
        ValueError: it names no robot, or says nothing of it.
    """
    robot = _named_first(text, [*names, EVERYBODY])
    words = text.split() if robot is None else [robot, *text.strip().removeprefix(robot).split()]
    if len(words) < 2:
        raise ValueError(f"{text.strip()}: is neither ROBOT FAULT [VALUE…] nor ROBOT mend FAULT")
    if robot is None:
        raise ValueError(f"{words[0]}: no such robot; there are {', '.join(names)}, and all")
    return tuple(name for name in names if robot in (name, EVERYBODY)), words[1], tuple(words[2:])


def _named_first(text: str, names: Sequence[str]) -> str | None:
    """Return the name that a line begins with, the longest where several fit: names may have blanks."""
    fitting = [name for name in names if f"{text.strip()} ".startswith(f"{name} ")]
    return max(fitting, key=len, default=None)
