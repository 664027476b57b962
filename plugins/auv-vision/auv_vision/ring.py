"""Pairs of pictures in shared memory: one process writes, any number of others read, none waits.

The memory is a header and some slots, each of which holds a pair with its time and the vehicle's pose. Who
writes goes round the slots and marks a slot odd before it writes there and even afterwards, so that who
reads knows that a pair changed under its hands; a checksum tells so too where processors reorder writes.
"""

from __future__ import annotations

import os
import struct
import zlib
from contextlib import suppress
from dataclasses import astuple, dataclass
from math import isfinite, nan
from multiprocessing import resource_tracker
from multiprocessing.shared_memory import SharedMemory
from pathlib import Path
from secrets import randbits
from types import TracebackType
from typing import Final

import numpy as np
from numpy.typing import NDArray

from auv_vision.cameras import Picture, Pose

SLOTS: Final = 4

_MAGIC: Final = 0x4D4D5253_45594502
_HEADER: Final = struct.Struct("=QQqqqqqQ")
"""Magic, generation, process and when it began, slots, width, height, newest."""

_NEWEST: Final = _HEADER.size - 8
_SLOT: Final = struct.Struct("=QQ8d")  # mark, checksum, time, pose, gain
_WORD: Final = struct.Struct("=Q")
_LARGEST: Final = 1 << 28
_TRIES: Final = 4


class MemoryTakenError(OSError):
    """The memory belongs to another program."""


@dataclass(frozen=True, slots=True)
class Pair:
    """Two pictures that were taken together.

    Attributes:
        number: counts from 1.
        time: seconds of the vehicle's clock.
        pose: of the vehicle as it believed; None: not known.
        gain: by which the pictures were brightened.
    """

    number: int
    time: float
    pose: Pose | None
    left: Picture
    right: Picture
    gain: float = 1.0


class Writer:
    """Puts pairs into shared memory; ends it when closed.

    Memory that a killed process of the same name has left behind is replaced.
    """

    def __init__(self, name: str, width: int, height: int, slots: int = SLOTS) -> None:
        """Make the memory.

        Raises:
            MemoryTakenError: another process that is alive writes there.
            OSError: there is not enough memory.
        """
        self._shape = (2, height, width, 3)
        self._stride = _stride(width, height)
        self._slots, self._number = slots, 0
        self._memory = _made(name, _HEADER.size + slots * self._stride)
        owner = os.getpid()
        _HEADER.pack_into(
            self._buffer, 0, 0, randbits(63), owner, _beginning(owner) or 0, slots, width, height, 0
        )
        _WORD.pack_into(self._buffer, 0, _MAGIC)

    def __enter__(self) -> Writer:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    @property
    def _buffer(self) -> memoryview:
        buffer = self._memory.buf
        assert buffer is not None
        return buffer

    def write(self, time: float, pose: Pose | None, left: Picture, right: Picture, gain: float = 1.0) -> None:
        """Put a pair into the next slot.

        Raises:
            ValueError: pictures of another size.
        """
        pictures = np.stack((left, right))
        if pictures.shape != self._shape:
            raise ValueError(f"pictures of {pictures.shape}, not {self._shape}")
        number = self._number + 1
        begin = _HEADER.size + number % self._slots * self._stride
        placed = astuple(pose) if pose is not None else (nan,) * 6
        data = pictures.tobytes()
        head = _SLOT.pack(2 * number, _check(number, data), time, *placed, gain)
        _WORD.pack_into(self._buffer, begin, 2 * number - 1)
        self._buffer[begin + 8 : begin + _SLOT.size] = head[8:]
        self._buffer[begin + _SLOT.size : begin + _SLOT.size + len(data)] = data
        _WORD.pack_into(self._buffer, begin, 2 * number)
        _WORD.pack_into(self._buffer, _NEWEST, number)
        self._number = number

    def close(self) -> None:
        """End the memory; who reads it still may do so to its end. Idempotent."""
        with suppress(FileNotFoundError):
            self._memory.unlink()
        self._memory.close()


class Reader:
    """Reads pairs that another process writes, whenever that process begins, ends or begins again."""

    def __init__(self, name: str) -> None:
        self._name = name
        self._memory: SharedMemory | None = None
        self._generation = self._seen = 0
        self._slots = self._width = self._height = 0
        self.torn = 0
        """Times that a pair changed while it was read, and was not returned."""

    def __enter__(self) -> Reader:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def newest(self) -> Pair | None:
        """Return the newest pair; None if there is none that was not returned before.

        Raises:
            MemoryTakenError: the memory holds something else.
        """
        if self._memory is None and not self._open():
            return None
        for _ in range(_TRIES):
            buffer = self._buffer
            (number,) = _WORD.unpack_from(buffer, _NEWEST)
            if number == self._seen:
                return None
            pair = self._read(number)
            if pair is not None:
                self._seen = number
                return pair
            self.torn += 1
        return None

    def look_again(self) -> None:
        """Look whether another process has begun to write: call it when there is nothing new for long."""
        seen, generation = self._seen, self._generation
        self.close()
        if self._open() and self._generation == generation:
            self._seen = seen

    def close(self) -> None:
        """Read no more; idempotent."""
        if self._memory is not None:
            self._memory.close()
            self._memory = None

    @property
    def _buffer(self) -> memoryview:
        assert self._memory is not None
        buffer = self._memory.buf
        assert buffer is not None
        return buffer

    def _open(self) -> bool:
        memory = _attached(self._name)
        if memory is None:
            return False
        try:
            found = _header(memory)
        except MemoryTakenError:
            memory.close()
            raise
        if found is None:
            memory.close()
            return False
        self._memory, self._seen = memory, 0
        self._generation, self._slots, self._width, self._height = found
        return True

    def _read(self, number: int) -> Pair | None:
        """Return a pair; None if it was overwritten meanwhile."""
        stride, shape = _stride(self._width, self._height), (2, self._height, self._width, 3)
        begin = _HEADER.size + number % self._slots * stride
        head = bytes(self._buffer[begin : begin + _SLOT.size])
        data = bytes(self._buffer[begin + _SLOT.size : begin + _SLOT.size + int(np.prod(shape))])
        (after,) = _WORD.unpack_from(self._buffer, begin)
        mark, check, time, *placed, gain = _SLOT.unpack(head)
        if mark != 2 * number or after != mark or check != _check(number, data):
            return None
        pictures: NDArray[np.uint8] = np.frombuffer(data, np.uint8).reshape(shape)
        pose = Pose(*placed) if all(map(isfinite, placed)) else None
        return Pair(number, time, pose, pictures[0], pictures[1], gain)


def _stride(width: int, height: int) -> int:
    """Return bytes from one slot to the next: whole words."""
    return (_SLOT.size + 2 * 3 * width * height + 7) // 8 * 8


def _check(number: int, data: bytes) -> int:
    return zlib.crc32(data, number & 0xFFFFFFFF)


def _made(name: str, size: int) -> SharedMemory:
    """Make memory, in place of memory that a process which is gone has left."""
    try:
        return SharedMemory(name, create=True, size=size)
    except FileExistsError:
        pass
    left = _attached(name)
    if left is not None:
        owner = _owner(left)
        left.close()
        if owner is not None and owner[1] == _beginning(owner[0]):
            raise MemoryTakenError(f"shared memory {name!r}: process {owner[0]} writes there")
        with suppress(FileNotFoundError):
            resource_tracker.register(f"/{name}", "shared_memory")
            left.unlink()
    return SharedMemory(name, create=True, size=size)


def _attached(name: str) -> SharedMemory | None:
    """Return memory that is there; None: there is none.

    Python ends memory when a process that opened it ends, unless told not to: only its maker's end counts.
    """
    try:
        memory = SharedMemory(name)
    except (FileNotFoundError, ValueError):
        # ValueError: it has been made, but has no size yet.
        return None
    if not _is_own(memory):
        resource_tracker.unregister(f"/{memory.name}", "shared_memory")
    return memory


def _is_own(memory: SharedMemory) -> bool:
    """Return whether this process made memory."""
    assert memory.buf is not None
    if memory.size < _HEADER.size:
        return False
    magic, _, owner, *_ = _HEADER.unpack_from(memory.buf, 0)
    return bool(magic == _MAGIC and owner == os.getpid())


def _owner(memory: SharedMemory) -> tuple[int, int] | None:
    """Return the process that made memory, and when it began; None: the memory is not finished.

    Raises:
        MemoryTakenError: it is something else.
    """
    assert memory.buf is not None
    if memory.size < _HEADER.size:
        return None
    magic, _, owner, began, *_ = _HEADER.unpack_from(memory.buf, 0)
    if magic == 0:
        return None
    if magic != _MAGIC:
        raise MemoryTakenError(f"shared memory {memory.name!r} holds something else")
    return int(owner), int(began)


def _beginning(process: int) -> int | None:
    """Return when a process began, as the system counts it; None: it has ended.

    Another process may have got its number since, and one that was killed keeps its own until its parent asks
    how it ended. Where the system does not tell, 0 stands for all that live.
    """
    try:
        with suppress(PermissionError):
            os.kill(process, 0)
        words = Path(f"/proc/{process}/stat").read_text(encoding="utf-8", errors="replace")
    except ProcessLookupError:
        return None
    except OSError:
        return 0
    state, *rest = words.rpartition(")")[2].split()
    return None if state in "ZX" else int(rest[18])


def _header(memory: SharedMemory) -> tuple[int, int, int, int] | None:
    """Return generation, slots, width, height; None: it is being made."""
    assert memory.buf is not None
    if memory.size < _HEADER.size:
        return None
    magic, generation, _, _, slots, width, height, _ = _HEADER.unpack_from(memory.buf, 0)
    if magic == 0:
        return None
    sound = slots > 0 and width > 0 and height > 0 and width * height < _LARGEST
    if magic != _MAGIC or not sound or memory.size < _HEADER.size + slots * _stride(width, height):
        raise MemoryTakenError(f"shared memory {memory.name!r} holds something else")
    return generation, slots, width, height
