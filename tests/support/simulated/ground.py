"""A ground station of a simulated vehicle: the time of the vehicle passes while the station waits."""

import socket
from collections import deque

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.sitl import Settings, SimulatedVehicle

TICK = 0.05
SECONDS = 20.0
"""Of simulated time."""


class Ground:
    """Receives from one vehicle, and sends to it."""

    def __init__(self) -> None:
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.bind(("127.0.0.1", 0))
        self.socket.setblocking(False)
        self.mav = mavlink.MAVLink(None, srcSystem=255, srcComponent=190)
        self.mav.robust_parsing = True
        self.vehicle: SimulatedVehicle
        self._peer = None
        self._inbox: deque = deque()

    @property
    def address(self) -> tuple[str, int]:
        return self.socket.getsockname()

    def switch_on(self, **given) -> SimulatedVehicle:
        """Create the vehicle, and wait until it has a position."""
        settings = Settings(**{"boot": 0.5, "ready": 0.5, **given})
        self.vehicle = SimulatedVehicle(self.address[1], settings)
        self.receive("GLOBAL_POSITION_INT", lambda message: message.lat)
        return self.vehicle

    def close(self) -> None:
        self.socket.close()
        if hasattr(self, "vehicle"):
            self.vehicle.close()

    def wait(self, seconds: float) -> None:
        """Let time pass, and forget what arrives."""
        self.receive("", seconds=seconds)

    def receive(self, kind: str | None, test=lambda message: True, seconds: float = SECONDS):
        """Return the first message of a kind (None: of any) that passes a test; None if none comes."""
        pilot = self.vehicle.autopilot
        until = pilot.time + seconds
        while True:
            self.vehicle.receive()
            self._collect()
            while self._inbox:
                message = self._inbox.popleft()
                if kind in (None, message.get_type()) and test(message):
                    return message
            if pilot.time >= until:
                return None
            self.vehicle.advance(TICK)

    def send(self, message) -> None:
        self.socket.sendto(message.pack(self.mav), self._peer)

    def command(self, number: int, *params: float):
        """Return the acknowledgement of a command; None if none comes."""
        values = (*params, 0, 0, 0, 0, 0, 0, 0)[:7]
        self.send(mavlink.MAVLink_command_long_message(1, 1, number, 0, *values))
        return self.receive("COMMAND_ACK", lambda message: message.command == number, 2.0)

    def _collect(self) -> None:
        while True:
            try:
                data, self._peer = self.socket.recvfrom(65_535)
            except BlockingIOError:
                return
            self._inbox += self.mav.parse_buffer(data) or ()
