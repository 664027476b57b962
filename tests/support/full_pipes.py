"""Pipes whose readers sleep, and that take nothing any more: whoever writes to them waits."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TextIO

MOST = 1 << 20


@contextmanager
def full_pipe() -> Iterator[tuple[int, TextIO]]:
    """Give the end of a pipe that nobody has read yet, and what writes to it."""
    reads, writes = os.pipe()
    os.set_blocking(writes, False)
    os.write(writes, b" " * MOST)
    os.set_blocking(writes, True)
    with os.fdopen(writes, "w", encoding="utf-8") as stream:
        yield reads, stream
    os.close(reads)
