"""Ground stations of people, heard over the link of a vehicle, which hands on what it hears itself.

ArduPilot and PX4 hand heartbeats on between their ports, but ArduPilot never to a port where the same
system and component is heard already (https://mavlink.io/en/guide/routing.html): that is why our own
programs do not speak as the component that ground stations usually are.
"""

from __future__ import annotations

import threading
from typing import Any

from pymavlink.dialects.v20 import ardupilotmega as mavlink

Message = Any
Station = tuple[int, int]
"""System and component."""


class Stations:
    """When each ground station was last heard; any thread may ask.

    Attributes:
        deaf: whether they are left unheard, as in a rehearsal.
    """

    def __init__(self) -> None:
        """Know of no station yet."""
        self.deaf = False
        self._heard: dict[Station, float] = {}
        self._lock = threading.Lock()

    def hear(self, heartbeat: Message, now: float) -> None:
        """Take the heartbeat of a station at a second of the run."""
        if not self.deaf:
            with self._lock:
                self._heard[heartbeat.get_srcSystem(), heartbeat.get_srcComponent()] = now

    def pass_over(self, seconds: float) -> None:
        """Leave seconds out of account in which nothing could be heard of any station."""
        with self._lock:
            self._heard = {station: heard + seconds for station, heard in self._heard.items()}

    def silent_for(self, now: float) -> float | None:
        """Return for how many seconds none of them was heard; None before the first was."""
        with self._lock:
            return max(0.0, now - max(self._heard.values())) if self._heard else None

    @property
    def systems(self) -> tuple[int, ...]:
        """Return the system ids of all that were heard, ascending."""
        with self._lock:
            return tuple(sorted({system for system, _ in self._heard}))

    def __str__(self) -> str:
        """Return which there are, for people; empty before the first was heard."""
        systems = self.systems
        word = "ground stations" if len(systems) > 1 else "ground station"
        return f"{word} {' and '.join(map(str, systems))}" if systems else ""


def is_station(message: Message) -> bool:
    """Return whether a message is the heartbeat of a ground station."""
    return bool(message.get_type() == "HEARTBEAT" and message.type == mavlink.MAV_TYPE_GCS)
