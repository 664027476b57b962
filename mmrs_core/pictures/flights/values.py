"""A flight by its logs and black boxes: plain values in the local frame of the behaviour."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from mmrs_core.geometry.frames import Floats
from mmrs_core.scene import Position
from mmrs_runtime.faults import TAKEN_OVER
from mmrs_runtime.policies import EVENTS, NOTHING
from mmrs_runtime.records.entries import Entry
from mmrs_runtime.records.steps import StepRecord

_OFTEN = 0.5
Flags: TypeAlias = NDArray[np.bool_]


@dataclass(frozen=True, slots=True, eq=False)
class Track:
    """Where a robot was when.

    Attributes:
        times: (n,) seconds of the run, never falling.
        positions: (n, 3) metres east, north, up.
        energies: (n,) fraction of the battery that is left, 0 to 1; nan where unknown.
        broken: (n,) whether its position between that fix and the next is unknown; false for the last.
            Between others it went straight.
    """

    times: Floats
    positions: Floats
    energies: Floats
    broken: Flags

    @property
    def gaps(self) -> tuple[tuple[float, float], ...]:
        """Return (since, until) of every gap."""
        found = np.flatnonzero(self.broken)
        return tuple((float(self.times[i]), float(self.times[i + 1])) for i in found)

    def at(self, time: float) -> Position | None:
        """Return where the robot was; None before the first fix, after the last, and in a gap.

        Half a second is tolerated at the ends, the usual time between fixes.
        """
        if not len(self.times) or not self.times[0] - _OFTEN <= time <= self.times[-1] + _OFTEN:
            return None
        time = min(max(time, float(self.times[0])), float(self.times[-1]))
        after = min(int(np.searchsorted(self.times, time, side="right")), len(self.times) - 1)
        before = max(after - 1, 0)
        since, until = self.times[before], self.times[after]
        if self.broken[before] and since < time < until:
            return None
        part = (time - since) / (until - since) if until > since else 1.0
        east, north, up = self.positions[before] * (1 - part) + self.positions[after] * part
        return float(east), float(north), float(up)


NOWHERE = Track(np.empty(0), np.empty((0, 3)), np.empty(0), np.empty(0, dtype=bool))


@dataclass(frozen=True, slots=True)
class Flown:
    """What one robot did.

    Attributes:
        records: its steps, in the order of its log.
        track: empty where there is no black box.
        entries: of its black box, in order: all but fixes, messages and counts.
        messages: how many there were, by direction and type; counted: frames, by how they were counted.
        simulated: whether there was no vehicle.
        vehicle: class of vehicle that its black box names; empty where it names none.
    """

    robot: str
    records: tuple[StepRecord, ...] = ()
    track: Track = NOWHERE
    entries: tuple[Entry, ...] = ()
    messages: int = 0
    counted: Mapping[str, int] = field(default_factory=dict)
    simulated: bool = False
    vehicle: str = ""

    def of_kind(self, kind: str) -> tuple[Entry, ...]:
        """Return the entries of one kind."""
        return tuple(entry for entry in self.entries if entry.kind == kind)

    @property
    def given_up(self) -> tuple[Entry, ...]:
        """Return the decisions after which the robot was not under control: responses that failed."""
        decisions = ((entry, entry.content) for entry in self.of_kind("decision"))
        return tuple(
            entry
            for entry, content in decisions
            if content.get("response") == NOTHING and content.get("what") != TAKEN_OVER
        )

    @property
    def answered(self) -> tuple[Entry, ...]:
        """Return the decisions on faults that are not in its log: its program continued."""
        logged = {record.detail.partition(":")[0] for record in self.records if record.label == "fault"}
        return tuple(
            entry
            for entry in self.of_kind("decision")
            if entry.content.get("what") in {*EVENTS} - logged and entry not in self.given_up
        )

    @property
    def program_time(self) -> float:
        """Return how long its program took by its log, seconds; without one, until the end of its record."""
        return self.records[-1].time - self.records[0].time if self.records else self.end

    @property
    def end(self) -> float:
        """Return the end of its record, seconds."""
        times = [*self.track.times[-1:].tolist(), *(entry.time for entry in self.entries[-1:])]
        return max([*times, *(record.time for record in self.records[-1:])], default=0.0)


@dataclass(frozen=True, slots=True)
class Flight:
    """What all robots did.

    Attributes:
        run: identifier of the run; empty where nothing could be read.
        robots: by name, those of the behaviour in its order; one without log or box is here, too.
        damages: what could not be read, or is inconsistent.
        boxes: how many black boxes there are.
        whole: whether every robot has a log, and all logs can be read.
        begun: date and time of day, ISO 8601; empty where unknown.
    """

    run: str
    robots: Mapping[str, Flown]
    damages: tuple[str, ...] = ()
    boxes: int = 0
    whole: bool = True
    begun: str = ""
