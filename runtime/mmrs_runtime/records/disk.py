"""Writes files to the disk: in a thread of its own, while their writers continue; and secrets, whole."""

from __future__ import annotations

import os
from collections.abc import Callable
from functools import cache
from typing import IO, TYPE_CHECKING

if TYPE_CHECKING:
    from concurrent.futures import Executor, Future
    from pathlib import Path

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


def write_secret(path: Path, content: bytes) -> None:
    """Write a file that only its owner may read, whole or not at all.

    Raises:
        OSError: it cannot be written; it is as before then.
    """
    part = path.with_name(f"{path.name}.{os.getpid()}.part")
    handle = os.open(part, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600)
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(content)
        part.replace(path)
    except BaseException:
        part.unlink(missing_ok=True)
        raise


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
