"""A robot and its simulated vehicle on time that passes only while the robot waits: flights in milliseconds.

All runs in the caller's thread, so that the same seed brings the same flight. Frames may be lost, doubled,
late, and overtake one another, and either side may stand still for a while, as on a machine that is busy.
"""

from __future__ import annotations

import heapq
import random
import socket
import threading
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field
from pathlib import Path

from flight_crew import crewed
from ports import free_port
from pymavlink.dialects.v20 import ardupilotmega as mavlink
from virtual_link import Air

from mmrs_core.sitl import Settings, SimulatedVehicle
from mmrs_mavlink.links.link import Link
from mmrs_mavlink.links.radio import Radio
from mmrs_mavlink.program import (
    Geographic,
    GoTo,
    Hold,
    Land,
    Policy,
    Robot,
    Start,
    Step,
    Stop,
    TakeOff,
    Then,
)
from mmrs_mavlink.steps.ending import Crew, Ending
from mmrs_runtime.clock import Clock
from mmrs_runtime.faults import Fault
from mmrs_runtime.orders.orders import Inbox, Order, Receipt
from mmrs_runtime.ports import NOTHING

TICK = 0.05
THERE = ("127.0.0.1", 1)
HEIGHTS = {"copter": 10.0, "sub": -4.0, "rover": 0.0}
COMMANDS = ("COMMAND_LONG", "SET_POSITION_TARGET_GLOBAL_INT")


def robot_of(kind: str, *policies: Policy) -> Robot:
    """Return a robot that goes 33 metres north in two legs, stays a while, and comes back."""

    def north(degrees: float) -> Geographic:
        surfaces = kind == "sub" and not degrees
        return Geographic(42.37 + degrees, 13.35, 0.0 if surfaces else HEIGHTS[kind])

    legs = [
        ("out", GoTo(north(2e-4), 3.0)),
        ("far", GoTo(north(3e-4), 3.0)),
        ("stay", Hold(5.0)),
        ("back", GoTo(north(0.0), 3.0)),
    ]
    flight = [("up", TakeOff(10.0)), *legs, ("down", Land())] if kind == "copter" else legs
    moves = [("start", Start()), *flight, ("stop", Stop())]
    following = [*(Then(name) for name, _ in moves[1:]), None]
    steps = tuple(Step(*move, then=then) for move, then in zip(moves, following, strict=True))
    home = north(0.0) if kind != "copter" else Geographic(42.37, 13.35, 0.0)
    given = {"home": home, "start": "start", "reserve": 0.1, "vehicle": kind}
    return Robot("alpha", "alpha.jsonl", steps=steps, policies=policies, fleet=("alpha",), **given)


class StillClock(Clock):
    """Seconds that somebody else counts; no real time is waited for."""

    def __init__(self) -> None:
        super().__init__()
        self.time = 0.0

    def now(self) -> float:
        return self.time

    def real(self, seconds: float) -> float:
        return 0.0


class StillRadio(Radio):
    """One that reads and beats only when it is told to."""

    def _listen(self) -> None:
        pass

    @property
    def listening(self) -> bool:
        return True

    def go_on(self) -> None:
        self._beat()

    def take(self, data: bytes) -> None:
        for message in self._parse(data, THERE):
            self._sort(message, THERE)


class Passing(threading.Condition):
    """Time passes while somebody waits for it."""

    def __init__(self, step: Callable[[], None]) -> None:
        super().__init__()
        self._step = step

    def wait(self, timeout: float | None = None) -> bool:
        self._step()
        return True


class World:
    """A port, the air between it and a vehicle, and the vehicle.

    Attributes:
        told: (seconds, what) of every command and target that was sent.
        shown: (seconds, mode) of what the vehicle's newest heartbeat said, tick by tick.
        until: second after which nobody may wait any more.
        ours, its: second until which who steers it, or the vehicle, stands still.
        most: frames that are read in a tick.
        mode: returns what the vehicle's newest heartbeat says.
    """

    def __init__(self, kind: str, air: Air, seed: int) -> None:
        self.clock, self.until = StillClock(), 900.0
        self.told: list[tuple[float, str]] = []
        self.shown: list[tuple[float, int]] = []
        self.ours = self.its = 0.0
        self.most = 1000
        self.mode: Callable[[], int] = lambda: -1
        self._air, self._random = air, random.Random(seed)
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        port = free_port()
        self._socket.bind(("127.0.0.1", port))
        self._socket.setblocking(False)
        self._address: tuple[str, int] | None = None
        self._in: list[tuple[float, int, bytes]] = []
        self._out: list[tuple[float, int, bytes]] = []
        self._due: list[tuple[float, int, Callable[[], None]]] = []
        self._number = 0
        self._parser = mavlink.MAVLink(None)
        self.vehicle = SimulatedVehicle(port, Settings(kind=kind))
        self.vehicle.autopilot.patience = 0.0
        self.radio = StillRadio(self, self.clock)

    def read(self, seconds: float):
        return NOTHING

    def write(self, data: bytes, to=None) -> None:
        for message in self._parser.parse_buffer(data) or ():
            if message.get_type() in COMMANDS:
                self.told.append((self.clock.time, message.get_type()))
        self._fly(self._out, data)

    def close(self) -> None:
        self.vehicle.close()
        self._socket.close()

    def at(self, second: float, do: Callable[[], None]) -> None:
        """Have something done at a second."""
        self._number += 1
        heapq.heappush(self._due, (second, self._number, do))

    def step(self) -> None:
        """Let a tick pass, or as many as nobody here runs."""
        assert self.clock.time < self.until, "it does not come to an end"
        self._tick()
        while self.clock.time < self.ours:
            self._tick()
        self.radio.go_on()
        for _ in range(self.most):
            if not self._in or self._in[0][0] > self.clock.time:
                break
            self.radio.take(heapq.heappop(self._in)[2])
        self.shown.append((self.clock.time, self.mode()))

    def _tick(self) -> None:
        self.clock.time += TICK
        if self.clock.time >= self.its:
            while self._out and self._out[0][0] <= self.clock.time:
                data = heapq.heappop(self._out)[2]
                if self._address is not None:
                    self._socket.sendto(data, self._address)
            self.vehicle.hear()
            self.vehicle.go_on(TICK)
        for data in self._datagrams():
            self._fly(self._in, data)
        while self._due and self._due[0][0] <= self.clock.time:
            heapq.heappop(self._due)[2]()

    def _datagrams(self) -> Iterator[bytes]:
        while True:
            try:
                data, self._address = self._socket.recvfrom(65_535)
            except BlockingIOError:
                return
            yield data

    def _fly(self, way: list[tuple[float, int, bytes]], data: bytes) -> None:
        chance = self._random.random
        if chance() < self._air.loss:
            return
        for _ in range(2 if chance() < self._air.double else 1):
            self._number += 1
            due = self.clock.time + self._air.delay + chance() * self._air.jitter
            heapq.heappush(way, (due, self._number, data))


@dataclass
class Still:
    """A robot whose program has not begun, and its world.

    Attributes:
        said: what people were told, with seconds.
        receipts: of the orders that were given.
    """

    world: World
    crew: Crew
    inbox: Inbox
    said: list[tuple[float, str]]
    receipts: list[Receipt] = field(default_factory=list)

    def order(self, name: str, second: float) -> None:
        """Have something ordered at a second."""
        self.world.at(second, lambda: self.receipts.append(self.inbox.give(Order(name))))

    def fly(self) -> int:
        """Carry the program out, to whatever end it comes; return the exit code."""
        try:
            self.crew.pilot.fly()
        except Fault as fault:
            return Ending(self.crew, lambda: None).end(fault)
        return 0

    def says(self, words: str) -> bool:
        """Return whether people were told something."""
        return any(words in line for _, line in self.said)


@contextmanager
def still(folder: Path, robot: Robot, air: Air = Air(), seed: int = 0) -> Iterator[Still]:  # noqa: B008
    """Give a robot whose vehicle stands at home."""
    with ExitStack() as stack:
        world = World(robot.vehicle, air, seed)
        clock, said = world.clock, []

        def say(line: str) -> None:
            said.append((clock.time, line))

        link = Link(world.radio, clock, 1)
        stack.callback(link.close)
        link._changed = Passing(world.step)
        assert link.wait(lambda: link.component, 60.0)
        crew, inbox = stack.enter_context(crewed(folder, robot, link, threading.Event(), say, "land"))
        crew.watch.say, world.mode = say, crew.vehicle.telemetry.mode
        yield Still(world, crew, inbox, said)
