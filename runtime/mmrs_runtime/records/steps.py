"""Steps of robots, as lines of their logs record them; the schema of a line lies beside this module."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from hashlib import sha256
from math import inf, isfinite
from pathlib import Path
from typing import NamedTuple
from urllib.parse import quote

SCHEMA = Path(__file__).with_name("log.schema.json")
SUFFIX = ".jsonl"
LABELS = ("act", "ntf", "begin", "end", "take", "choose", "fault")
LONGEST_LINE = 100_000
_LONGEST_NUMBER = 400
_LONGEST_NAME = 120


class StepRecord(NamedTuple):
    """A step: one label of the semantics of BL.

    Attributes:
        run: identifier of the run.
        robot: identifier of the robot.
        seq: counted from 0 in each robot's log, without gaps.
        lamport: logical time; a notify's is below that of every step that it enabled.
        time: seconds of the run's clock.
        label: ``act``, ``ntf``, ``begin``, ``end``, ``take``, ``choose`` or ``fault``.
        move: identifier of the move that the step belongs to.
        detail: of an act or ntf: index of the action, as ``pre:0`` or ``post:1``; of a take: the
            identifier of the next move; of a choose: ``true`` or ``false``; of a fault: which one.
        slot: of a ntf: the slots set, as ``robot.slot`` joined by blanks, with ``+`` or ``-`` before
            the first; empty otherwise.
    """

    run: str
    robot: str
    seq: int
    lamport: int
    time: float
    label: str
    move: str
    detail: str = ""
    slot: str = ""


_FIELDS = StepRecord._fields
_TEXT = json.encoder.encode_basestring
_COUNTS = ("seq", "lamport")
_NEVER_EMPTY = ("run", "robot", "move")


def log_name(robot: str) -> str:
    """Return the name of a robot's log; different robots have different ones, whatever their names."""
    name = quote(robot, safe="").replace(".", "%2E")
    if len(name) > _LONGEST_NAME or not name:
        name = f"{name[:_LONGEST_NAME]}%{sha256(robot.encode()).hexdigest()[:16]}"
    return name + SUFFIX


def merge(records: Iterable[StepRecord]) -> tuple[StepRecord, ...]:
    """Return the steps of all robots in one order in which they may have happened."""
    return tuple(sorted(records, key=lambda record: (record.lamport, record.robot, record.seq)))


def to_line(record: StepRecord) -> str:
    """Return a step as one line of a log, without the line's end."""
    if not isfinite(record.time):
        raise ValueError(f"time {record.time}: no number that JSON has")
    run, robot, seq, lamport, time, label, move, detail, slot = record
    return (
        f'{{"run":{_TEXT(run)},"robot":{_TEXT(robot)},"seq":{seq},"lamport":{lamport},"time":{time!r},'
        f'"label":"{label}","move":{_TEXT(move)},"detail":{_TEXT(detail)},"slot":{_TEXT(slot)}}}'
    )


def step_in(line: str) -> StepRecord:
    """Return the step in a line of a log.

    Raises:
        ValueError: there is none; the message says everything that is wrong with the line.
    """
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


def _whole(text: str) -> int:
    if len(text) > _LONGEST_NUMBER:
        raise ValueError(f"a whole number of {len(text)} digits: longer than any of a step")
    return int(text)


def _refuse(constant: str) -> float:
    raise ValueError(f"{constant}: not a number of JSON")
