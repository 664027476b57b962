"""Faults that are made on purpose on the way between a decision centre and its vehicle's bus."""

from __future__ import annotations

from typing import Protocol

from auv_vessel.hosting import Port, tells_time
from auv_vessel.wire import ports
from auv_vessel.wire.frame import Frame
from mmrs_runtime.injection import Rehearsal
from mmrs_runtime.injection.port import Line
from mmrs_runtime.ports import NOTHING, Address, Received
from mmrs_runtime.ports import Port as Carrier

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


class ClosablePort(Port, Protocol):
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
