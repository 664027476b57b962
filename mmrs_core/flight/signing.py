"""MAVLink 2 signing: nobody without the key commands a vehicle, or speaks in its name."""

from __future__ import annotations

import os
import stat
import time
from pathlib import Path
from typing import Any

KEY_BYTES = 32
EPOCH = 1_420_070_400
"""Seconds from 1970 to 2015, from when signatures count."""

TICKS = 100_000
"""Counted in a second by the time stamps of signatures."""


def signing_key(path: Path) -> bytes:
    """Return the key in a file: 32 bytes, readable by its owner only.

    Raises:
        ValueError: it is no such file.
        OSError: it cannot be read.
    """
    key = path.read_bytes()
    if len(key) != KEY_BYTES:
        raise ValueError(f"{path}: holds {len(key)} bytes instead of {KEY_BYTES}")
    if os.name == "posix" and stat.S_IMODE(path.stat().st_mode) & 0o077:
        raise ValueError(f"{path}: others may read it; a key should be its owner's only (chmod 600)")
    return key


def sign(connection: Any, key: bytes) -> None:
    """Have a pymavlink connection sign what it packs, and drop what is not signed with the key.

    Time stamps come from the clock on the wall, so that they grow over restarts.
    """
    connection.signing.secret_key = key
    connection.signing.sign_outgoing = True
    connection.signing.timestamp = int((time.time() - EPOCH) * TICKS)
    connection.signing.allow_unsigned_callback = None
