"""Waiting for what comes from another thread or process."""

from __future__ import annotations

import time
from collections.abc import Callable

GLANCE_SECONDS = 0.005


def until(test: Callable[[], object], seconds: float = 20.0) -> None:
    """Wait for something, and fail if it has not come after so many seconds."""
    end = time.monotonic() + seconds
    while not test():
        assert time.monotonic() < end, f"it did not come to that in {seconds:g} s"
        time.sleep(GLANCE_SECONDS)
