"""A flight by its logs and black boxes: plain values in the local frame of the behaviour."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from mmrs_core.pictures.flights.tracks import NOWHERE, Track
from mmrs_runtime.faults import TAKEN_OVER
from mmrs_runtime.policies import EVENTS, NOTHING
from mmrs_runtime.records.entries import Entry
from mmrs_runtime.records.steps import StepRecord


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
        zero: time of day at which times are 0, seconds since 1970-01-01 UTC; None where unknown.
    """

    run: str
    robots: Mapping[str, Flown]
    damages: tuple[str, ...] = ()
    boxes: int = 0
    whole: bool = True
    begun: str = ""
    zero: float | None = None
