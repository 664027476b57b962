"""How fast a robot may go while a camera takes images in passing: one rule for the tasks of all plug-ins.

Keys of a camera's properties, as text: ``capture.interval``, the shortest time between two images, and
``exposure.time``, the time in which an image blurs, both in seconds.
"""

from __future__ import annotations

from dataclasses import replace
from math import ceil, inf

from mmrs_core.errors import InfeasibleError
from mmrs_core.planning.devices import figure
from mmrs_core.scene import Device, Repetition, Robot, Stroke

EXPOSURE_KEY, INTERVAL_KEY = "exposure.time", "capture.interval"


MOST_CUTS = 16
"""Places at most at which one stroke may be split."""

NOTICING = 0.05
"""Seconds by which an autopilot triggers late, at most; in a simulation of one, 0.1 m late at 4.8 m/s."""


def trigger_distance(length: float, spacing: float, speed: float) -> float:
    """Return the metres after which a camera is triggered along a line, so that its images are spread evenly.

    Args:
        length: of the straight line, with an image at either end.
        spacing: metres between two images, at most; what the autopilot is late is taken off.
        speed: metres per second.

    >>> trigger_distance(100.0, 30.0, 10.0)
    25.0
    """
    most = spacing - min(NOTICING * speed, spacing / 2.0)
    return length / ceil(length / most - 1e-6)


def in_passing(stroke: Stroke, spacing: float, action: str, device: str, interval: float) -> Stroke:
    """Return a stroke along which images are taken in passing instead, spread evenly from end to end.

    It may be split where there is an image: both parts then have one there.

    Args:
        stroke: with its largest speed.
        spacing: metres between two images, at most.
        action: of the device, with a distance.
        device: its identifier.
        interval: seconds between two images, at least; where these are nearer than `spacing`, the robot is
            slower.
    """
    length, speed = stroke.length, stroke.speed
    every = trigger_distance(length, spacing, speed or 0.0)
    if interval > 0.0:
        speed = min(every / interval, inf if speed is None else speed)
    images = [index * every for index in range(1, round(length / every))]
    few = -(-len(images) // MOST_CUTS) or 1
    repetition = Repetition(every, action, device)
    return replace(stroke, actions=(), speed=speed, repetition=repetition, cuts=tuple(images[few - 1 :: few]))


def passing_speed(
    camera: Device, robot: Robot, spacing: float, pixel: float | None, blur: float, most: float = inf
) -> float:
    """Return the largest speed at which images in passing are sharp and near enough to each other.

    Args:
        camera: that takes them. Without an exposure time its images count as sharp.
        robot: that carries it.
        spacing: metres between two images, at most.
        pixel: size of a pixel on what is seen, metres; None: unknown, so that blur does not count.
        blur: pixels by which an image may be smeared during an exposure.
        most: speed that is not exceeded anyway, metres per second.

    Raises:
        InfeasibleError: the camera does not state its interval, or the robot cannot go so slowly.
    """
    interval, exposure = (figure(camera.properties, key) for key in (INTERVAL_KEY, EXPOSURE_KEY))
    if interval is None:
        raise InfeasibleError(f"device '{camera.id}' does not state {INTERVAL_KEY}")
    sharp = blur * pixel / exposure if pixel is not None and exposure is not None else inf
    speed = min(sharp, spacing / interval, most)
    slowest = robot.kinematics.slowest if robot.kinematics is not None else 0.0
    if not speed > 0.0 or speed < slowest:
        raise InfeasibleError(
            f"images of device '{camera.id}' in passing are sharp and overlap up to {speed:.2f} m/s, "
            f"the robot's smallest speed is {slowest:.2f} m/s"
        )
    return speed
