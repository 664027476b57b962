"""Ends the process when it is interrupted, even while it imports."""

from __future__ import annotations

import signal
import sys
from _thread import interrupt_main
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from threading import Timer
from types import FrameType, TracebackType
from typing import NoReturn

INTERRUPTED = 130
"""What shells report of a program that SIGINT ended: 128 and the number of the signal."""

_SOON = 0.001
_seen: list[int] = []
"""The interrupts of this process, which signals make global."""


def interrupted() -> bool:
    """Return whether the process was interrupted since `interruptible` began.

    Code that is interrupted may end with another exception, such as the ImportError of a library whose
    own imports broke off.
    """
    return bool(_seen)


def interruptible(work: Callable[[], int]) -> int:
    """Return the exit code of some work; 130, after one line, if it was interrupted.

    An interrupt becomes KeyboardInterrupt, so that whatever is open is closed during the exit. Interrupts
    that the process was started to ignore stay ignored. For the main thread.
    """
    if signal.getsignal(signal.SIGINT) is not signal.default_int_handler:
        return work()
    signal.signal(signal.SIGINT, _interrupt)
    sys.excepthook, sys.unraisablehook = _reported_elsewhere, _again_if_lost
    try:
        return work()
    except KeyboardInterrupt:
        return _ended()
    except Exception:
        if interrupted():
            return _ended()
        raise
    finally:
        signal.signal(signal.SIGINT, signal.SIG_IGN)  # nothing is left to be broken off


@contextmanager
def ended_by_interrupt(stop: Callable[[], bool]) -> Iterator[None]:
    """Let the first interrupt call a function; it interrupts if that returns false, as do all others."""
    if signal.getsignal(signal.SIGINT) is not _interrupt:
        yield
        return

    def end(number: int, frame: FrameType | None) -> None:
        signal.signal(signal.SIGINT, _interrupt)
        if not stop():
            _interrupt(number, frame)

    signal.signal(signal.SIGINT, end)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, _interrupt)


def _ended() -> int:
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    sys.stderr.write("mmrs: interrupted\n")
    return INTERRUPTED


def _interrupt(number: int, frame: FrameType | None) -> NoReturn:
    _seen.append(number)
    raise KeyboardInterrupt


def _reported_elsewhere(
    kind: type[BaseException], error: BaseException, traceback: TracebackType | None
) -> None:
    """Print errors as usual, but none of an interrupt.

    Libraries written in C print what breaks their imports off: the interrupt, and errors that follow from it.
    """
    if not (interrupted() or issubclass(kind, KeyboardInterrupt)):
        sys.__excepthook__(kind, error, traceback)


def _again_if_lost(unraisable: sys.UnraisableHookArgs) -> None:
    """Interrupt once more where a callback swallowed it: Python continues from there."""
    if not isinstance(unraisable.exc_value, KeyboardInterrupt):
        sys.__unraisablehook__(unraisable)
        return
    Timer(_SOON, interrupt_main).start()
