"""The words of the socketcand protocol, raw mode, as a hub receives and sends them.

A hub greets with ``< hi >``; a client answers ``< open CHANNEL >`` and ``< rawmode >``, each acknowledged
by ``< ok >``; from then on ``< send ID LENGTH BYTES >`` of one becomes ``< frame ID TIME BYTES >`` of all
others. ``< echo >`` comes back. Identifiers of three hexadecimal digits are standard, of eight extended.
"""

from __future__ import annotations

import re

from auv_vessel.wire.frame import Frame

HI, OK, ECHO = b"< hi >", b"< ok >", b"< echo >"
LONGEST = 128
"""Characters in a word; who says longer ones speaks something else."""

CHANNEL = re.compile(r"[A-Za-z0-9_.:-]{1,32}")
_ID, _BYTE = re.compile(r"[0-9A-Fa-f]{3}|[0-9A-Fa-f]{8}"), re.compile(r"[0-9A-Fa-f]{1,2}")


def words_of(buffer: bytearray) -> list[list[str]]:
    """Take all whole words from a buffer and return their parts; what is between words is let go.

    Raises:
        ValueError: there is a word without end.
    """
    words = []
    while (begin := buffer.find(b"<")) >= 0 and (end := buffer.find(b">", begin)) >= 0:
        words.append(buffer[begin + 1 : end].decode("ascii", "replace").split())
        del buffer[: end + 1]
    del buffer[: buffer.find(b"<") if b"<" in buffer else len(buffer)]
    if len(buffer) > LONGEST:
        raise ValueError("a word without end")
    return words


def frame_of(parts: list[str]) -> Frame:
    """Return the frame that a ``send`` says, given what follows that word.

    Raises:
        ValueError: it is none.
    """
    id, length, data = parts[0], parts[1], parts[2:]
    if not _ID.fullmatch(id) or not all(map(_BYTE.fullmatch, data)):
        raise ValueError("no identifier or bytes in hexadecimal digits")
    if length not in tuple("012345678") or int(length) != len(data):
        raise ValueError("not as many bytes as it says, or more than 8")
    number, extended = int(id, 16), len(id) == 8
    if number >= 1 << (29 if extended else 11):
        raise ValueError(f"identifier {id} is too large")
    return Frame(number, bytes(int(byte, 16) for byte in data), extended)


def frame_word(frame: Frame, time: float) -> bytes:
    """Return the word that tells a frame and the time, in seconds, at which it was on the bus."""
    id = f"{frame.id:08X}" if frame.extended else f"{frame.id:03X}"
    return f"< frame {id} {time:.6f} {frame.data.hex().upper()} >".encode()


def error_word(why: str, time: float) -> bytes:
    """Return the word that tells a client what was wrong, in seconds when.

    It has the form of an error frame, since python-can takes every error for one and fails on others.
    """
    return f"< error 000 {time:.6f} {why} >".encode()
