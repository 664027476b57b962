"""The log of a robot: what happened, in the order in which it happened, one JSON object a line."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import IO


class Log:
    """Writes steps. Every line is out of the process before the robot goes on."""

    def __init__(self, path: Path, run: str, robot: str) -> None:
        """Open a new file.

        Raises:
            FileExistsError: there is one already; logs are never overwritten.
        """
        path.parent.mkdir(parents=True, exist_ok=True)
        self._file: IO[str] = path.open("x", encoding="ascii", newline="\n")
        self._run = run
        self._robot = robot
        self._seq = 0
        self._time = 0.0

    def write(
        self, label: str, move: str, *, lamport: int, time: float, detail: str = "", slot: str = ""
    ) -> None:
        """Write one step; a notify is on the disk before it is delivered."""
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
        self._file.write(json.dumps(line, ensure_ascii=True) + "\n")
        self._file.flush()
        if label == "ntf":
            os.fsync(self._file.fileno())
        self._seq += 1

    def close(self) -> None:
        """Close the file."""
        self._file.close()


class Records:
    """What a robot reported and measured, one JSON object a line; the file appears with the first."""

    def __init__(self, path: Path) -> None:
        """Keep the path; nothing is opened yet."""
        self._path = path

    def add(self, **fields: object) -> None:
        """Append one record."""
        with self._path.open("a", encoding="ascii", newline="\n") as file:
            file.write(json.dumps(fields, ensure_ascii=True, default=str) + "\n")
