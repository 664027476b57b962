"""The other side of a link, in the same process: says what a test wants, and answers as it wants."""

import queue
import struct
import threading
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from types import SimpleNamespace

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.links.link import Link
from mmrs_mavlink.links.radio import Radio
from mmrs_mavlink.links.retries import Retries
from mmrs_runtime.clock import Clock
from mmrs_runtime.ports import NOTHING, Received

HERE, THERE = ("10.0.0.1", 14_550), ("10.0.0.2", 14_550)
ARDUPILOT, PX4 = mavlink.MAV_AUTOPILOT_ARDUPILOTMEGA, mavlink.MAV_AUTOPILOT_PX4
QUICK = Retries(tries=3, answer=0.15, item=0.1)
Answer = Callable[[object], Iterable[object]]


class Wire:
    """A port whose other end is in the test.

    Attributes:
        sent: (message, address) of everything that was sent, parsed again, heartbeats left out.
        answer: gives the messages to say when one was sent.
    """

    def __init__(self, answer: Answer = lambda message: ()) -> None:
        self.sent: list[tuple[object, object]] = []
        self.beats: list[object] = []
        self.answer = answer
        self._arriving: queue.SimpleQueue[Received] = queue.SimpleQueue()
        self._parser = mavlink.MAVLink(None)
        self._parser.robust_parsing = True

    def read(self, seconds: float) -> Received:
        try:
            return self._arriving.get(timeout=seconds)
        except queue.Empty:
            return NOTHING

    def write(self, data: bytes, to=None) -> None:
        for message in self._parser.parse_buffer(data) or ():
            if message.get_type() == "HEARTBEAT":
                self.beats.append(to)
                continue
            self.sent.append((message, to))
            for reply in self.answer(message):
                self.say(reply)

    def close(self) -> None:
        pass

    def put(self, data: bytes, sender=HERE) -> None:
        self._arriving.put(Received(data, sender))

    def say(
        self, message, *, system: int = 1, component: int = 1, sender=HERE, seq: int | None = None
    ) -> None:
        self.put(self.pack(message, system, component, seq), sender)

    def pack(self, message, system: int = 1, component: int = 1, seq: int | None = None) -> bytes:
        packer = self._packer(system, component)
        if seq is not None:
            packer.seq = seq
        data = message.pack(packer)
        packer.seq = (packer.seq + 1) % 256
        return bytes(data)

    def beat(self, *, system: int = 1, sender=HERE, autopilot: int = ARDUPILOT, **fields) -> None:
        self.say(heartbeat(autopilot=autopilot, **fields), system=system, sender=sender)

    def kinds(self) -> list[str]:
        return [message.get_type() for message, _ in self.sent]

    def of(self, kind: str) -> list[object]:
        return [message for message, _ in self.sent if message.get_type() == kind]

    def _packer(self, system: int, component: int) -> mavlink.MAVLink:
        packers = self.__dict__.setdefault("_packers", {})
        return packers.setdefault(
            (system, component), mavlink.MAVLink(None, srcSystem=system, srcComponent=component)
        )


def heartbeat(
    *, autopilot: int = ARDUPILOT, kind: int = mavlink.MAV_TYPE_QUADROTOR, mode: int = 4, armed: bool = False
):
    base = 1 | (mavlink.MAV_MODE_FLAG_SAFETY_ARMED if armed else 0)
    return mavlink.MAVLink_heartbeat_message(kind, autopilot, base, mode, 3, 3)


def acknowledged(command: int, result: int = 0, progress: int = 0):
    return mavlink.MAVLink_command_ack_message(command, result, progress, 0, 255, 191)


def value(name: str, number: float, kind: int = mavlink.MAV_PARAM_TYPE_REAL32, index: int = 65_535):
    return mavlink.MAVLink_param_value_message(name.encode(), number, kind, 1, index)


def bytewise(number: int) -> float:
    return struct.unpack("<f", struct.pack("<i", number))[0]


class SkippingClock(Clock):
    """A clock that can skip time, so that nothing waits for it."""

    def skip(self, seconds: float) -> None:
        """Let seconds of the run pass at once."""
        self._zero -= self.real(seconds)


@contextmanager
def linked(
    answer: Answer = lambda message: (), *, autopilot: int = ARDUPILOT, system: int = 0, speedup: float = 1.0
):
    """Give a link that has met its vehicle, and the wire to it."""
    wire = Wire(answer)
    clock = SkippingClock(speedup)
    link = Link(Radio(wire, clock), clock, system, retries=QUICK)
    wire.beat(autopilot=autopilot)
    assert link.wait(lambda: link.component, 5.0 * speedup)
    try:
        yield link, wire
    finally:
        link.close()


@contextmanager
def two_linked(clock: Clock) -> Iterator[SimpleNamespace]:
    """Give a wire, and on it links to the vehicles 1 and 2, which speak from different addresses."""
    wire = Wire()
    radio = Radio(wire, clock)
    first, second = (Link(radio, clock, system, retries=QUICK) for system in (1, 2))
    wire.beat(system=1, sender=HERE)
    wire.beat(system=2, sender=THERE)
    for link in (first, second):
        eventually(lambda link=link: link.component)
    try:
        yield SimpleNamespace(wire=wire, clock=clock, first=first, second=second)
    finally:
        first.close()
        second.close()


def eventually(test: Callable[[], object], seconds: float = 5.0) -> object:
    """Return what a test finds, and fail if it finds nothing for so long."""
    until = time.monotonic() + seconds
    while not (found := test()):
        assert time.monotonic() < until, "it did not come to that"
        threading.Event().wait(0.005)
    return found
