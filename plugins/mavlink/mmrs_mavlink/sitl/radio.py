"""Radios of a simulated vehicle: MAVLink 2 over UDP, with forwarding."""

from __future__ import annotations

import socket
import time
from collections.abc import Callable, Iterator, Sequence
from typing import Any

from pymavlink.dialects.v20 import ardupilotmega as mavlink

Message = Any

LARGEST = 65_535
SIGNATURE_EPOCH = 1_420_070_400
COMPONENT = 1


class SimulatedRadio:
    """Sends to one address, and receives from it.

    Attributes:
        down: returns whether the link is cut. silent: returns whether it sends nothing.
        sent: number of messages.
    """

    def __init__(self, address: tuple[str, int], system: int, key: bytes = b"") -> None:
        """Open a socket.

        Args:
            address: host and UDP port of the ground station; a name is resolved once.
            system: MAVLink system of the vehicle.
            key: signing key; empty: unsigned.

        Raises:
            ValueError: the host cannot be resolved.
        """
        self.down: Callable[[], bool] = lambda: False
        self.silent: Callable[[], bool] = lambda: False
        self.sent = 0
        self._address = _resolved(address)
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.bind(("127.0.0.1" if self._address[0] == "127.0.0.1" else "0.0.0.0", 0))
        self._socket.setblocking(False)
        self._mav = mavlink.MAVLink(None, srcSystem=system, srcComponent=COMPONENT)
        self._mav.robust_parsing = True
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
        """Send a message, unless the link is cut."""
        self.relay(bytes(message.pack(self._mav)))
        self._mav.seq = (self._mav.seq + 1) % 256

    def relay(self, data: bytes) -> None:
        """Send a frame unchanged, unless the link is cut."""
        if self.down() or self.silent():
            return
        try:
            self._socket.sendto(data, self._address)
            self.sent += 1
        except OSError:
            return  # no receiver, no route or a full buffer: lost, as on any radio

    def receive(self) -> Iterator[Message]:
        """Yield the messages that have arrived."""
        while True:
            try:
                data = self._socket.recv(LARGEST)
            except BlockingIOError:
                return
            except ConnectionError:
                continue
            for message in () if self.down() else self._mav.parse_buffer(data) or ():
                if message.get_type() != "BAD_DATA":
                    yield message


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


def _resolved(address: tuple[str, int]) -> tuple[str, int]:
    host, port = address
    try:
        return socket.gethostbyname(host), port
    except (OSError, UnicodeError) as error:
        raise ValueError(f"{host}: cannot be resolved") from error
