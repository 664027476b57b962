"""Radios of a simulated vehicle: MAVLink over UDP with packet loss, latency and routing."""

from __future__ import annotations

import heapq
import random
import socket
import time
from collections.abc import Callable, Iterator
from typing import Any

from pymavlink.dialects.v10 import ardupilotmega as old
from pymavlink.dialects.v20 import ardupilotmega as mavlink

Message = Any

LARGEST = 65_535
SIGNATURE_EPOCH = 1_420_070_400
COMPONENT = 1
BROADCAST = 0
NEVER_ROUTED = frozenset({"RADIO", "RADIO_STATUS"})
"""Messages of a radio about itself."""


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
        if self._old:
            data = packed(message, self._mav.srcSystem, COMPONENT, self._mav.seq)
        else:
            data = bytes(message.pack(self._mav))
        if data is not None:
            self._mav.seq = (self._mav.seq + 1) % 256
            self.relay(data)

    def relay(self, data: bytes) -> None:
        """Send a frame of another sender unchanged, unless it is lost."""
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


class Router:
    """Routes messages between a vehicle and its radios by the rules of ArduPilot's ``MAVLink_routing``.

    Heartbeats go to every other radio by which their sender was not received; other messages go to the radios
    by which their target was received, and broadcasts to all by which any system was received.
    """

    def __init__(self, system: int, *radios: SimulatedRadio) -> None:
        self.radios = radios
        self._own = (system, COMPONENT)
        self._routes: dict[tuple[int, int], set[SimulatedRadio]] = {}

    def send(self, message: Message) -> None:
        """Send a message to its target; one that was never received is sought by all radios."""
        for radio in self._towards(*_target(message)) or self.radios:
            radio.send(message)

    def receive(self) -> Iterator[Message]:
        """Yield the messages that have arrived, for any target, and forward them."""
        for radio in self.radios:
            for message in radio.receive():
                source = (message.get_srcSystem(), message.get_srcComponent())
                if source == self._own:
                    continue
                self._routes.setdefault(source, set()).add(radio)
                for other in self._further(message, source) - {radio}:
                    other.relay(bytes(message.get_msgbuf()))
                yield message

    def _further(self, message: Message, source: tuple[int, int]) -> set[SimulatedRadio]:
        """Return the radios to which a message is forwarded."""
        if message.get_type() in NEVER_ROUTED:
            return set()
        if message.get_type() == "HEARTBEAT":
            return set(self.radios) - self._routes[source]
        system, component = _target(message)
        if system == BROADCAST:
            return set().union(*self._routes.values())
        return set() if (system, component) == self._own else self._towards(system, component)

    def _towards(self, system: int, component: int) -> set[SimulatedRadio]:
        """Return the radios by which a target was received."""
        found = [
            radios
            for (its, part), radios in self._routes.items()
            if its == system and (component in (BROADCAST, part) or system != self._own[0])
        ]
        return set().union(*found)


def packed(message: Message, system: int, component: int, number: int) -> bytes | None:
    """Return a MAVLink 2 message as MAVLink 1 frame, without extension fields; None if MAVLink 1 lacks it.

    Args:
        message: to be sent.
        system: of the sender. component: of the sender.
        number: sequence number of the frame, 0 to 255.
    """
    kind = getattr(old, type(message).__name__, None)
    if kind is None:
        return None
    values = message.to_dict()
    fields = {name: values[name] for name in kind.fieldnames}
    plain = {name: value.encode() if isinstance(value, str) else value for name, value in fields.items()}
    packer = old.MAVLink(None, srcSystem=system, srcComponent=component)
    packer.seq = number
    return bytes(kind(**plain).pack(packer))


def _target(message: Message) -> tuple[int, int]:
    return getattr(message, "target_system", BROADCAST), getattr(message, "target_component", BROADCAST)


def _resolved(address: tuple[str, int]) -> tuple[str, int]:
    host, port = address
    try:
        return socket.gethostbyname(host), port
    except (OSError, UnicodeError) as error:
        raise ValueError(f"{host}: cannot be resolved") from error
