"""Lines that people type while a command runs."""

from __future__ import annotations

import queue
import signal
import sys
import threading
from contextlib import suppress


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
