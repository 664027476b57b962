"""Signals that another thread takes: they do not break off what the main thread waits for."""

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager

SOON_SECONDS, RESCUE_SECONDS = 0.1, 8.0


class Lost(BaseException):
    """The waiting was broken off."""


@contextmanager
def signalled(heed: Callable[[], object], rescue: Callable[[], object] = lambda: None) -> Iterator[None]:
    """Have the main thread do something because of a signal that another thread takes soon.

    Args:
        heed: what the main thread does, as soon as it executes anything.
        rescue: ends the waiting where that takes too long; from another thread.
    """
    before = signal.signal(signal.SIGUSR1, lambda number, frame: heed())
    soon = threading.Timer(SOON_SECONDS, signal.raise_signal, [signal.SIGUSR1])
    late = threading.Timer(RESCUE_SECONDS, rescue)
    try:
        for timer in (soon, late):
            timer.start()
        yield
    finally:
        for timer in (soon, late):
            timer.cancel()
            timer.join()
        signal.signal(signal.SIGUSR1, before)


@contextmanager
def broken_off(rescue: Callable[[], object] = lambda: None) -> Iterator[None]:
    """Expect that such a signal breaks off what is done within, as an interrupt would."""

    def interrupt() -> None:
        raise Lost

    try:
        with signalled(interrupt, rescue):
            yield
    except Lost:
        return
    raise AssertionError("the signal came to nothing")
