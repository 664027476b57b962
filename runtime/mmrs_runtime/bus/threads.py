"""The threads of one end of the bus: they do what is due, and after a failure report it and continue."""

from __future__ import annotations

import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

SORE_SECONDS = 0.5
"""How long something that fails is left alone."""

LONGEST_SLEEP = 3600.0

MOST_TOLD = 100
"""What goes wrong in more different ways than that is no longer told each time."""

Tell = Callable[[str], None]


def tell_people(line: str) -> None:
    """Write a line to standard error."""
    print(f"bus: {line}\n", end="", file=sys.stderr, flush=True)


class Net:
    """Catches otherwise uncaught exceptions, and reports each once."""

    def __init__(self, tell: Tell = tell_people) -> None:
        """Report with a function, which may be called from any thread."""
        self._tell = tell
        self._reported: set[str] = set()

    @contextmanager
    def under(self, what: str) -> Iterator[None]:
        """Continue after the block whatever it raises; `what` names the activity."""
        try:
            yield
        except Exception as error:
            self.tell(f"{what}: fails, and continues: {error!r}")

    def tell(self, line: str) -> None:
        """Report to the operator, unless the same was reported before."""
        if line not in self._reported and len(self._reported) < MOST_TOLD:
            self._reported.add(line)
            self._tell(line)

    def forget(self, line: str) -> None:
        """Allow the same to be reported again."""
        self._reported.discard(line)


class Pacing:
    """Does what is due when it is due; no thread is started before that.

    Attributes:
        is_over: whether it has ended, or ends after its present work.
    """

    def __init__(
        self,
        lock: threading.Condition,
        now: Callable[[], float],
        next_due: Callable[[], float],
        do: Callable[[], None],
        net: Net,
        *,
        threaded: bool,
    ) -> None:
        """Prepare the thread, without starting it.

        Args:
            lock: guards what it looks at; signalled when `next_due` may have changed.
            now: seconds of a clock that never goes back.
            next_due: returns when there is something to do; inf: never. Called with the lock.
            do: does what is due. Called without the lock.
            net: catches what that raises.
            threaded: whether there may be a thread at all.
        """
        self.is_over = False
        self._lock, self._now, self._next_due, self._do, self._net = lock, now, next_due, do, net
        self._threaded = threaded
        self._thread: threading.Thread | None = None

    @property
    def is_threaded(self) -> bool:
        """Return whether a thread does what is due."""
        return self._threaded

    def keep_going(self) -> None:
        """Take note that something may be due; to be called with the lock."""
        may_begin = self._threaded and self._thread is None and not self.is_over
        if may_begin and self._next_due() < float("inf"):
            self._thread = threading.Thread(target=self._work, name="bus", daemon=True)
            self._thread.start()
        self._lock.notify_all()

    def join(self) -> None:
        """Wait until the thread has ended, where there is one, and another one asks."""
        if self._thread is not None and self._thread is not threading.current_thread():
            self._thread.join()

    def _work(self) -> None:
        while True:
            with self._lock:
                if self.is_over:
                    return
                left = self._next_due() - self._now()
                if left > 0:
                    self._lock.wait(min(left, LONGEST_SLEEP))
                    continue
            with self._net.under("sending what is due"):
                self._do()
                continue
            time.sleep(SORE_SECONDS)
