"""Waiting for what comes from another thread or process."""

import time
from collections.abc import Callable

GLANCE_SECONDS = 0.005


def wait_for(test: Callable[[], object], seconds: float = 10.0) -> bool:
    """Return whether a test has come true in that many real seconds."""
    end = time.monotonic() + seconds
    while not test():
        if time.monotonic() > end:
            return False
        time.sleep(GLANCE_SECONDS)
    return True


def until(test: Callable[[], object], seconds: float = 20.0) -> None:
    """Wait for something, and fail if it has not come after so many seconds."""
    assert wait_for(test, seconds), f"it did not come to that in {seconds:g} s"
