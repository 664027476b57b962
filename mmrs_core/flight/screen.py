"""Tells people what goes on."""

from __future__ import annotations

import io
import sys
import threading
from collections.abc import Mapping
from contextlib import suppress

_print_lock = threading.Lock()


def bear_all_characters() -> None:
    """Have results and help shown on any terminal: what its encoding lacks, by its code."""
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="backslashreplace")


def say(line: str) -> None:
    """Tell people something, one line at a time."""
    # Nobody may read any more, or the disk that is written to be full: robots fly on all the same.
    with _print_lock, suppress(OSError, ValueError):
        print(line, file=sys.stderr, flush=True)


def words_of(robot: str, name: str, content: Mapping[str, str]) -> str:
    """Return what a robot reports as people read it."""
    pairs = ", ".join(f"{key} {value}" for key, value in content.items())
    return ": ".join(part for part in (robot, name, pairs) if part)
