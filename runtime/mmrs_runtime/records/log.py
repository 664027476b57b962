"""The log of a robot: what happened, in the order in which it happened, one JSON object a line."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import IO, Any

from ..faults import LOG_FAILED, Fault
from .lines import append_whole, keep_whole_lines, whole_lines

FIELDS = frozenset({"run", "robot", "seq", "lamport", "time", "label", "move", "detail", "slot"})
KEPT_AT_ONCE = frozenset({"ntf", "fault"})
"""Labels of steps that are on the disk when they have been written."""


class Log:
    """Writes steps. Every line is out of the process before the robot goes on.

    Attributes:
        steps: all that are in the file, those of before a break included.
    """

    def __init__(self, path: Path, run: str, robot: str, *, resume: bool = False) -> None:
        """Open a new file, or go on with one; a last line that was cut off is taken away then.

        Raises:
            Fault: it cannot be, or there is one already and it is not to be gone on with; logs are
                never overwritten.
        """
        self.steps: list[dict[str, Any]] = list(read(path)) if resume else []
        with _writing(path):
            path.parent.mkdir(parents=True, exist_ok=True)
            if resume and path.exists():
                keep_whole_lines(path)
            self._file: IO[bytes] = path.open("ab" if resume else "xb", buffering=0)
        self._owed: dict[str, Any] | None = None
        self._path = path
        self._run = run
        self._robot = robot
        self._time = float(self.steps[-1]["time"]) if self.steps else 0.0

    def write(
        self, label: str, move: str, *, lamport: int, time: float, detail: str = "", slot: str = ""
    ) -> None:
        """Write one step; a notify or a fault is on the disk when this returns.

        Raises:
            Fault: it cannot be written; nothing of it is left in the file then.
        """
        self._time = max(self._time, round(time, 3))
        line: dict[str, Any] = {
            "run": self._run,
            "robot": self._robot,
            "seq": len(self.steps),
            "lamport": lamport,
            "time": self._time,
            "label": label,
            "move": move,
            "detail": detail,
            "slot": slot,
        }
        self._owed = line if label == "fault" else None
        with _writing(self._path):
            self._append(line)

    def close(self) -> None:
        """Close the file, after a fault that could not be written before, as on a full disk.

        One without steps is taken away, so that nobody takes it for a run's.
        """
        with suppress(OSError):
            if self._owed is not None:
                self._append(self._owed)
        # Every line was written, or its fault raised, before: nothing new can fail here.
        with suppress(OSError):
            self._file.close()
            if not self.steps and not self._path.stat().st_size:
                self._path.unlink()

    def _append(self, line: dict[str, Any]) -> None:
        data = json.dumps(line, ensure_ascii=True).encode("ascii") + b"\n"
        append_whole(self._file, data, at_once=line["label"] in KEPT_AT_ONCE)
        self.steps.append(line)
        self._owed = None


def read(path: Path) -> tuple[dict[str, Any], ...]:
    """Return the whole lines of a log; none where there is no such file.

    Raises:
        Fault: it cannot be read, or a line is no step.
    """
    try:
        data = path.read_bytes() if path.exists() else b""
        steps = tuple(json.loads(line) for line in whole_lines(data))
    except (OSError, ValueError, RecursionError) as error:
        raise Fault(LOG_FAILED, f"{path}: cannot be read: {error}") from error
    for number, step in enumerate(steps):
        if not isinstance(step, dict) or not step.keys() >= FIELDS or step["seq"] != number:
            raise Fault(LOG_FAILED, f"{path}:{number + 1}: is not the next step of a log")
    return steps


@contextmanager
def _writing(path: Path) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        raise Fault(LOG_FAILED, f"{path}: cannot be written: {error.strerror or error}") from error
