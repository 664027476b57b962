"""Lays the times of robots that had processes of their own over each other, by the time of day.

Each process counts the seconds of a run from its own start; a black box has the time of day beside them.
"""

from __future__ import annotations

from array import array
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import datetime

import numpy as np

from mmrs_core.geometry.frames import Floats
from mmrs_runtime.records.entries import Entry

SAME = 0.02
"""Seconds by which the clocks of robots of one process differ at most, as they are written."""
LONG = 0.2
"""Shortest process, in seconds, whose speed-up can be estimated: lines are late by milliseconds."""


@dataclass(slots=True)
class Readings:
    """The clock of one robot: the time of the run and the time of day, in each process that it had.

    Attributes:
        names: of these processes; robots of one process have the same clock. Empty: unknown.
    """

    names: list[str] = field(default_factory=list)
    _processes: list[array[float]] = field(default_factory=list)
    _named: bool = False

    def add(self, entry: Entry) -> None:
        """Take both times of an entry; one without a readable time of day is ignored."""
        began = entry.kind == "start"
        if not self._processes or (began and self._named):
            self._processes.append(array("d"))
            self.names.append("")
        if began:  # what is noted before the first one is of the same process
            self.names[-1], self._named = str(entry.content.get("process", "")), True
        try:
            of_day = datetime.fromisoformat(entry.wall).timestamp()
        except (ValueError, OverflowError, OSError):
            return
        self._processes[-1].extend((entry.time, of_day))

    @property
    def processes(self) -> tuple[Floats, ...]:
        """Return (n, 2) times of the run and of the day for each process."""
        return tuple(np.frombuffer(each).reshape(-1, 2) for each in self._processes)


@dataclass(frozen=True, slots=True)
class Shift:
    """Seconds by which the times of a robot are to be moved.

    Attributes:
        since: from which times on, one for each process; by: seconds, as many.
    """

    since: tuple[float, ...] = (0.0,)
    by: tuple[float, ...] = (0.0,)

    def times(self, times: Floats) -> Floats:
        """Return (n,) times moved; they never fall where they did not before."""
        number = np.clip(np.searchsorted(self.since, times, side="right") - 1, 0, None)
        moved = times + np.asarray(self.by)[number]
        falls = np.diff(times, prepend=times[:1]) < 0.0
        return moved if falls.any() else np.maximum.accumulate(moved)

    def time(self, time: float) -> float:
        """Return one time, moved."""
        return float(self.times(np.array([time]))[0])


def shifts_of(clocks: Mapping[str, Readings]) -> tuple[dict[str, Shift], tuple[str, ...]]:
    """Return the shifts of robots' times, and notes on them.

    Times are those of the robot that began first. Robots without times of day, and those that were in
    another number of processes than that one, stay as they are.

    Args:
        clocks: by robot.
    """
    processes = {robot: each.processes for robot, each in clocks.items()}
    known = {robot: each for robot, each in processes.items() if each and all(len(part) for part in each)}
    pace = _pace([part for each in known.values() for part in each])
    zeros = {robot: [_zero(part, pace) for part in each] for robot, each in known.items()}
    if not zeros:
        return {}, ()
    first = min(zeros, key=lambda robot: zeros[robot][0])
    shifts: dict[str, Shift] = {}
    notes = []
    for robot, own in zeros.items():
        later = own[0] - zeros[first][0]
        if len(own) != len(zeros[first]):
            notes.append(f"{robot}: was restarted differently from {first}: their times may not agree")
            continue
        names = zip(clocks[robot].names, clocks[first].names, strict=True)
        same = [bool(mine) and mine == its for mine, its in names]
        pairs = zip(own, zeros[first], same, strict=True)
        by = [0.0 if one else pace * (mine - its) for mine, its, one in pairs]
        if max(map(abs, by)) <= SAME * max(1.0, pace):
            continue
        shifts[robot] = Shift(tuple(float(part[0, 0]) for part in known[robot]), tuple(by))
        notes.append(
            f"{robot}: its process began {later:.1f} s after that of {first}, by the time of day;"
            f" its times are counted as those of {first}"
        )
    return shifts, tuple(notes)


def zero_of(clocks: Iterable[Readings]) -> float | None:
    """Return the earliest time of day at which a robot counted 0, seconds since 1970; None where unknown."""
    known = [[part for part in each.processes if len(part)] for each in clocks]
    pace = _pace([part for parts in known for part in parts])
    return min((_zero(parts[0], pace) for parts in known if parts), default=None)


def _pace(parts: Sequence[Floats]) -> float:
    """Return how many seconds of the run pass in one of the day; 1 where no process was long enough."""
    spans = [(day, run) for run, day in (part[-1] - part[0] for part in parts) if run > 0.0]
    day, run = max(spans, default=(0.0, 0.0))
    return float(run / day) if day >= LONG else 1.0


def _zero(part: Floats, pace: float) -> float:
    """Return the time of day at which a process counted 0."""
    return float(np.median(part[:, 1] - part[:, 0] / pace))
