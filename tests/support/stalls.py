"""How long a machine that stalls has kept this process from running: limits of tests are that much longer."""

import threading
import time

GLANCE_SECONDS, USUAL_SECONDS = 0.02, 0.05
"""How often somebody looks at the clock, and how far apart two looks may be where nothing stalls."""


class _Meter:
    """Adds up what there was between two looks at the clock beyond what was asked for."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._lost, self._looked = 0.0, time.monotonic()
        self._thread = threading.Thread(target=self._look_on, name="stalls", daemon=True)

    def lost(self) -> float:
        """Return the seconds lost up to now."""
        with self._lock:
            now = time.monotonic()
            gap, self._looked = now - self._looked, now
            if gap > USUAL_SECONDS:
                self._lost += gap - GLANCE_SECONDS
            return self._lost

    def begin(self) -> None:
        """Look on from now on."""
        with self._lock:
            if self._thread.ident is None:
                self._looked = time.monotonic()
                self._thread.start()

    def _look_on(self) -> None:
        while True:
            time.sleep(GLANCE_SECONDS)
            self.lost()


_METER = _Meter()


class Stalls:
    """Counts from when it is made."""

    def __init__(self) -> None:
        _METER.begin()
        self._before = _METER.lost()

    @property
    def seconds(self) -> float:
        """Return for how long this process has not run since."""
        return _METER.lost() - self._before
