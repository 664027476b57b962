"""Ground stations, received over the link of a vehicle, which forwards their messages.

ArduPilot and PX4 forward heartbeats between their ports, but ArduPilot never to a port where the same
system and component was received already (https://mavlink.io/en/guide/routing.html): therefore our own
programs do not use the usual component of ground stations.
"""

from __future__ import annotations

import threading
from typing import Any

from pymavlink.dialects.v20 import ardupilotmega as mavlink

Message = Any
Station = tuple[int, int]
"""System and component."""


class Stations:
    """When each ground station was last received; any thread may ask.

    Attributes:
        deaf: whether they are ignored, as in a rehearsal.
    """

    def __init__(self) -> None:
        """Create without stations."""
        self.deaf = False
        self._received: dict[Station, float] = {}
        self._lock = threading.Lock()

    def hear(self, heartbeat: Message, now: float) -> None:
        """Take the heartbeat of a station at a second of the run."""
        if not self.deaf:
            with self._lock:
                self._received[heartbeat.get_srcSystem(), heartbeat.get_srcComponent()] = now

    def pass_over(self, seconds: float) -> None:
        """Leave out seconds in which no station could be received."""
        with self._lock:
            self._received = {station: received + seconds for station, received in self._received.items()}

    def silent_for(self, now: float) -> float | None:
        """Return the seconds since any of them was received; None before the first."""
        with self._lock:
            return max(0.0, now - max(self._received.values())) if self._received else None

    @property
    def systems(self) -> tuple[int, ...]:
        """Return the system ids of all stations received, ascending."""
        with self._lock:
            return tuple(sorted({system for system, _ in self._received}))

    def __str__(self) -> str:
        """Return their names, as printed; empty before the first message."""
        systems = self.systems
        word = "ground stations" if len(systems) > 1 else "ground station"
        return f"{word} {' and '.join(map(str, systems))}" if systems else ""


def is_station(message: Message) -> bool:
    """Return whether a message is the heartbeat of a ground station."""
    return bool(message.get_type() == "HEARTBEAT" and message.type == mavlink.MAV_TYPE_GCS)
