"""How far apart the photos of a task may be: along a path, and from one path to the next."""

from __future__ import annotations

from dataclasses import dataclass, replace

from mmrs_core.errors import InfeasibleError
from mmrs_core.planning.devices import device_for
from mmrs_core.planning.in_passing import in_passing
from mmrs_core.scene import ActionAt, Device, Part, Position, Robot, Stroke
from mmrs_core.scene.attributes import number, text
from mmrs_survey.camera import CAMERA_KEYS, Footprint, footprint_at, footprint_of
from mmrs_survey.lines import cuts_between, even_distances, length_of
from mmrs_survey.passing import Capture, capture_of


@dataclass(frozen=True, slots=True)
class Shots:
    """Photos along paths.

    Attributes:
        camera: that takes them; None: none are taken.
        every: metres between two of them, at most.
        strip: metres between neighbouring paths, at most; None where what a photo covers is not known.
        capture: how they are taken.
    """

    camera: Device | None
    every: float
    strip: float | None
    capture: Capture


def shots_of(part: Part, robot: Robot, height: float, *, sideways: bool = False) -> Shots:
    """Return how photos are taken along paths, as the task states it.

    Overlaps alone ask for photos as near as the camera's optics make them so.

    Args:
        height: of the camera above what it photographs, metres.
        sideways: whether it looks aside, so that the width of a photo lies along the path.

    Raises:
        InfeasibleError: the robot has no camera for that, it is too coarse, or what it covers is unknown.
    """
    width, length = number(part, "footprintWidth"), number(part, "footprintLength")
    side, front = (1.0 - (number(part, name) or 0.0) for name in ("sideOverlap", "frontOverlap"))
    along, across = (width, length) if sideways else (length, width)
    every = number(part, "photoDistance") or (None if along is None else along * front)
    strip = None if across is None else across * side
    resolution = number(part, "groundResolution")
    overlaps = side < 1.0 or front < 1.0
    if every is None and resolution is None and not overlaps:
        return Shots(None, 0.0, strip, Capture(None, number(part, "speed")))
    camera = device_for(robot.type, text(part, "actionName"), text(part, "deviceId"))
    if resolution is not None or every is None:
        seen = (
            _footprint(part, camera, height)
            if resolution is None
            else footprint_of(camera.properties, height, resolution, camera.id)
        )
        along, across = (seen.width, seen.length) if sideways else (seen.length, seen.width)
        every, strip = every or along * front, across * side
    spacing = every or 0.0
    return Shots(camera, spacing, strip, capture_of(part, robot, camera, spacing, height))


def photographed(part: Part, line: tuple[Position, ...], shots: Shots, *, begun: bool = False) -> Stroke:
    """Return the stroke along a line with its photos, in passing where task and camera allow that.

    Args:
        begun: whether there is a photo already where it begins: at stops, another one is not taken.
    """
    how = shots.capture
    plain = Stroke(line, speed=how.speed, slow_down=None if how.speed is None else 1.0)
    if shots.camera is None:
        return replace(plain, cuts=cuts_between(line, ()))
    at = even_distances(length_of(line), shots.every)
    stroke = replace(plain, cuts=cuts_between(line, at))
    at = at[1:] if begun and how.passing is None else at
    if how.passing is None or len(at) == 1:
        action = text(part, "actionName")
        return replace(stroke, actions=tuple(ActionAt(where, action, shots.camera.id) for where in at))
    return in_passing(stroke, shots.every, how.passing, shots.camera.id, how.interval)


def spacing_of(part: Part, device: Device, altitude: float) -> Footprint:
    """Return how far apart swaths, and photos along them, may be: footprints less their overlaps.

    The ground is taken to be level at the height of the origin.

    Raises:
        InfeasibleError: neither the task nor the device defines what one photo covers, or the camera is
            too coarse.
    """
    grid = number(part, "gridResolution")
    seen = Footprint(grid, grid) if grid is not None else _footprint(part, device, altitude)
    side, front = number(part, "sideOverlap") or 0.0, number(part, "frontOverlap") or 0.0
    left = Footprint(seen.width * (1.0 - side), seen.length * (1.0 - front)) if grid is None else seen
    if not (left.width > 0.0 and left.length > 0.0):
        raise InfeasibleError("grid, footprint and overlaps leave no distance between photos")
    return left


def _footprint(part: Part, device: Device, altitude: float) -> Footprint:
    width, length = number(part, "footprintWidth"), number(part, "footprintLength")
    if width is not None and length is not None:
        return Footprint(width, length)
    resolution = number(part, "groundResolution")
    if resolution is not None:
        return footprint_of(device.properties, altitude, resolution, device.id)
    if altitude <= 0.0:
        raise InfeasibleError(f"what one photo covers is not known at {altitude:g} m: give a footprint")
    seen = footprint_at(device.properties, altitude)
    if seen is None:
        keys = ", ".join(CAMERA_KEYS[:3])
        raise InfeasibleError(f"device '{device.id}' does not state what one photo covers ({keys})")
    return seen
