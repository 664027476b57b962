"""The black box: all decisions, messages and positions of a robot, one JSON object a line.

Next to the log of steps, ``NAME.jsonl``, lies ``NAME.blackbox.ndjson``. Every line has `run`, `robot`,
`time` (seconds of the run), `wall` (UTC) and `kind`; the other keys depend on the kind:

``start``     plan, process, link, vehicle, firmware, home, system, versions
``fix``       place, speed, heading, energy, mode, armed
``text``      severity, text: a message of the vehicle
``command``   name, params, result, seconds, tries
``upload``    what, items, seconds
``parameter`` name, value, was
``decision``  what, why, response
``failed``    error, trace: an error of the program
``order``     order, confirmed, seconds, why; of an answer, question and says, too
``injected``  fault, state: an injected fault
``wait``      slots, seconds
``photo``     index, place
``reported``  name, content
``measured``  name, content
``message``   direction, type, fields
``counted``   frames: numbers by type
"""

from __future__ import annotations

import json
import os
import threading
import time
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict, is_dataclass
from datetime import UTC, datetime
from math import isfinite
from pathlib import Path
from typing import IO, TYPE_CHECKING

from ..screen import say
from .disk import sync
from .entries import entry_in

if TYPE_CHECKING:
    from concurrent.futures import Future

BOX = ".blackbox"
BOX_SUFFIX = ".ndjson"

LARGEST_PART = 32 * 1024 * 1024
"""Bytes after which a new file is begun."""

LONGEST_END = 1 << 16
"""Bytes at either end of a file in which its first and last lines are looked for."""

DIGITS = 9
KEPT_AT_ONCE = frozenset({"start", "decision", "failed", "order"})
"""Kinds that are to be on the disk soon after they are written, and are written later where that fails."""

OWED = 1000
"""How many lines are kept until they can be written, at most; then the oldest are given up."""


def black_box_path(log: Path) -> Path:
    """Return where the black box of a robot lies, given the path of its log of steps."""
    return log.with_name(f"{log.stem}{BOX}{BOX_SUFFIX}")


def last_time(path: Path) -> float:
    """Return the seconds of the run at which a black box ends; 0: it does not say."""
    try:
        with path.open("rb") as file:
            file.seek(-min(LONGEST_END, file.seek(0, os.SEEK_END)), os.SEEK_END)
            lines = file.read().splitlines()
    except OSError:
        return 0.0
    entries = (entry_in(line)[0] for line in reversed(lines))
    return next((entry.time for entry in entries if entry is not None), 0.0)


def plan_of(path: Path) -> str:
    """Return the plan of the mission at the beginning of a black box; empty: it has none."""
    oldest = _part(path, 1)
    try:
        with (oldest if oldest.exists() else path).open("rb") as file:
            lines = file.read(LONGEST_END).splitlines()
    except OSError:
        return ""
    entries = (entry for line in lines if (entry := entry_in(line)[0]) is not None)
    reported = (entry.content.get("plan") for entry in entries if entry.kind == "start")
    return next((plan for plan in reported if isinstance(plan, str)), "")


def _part(path: Path, number: int) -> Path:
    return path.with_suffix(f".{number:04d}{BOX_SUFFIX}")


class BlackBox:
    """Appends lines to a robot's black box; any thread may.

    A black box that cannot be written stops no robot: it is said once, and tried again with the next
    line, before which come the lines that matter most of those that could not be written. A file that
    has grown large is put aside as ``NAME.blackbox.0001.ndjson``, and so on; the one without a number
    is the newest.
    """

    def __init__(
        self,
        path: Path,
        run: str,
        robot: str,
        now: Callable[[], float],
        *,
        mark: Mapping[str, object] | None = None,
        largest: int = LARGEST_PART,
        say: Callable[[str], None] = say,
    ) -> None:
        """Continue a file, or begin one.

        Args:
            path: of the file; its folder is made.
            run: identifier of the run.
            robot: whose box it is.
            now: gives the seconds of the run.
            mark: further keys of every line, such as that there was no vehicle.
            largest: bytes after which a new file is begun.
            say: reports that it cannot be written.
        """
        self._path = path
        self._head = {"run": run, "robot": robot}
        self._now = now
        self._mark = dict(mark or {})
        self._largest = largest
        self._say = say
        self._said = False
        self._owed: deque[tuple[bytes, bool]] = deque(maxlen=OWED)
        self._lock = threading.Lock()
        self._file: IO[bytes] | None = None
        self._closed = False
        self._syncing: Future[None] | None = None

    def write(self, kind: str, **content: object) -> None:
        """Append one line; nothing is raised where that fails."""
        wall = (
            datetime.fromtimestamp(time.time(), UTC).isoformat(timespec="milliseconds").replace("+00:00", "Z")
        )
        line = {**self._head, "time": round(self._now(), 3), "wall": wall, "kind": kind}
        data = json.dumps(line | self._mark | {name: plain(value) for name, value in content.items()})
        with self._lock:
            if not self._closed:
                self._owed.append((data.encode("ascii") + b"\n", kind in KEPT_AT_ONCE))
                self._settle()

    def close(self) -> None:
        """Write no more than what could not be written before."""
        with self._lock:
            self._closed = True
            self._settle()
            self._let_go()
        if self._syncing is not None:
            self._syncing.result()

    def _settle(self) -> None:
        try:
            while self._owed:
                self._append(*self._owed[0])
                self._owed.popleft()
        except OSError as error:
            self._complain(error)
            self._owed = deque((each for each in self._owed if each[1]), OWED)

    def _append(self, data: bytes, at_once: bool) -> None:
        file = self._file if self._file is not None else self._open()
        if file.tell() + len(data) > self._largest and file.tell() > 0:
            self._let_go()
            self._path.rename(self._next_part())
            file = self._open()
        file.write(data)
        file.flush()
        if at_once:
            self._syncing = sync(file, self._synced)

    def _synced(self, error: OSError | None) -> None:
        if error is not None:
            with self._lock:
                self._complain(error)

    def _open(self) -> IO[bytes]:
        self._path.parent.mkdir(parents=True, exist_ok=True)
        file = self._file = self._path.open("a+b")
        if file.tell() > 0:
            file.seek(-1, os.SEEK_END)
            if file.read(1) != b"\n":
                # Something was cut off here; what follows must not become part of it.
                file.write(b"\n")
        return file

    def _next_part(self) -> Path:
        number = 1
        while (part := _part(self._path, number)).exists():
            number += 1
        return part

    def _let_go(self) -> None:
        file, self._file = self._file, None
        if file is not None:
            # What could not be written was complained of when it was: closing only tries it again.
            with suppress(OSError):
                file.close()

    def _complain(self, error: OSError) -> None:
        self._let_go()
        if not self._said:
            self._said = True
            self._say(f"{self._path}: the black box cannot be written: {error.strerror or error}")


def plain(value: object) -> object:
    """Return a value as JSON has it: NaN is null, values that JSON does not know are text."""
    if value is None or isinstance(value, str | bool | int):
        return value
    if isinstance(value, float):
        return round(value, DIGITS) if isfinite(value) else None
    if isinstance(value, bytes | bytearray):
        return value.hex()
    if is_dataclass(value) and not isinstance(value, type):
        return plain(asdict(value))
    if isinstance(value, Mapping):
        return {str(name): plain(each) for name, each in value.items()}
    if isinstance(value, Sequence | set | frozenset):
        return [plain(each) for each in value]
    return str(value)
