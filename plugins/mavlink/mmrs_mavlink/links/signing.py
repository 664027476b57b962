"""MAVLink 2 signing: without the key, vehicles cannot be commanded, nor messages be sent in their name.

Frames carry a rising time stamp, so that old ones cannot be replayed. The last stamps sent and
received are kept in a file next to the key, so that this holds over restarts, whatever the wall clock
shows.
"""

from __future__ import annotations

import hashlib
import json
import os
import stat
import threading
import time
from contextlib import suppress
from hmac import compare_digest
from pathlib import Path

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_runtime.records.disk import write_secret

KEY_BYTES = 32
EPOCH = 1_420_070_400
"""Seconds from 1970 to 2015, from when signatures count."""

TICKS = 100_000
"""Counted in a second by the time stamps of signatures."""

BEHIND = 60 * TICKS
"""How old the first frame of a new stream may be: a minute, as the protocol says."""

SAVE_SECONDS = 10.0
"""Real seconds between two times that the stamps are saved; after a restart they continue that much later."""

SIGNATURE_BYTES = 6
_LINK, _STAMP = slice(-13, -12), slice(-12, -6)


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


def signer_for(path: Path) -> Signer:
    """Return the signer with the key in a file; its stamps are kept beside, in ``<file>.stamps``.

    Raises:
        ValueError: there is no good key, or there are no good stamps.
        OSError: they cannot be read.
    """
    return Signer(signing_key(path), path.with_name(f"{path.name}.stamps"))


class Signer:
    """A key, the time stamp to sign with next, and the newest that was received of each stream.

    Attributes:
        refused: how many signed frames were refused, by reason: ``bad signature``, ``replayed``.
        trouble: why the stamps cannot be kept; empty where they can.
    """

    def __init__(self, key: bytes, stamps: Path | None = None) -> None:
        """Sign with a key; stamps are kept in a file, or None: for this process only.

        Raises:
            ValueError: there is a file, and it holds no stamps.
        """
        self._key = key
        self._path = stamps
        self._lock = threading.Lock()
        self._sent, self._received = self._read()
        self._saved = time.monotonic()
        self.refused: dict[str, int] = {}
        self.trouble = ""

    @property
    def key(self) -> bytes:
        """Return the key."""
        return self._key

    def next_stamp(self) -> int:
        """Return a time stamp above all before, and not behind the clock on the wall."""
        with self._lock:
            self._sent = max(self._sent + 1, _now())
            return self._sent

    def accepts(self, frame: bytes, system: int, component: int) -> bool:
        """Return whether a signed frame is signed with the key and newer than all of its stream."""
        digest = hashlib.sha256(self._key + frame[:-SIGNATURE_BYTES]).digest()[:SIGNATURE_BYTES]
        if not compare_digest(digest, bytes(frame[-SIGNATURE_BYTES:])):
            return self._refuse("bad signature")
        stream = f"{frame[_LINK][0]}/{system}/{component}"
        stamp = int.from_bytes(frame[_STAMP], "little")
        with self._lock:
            known = self._received.get(stream)
            if stamp <= known if known is not None else stamp + BEHIND < max(self._sent, _now()):
                return self._refuse("replayed")
            self._received[stream] = stamp
            self._sent = max(self._sent, stamp)
        return True

    def save(self, *, at_once: bool = False) -> None:
        """Keep the stamps, if they were not kept a moment ago."""
        if self._path is None or not (at_once or time.monotonic() - self._saved > SAVE_SECONDS):
            return
        self._saved = time.monotonic()
        try:
            with self._lock:
                self._write(self._path)
        except OSError as error:
            self.trouble = f"{self._path}: time stamps cannot be kept: {error.strerror or error}"

    def _refuse(self, reason: str) -> bool:
        self.refused[reason] = self.refused.get(reason, 0) + 1
        return False

    def _read(self) -> tuple[int, dict[str, int]]:
        sent, received = 0, dict[str, int]()
        if self._path is not None and self._path.exists():
            sent, received = _stamps_in(self._path)
            sent += int(2 * SAVE_SECONDS * TICKS)
        return max(sent, _now()), received

    def _write(self, path: Path) -> None:
        """Write the newest of what is in the file, from another process, and of what is here."""
        sent, received = self._sent, dict(self._received)
        # A file that is damaged now was good when this process began: what is here replaces it.
        with suppress(OSError, ValueError):
            others_sent, others_heard = _stamps_in(path)
            sent = max(sent, others_sent)
            for stream, stamp in others_heard.items():
                received[stream] = max(stamp, received.get(stream, 0))
        write_secret(path, json.dumps({"sent": sent, "heard": received}).encode())


class Signed(mavlink.MAVLink):  # type: ignore[misc]  # pymavlink is not typed
    """Packs and parses signed frames; radios report their signal strength unsigned, and are accepted.

    pymavlink's own check takes a frame's time stamp before it looks at the signature, so that one
    forged frame from the future shuts its stream for good; and it never moves its own stamp on,
    so that a vehicle that restarts after a minute no longer accepts its frames.
    """

    def __init__(self, signer: Signer, system: int, component: int) -> None:
        """Sign as a system and component."""
        super().__init__(None, srcSystem=system, srcComponent=component)
        self._signer = signer
        self.signing.secret_key = signer.key
        self.signing.sign_outgoing = True
        self.signing.allow_unsigned_callback = lambda _, kind: kind == mavlink.MAVLINK_MSG_ID_RADIO_STATUS

    def packed(self, message: mavlink.MAVLink_message) -> bytes:
        """Return a message as a signed frame."""
        self.signing.timestamp = self._signer.next_stamp()
        return bytes(message.pack(self))

    def check_signature(self, msgbuf: bytearray, srcSystem: int, srcComponent: int) -> bool:  # noqa: N803
        """Return whether the frame's signature is accepted."""
        return self._signer.accepts(bytes(msgbuf), srcSystem, srcComponent)


def _stamps_in(path: Path) -> tuple[int, dict[str, int]]:
    try:
        kept = json.loads(path.read_text("ascii"))
        return int(kept["sent"]), {str(stream): int(stamp) for stream, stamp in kept["heard"].items()}
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
        raise ValueError(f"{path}: holds no time stamps of signatures: {error}") from error


def _now() -> int:
    return int((time.time() - EPOCH) * TICKS)
