"""The simulated vehicle's radio: MAVLink over UDP, with what gets lost and what comes late."""

from __future__ import annotations

import heapq
import random
import socket
import time
from collections.abc import Callable, Iterator
from typing import Any

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.sitl.old_frames import packed

Message = Any

LARGEST = 65_535
SIGNATURE_EPOCH = 1_420_070_400
COMPONENT = 1


class Radio:
    """Speaks to one address, and hears what comes back.

    Attributes:
        down: returns whether nothing comes through at the moment. dumb: the same, of what it sends.
        sent, heard: how many messages.
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
        """Be ready to speak.

        Args:
            address: host and UDP port of the ground station; names are looked up once.
            system: MAVLink system that speaks.
            key: to sign with and to expect signatures of; empty: no signatures.
            loss: part of all datagrams that are lost, either way.
            delay: real seconds that a datagram takes, either way.
            seed: of the losses.
            old: whether it speaks MAVLink 1, for good.

        Raises:
            ValueError: the host has no address.
        """
        self.down: Callable[[], bool] = lambda: False
        self.dumb: Callable[[], bool] = lambda: False
        self.sent = self.heard = 0
        self._address = _found(address)
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
            self._sign(key)

    def fileno(self) -> int:
        """Return what a selector waits for."""
        return self._socket.fileno()

    def close(self) -> None:
        """Fall silent."""
        self._socket.close()

    def send(self, message: Message) -> None:
        """Send a message, unless it is lost."""
        data = self._packed(message)
        if data is not None:
            self._mav.seq = (self._mav.seq + 1) % 256
            self.relay(data)

    def relay(self, data: bytes) -> None:
        """Send a frame of somebody else's as it is, unless it is lost."""
        if self._loses():
            return
        if self._delay:
            self._order += 1
            heapq.heappush(self._leaving, (time.monotonic() + self._delay, self._order, data))
        else:
            self._transmit(data)

    def receive(self) -> Iterator[Message]:
        """Yield what has come."""
        for data in self._datagrams():
            for message in self._mav.parse_buffer(data) or ():
                if message.get_type() != "BAD_DATA":
                    self.heard += 1
                    yield message

    @property
    def late(self) -> bool:
        """Return whether something is on its way that has not been heard yet."""
        return bool(self._coming)

    def flush(self) -> None:
        """Send what was held back long enough."""
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

    def _packed(self, message: Message) -> bytes | None:
        if self._old:
            return packed(message, self._mav.srcSystem, COMPONENT, self._mav.seq)
        return bytes(message.pack(self._mav))

    def _transmit(self, data: bytes) -> None:
        if self.dumb():
            return
        try:
            self._socket.sendto(data, self._address)
            self.sent += 1
        except OSError:
            return  # nobody listens there, there is no way to it, or it takes no more: lost, as on any radio

    def _loses(self) -> bool:
        return self.down() or (self._loss > 0.0 and self._random.random() < self._loss)

    def _sign(self, key: bytes) -> None:
        signing = self._mav.signing
        signing.secret_key, signing.sign_outgoing = key, True
        signing.timestamp = int((time.time() - SIGNATURE_EPOCH) * 100_000)


def _found(address: tuple[str, int]) -> tuple[str, int]:
    host, port = address
    try:
        return socket.gethostbyname(host), port
    except (OSError, UnicodeError) as error:
        raise ValueError(f"{host}: no address is known of it") from error
