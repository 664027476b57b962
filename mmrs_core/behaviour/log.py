"""Logs of runs: JSON Lines, one file a robot; the schema lies beside this module."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from contextlib import suppress
from dataclasses import asdict, fields
from hashlib import sha256
from math import inf
from pathlib import Path
from types import TracebackType
from typing import IO
from urllib.parse import quote

from mmrs_core.behaviour.steps import StepRecord
from mmrs_core.diagnostics import Diagnostic, Place, Severity
from mmrs_core.errors import InvalidModelError, UnreadableError
from mmrs_core.languages.codes import explained
from mmrs_core.resources import named
from mmrs_runtime.records.lines import append_whole, keep_whole_lines, whole_lines

SCHEMA = Path(__file__).with_name("log.schema.json")
SUFFIX = ".jsonl"
LABELS = ("act", "ntf", "begin", "end", "take", "choose", "fault")
LONGEST_LINE = 100_000
_LONGEST_NUMBER = 400

_FIELDS = tuple(field.name for field in fields(StepRecord))
_COUNTS = ("seq", "lamport")
_NEVER_EMPTY = ("run", "robot", "move")
_LONGEST_NAME = 120


def log_name(robot: str) -> str:
    """Return the name of a robot's log; different robots have different ones, whatever their names."""
    name = quote(robot, safe="").replace(".", "%2E")
    if len(name) > _LONGEST_NAME or not name:
        name = f"{name[:_LONGEST_NAME]}%{sha256(robot.encode()).hexdigest()[:16]}"
    return name + SUFFIX


def to_line(record: StepRecord) -> str:
    """Return the record as one line of a log, without the line's end."""
    return json.dumps(asdict(record), ensure_ascii=False, separators=(",", ":"), allow_nan=False)


class LogWriter:
    """Appends steps to one log a robot in a folder; the first step of a robot replaces an older log.

    A run that is resumed goes on with its logs instead, after their last whole lines. Every step is out of
    the process, a notify or a fault on the disk, when `write` returns, so that a notify written before it is
    delivered survives whatever happens next. Of what cannot be written, nothing is left in the log; a fault
    is tried once more when it is closed.
    """

    def __init__(self, folder: Path, *, resumed: bool = False) -> None:
        """Open no file yet; make the folder where it is missing."""
        folder.mkdir(parents=True, exist_ok=True)
        self._folder, self._resumed = folder, resumed
        self._files: dict[str, IO[bytes]] = {}
        self._owed: dict[str, StepRecord] = {}

    def write(self, record: StepRecord) -> None:
        """Append a step to its robot's log.

        Raises:
            OSError: it cannot be written.
        """
        if record.label == "fault":
            self._owed[record.robot] = record
        self._append(record)
        self._owed.pop(record.robot, None)

    def close(self) -> None:
        """Write the faults that could not be written before, as on a full disk; close all files."""
        while self._owed:
            with suppress(OSError):
                self._append(self._owed.popitem()[1])
        while self._files:
            self._files.popitem()[1].close()

    def _append(self, record: StepRecord) -> None:
        with named(self._folder / log_name(record.robot)):
            file = self._files.get(record.robot) or self._opened(record.robot)
            line = to_line(record).encode("utf-8") + b"\n"
            append_whole(file, line, at_once=record.label in ("ntf", "fault"))

    def _opened(self, robot: str) -> IO[bytes]:
        path = self._folder / log_name(robot)
        if self._resumed and path.exists():
            keep_whole_lines(path)
        file: IO[bytes] = path.open("ab" if self._resumed else "wb", buffering=0)
        self._files[robot] = file
        return file

    def __enter__(self) -> LogWriter:
        """Return the writer."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Close all files."""
        self.close()


def read_log(path: Path, *, partial: bool = False) -> tuple[StepRecord, ...]:
    """Return the steps in a log, in the order of its lines.

    Args:
        path: of the log.
        partial: pass over a last line that was cut off while it was written, and over lines behind the
            last whole one that are no JSON: after a loss of power, disks leave rubbish there.

    Raises:
        UnreadableError: if the file cannot be read.
        InvalidModelError: if lines are not steps; every such line is reported.
    """
    try:
        data = path.read_bytes()
    except OSError as error:
        raise UnreadableError(f"{path}: cannot be read as a log: {error.strerror or error}") from error
    lines = whole_lines(data) if partial else data.removesuffix(b"\n").split(b"\n") if data else []
    return _records(
        [_text(line, f"{path}:{number}") for number, line in enumerate(lines, start=1)], str(path)
    )


def _text(line: bytes, where: str) -> str:
    try:
        return line.decode("utf-8")
    except UnicodeDecodeError as error:
        raise UnreadableError(f"{where}: cannot be read as a log: {error.reason} in UTF-8") from error


def read_logs(paths: Iterable[Path], *, partial: bool = False) -> tuple[StepRecord, ...]:
    """Return the steps of several logs, merged; a folder stands for all logs in it.

    Raises:
        UnreadableError: if a file cannot be read, or a folder holds no log.
        InvalidModelError: if lines are not steps.
    """
    records: list[StepRecord] = []
    for path in paths:
        for file in _logs_in(path):
            records.extend(read_log(file, partial=partial))
    return merge(records)


def merge(records: Iterable[StepRecord]) -> tuple[StepRecord, ...]:
    """Return the steps of all robots in one order in which they may have happened."""
    return tuple(sorted(records, key=lambda record: (record.lamport, record.robot, record.seq)))


def faults_of(value: object) -> tuple[str, ...]:
    """Return what keeps a JSON value from being a step; empty if nothing does."""
    if not isinstance(value, Mapping):
        return (f"{type(value).__name__}: not an object",)
    missing = [f"{name}: missing" for name in _FIELDS if name not in value]
    unknown = [f"{name}: unknown field" for name in value if name not in _FIELDS]
    wrong = [fault for name in _FIELDS if name in value and (fault := _field_fault(name, value[name]))]
    return (*missing, *unknown, *wrong)


def _field_fault(name: str, value: object) -> str:
    if name in _COUNTS:
        whole = isinstance(value, int | float) and not isinstance(value, bool) and value == value // 1
        return "" if whole and value >= 0 else f"{name}: {value!r} is not a whole number from 0 on"  # type: ignore[operator]
    if name == "time":
        number = isinstance(value, int | float) and not isinstance(value, bool)
        return "" if number and 0 <= value < inf else f"time: {value!r} is not a number from 0 on"  # type: ignore[operator]
    if not isinstance(value, str):
        return f"{name}: {value!r} is not text"
    if name == "label" and value not in LABELS:
        return f"label: {value!r} is none of {', '.join(LABELS)}"
    return f"{name}: empty" if name in _NEVER_EMPTY and not value else ""


def _records(lines: Iterable[str], file: str) -> tuple[StepRecord, ...]:
    records: list[StepRecord] = []
    faults: list[Diagnostic] = []
    for number, line in enumerate(lines, start=1):
        place = Place(file, number)
        try:
            records.append(_record(line))
        except ValueError as error:
            faults.append(explained(Diagnostic("LOG001", Severity.ERROR, str(error), place)))
    if faults:
        raise InvalidModelError(f"{file}: {len(faults)} lines are not steps", faults)
    return tuple(records)


def _record(line: str) -> StepRecord:
    if len(line) > LONGEST_LINE:
        raise ValueError(f"line of {len(line)} characters: longer than any step")
    try:
        value: object = json.loads(line, parse_constant=_refuse, parse_int=_whole)
    except RecursionError:
        raise ValueError("line nested too deeply to be a step") from None
    except json.JSONDecodeError as error:
        raise ValueError(f"line is not JSON: {error.msg} at column {error.colno}") from None
    if faults := faults_of(value):
        raise ValueError("; ".join(faults))
    assert isinstance(value, dict)
    counts = {name: int(value[name]) for name in _COUNTS}
    return StepRecord(**{**value, **counts, "time": float(value["time"])})


def _whole(text: str) -> int:
    if len(text) > _LONGEST_NUMBER:
        raise ValueError(f"a whole number of {len(text)} digits: longer than any of a step")
    return int(text)


def _refuse(constant: str) -> float:
    raise ValueError(f"{constant}: not a number of JSON")


def _logs_in(path: Path) -> tuple[Path, ...]:
    if not path.is_dir():
        return (path,)
    found = tuple(sorted(path.glob(f"*{SUFFIX}")))
    if not found:
        raise UnreadableError(f"{path}: no log in this folder")
    return found
