"""Where in the water, and by what name, a camera has seen something."""

from __future__ import annotations

from collections.abc import Iterable
from math import dist

from auv_vessel.eyes import Detection, owner_of
from auv_vessel.sheet import Vector
from auv_vision.cameras import Camera, Pose
from auv_vision.detecting import Sighting, Sought


def detections_of(
    sightings: Iterable[Sighting], camera: Camera, pose: Pose, time: float, robot: str = ""
) -> list[Detection]:
    """Return what is told of sightings; each name at most once, the surest first.

    Args:
        sightings: in the camera's pictures.
        camera: of the vehicle.
        pose: where the vehicle believed to be when the pictures were taken, at `time`.
        time: seconds of the vehicle's clock.
        robot: whose camera it is; empty: that is not told.
    """
    found: dict[str, Detection] = {}
    for each in sorted(sightings, key=lambda each: -each.confidence):
        place = camera.world(each.point, pose)
        name = name_of(each.matches, place)
        if name is not None and name not in found:
            found[name] = Detection(time, name, each.confidence, *place, camera.name, owner_of(robot))
    return list(found.values())


def name_of(matches: Iterable[Sought], place: Vector) -> str | None:
    """Return which of things that look the same is at a place; None where nothing tells them apart."""
    known = list(matches)
    if len(known) == 1:
        return known[0].name
    expected = [(dist(each.place, place), each.name) for each in known if each.place is not None]
    return min(expected)[1] if len(expected) == len(known) else None
