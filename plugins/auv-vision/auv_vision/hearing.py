"""Where the vehicle believes to be, as its sensor controller tells it on the bus."""

from __future__ import annotations

import threading
import time

from auv_vessel.hosting import Port, clock_time
from auv_vessel.wire.codec import Codec
from auv_vessel.wire.frame import Frame
from auv_vision.cameras import Pose

STALE = 1.0
"""Seconds of silence after which a pose is not known any more."""


class Whereabouts:
    """Hears places and poses; one thread may hear while another asks."""

    def __init__(self, codec: Codec) -> None:
        self._codec = codec
        self._lock = threading.Lock()
        self._values: dict[str, dict[str, float]] = {}
        self._heard: dict[str, float] = {}
        self._clock: float | None = None

    def hear(self, frame: Frame) -> None:
        """Take a frame of the bus."""
        told = clock_time(frame)
        if told is not None:
            self._clock = told
            return
        received = self._codec.decode(frame)
        if received is None or received.name not in ("Position", "Depth", "Pose"):
            return
        values = {key: float(value) for key, value in received.values.items() if not isinstance(value, str)}
        with self._lock:
            self._values[received.name] = values
            self._heard[received.name] = time.monotonic()

    def pose(self) -> Pose | None:
        """Return where the vehicle believes to be; None if that is not known, or not to be trusted."""
        with self._lock:
            now = time.monotonic()
            if len(self._heard) < 3 or now - min(self._heard.values()) > STALE:
                return None
            place, depth, turned = (self._values[name] for name in ("Position", "Depth", "Pose"))
        if not depth["Trusted"]:
            return None
        return Pose(
            place["North"], place["East"], depth["Depth"], turned["Roll"], turned["Pitch"], turned["Heading"]
        )

    def now(self) -> float:
        """Return the time as the vehicle tells it; as this computer does, where nobody tells."""
        return time.time() if self._clock is None else self._clock

    def listen(self, port: Port, stop: threading.Event) -> None:
        """Hear a bus until told to stop; raises what the port does when the bus is gone."""
        while not stop.is_set():
            if (frame := port.receive(0.1)) is not None:
                self.hear(frame)
