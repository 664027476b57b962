"""The radio of a simulated vehicle: MAVLink 2 over UDP, to its controller and to a ground station."""

from __future__ import annotations

import socket
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from typing import Any

from pymavlink.dialects.v20 import ardupilotmega as mavlink

Message = Any
Address = tuple[str, int]

LARGEST = 65_535
SIGNATURE_EPOCH = 1_420_070_400
COMPONENT = 1
CONTROLLER, STATION = 0, 1
"""Numbers of the addresses: of the controller, and of a ground station."""


class SimulatedRadio:
    """Sends to all its addresses, receives from them, and forwards between them.

    Attributes:
        down: returns whether the link to an address, by its number, is cut.
        mute: whether nothing that it sends arrives.
        sent: number of frames.
    """

    def __init__(self, addresses: Sequence[Address], system: int, key: bytes = b"") -> None:
        """Open a socket for a MAVLink system, and for hosts and UDP ports; an empty key signs nothing.

        Raises:
            ValueError: a host cannot be resolved.
        """
        self.down: Callable[[int], bool] = lambda number: False
        self.mute, self.sent = False, 0
        self._addresses = [_resolved(*address) for address in addresses]
        is_local = all(host == "127.0.0.1" for host, _ in self._addresses)
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.bind(("127.0.0.1" if is_local else "0.0.0.0", 0))
        self._socket.setblocking(False)
        self._mav = mavlink.MAVLink(self, srcSystem=system, srcComponent=COMPONENT)
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
        self._mav.send(message)

    def write(self, frame: bytes, source: int | None = None) -> None:
        """Send a frame to all addresses but its source, unless their links are cut."""
        for number, address in enumerate(self._addresses):
            if number != source and not (self.mute or self.down(number)):
                with suppress(OSError):  # no receiver, no route or a full buffer: lost, as on any radio
                    self._socket.sendto(frame, address)
                    self.sent += 1

    def receive(self) -> Iterator[Message]:
        """Yield the messages that have arrived, and forward those that are not for the vehicle alone."""
        own = self._mav.srcSystem
        while True:
            try:
                data, address = self._socket.recvfrom(LARGEST)
            except BlockingIOError:
                return
            except ConnectionError:
                continue
            source = self._addresses.index(address) if address in self._addresses else CONTROLLER
            for message in () if self.down(source) else self._mav.parse_buffer(data) or ():
                kind, sender = message.get_type(), (message.get_srcSystem(), message.get_srcComponent())
                if kind == "BAD_DATA" or sender == (own, COMPONENT):
                    continue
                if getattr(message, "target_system", 0) != own and kind != "RADIO_STATUS":
                    self.write(bytes(message.get_msgbuf()), source)
                yield message


def _resolved(host: str, port: int) -> Address:
    try:
        return socket.gethostbyname(host), port
    except (OSError, UnicodeError) as error:
        raise ValueError(f"{host}: cannot be resolved") from error
