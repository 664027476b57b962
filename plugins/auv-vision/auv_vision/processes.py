"""The three processes: one captures pictures, two look at them and send detections."""

from __future__ import annotations

import socket
import sys
import threading
import time
from collections.abc import Callable, Mapping, Sequence

from auv_vessel.eyes import to_datagram
from auv_vision.cameras import Camera, Pose
from auv_vision.detecting import Sought, detect, detections_of
from auv_vision.ring import Reader, Writer
from auv_vision.sources import Adjusted, Source
from auv_vision.water import POOL, Water

WAIT, AGAIN = 0.01, 1.0
"""Seconds between two looks for new pictures, and without any until the memory is opened again."""

SIGNAL_SECONDS = 0.5
"""Longest wait before a signal is handled that came just before the wait, and did not end it."""

PATIENCE = 3.0
"""Seconds that something may be amiss before it is said."""


class Notice:
    """Says when something has been amiss for a while, and when it no longer is; each time once."""

    def __init__(self, amiss: str, mended: str) -> None:
        self._amiss, self._mended = amiss, mended
        self._since: float | None = None
        self._said = False

    def note(self, is_amiss: bool) -> None:
        """Take how it is now."""
        now = time.monotonic()
        if not is_amiss:
            if self._said:
                print(self._mended, file=sys.stderr, flush=True)
            self._since, self._said = None, False
        elif self._since is None:
            self._since = now
        elif not self._said and now - self._since > PATIENCE:
            self._said = True
            print(self._amiss, file=sys.stderr, flush=True)


def handle(
    sources: Mapping[str, Source],
    cameras: Mapping[str, Camera],
    writers: Mapping[str, Writer],
    where: Callable[[], Pose | None],
    clock: Callable[[], float],
    stop: threading.Event,
    rate: float,
) -> None:
    """Put pairs of all cameras into shared memory, so many each second, until a source has no more.

    Pairs carry the pose that the vehicle reported when they were taken, and none where it knows none;
    that, and the end of a film, is said.

    Args:
        sources, cameras, writers: by the camera's name.

    Raises:
        SourceError: a camera is gone.
    """
    lost = Notice(
        "frames: no certain position of the vehicle on the bus: nothing counts as detected",
        "frames: position of the vehicle received",
    )
    adjusted = {name: Adjusted(camera) for name, camera in cameras.items()}
    begin, taken = time.monotonic(), 0
    while not _ended(stop, begin + taken / rate):
        pose, now = where(), clock()
        lost.note(pose is None)
        for name, source in sources.items():
            pictures = source.take(now, pose or Pose(0.0, 0.0, 0.0))
            if pictures is None:
                print(f"frames: the film for {name} has ended", file=sys.stderr)
                return
            writers[name].write(now, pose, *adjusted[name].pair(*pictures), adjusted[name].gain)
        taken = max(taken + 1, int((time.monotonic() - begin) * rate))


def _ended(stop: threading.Event, until: float) -> bool:
    """Return, when a time has come, whether it is to end; at once if it is."""
    while (left := until - time.monotonic()) > 0.0:
        if stop.wait(min(left, SIGNAL_SECONDS)):
            return True
    return stop.is_set()


def watch(
    reader: Reader,
    camera: Camera,
    sought: Sequence[Sought],
    to: tuple[str, int],
    stop: threading.Event,
    water: Water = POOL,
    robot: str = "",
) -> int:
    """Send the detections in pairs of one camera, by UDP, until stopped; return how many were looked at.

    Only the newest pair counts. Pairs without a pose are left out, since their objects have no positions.
    """
    looked = 0
    received = seen = time.monotonic()
    blind = Notice(
        f"{camera.name}: no pictures come: does frames run, for this vehicle, with the same --memory?",
        f"{camera.name}: pictures come",
    )
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as out:
        while not stop.is_set():
            pair = reader.newest()
            blind.note(pair is None and time.monotonic() - seen > AGAIN)
            if pair is None:
                if time.monotonic() - received > AGAIN:
                    reader.look_again()
                    received = time.monotonic()
                stop.wait(WAIT)
                continue
            received = seen = time.monotonic()
            if pair.pose is None:
                continue
            looked += 1
            fitting = camera.scaled(pair.left.shape[1], pair.left.shape[0])
            sightings = detect(pair.left, pair.right, fitting, sought, water)
            for detection in detections_of(sightings, fitting, pair.pose, pair.time, robot):
                _send(out, to_datagram(detection), to)
    return looked


def _send(out: socket.socket, data: bytes, to: tuple[str, int]) -> None:
    """Send a datagram; who listens may begin later or be gone for a while."""
    try:
        out.sendto(data, to)
    except OSError as error:
        print(f"detections cannot be sent: {error}", file=sys.stderr)
