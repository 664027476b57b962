"""Tells people what goes on."""

from __future__ import annotations

import sys
import threading

_print_lock = threading.Lock()


def say(line: str) -> None:
    """Tell people something, one line at a time."""
    with _print_lock:
        print(line, file=sys.stderr, flush=True)
