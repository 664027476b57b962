"""The log of a robot: what happened, in the order in which it happened, one JSON object a line."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import IO

from .faults import LOG_FAILED, Fault


class Log:
    """Writes steps. Every line is out of the process before the robot goes on."""

    def __init__(self, path: Path, run: str, robot: str) -> None:
        """Open a new file.

        Raises:
            Fault: it cannot be, or there is one already; logs are never overwritten.
        """
        with _writing(path):
            path.parent.mkdir(parents=True, exist_ok=True)
            self._file: IO[str] = path.open("x", encoding="ascii", newline="\n")
        self._path = path
        self._run = run
        self._robot = robot
        self._seq = 0
        self._time = 0.0

    def write(
        self, label: str, move: str, *, lamport: int, time: float, detail: str = "", slot: str = ""
    ) -> None:
        """Write one step; a notify is on the disk before it is delivered.

        Raises:
            Fault: it cannot be written.
        """
        self._time = max(self._time, round(time, 3))
        line = {
            "run": self._run,
            "robot": self._robot,
            "seq": self._seq,
            "lamport": lamport,
            "time": self._time,
            "label": label,
            "move": move,
            "detail": detail,
            "slot": slot,
        }
        with _writing(self._path):
            self._file.write(json.dumps(line, ensure_ascii=True) + "\n")
            self._file.flush()
            if label == "ntf":
                os.fsync(self._file.fileno())
        self._seq += 1

    def close(self) -> None:
        """Close the file."""
        # Every line was flushed, or its fault raised, when it was written: nothing new can fail here.
        with suppress(OSError):
            self._file.close()


@contextmanager
def _writing(path: Path) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        raise Fault(LOG_FAILED, f"{path}: cannot be written: {error.strerror or error}") from error
