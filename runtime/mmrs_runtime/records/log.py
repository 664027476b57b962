"""Logs of robots, a file each: what happened, in the order in which it happened, one JSON object a line."""

from __future__ import annotations

from contextlib import ExitStack, suppress
from pathlib import Path
from types import TracebackType
from typing import IO, TYPE_CHECKING, Literal

from ..faults import LOG_FAILED, FaultError
from .disk import Kept, sync
from .lines import append_whole, keep_whole_lines, whole_lines
from .steps import StepRecord, log_name, step_in, to_line

if TYPE_CHECKING:
    from concurrent.futures import Future


class LogFile:
    """One robot's log. A step is out of the process once it is written, on the disk once that was asked for.

    So what is written and synced before it has an effect survives whatever happens next. Of what cannot be
    written, nothing is left in the log; a fault is tried once more when it is closed.
    """

    def __init__(self, path: Path, mode: Literal["a", "w"], *, synced: bool = True) -> None:
        """Create without opening a file.

        Args:
            path: of the log.
            mode: ``a``: continue after its last whole line; ``w``: replace it.
            synced: whether a step has left the process once it is written; otherwise nothing is known to be
                there before the log is closed.
        """
        self._path, self._mode, self._synced = path, mode, synced
        self._file: IO[bytes] | None = None
        self._owed: StepRecord | None = None
        self._syncing: Future[None] | None = None

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

    def sync(self, kept: Kept) -> None:
        """Write the log to the disk; `kept` is called then, from another thread.

        Raises:
            OSError: there are too many open files.
        """
        if self._synced:
            self._syncing = sync(self.open(), kept)
        else:
            kept(None)

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
        if self._syncing is not None:
            self._syncing.result()
        if self._file is not None:
            # Every line was written, or its fault raised, before: nothing new can fail here.
            with suppress(OSError):
                self._file.close()
                if not self._path.stat().st_size:
                    self._path.unlink()

    def _append(self, record: StepRecord) -> None:
        line = to_line(record).encode("utf-8") + b"\n"
        try:
            if self._synced:
                append_whole(self.open(), line)
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

    A run that is resumed continues its logs instead, after their last whole lines.
    """

    def __init__(self, folder: Path, *, resumed: bool = False, synced: bool = True) -> None:
        """Create without open files; make the folder where it is missing.

        Args:
            folder: of the logs.
            resumed: whether to continue existing logs.
            synced: whether steps survive whatever happens next; a simulation can be repeated.
        """
        folder.mkdir(parents=True, exist_ok=True)
        self._folder, self._resumed, self._synced = folder, resumed, synced
        self._files: dict[str, LogFile] = {}

    def write(self, record: StepRecord) -> None:
        """Append a step to its robot's log.

        Raises:
            OSError: it cannot be written.
        """
        file = self._files.get(record.robot)
        if file is None:
            path = self._folder / log_name(record.robot)
            file = LogFile(path, "a" if self._resumed else "w", synced=self._synced)
            self._files[record.robot] = file
        file.write(record)

    def sync(self, robot: str, kept: Kept) -> None:
        """Write a robot's log to the disk, as `LogFile.sync` does."""
        if robot in self._files:
            self._files[robot].sync(kept)
        else:
            kept(None)

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


def read(path: Path) -> tuple[StepRecord, ...]:
    """Return the steps in the whole lines of a log; none where there is no such file.

    Raises:
        FaultError: it cannot be read, or a line is not a step.
    """
    try:
        lines = whole_lines(path.read_bytes()) if path.exists() else []
    except OSError as error:
        raise FaultError(LOG_FAILED, f"{path}: cannot be read: {error}") from error
    return tuple(_next_step(line, number, path) for number, line in enumerate(lines))


def _next_step(line: bytes, number: int, path: Path) -> StepRecord:
    try:
        step = step_in(line.decode("utf-8"))
    except ValueError as error:
        raise FaultError(LOG_FAILED, f"{path}:{number + 1}: cannot be read: {error}") from error
    if step.seq != number:
        raise FaultError(LOG_FAILED, f"{path}:{number + 1}: is not the next step of a log")
    return step
