"""Writes files to the disk in a thread of its own, while their writers continue."""

from __future__ import annotations

import os
from collections.abc import Callable
from functools import cache
from typing import IO, TYPE_CHECKING

if TYPE_CHECKING:
    from concurrent.futures import Executor, Future

Kept = Callable[[OSError | None], None]
"""Is called once something is on the disk, or with why it is not; from another thread."""


def sync(file: IO[bytes], kept: Kept) -> Future[None]:
    """Write all of a file to the disk, after what was asked for before.

    The file may be closed meanwhile.

    Args:
        file: without a buffer, or flushed.
        kept: called then.

    Returns:
        what is done once `kept` has returned.

    Raises:
        OSError: there are too many open files.
    """
    return _thread().submit(_synced, os.dup(file.fileno()), str(file.name), kept)


def _synced(handle: int, name: str, kept: Kept) -> None:
    failed: OSError | None = None
    try:
        os.fsync(handle)
    except OSError as error:
        error.filename = error.filename or name
        failed = error
    finally:
        os.close(handle)
    kept(failed)


@cache
def _thread() -> Executor:
    # Imported here: what only reads logs, or simulates, has no use for it.
    from concurrent.futures import ThreadPoolExecutor

    return ThreadPoolExecutor(1, "disk")
