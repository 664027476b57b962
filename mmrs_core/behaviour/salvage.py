"""Reads what is left of a damaged log, for people; the judge of runs takes whole logs only."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from mmrs_core.errors import UnreadableError
from mmrs_runtime.records.entries import Damage
from mmrs_runtime.records.steps import SUFFIX, StepRecord, step_in


def salvage_log(path: Path) -> tuple[tuple[StepRecord, ...], tuple[Damage, ...]]:
    """Return the steps in a log that can be read, and what cannot be.

    Raises:
        UnreadableError: if the file cannot be opened.
    """
    try:
        lines = path.read_bytes().splitlines()
    except OSError as error:
        raise UnreadableError(f"{path}: cannot be read as a log: {error.strerror or error}") from error
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
