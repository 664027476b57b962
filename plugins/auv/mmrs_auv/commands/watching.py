"""Prints the traffic and the load of a bus."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Iterator, Mapping

from auv_vessel.sheet import Sheet
from auv_vessel.wire.catalogue import messages_of
from auv_vessel.wire.codec import Codec, Received, Value
from auv_vessel.wire.frame import Frame
from auv_vessel.wire.load import Load, MeasuredLoad
from auv_vessel.wire.ports import Port


class Monitor:
    """Tells frames of one vehicle's bus, and keeps count of what is not right.

    Attributes:
        counts: frames by message; ``unknown``: of no message of this vehicle.
        missed: frames by message that are missing by their counters.
    """

    def __init__(self, sheet: Sheet) -> None:
        """Prepare for a vehicle."""
        self.counts: Counter[str] = Counter()
        self.missed: Counter[str] = Counter()
        self._codec = Codec(sheet)
        messages = messages_of(sheet)
        self._units = {(each.name, field.name): field.unit for each in messages for field in each.fields}
        self._names = {each.id: each.name for each in messages}
        self._last: dict[str, int] = {}

    @property
    def faults(self) -> Mapping[str, int]:
        """Frames by message that cannot be believed."""
        return self._codec.faults

    @property
    def names(self) -> frozenset[str]:
        """The names of all messages of this vehicle."""
        return frozenset(self._names.values())

    def summary(self) -> Iterator[str]:
        """Yield what there is to say at the end."""
        yield f"{self.counts.total()} frames"
        if self.counts["unknown"]:
            yield f"of no message of this vehicle: {self.counts['unknown']}"
        for what, counts in (("not believed", self.faults), ("missed", self.missed)):
            if reported := ", ".join(f"{count} {name}" for name, count in sorted(counts.items()) if count):
                yield f"{what}: {reported}"

    def name_of(self, frame: Frame) -> str:
        """Return the name of a frame's message; empty: it is none of this vehicle."""
        return "" if frame.extended else self._names.get(frame.id, "")

    def line(self, frame: Frame) -> str:
        """Return what a frame says."""
        name = self.name_of(frame)
        self.counts[name or "unknown"] += 1
        said = self._codec.decode(frame)
        if said is None:
            id = f"{frame.id:08X}" if frame.extended else f"{frame.id:03X}"
            why = "not believed: wrong length, check or value" if name else "no message of this vehicle"
            return f"{name or id} [{frame.data.hex(' ')}] {why}"
        self._follow(said)
        values = " ".join(f"{key}={self._shown(name, key, value)}" for key, value in said.values.items())
        return f"{name} {values}"

    def _follow(self, said: Received) -> None:
        if said.sequence is None:
            return
        if said.name in self._last:
            self.missed[said.name] += (said.sequence - self._last[said.name] - 1) % 256
        self._last[said.name] = said.sequence

    def _shown(self, name: str, field: str, value: Value) -> str:
        if isinstance(value, bool):
            return "yes" if value else "no"
        if isinstance(value, str):
            return value
        return f"{value:.10g}{self._units[name, field]}"


def received(port: Port, seconds: float) -> Iterator[tuple[float, Frame]]:
    """Yield the frames of a bus, with the time since the beginning; seconds 0: without end.

    Raises:
        PortError: the bus is gone.
    """
    begin = time.monotonic()
    while not seconds or time.monotonic() - begin < seconds:
        left = seconds - (time.monotonic() - begin) if seconds else 0.5
        if (frame := port.receive(min(max(left, 0.0), 0.5))) is not None:
            yield time.monotonic() - begin, frame


def table(designed: Load) -> Iterator[str]:
    """Yield a line for each message."""
    yield f"{'message':20} {'id':>5} {'period':>8} {'bits':>9} {'over by':>9}"
    for each in designed.shares:
        period = "-" if each.period is None else f"{each.period * 1000:.0f} ms"
        latest = "-" if each.latest is None else f"{each.latest * 1000:.2f} ms"
        bits = f"{each.shortest}-{each.longest}"
        yield f"{each.name:20} 0x{each.id:03X} {period:>8} {bits:>9} {latest:>9}"


def summary(designed: Load, found: MeasuredLoad | None) -> Iterator[str]:
    """Yield the load of a bus by design, and as measured, if it was."""
    yield (
        f"by design: {designed.least:.1%} of the time without stuff bits, {designed.most:.1%} at most, "
        f"at {designed.bit_rate / 1000:g} kbit/s"
    )
    if found is not None:
        yield (
            f"as measured: {found.mean:.1%} on average ({found.frames} frames in {found.seconds:.1f} s); "
            f"in windows of {found.window * 1000:.0f} ms: median {found.median:.1%}, 99th percentile "
            f"{found.high:.1%}, most {found.peak:.1%}; {found.stuffing:.1f} stuff bits on 100"
        )
