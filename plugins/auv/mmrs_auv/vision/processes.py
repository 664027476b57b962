"""The three processes: one has pictures taken, two look at them and tell what they see."""

from __future__ import annotations

import socket
import sys
import threading
import time
from collections.abc import Callable, Mapping, Sequence

from ..vessel.eyes import to_datagram
from .cameras import Camera, Pose
from .detecting import Sought, detect
from .placing import detections_of
from .ring import Reader, Writer
from .sources import Adjusted, Source
from .water import POOL, Water

WAIT, AGAIN = 0.01, 1.0
"""Seconds between two looks for new pictures, and without any until the memory is opened anew."""


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

    Pairs bear the pose that the vehicle believed in when they were taken, and none where it knows none.

    Args:
        sources, cameras, writers: by the camera's name.

    Raises:
        SourceError: a camera is gone.
    """
    adjusted = {name: Adjusted(camera) for name, camera in cameras.items()}
    begin, taken = time.monotonic(), 0
    while not stop.wait(max(0.0, begin + taken / rate - time.monotonic())):
        pose, now = where(), clock()
        for name, source in sources.items():
            pictures = source.take(now, pose or Pose(0.0, 0.0, 0.0))
            if pictures is None:
                return
            writers[name].write(now, pose, *adjusted[name].pair(*pictures), adjusted[name].gain)
        taken = max(taken + 1, int((time.monotonic() - begin) * rate))


def watch(
    reader: Reader,
    camera: Camera,
    sought: Sequence[Sought],
    to: tuple[str, int],
    stop: threading.Event,
    water: Water = POOL,
) -> int:
    """Tell what is seen in pairs of one camera, by UDP, until told to stop; return how many were looked at.

    Only the newest pair counts. Pairs without a pose are left out, since nobody could say where things are.
    """
    looked, heard = 0, time.monotonic()
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as out:
        while not stop.is_set():
            pair = reader.newest()
            if pair is None:
                if time.monotonic() - heard > AGAIN:
                    reader.look_again()
                    heard = time.monotonic()
                stop.wait(WAIT)
                continue
            heard = time.monotonic()
            if pair.pose is None:
                continue
            looked += 1
            fitting = camera.scaled(pair.left.shape[1], pair.left.shape[0])
            sightings = detect(pair.left, pair.right, fitting, sought, water)
            for detection in detections_of(sightings, fitting, pair.pose, pair.time):
                _send(out, to_datagram(detection), to)
    return looked


def _send(out: socket.socket, data: bytes, to: tuple[str, int]) -> None:
    """Send a datagram; who listens may begin later or be gone for a while."""
    try:
        out.sendto(data, to)
    except OSError as error:
        print(f"detections are not heard: {error}", file=sys.stderr)
