"""Logs of robots, a file each: what happened, in the order in which it happened, one JSON object a line."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from types import TracebackType
from typing import IO, Literal

from ..faults import LOG_FAILED, Fault
from .lines import append_whole, keep_whole_lines, whole_lines
from .steps import StepRecord, log_name, step_in, to_line

KEPT_AT_ONCE = frozenset({"ntf", "fault"})
"""Labels of steps that are on the disk when they have been written."""


class LogFile:
    """One robot's log. Every step is out of the process, a notify or a fault on the disk, once it is written.

    So a notify that is written before it is delivered survives whatever happens next. Of what cannot be
    written, nothing is left in the log; a fault is tried once more when it is closed.
    """

    def __init__(
        self, path: Path, mode: Literal["a", "w", "x"], *, spaced: bool = False, synced: bool = True
    ) -> None:
        """Open nothing yet.

        Args:
            path: of the log.
            mode: ``a``: go on after its last whole line; ``w``: replace it; ``x``: refuse one that is there.
            spaced: as `to_line` takes it.
            synced: whether a step is out of the process, and a notify or a fault on the disk, once it is
                written; else nothing is known to be there before the log is closed.
        """
        self._path, self._mode, self._spaced, self._synced = path, mode, spaced, synced
        self._file: IO[bytes] | None = None
        self._owed: StepRecord | None = None

    def open(self) -> IO[bytes]:
        """Return the open file; its folder is made.

        Raises:
            OSError: it cannot be opened.
        """
        if self._file is None:
            self._path.parent.mkdir(parents=True, exist_ok=True)
            if self._mode == "a" and self._path.exists():
                keep_whole_lines(self._path)
            buffering = 0 if self._synced else -1
            self._file = self._path.open(f"{self._mode}b", buffering=buffering)
        return self._file

    def write(self, record: StepRecord) -> None:
        """Append a step.

        Raises:
            OSError: it cannot be written; it names the file.
        """
        if record.label == "fault":
            self._owed = record
        self._append(record)
        self._owed = None

    def close(self) -> None:
        """Close the file, after a fault that could not be written before, as on a full disk.

        One without steps is taken away, so that it is not taken for a run's.

        Raises:
            OSError: not all is written, in a log that is not synced.
        """
        if self._file is not None and not self._synced:
            try:
                self._file.close()
            except OSError as error:
                raise self._named(error) from None
            return
        with suppress(OSError):
            if self._owed is not None:
                self._append(self._owed)
        if self._file is not None:
            # Every line was written, or its fault raised, before: nothing new can fail here.
            with suppress(OSError):
                self._file.close()
                if not self._path.stat().st_size:
                    self._path.unlink()

    def _append(self, record: StepRecord) -> None:
        line = to_line(record, spaced=self._spaced).encode("utf-8") + b"\n"
        try:
            if self._synced:
                append_whole(self.open(), line, at_once=record.label in KEPT_AT_ONCE)
            else:
                self.open().write(line)
        except OSError as error:
            raise self._named(error) from None

    def _named(self, error: OSError) -> OSError:
        """Return an error about the file that names it."""
        error.filename = error.filename or str(self._path)
        return error


class LogWriter:
    """Appends steps to one log a robot in a folder; the first step of a robot replaces an older log.

    A run that is resumed goes on with its logs instead, after their last whole lines.
    """

    def __init__(self, folder: Path, *, resumed: bool = False, synced: bool = True) -> None:
        """Open no file yet; make the folder where it is missing.

        Args:
            folder: of the logs.
            resumed: whether to go on with logs that are there.
            synced: whether steps survive whatever happens next; what is simulated can be simulated again.
        """
        folder.mkdir(parents=True, exist_ok=True)
        self._folder, self._resumed, self._synced = folder, resumed, synced
        self._files: dict[str, LogFile] = {}

    def write(self, record: StepRecord) -> None:
        """Append a step to its robot's log.

        Raises:
            OSError: it cannot be written.
        """
        if record.robot not in self._files:
            path = self._folder / log_name(record.robot)
            self._files[record.robot] = LogFile(path, "a" if self._resumed else "w", synced=self._synced)
        self._files[record.robot].write(record)

    def close(self) -> None:
        """Close all files, after faults that could not be written before.

        Raises:
            OSError: not all is written, in logs that are not synced.
        """
        with ExitStack() as stack:
            while self._files:
                stack.callback(self._files.popitem()[1].close)

    def __enter__(self) -> LogWriter:
        """Return the writer."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Close all files."""
        self.close()


class Log:
    """Numbers and writes the steps of one controller.

    Attributes:
        steps: all that are in the file, those of before a break included.
    """

    def __init__(self, path: Path, run: str, robot: str, *, resume: bool = False) -> None:
        """Open a new file, or go on with one; a last line that was cut off is taken away then.

        Raises:
            Fault: it cannot be, or there is one already and it is not to be gone on with; logs are
                never overwritten.
        """
        self.steps: list[StepRecord] = list(read(path)) if resume else []
        self._file = LogFile(path, "a" if resume else "x", spaced=True)
        with _writing(path):
            self._file.open()
        self._path = path
        self._run = run
        self._robot = robot
        self._time = self.steps[-1].time if self.steps else 0.0

    def write(
        self, label: str, move: str, *, lamport: int, time: float, detail: str = "", slot: str = ""
    ) -> None:
        """Write one step; a notify or a fault is on the disk when this returns.

        Raises:
            Fault: it cannot be written; nothing of it is left in the file then.
        """
        self._time = max(self._time, round(time, 3))
        seq = len(self.steps)
        step = StepRecord(self._run, self._robot, seq, lamport, self._time, label, move, detail, slot)
        with _writing(self._path):
            self._file.write(step)
        self.steps.append(step)

    def close(self) -> None:
        """Close the file, as `LogFile.close` does."""
        self._file.close()


def read(path: Path) -> tuple[StepRecord, ...]:
    """Return the steps in the whole lines of a log; none where there is no such file.

    Raises:
        Fault: it cannot be read, or a line is no step.
    """
    try:
        lines = whole_lines(path.read_bytes()) if path.exists() else []
    except OSError as error:
        raise Fault(LOG_FAILED, f"{path}: cannot be read: {error}") from error
    return tuple(_next_step(line, number, path) for number, line in enumerate(lines))


def _next_step(line: bytes, number: int, path: Path) -> StepRecord:
    try:
        step = step_in(line.decode("utf-8"))
    except ValueError as error:
        raise Fault(LOG_FAILED, f"{path}:{number + 1}: cannot be read: {error}") from error
    if step.seq != number:
        raise Fault(LOG_FAILED, f"{path}:{number + 1}: is not the next step of a log")
    return step


@contextmanager
def _writing(path: Path) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        raise Fault(LOG_FAILED, f"{path}: cannot be written: {error.strerror or error}") from error
