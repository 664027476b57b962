"""Reads logs of runs: whole ones, and what is left of damaged ones."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from mmrs_core.diagnostics import Diagnostic, Place, Severity
from mmrs_core.errors import InvalidModelError, UnreadableError
from mmrs_core.languages.codes import explained
from mmrs_runtime.records.entries import Damage
from mmrs_runtime.records.lines import whole_lines
from mmrs_runtime.records.steps import SUFFIX, StepRecord, merge, step_in


def read_log(path: Path, *, partial: bool = False) -> tuple[StepRecord, ...]:
    """Return the steps in a log, in the order of its lines.

    Args:
        path: of the log.
        partial: pass over a last line that was cut off while it was written, and over lines behind the
            last whole one that are not JSON: after a loss of power, disks leave rubbish there.

    Raises:
        UnreadableError: if the file cannot be read.
        InvalidModelError: if lines are not steps; every such line is reported.
    """
    try:
        data = path.read_bytes()
    except OSError as error:
        raise UnreadableError(
            f"{path}: cannot be read as a log: {(error.strerror or str(error)).lower()}"
        ) from error
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


def _records(lines: Iterable[str], file: str) -> tuple[StepRecord, ...]:
    records: list[StepRecord] = []
    faults: list[Diagnostic] = []
    for number, line in enumerate(lines, start=1):
        place = Place(file, number)
        try:
            records.append(step_in(line))
        except ValueError as error:
            faults.append(explained(Diagnostic("LOG001", Severity.ERROR, str(error), place)))
    if faults:
        raise InvalidModelError(f"{file}: {len(faults)} lines are not steps", faults)
    return tuple(records)


def _logs_in(path: Path) -> tuple[Path, ...]:
    if not path.is_dir():
        return (path,)
    found = tuple(sorted(path.glob(f"*{SUFFIX}")))
    if not found:
        raise UnreadableError(f"{path}: no log in this folder")
    return found


def recover_log(path: Path) -> tuple[tuple[StepRecord, ...], tuple[Damage, ...]]:
    """Return the steps in a log that can be read, and what cannot be.

    Raises:
        UnreadableError: if the file cannot be opened.
    """
    try:
        lines = path.read_bytes().splitlines()
    except OSError as error:
        raise UnreadableError(
            f"{path}: cannot be read as a log: {(error.strerror or str(error)).lower()}"
        ) from error
    records: list[StepRecord] = []
    damages: list[Damage] = []
    for number, line in enumerate(lines, start=1):
        record, fault = _record(line)
        if record is not None:
            records.append(record)
        elif line.strip():
            cut = number == len(lines) and not line.endswith(b"}")
            damages.append(Damage(path.name, number, "cut off while it was written" if cut else fault))
    return tuple(records), tuple(damages)


def logs_in(paths: Iterable[Path]) -> tuple[Path, ...]:
    """Return the logs that paths lead to, each once: a folder stands for all in it.

    Other files, such as the parts of a black box, are none.
    """
    found: dict[Path, Path] = {}
    for path in paths:
        for log in sorted(path.glob(f"*{SUFFIX}")) if path.is_dir() else [path]:
            found.setdefault(log.resolve(), log)
    return tuple(path for path in found.values() if path.suffix == SUFFIX)


def _record(line: bytes) -> tuple[StepRecord | None, str]:
    try:
        return step_in(line.decode("utf-8")), ""
    except UnicodeDecodeError:
        fault = "not JSON"
    except ValueError as error:
        fault = str(error)
    return None, "zero bytes, as power loss leaves them" if b"\0" in line else fault
