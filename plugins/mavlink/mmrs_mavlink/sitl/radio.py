"""Radios of a simulated vehicle: MAVLink over UDP with packet loss, latency and forwarding."""

from __future__ import annotations

import heapq
import random
import socket
import time
from collections.abc import Callable, Iterator, Sequence
from typing import Any

from pymavlink.dialects.v10 import ardupilotmega as old
from pymavlink.dialects.v20 import ardupilotmega as mavlink

Message = Any

LARGEST = 65_535
SIGNATURE_EPOCH = 1_420_070_400
COMPONENT = 1


class SimulatedRadio:
    """Sends to one address, and receives from it.

    Attributes:
        down: returns whether the link is cut. silent: returns whether it sends nothing.
        sent, received: number of messages.
    """

    def __init__(
        self,
        address: tuple[str, int],
        system: int,
        *,
        key: bytes = b"",
        loss: float = 0.0,
        delay: float = 0.0,
        seed: int = 0,
        old: bool = False,
    ) -> None:
        """Open a socket.

        Args:
            address: host and UDP port of the ground station; a name is resolved once.
            system: MAVLink system of the vehicle.
            key: signing key; empty: unsigned.
            loss: fraction of packets lost, in each direction.
            delay: latency in real seconds, in each direction.
            seed: of the losses.
            old: whether it sends MAVLink 1 only.

        Raises:
            ValueError: the host cannot be resolved.
        """
        self.down: Callable[[], bool] = lambda: False
        self.silent: Callable[[], bool] = lambda: False
        self.sent = self.received = 0
        self._address = _resolved(address)
        self._loss, self._delay = loss, delay
        self._random = random.Random(seed * 1009 + system)
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.bind(("127.0.0.1" if self._address[0] == "127.0.0.1" else "0.0.0.0", 0))
        self._socket.setblocking(False)
        self._mav = mavlink.MAVLink(None, srcSystem=system, srcComponent=COMPONENT)
        self._mav.robust_parsing = True
        self._old = old
        self._leaving: list[tuple[float, int, bytes]] = []
        self._coming: list[tuple[float, int, bytes]] = []
        self._order = 0
        if key:
            signing = self._mav.signing
            signing.secret_key, signing.sign_outgoing = key, True
            signing.timestamp = int((time.time() - SIGNATURE_EPOCH) * 100_000)

    def fileno(self) -> int:
        """Return the number of the socket."""
        return self._socket.fileno()

    def close(self) -> None:
        """Close the socket."""
        self._socket.close()

    def send(self, message: Message) -> None:
        """Send a message, unless it is lost."""
        data = packed(message, self._mav) if self._old else bytes(message.pack(self._mav))
        if data is not None:
            self._mav.seq = (self._mav.seq + 1) % 256
            self.relay(data)

    def relay(self, data: bytes) -> None:
        """Send a frame unchanged, unless it is lost."""
        if self._loses():
            return
        if self._delay:
            self._order += 1
            heapq.heappush(self._leaving, (time.monotonic() + self._delay, self._order, data))
        else:
            self._transmit(data)

    def receive(self) -> Iterator[Message]:
        """Yield the messages that have arrived."""
        for data in self._datagrams():
            for message in self._mav.parse_buffer(data) or ():
                if message.get_type() != "BAD_DATA":
                    self.received += 1
                    yield message

    @property
    def pending(self) -> bool:
        """Return whether a delayed packet has not arrived yet."""
        return bool(self._coming)

    def flush(self) -> None:
        """Send the packets whose delay is over."""
        while self._leaving and self._leaving[0][0] <= time.monotonic():
            self._transmit(heapq.heappop(self._leaving)[2])

    def _datagrams(self) -> Iterator[bytes]:
        while True:
            try:
                data = self._socket.recv(LARGEST)
            except BlockingIOError:
                break
            except ConnectionError:
                continue
            if not self._loses():
                self._order += 1
                heapq.heappush(self._coming, (time.monotonic() + self._delay, self._order, data))
        while self._coming and self._coming[0][0] <= time.monotonic():
            yield heapq.heappop(self._coming)[2]

    def _transmit(self, data: bytes) -> None:
        if self.silent():
            return
        try:
            self._socket.sendto(data, self._address)
            self.sent += 1
        except OSError:
            return  # no receiver, no route or a full buffer: lost, as on any radio

    def _loses(self) -> bool:
        return self.down() or (self._loss > 0.0 and self._random.random() < self._loss)


def receive(radios: Sequence[SimulatedRadio], system: int) -> Iterator[Message]:
    """Yield the messages that have arrived by a vehicle's radios, and forward those not only for it."""
    for radio in radios:
        for message in radio.receive():
            if (message.get_srcSystem(), message.get_srcComponent()) == (system, COMPONENT):
                continue
            if getattr(message, "target_system", 0) != system and message.get_type() != "RADIO_STATUS":
                for other in radios:
                    if other is not radio:
                        other.relay(bytes(message.get_msgbuf()))
            yield message


def packed(message: Message, sender: Any) -> bytes | None:
    """Return a message as MAVLink 1 frame, without extension fields; None if MAVLink 1 lacks it."""
    kind = getattr(old, type(message).__name__, None)
    if kind is None:
        return None
    values = [getattr(message, name) for name in kind.fieldnames]
    packer = old.MAVLink(None, srcSystem=sender.srcSystem, srcComponent=sender.srcComponent)
    packer.seq = sender.seq
    return bytes(kind(*(each.encode() if isinstance(each, str) else each for each in values)).pack(packer))


def _resolved(address: tuple[str, int]) -> tuple[str, int]:
    host, port = address
    try:
        return socket.gethostbyname(host), port
    except (OSError, UnicodeError) as error:
        raise ValueError(f"{host}: cannot be resolved") from error
