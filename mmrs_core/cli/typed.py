"""Lines typed while a command runs."""

from __future__ import annotations

import queue
import signal
import sys
import threading
from collections.abc import Callable, Sequence
from contextlib import suppress

from mmrs_core.cli.output import tell

ALL_ROBOTS = "all"
"""Addresses every robot, instead of a name."""

QUIT = frozenset({"quit", "exit"})


def typed_lines() -> queue.SimpleQueue[str]:
    """Return the queue of typed lines, which stays empty without a terminal or a pipe."""
    lines: queue.SimpleQueue[str] = queue.SimpleQueue()
    listen(lines.put)
    return lines


def listen(received: Callable[[str], object]) -> None:
    """Call a function with every line that is typed, from a thread, until it raises RuntimeError."""

    def read() -> None:
        with suppress(OSError, RuntimeError):  # a background process cannot read from its terminal
            for line in sys.stdin:
                received(line)

    if hasattr(signal, "SIGTTIN"):
        signal.signal(signal.SIGTTIN, signal.SIG_IGN)
    if sys.stdin is not None and not sys.stdin.closed:
        threading.Thread(target=read, name="typed lines", daemon=True).start()


def addressed(text: str, names: Sequence[str]) -> tuple[tuple[str, ...], str, tuple[str, ...]]:
    """Return the robots that a line addresses, and its other words: ``ROBOT WORD [WORD…]``, or ``all``.

    A name can contain spaces; of several that fit, the longest is meant.

    Args:
        text: the line.
        names: of all robots.

    Raises:
        ValueError: it names no robot, or nothing else.
    """
    fitting = [name for name in (*names, ALL_ROBOTS) if f"{text.strip()} ".startswith(f"{name} ")]
    robot = max(fitting, key=len, default=None)
    words = text.split() if robot is None else [robot, *text.strip().removeprefix(robot).split()]
    if len(words) < 2:
        raise ValueError(f"{text.strip()}: neither ROBOT FAULT [VALUE…] nor ROBOT clear FAULT")
    if robot is None:
        raise ValueError(f"{words[0]}: unknown robot; known are {', '.join(names)}, and all")
    return tuple(name for name in names if robot in (name, ALL_ROBOTS)), words[1], tuple(words[2:])


def obeyed(
    lines: queue.SimpleQueue[str],
    names: Sequence[str],
    obey: Callable[[str, tuple[str, ...]], None],
    usual: str = "",
) -> bool:
    """Obey the lines typed so far, and print what was done; return whether one of them quits.

    Args:
        lines: typed.
        names: of all robots.
        obey: does what the words of a line say with a robot; raises ValueError where that makes no sense.
        usual: word that addresses all robots without naming them, as does an empty line.
    """
    while not lines.empty():
        line = lines.get().strip()
        if line in QUIT:
            return True
        if usual and line in ("", usual):
            line = f"{ALL_ROBOTS} {usual}"
        try:
            robots, what, values = addressed(line, names)
            for robot in robots:
                obey(robot, (what, *values))
        except ValueError as error:
            tell(str(error))
            continue
        if what != usual:
            tell(f"{', '.join(robots)}: {' '.join((what, *values))}")
    return False
