"""A link on which time does not pass by itself: frames are lost, doubled, late and overtake one another.

It stands for the flight runtime's link and for the radio below it, so that exchanges of minutes take
milliseconds, and the same seed brings the same frames; the vehicle's side is one of our simulated ones.
"""

import heapq
import random
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from mavlink_peer import ARDUPILOT, PX4, heartbeat
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.links.retries import Retries
from mmrs_mavlink.profiles import ARDUCOPTER, VehicleProfile, on_autopilot
from mmrs_mavlink.sitl.items import StoredItem
from mmrs_mavlink.sitl.transfers import Transfers

TICK = 0.05
"""Seconds between two looks of the vehicle at what it waits for."""


@dataclass(frozen=True, slots=True)
class Air:
    """How frames fare, either way: part lost, part doubled, seconds on the way, and up to so many more."""

    loss: float = 0.0
    double: float = 0.0
    delay: float = 0.0
    jitter: float = 0.0


class VirtualClock:
    """Seconds that pass when somebody waits."""

    speedup = 1.0

    def __init__(self) -> None:
        self.time = 0.0

    def now(self) -> float:
        return self.time

    def patience(self, seconds: float, least: float = 0.5) -> float:
        return max(seconds, least)


class VirtualLink:
    """A vehicle's mission service at the other end of bad air.

    Attributes:
        stores: what the vehicle has, by kind. said: what it said in words. sent: how many frames we sent.
    """

    system = component = 1
    tries = 5

    def __init__(self, firmware: str, air: Air, seed: int) -> None:
        self.clock, self.retries = VirtualClock(), Retries()
        self.stores: dict[int, list[StoredItem]] = {kind: [] for kind in (0, 1, 2)}
        self.said: list[str] = []
        self.sent = 0
        self._air, self._random = air, random.Random(seed)
        self._ours = mavlink.MAVLink(None, srcSystem=255, srcComponent=191)
        self._its = mavlink.MAVLink(None, srcSystem=1, srcComponent=1)
        self._beat = heartbeat(autopilot=PX4 if firmware == "px4" else ARDUPILOT)
        say = lambda severity, text: self.said.append(text)  # noqa: E731
        self.vehicle = Transfers(self.stores, self._answer, say, self.profile.autopilot)
        self._flying: list[tuple[float, int, bytes, bool]] = []
        self._order = 0
        self._look = 0.0
        self._inboxes: list[tuple[tuple[str, ...], deque]] = []

    @property
    def patience(self) -> float:
        return self.retries.answer

    @property
    def profile(self) -> VehicleProfile:
        return on_autopilot(ARDUCOPTER, self._beat.autopilot)

    def latest(self, kind: str):
        return self._beat if kind == "HEARTBEAT" else None

    def attempts(self) -> Iterator[int]:
        yield from range(self.retries.tries)

    @contextmanager
    def inbox(self, *kinds: str):
        entry = (kinds, deque())
        self._inboxes.append(entry)
        try:
            yield entry[1]
        finally:
            self._inboxes = [other for other in self._inboxes if other is not entry]

    def send(self, message) -> None:
        self.sent += 1
        self._fly(bytes(message.pack(self._ours)), outwards=True)

    def wait(self, test: Callable[[], object], seconds: float) -> object:
        until = self.clock.time + seconds
        while not (found := test()) and self.clock.time < until:
            self._pass(until)
        return found or None

    def settle(self, seconds: float = 30.0) -> None:
        """Let so much time pass that nothing is on its way any more, and the vehicle has given up."""
        self.wait(lambda: None, seconds)

    def _answer(self, message) -> None:
        self._fly(bytes(message.pack(self._its)), outwards=False)

    def _fly(self, data: bytes, *, outwards: bool) -> None:
        chance = self._random.random
        if chance() < self._air.loss:
            return
        for _ in range(2 if chance() < self._air.double else 1):
            self._order += 1
            due = self.clock.time + self._air.delay + chance() * self._air.jitter
            heapq.heappush(self._flying, (due, self._order, data, outwards))

    def _pass(self, until: float) -> None:
        """Let time pass to whatever comes next."""
        frame = self._flying[0][0] if self._flying else until
        self.clock.time = max(self.clock.time, min(frame, self._look, until))
        if self._look <= self.clock.time:
            self.vehicle.advance(self.clock.time, 0.0)
            self._look = self.clock.time + TICK
        while self._flying and self._flying[0][0] <= self.clock.time:
            _, _, data, outwards = heapq.heappop(self._flying)
            self._arrive(data, outwards=outwards)

    def _arrive(self, data: bytes, *, outwards: bool) -> None:
        (message,) = mavlink.MAVLink(None).parse_buffer(data)
        if outwards:
            self.vehicle.take(message)
            return
        for kinds, collected in self._inboxes:
            if message.get_type() in kinds:
                collected.append(message)
