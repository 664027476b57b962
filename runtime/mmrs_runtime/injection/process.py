"""Faults of the whole process: it freezes, its disk is full, its wall clock jumps."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Mapping
from typing import Protocol

from .spec import Injection

THAW = (
    "import os, signal, sys, time; time.sleep(float(sys.argv[1])); os.kill(int(sys.argv[2]), signal.SIGCONT)"
)


class Effect(Protocol):
    """What a fault does to the process."""

    def begin(self) -> None:
        """Let it happen."""
        ...

    def end(self) -> None:
        """Undo it."""
        ...


class Freeze:
    """The process is stopped, as a debugger does it or a computer that swaps; another one continues it."""

    def __init__(self, seconds: float) -> None:
        """Stop for so many real seconds."""
        self._seconds = seconds

    def begin(self) -> None:
        """Stop, and return when it is over."""
        thaw = [sys.executable, "-S", "-E", "-c", THAW, str(self._seconds), str(os.getpid())]
        with subprocess.Popen(thaw, stdin=subprocess.DEVNULL):
            os.kill(os.getpid(), signal.SIGSTOP)

    def end(self) -> None:
        """Return at once: the fault is over."""


class FullDisk:
    """No file of this process grows any more: the system refuses it (EFBIG, "File too large").

    Interpreters ignore the signal that comes with it, so that every write raises OSError.
    """

    def __init__(self) -> None:
        """Change nothing yet."""
        self._limit = 0

    def begin(self) -> None:
        """Let writing fail; what was written stays."""
        import resource

        self._limit, most = resource.getrlimit(resource.RLIMIT_FSIZE)
        resource.setrlimit(resource.RLIMIT_FSIZE, (0, most))

    def end(self) -> None:
        """Let files grow again."""
        import resource

        resource.setrlimit(resource.RLIMIT_FSIZE, (self._limit, resource.getrlimit(resource.RLIMIT_FSIZE)[1]))


class ClockJump:
    """The wall clock of this process is wrong: `time.time` and `time.time_ns` are off by some seconds."""

    def __init__(self, seconds: float) -> None:
        """Advance the clock by that many seconds."""
        self._seconds = seconds
        self._right = time.time, time.time_ns

    def begin(self) -> None:
        """Jump."""
        wall, wall_ns = self._right = time.time, time.time_ns
        time.time = lambda: wall() + self._seconds
        time.time_ns = lambda: wall_ns() + round(self._seconds * 1e9)

    def end(self) -> None:
        """Jump back."""
        time.time, time.time_ns = self._right


def effect_of(fault: Injection, real: Callable[[float], float]) -> Effect | None:
    """Return what a fault does to the process; None where it does nothing to it.

    Args:
        fault: one that begins at a second of the run.
        real: gives the real seconds of seconds of the run.
    """
    effects: Mapping[str, Callable[[], Effect]] = {
        "freeze": lambda: Freeze(real(fault.ends - fault.begins)),
        "disk-full": FullDisk,
        "clock-jump": lambda: ClockJump(fault.amount),
    }
    made = effects.get(fault.name)
    return made() if made is not None else None
