"""The decision centre of a vehicle on its bus, in real time."""

from __future__ import annotations

import logging
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import hypot, inf
from typing import Protocol

from auv_vessel.api import FIRST_SIGN, Connection
from auv_vessel.decision.duties import Ready
from auv_vessel.eyes import Detections
from auv_vessel.goals import FAREWELL
from auv_vessel.hosting import FramePort, tells_time
from auv_vessel.sheet import Sheet
from auv_vessel.wire import ports
from auv_vessel.wire.frame import Frame
from auv_vessel.wire.ports import CHANNEL, open_port
from mmrs_auv.controllers.orders import Orders
from mmrs_auv.controllers.vehicle import CanVehicle
from mmrs_runtime.clock import Clock
from mmrs_runtime.engine.connecting import Live
from mmrs_runtime.faults import LINK_LOST, POSITION_LOST, REFUSED
from mmrs_runtime.injection import Rehearsal
from mmrs_runtime.injection.port import Line
from mmrs_runtime.ports import NOTHING, Address, Received
from mmrs_runtime.ports import Port as Carrier
from mmrs_runtime.records.blackbox import BlackBox
from mmrs_runtime.vehicle import Fault, LinkLost

EXTENDED, LONG, SHORT = 1 << 31, (1 << 29) - 1, (1 << 11) - 1


class FrameLine(Line):
    """One direction of a bus, which frames that tell simulated time pass whatever befalls others."""

    def passing(self, piece: bytes) -> list[tuple[float, bytes]]:
        """Return what arrives of a frame."""
        if tells_time(frame_of(piece)):
            return [(self._clock.now(), piece)]
        return super().passing(piece)


class _Pieces:
    """A bus whose frames are pieces of bytes."""

    def __init__(self, port: ports.Port) -> None:
        self._port = port

    def read(self, seconds: float) -> Received:
        frame = self._port.receive(seconds)
        return NOTHING if frame is None else Received(piece_of(frame))

    def write(self, data: bytes, to: Address | None = None) -> None:
        self._port.send(frame_of(data))

    def close(self) -> None:
        self._port.close()


class _Frames:
    """Pieces of bytes as frames again."""

    def __init__(self, carrier: Carrier) -> None:
        self._carrier = carrier

    def send(self, frame: Frame) -> None:
        self._carrier.write(piece_of(frame))

    def receive(self, timeout: float) -> Frame | None:
        data = self._carrier.read(timeout).data
        return frame_of(data) if data else None

    def close(self) -> None:
        self._carrier.close()


class ClosablePort(FramePort, Protocol):
    """A connection to a bus that can be closed."""

    def close(self) -> None:
        """Close it."""
        ...


def injected(port: ports.Port, rehearsal: Rehearsal, robot: str) -> ClosablePort:
    """Return a connection with the faults of a robot's bus in front of it."""
    return _Frames(rehearsal.wrap(_Pieces(port), (robot,), FrameLine))


def piece_of(frame: Frame) -> bytes:
    """Return a frame as bytes: its identifier, low byte first, then its data."""
    return (frame.id | (EXTENDED if frame.extended else 0)).to_bytes(4, "little") + frame.data


def frame_of(piece: bytes) -> Frame:
    """Return the frame that bytes are, whichever of their bits are wrong."""
    id = int.from_bytes(piece[:4], "little")
    extended = bool(id & EXTENDED)
    return Frame(id & (LONG if extended else SHORT), piece[4:], extended)


BATTERY_SECONDS = 1.0
"""Seconds within which a vehicle that tells its battery has done so."""


@dataclass(frozen=True, slots=True)
class Reach:
    """How a vehicle is reached, and what is taken for granted then.

    Attributes:
        interface, channel, bit_rate: of python-can; 0: default of the adapter.
        clock: ``real``, or ``bus``: time as a simulated vehicle tells it; empty: as the run's clock goes.
        patience: real seconds to wait for its first sign, and until it knows where it is.
        home_tolerance: metres that it may be from its home at first.
        clearance: metres ahead within which sonar must see nothing; 0: it may.
    """

    interface: str = "socketcand"
    channel: str = CHANNEL
    bit_rate: int = 0
    clock: str = ""
    patience: float = FIRST_SIGN
    home_tolerance: float = 20.0
    clearance: float = 0.0


class ConnectedVehicle(CanVehicle):
    """A vehicle on a bus of its own; a thread repeats its goals and receives its messages."""

    def __init__(
        self,
        robot: str,
        sheet: Sheet,
        orders: Orders,
        reach: Reach,
        clock: Clock,
        live: Live,
        start: Mapping[str, object],
        *,
        box: BlackBox | None,
        eyes: Detections | None = None,
        rehearsal: Rehearsal | None = None,
        let_go: Callable[[], None] = lambda: None,
    ) -> None:
        """Send only that nothing is to move, until the robot is to get ready.

        Args:
            start: what its black box says first.
            eyes: detections of its cameras; None: objects are not detected.
            rehearsal: of injected faults; None: none.
            let_go: called when it is let go of.

        Raises:
            OSError: there is no bus.
            ValueError: its channel makes no sense.
        """
        logging.getLogger("can").setLevel(logging.ERROR)
        port = open_port(reach.interface, reach.channel, bit_rate=reach.bit_rate or None, say=live.say)
        self._port: ClosablePort = port if rehearsal is None else injected(port, rehearsal, robot)
        paced = reach.clock or ("bus" if clock.speedup != 1.0 else "real")
        self._connection = Connection(sheet, self._port, "bus" if paced == "bus" else "real")
        super().__init__(
            robot,
            sheet,
            self._connection.craft,
            orders,
            box=box,
            say=live.say,
            seen=dict if eyes is None else eyes.places,
            clearance=reach.clearance,
        )
        self._live, self._reach, self._clock, self._eyes = live, reach, clock, eyes
        self._start, self._let_go = start, let_go
        self._begun = self._until = inf
        self._met = False

    def prepare(self, now: float) -> bool:
        """Begin to wait until the vehicle has sent a known position and its battery."""
        self.done, self.trouble = False, None
        self._begun, self._until = now, now + self._reach.patience * self._clock.speedup
        self.note("start", self._start)
        self._helm.begin(Ready(), now)
        return True

    def look(self, now: float) -> float:
        """See how it is, all the time; a bus that is gone is a lost link.

        Raises:
            LinkLost: it is.
        """
        if self._connection.failure is not None:
            raise LinkLost(str(self._connection.failure))
        again = super().look(now)
        self.done = self.done and self._met
        return again

    def watched(self, now: float) -> bool:
        """Return whether the vehicle must be attended; it cannot be where the bus itself is gone."""
        return self._connection.failure is None and super().watched(now)

    def close(self) -> None:
        """Send the last goal, and fall silent; the vehicle then holds, and surfaces."""
        time.sleep(FAREWELL)
        self._connection.close()
        self._port.close()
        if self._eyes is not None:
            self._eyes.close()
        self._let_go()
        if self._box is not None:
            self._box.close()

    def _wrong(self, now: float) -> Fault | None:
        return super()._wrong(now) if self._met else self._unmet(now)

    def _unmet(self, now: float) -> Fault | None:
        """Return why the vehicle does not get ready, if it does not."""
        state = self._connection.craft.state()
        reported = state.charge is not None or now - self._begun > BATTERY_SECONDS
        self._met = self._helm.done(now) and reported
        if self._met:
            return self._astray(state.north, state.east)
        if now < self._until:
            return None
        if state.age > self._reach.patience:
            return Fault(LINK_LOST, "no messages of a vehicle received on its bus")
        return Fault(POSITION_LOST, "the vehicle does not know where it is")

    def _astray(self, north: float, east: float) -> Fault | None:
        """Return that the vehicle is not where its program begins; one that resumes may be anywhere."""
        home = self._sheet.home
        away = hypot(north - home[0], east - home[1])
        if self._live.resumed or away <= self._reach.home_tolerance:
            return None
        return Fault(REFUSED, f"the vehicle is {away:.0f} m from its home: bring it home before it begins")
