"""A ground station: a bare socket, and pymavlink's codec."""

from __future__ import annotations

import socket
import time

from pymavlink.dialects.v20 import ardupilotmega as mavlink


class Ground:
    """Hears one vehicle, and sends to it."""

    def __init__(self, connection: socket.socket) -> None:
        self.socket = connection
        self.mav = mavlink.MAVLink(None, srcSystem=255, srcComponent=190)
        self.mav.robust_parsing = True
        self.peer = None

    def hear(self, test, seconds: float = 5.0):
        """Return the first message that a test finds good; None if none comes."""
        until = time.monotonic() + seconds
        while time.monotonic() < until:
            try:
                data, self.peer = self.socket.recvfrom(65_535)
            except TimeoutError:
                continue
            for message in self.mav.parse_buffer(data) or ():
                if test(message):
                    return message
        return None

    def of(self, kind: str, seconds: float = 5.0):
        return self.hear(lambda message: message.get_type() == kind, seconds)

    def send(self, message) -> None:
        self.socket.sendto(message.pack(self.mav), self.peer)

    def command(self, number: int, *params: float):
        values = (*params, 0, 0, 0, 0, 0, 0, 0)[:7]
        self.send(mavlink.MAVLink_command_long_message(1, 1, number, 0, *values))
        return self.hear(lambda m: m.get_type() == "COMMAND_ACK" and m.command == number, 2.0)
