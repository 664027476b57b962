"""Hosts of nodes: all of a vehicle in one process on simulated time, or one node in a process of its own."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from random import Random
from typing import Literal, Protocol

from auv_vessel.guard import Guard
from auv_vessel.node import Node
from auv_vessel.wire.catalogue import CLOCK_ID, NODES
from auv_vessel.wire.frame import Frame, check_of, is_sound

MICROSECONDS = 1_000_000
CATCH_UP = 5
"""Ticks that a node in real time may be late before it lets them go; more than that was a stall."""

BEHIND = 0.5
"""Fraction of a period by which a node may be late before it first takes the frames that wait for it."""

SEEN_BASE = 0x18FF0000
"""Extended identifiers by which hosts that go by the bus say that their node has done what was due at a time.

They concern hosts only: they are in no database, and are not sent in real time.
"""

LAG = 2
"""Ticks of who leads by which others may be behind it."""

PATIENCE = 2.0
"""Seconds of real time for which simulated time waits for a part; after that it counts as gone."""

CLOCK_SILENT = 20.0
"""Seconds of real time for which a process on bus time waits for the time."""

_LISTENING = 0.1

Pace = Literal["real", "bus", "lead"]


class ClockSilentError(OSError):
    """Who told the time is gone, and with it the simulated vehicle."""


class FramePort(Protocol):
    """A connection to a bus, as `wire.ports.open_port` opens one."""

    def send(self, frame: Frame) -> None:
        """Put a frame on the bus."""
        ...

    def receive(self, timeout: float) -> Frame | None:
        """Return the next frame, or None if there was none for `seconds`."""
        ...


@dataclass(frozen=True, slots=True)
class WireFault:
    """What is wrong with the bus for a while.

    Attributes:
        begin, end: seconds of simulated time.
        loss: part of the frames that never arrive. corruption: part that arrive with one to three bits wrong.
        ids: identifiers that it concerns; None: all.
        sender: name of the only node that it concerns; None: all.
        seed: of the chances.
    """

    begin: float = 0.0
    end: float = float("inf")
    loss: float = 0.0
    corruption: float = 0.0
    ids: frozenset[int] | None = None
    sender: str | None = None
    seed: int = 0


class _Disturbance:
    """A fault at work, with its chances."""

    def __init__(self, fault: WireFault) -> None:
        self._fault = fault
        self._random = Random(fault.seed)

    def through(self, frame: Frame, sender: str, now: float) -> Frame | None:
        """Return the frame as it arrives; None if it does not."""
        fault = self._fault
        if not fault.begin <= now < fault.end or (fault.sender is not None and fault.sender != sender):
            return frame
        if fault.ids is not None and frame.id not in fault.ids:
            return frame
        if self._random.random() < fault.loss:
            return None
        if frame.data and self._random.random() < fault.corruption:
            return self._corrupted(frame)
        return frame

    def _corrupted(self, frame: Frame) -> Frame:
        data = bytearray(frame.data)
        for bit in self._random.sample(range(8 * len(data)), self._random.randint(1, 3)):
            data[bit // 8] ^= 1 << bit % 8
        return Frame(frame.id, bytes(data), frame.extended)


class Rehearsal:
    """Nodes on one bus in simulated time: the same nodes and faults always say the same.

    All nodes whose time has come tick; what they say is then delivered to all others in the order of the
    bus (identifier, then order of the nodes), before time advances.

    Args:
        nodes: in the order in which they tick when their time comes together.
        faults: of the bus.
        watch: called with the time and every frame that was put on the bus, before faults take it.
    """

    def __init__(
        self,
        nodes: Sequence[Node],
        faults: Sequence[WireFault] = (),
        watch: Callable[[float, Frame], None] | None = None,
    ) -> None:
        self._nodes = [Guard(node) for node in nodes]
        self._disturbances = [_Disturbance(fault) for fault in faults]
        self._watch = watch
        self._time = 0
        self._due = {id(node): 0 for node in self._nodes}
        self._dead: set[str] = set()
        self._posted: list[Frame] = []

    @property
    def now(self) -> float:
        """Seconds of simulated time."""
        return self._time / MICROSECONDS

    def add(self, node: Node) -> None:
        """Take another node; it ticks with the others from now on."""
        self._nodes.append(guard := Guard(node))
        self._due[id(guard)] = self._time

    def kill(self, name: str) -> None:
        """Disconnect a node, like a process that was killed."""
        self._dead.add(name)

    def revive(self, name: str) -> None:
        """Reconnect a node that was killed, in its former state."""
        self._dead.discard(name)

    def disturb(self, fault: WireFault) -> None:
        """Let a fault of the bus begin to count."""
        self._disturbances.append(_Disturbance(fault))

    def post(self, frame: Frame) -> None:
        """Put a frame on the bus at the next tick, as if a node beside all others had said it."""
        self._posted.append(frame)

    def run(self, seconds: float) -> None:
        """Let so much time go by."""
        until = self._time + round(seconds * MICROSECONDS)
        while self._nodes and (due := min(self._due.values())) <= until:
            self._time = max(due, self._time)
            self._step()
        self._time = until

    def _step(self) -> None:
        now = self.now
        said: list[tuple[Guard | None, Frame]] = [(None, frame) for frame in self._posted]
        self._posted.clear()
        for node in self._nodes:
            if self._due[id(node)] > self._time:
                continue
            self._due[id(node)] += round(node.period * MICROSECONDS)
            if node.name not in self._dead:
                said.extend((node, frame) for frame in node.tick(now))
        said.sort(key=lambda each: each[1].id)
        for sender, frame in said:
            if self._watch is not None:
                self._watch(now, frame)
            self._deliver(frame, sender, now)

    def _deliver(self, frame: Frame, sender: Guard | None, now: float) -> None:
        arrived: Frame | None = frame
        for disturbance in self._disturbances:
            if arrived is None:
                return
            arrived = disturbance.through(arrived, sender.name if sender else "", now)
        if arrived is None:
            return
        for node in self._nodes:
            if node is not sender and node.name not in self._dead:
                node.hear(arrived, now)


def tells_time(frame: Frame) -> bool:
    """Return whether a frame is of those by which hosts share simulated time, which no vehicle has."""
    if frame.extended:
        return 0 <= frame.id - SEEN_BASE < len(NODES)
    return frame.id == CLOCK_ID


def clock_frame(now: float, counter: int = 0) -> Frame:
    """Return the frame that tells simulated time, seconds."""
    said = (round(now * 1000.0) & 0xFFFFFFFF).to_bytes(4, "little") + bytes((counter % 256,))
    return Frame(CLOCK_ID, said + bytes((check_of(CLOCK_ID, said),)))


def clock_time(frame: Frame) -> float | None:
    """Return what time a frame tells, seconds, or None if it tells none that can be believed."""
    return None if frame.id != CLOCK_ID or frame.extended else _time_in(frame.data)


def _time_in(data: bytes) -> float | None:
    if len(data) != 6 or not is_sound(CLOCK_ID, data):
        return None
    return int.from_bytes(data[:4], "little") / 1000.0


class Awake:
    """A clock that leaves out stalls of this process.

    Who reads it often, and finds that very much has gone by, was stalled: what others said meanwhile still
    waits to be received, so that time does not count as their silence. All deadlines move by it.

    Args:
        most: seconds from one reading to the next that count.
        clock: that runs all the time.

    Attributes:
        stalled: seconds that were left out.
    """

    def __init__(self, most: float, clock: Callable[[], float]) -> None:
        self._most, self._clock = most, clock
        self._read, self._now, self.stalled = clock(), 0.0, 0.0

    def now(self) -> float:
        """Return seconds since it was made, without those of stalls."""
        read = self._clock()
        counted = min(read - self._read, self._most)
        self._now += counted
        self.stalled += read - self._read - counted
        self._read = read
        return self._now


def serve(
    node: Node,
    port: FramePort,
    clock: Pace = "real",
    stop: threading.Event | None = None,
    *,
    speedup: float = 1.0,
    late: Callable[[float], None] | None = None,
    say: Callable[[str], None] = lambda text: None,
) -> None:
    """Host one node on a bus until `stop` is set.

    Args:
        clock: "real": ticks by this computer's monotonic clock; "bus": when `Clock` frames say so;
            "lead": real time times `speedup`, told to all others in `Clock` frames before each tick, and
            it waits for hosts by "bus" that are more than `LAG` ticks behind.
        late: called with the seconds by which each tick came late (not with "bus").
        say: told which message of the bus has two senders (see `guard`), if one has.

    Raises:
        ClockSilentError: no time is received, although the node follows bus time.
        Whatever the port raises when the bus is gone, and whatever the node raises: a process that fails is
        restarted from outside, and what depends on it meanwhile fails safe.
    """
    ended, guard = stop or threading.Event(), Guard(node, say)
    if clock == "bus":
        _serve_by_bus(guard, port, ended)
    elif clock == "lead":
        _serve_leading(guard, port, ended, speedup, late)
    else:
        _serve_by_clock(guard, port, ended, late)


def _serve_by_clock(
    node: Node, port: FramePort, stop: threading.Event, late: Callable[[float], None] | None
) -> None:
    awake = Awake(CATCH_UP * node.period, time.monotonic)
    ticks, stalled = 0, 0.0
    while not stop.is_set():
        due = ticks * node.period
        now = awake.now()
        if now < due:
            if (frame := port.receive(due - now)) is not None:
                node.hear(frame, awake.now())
            continue
        if now - due > BEHIND * node.period:
            _catch_up(node, port, awake)
            now = awake.now()
        if late is not None:
            late(now - due + awake.stalled - stalled)
            stalled = awake.stalled
        if now - due > CATCH_UP * node.period:
            ticks = int(now / node.period)
        for said in node.tick(now):
            port.send(said)
        ticks += 1
        while awake.now() < ticks * node.period and (received := port.receive(0.0)) is not None:
            node.hear(received, now)


def _catch_up(node: Node, port: FramePort, awake: Awake) -> None:
    """Let a late node take the frames that wait for it, for a period at most, before it judges silence."""
    until = awake.now() + node.period
    while (now := awake.now()) < until and (frame := port.receive(0.0)) is not None:
        node.hear(frame, now)


def _serve_leading(
    node: Node, port: FramePort, stop: threading.Event, speedup: float, late: Callable[[float], None] | None
) -> None:
    """Send the time, and let it advance when it may and the others have kept up with it."""
    begin = time.monotonic()
    now, ticks = 0.0, 0
    seen: dict[int, float] = {}
    while not stop.is_set():
        due = ticks * node.period
        on = begin + due / speedup
        given_up = max(on, time.monotonic()) + PATIENCE
        while not stop.is_set():
            while (frame := port.receive(0.0)) is not None:
                if not (frame.extended and 0 <= frame.id - SEEN_BASE < len(NODES)):
                    node.hear(frame, now)
                elif (at := _time_in(frame.data)) is not None:
                    seen[frame.id] = at
            real = time.monotonic()
            behind = [each for each, at in seen.items() if due - at > LAG * node.period + 1e-6]
            if real >= on and (not behind or real >= given_up):
                break
            time.sleep(min(max(on - real, 0.0005), 0.005))
        for each in behind:
            del seen[each]
        if late is not None:
            late(time.monotonic() - on)
        now = due
        port.send(clock_frame(now, ticks))
        for said in node.tick(now):
            port.send(said)
        ticks += 1


def _serve_by_bus(node: Guard, port: FramePort, stop: threading.Event) -> None:
    due: float | None = None
    now = 0.0
    awake = Awake(CATCH_UP * _LISTENING, time.monotonic)
    told_at = awake.now()
    while not stop.is_set():
        frame = port.receive(_LISTENING)
        reported = None if frame is None else clock_time(frame)
        if frame is None or reported is None:
            if frame is not None:
                node.hear(frame, now)
            if awake.now() - told_at > CLOCK_SILENT:
                raise ClockSilentError(f"no time received for {CLOCK_SILENT:g} s")
            continue
        node.notice(frame, now)
        now, told_at = reported, awake.now()
        if due is None or due - now > 10.0 * node.period:
            due = now
        if now + 1e-6 >= due:
            for said in node.tick(now):
                port.send(said)
            due = max(due + node.period, now)
        if node.name in NODES:
            port.send(Frame(SEEN_BASE + NODES.index(node.name), frame.data, True))
