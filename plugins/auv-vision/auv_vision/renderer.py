"""Stereo pictures of the simulated water, as cameras of a vehicle would take them."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from math import cos, pi, radians, sin

import cv2
import numpy as np

from auv_vessel.body.surroundings import BUOY, GATE, PATH, Surroundings, Thing
from auv_vision.cameras import LEFT, RIGHT, Camera, Numbers, Picture, Pose
from auv_vision.water import POOL, Water, bgr, hazier

NEAR = 0.15
"""Metres ahead of an eye within which nothing is drawn."""

POST = 0.05
"""Metres: radius of the posts and the bar of a gate."""

_FLOOR = np.array((205.0, 200.0, 180.0))
_SURFACE = np.array((225.0, 205.0, 150.0))
_COARSE, _PIECES, _SHIFT, _OFFSETS = 4, 6, 4, 300_000
_FINEST = float(1 << _SHIFT)


@dataclass(frozen=True, slots=True)
class Conditions:
    """What pictures suffer from.

    Attributes:
        noise: of each pixel, one sigma, of 255.
        light: on the things, 1: a bright day.
        ripple: of the light on the bottom below waves, as part of it. flicker: of all light.
    """

    noise: float = 4.0
    light: float = 1.0
    ripple: float = 0.15
    flicker: float = 0.05


class Renderer:
    """Draws what cameras see; the same seed draws the same noise."""

    def __init__(
        self,
        surroundings: Surroundings,
        seed: int = 0,
        conditions: Conditions | None = None,
        water: Water = POOL,
    ) -> None:
        self._surroundings, self._water = surroundings, hazier(water, surroundings.haze)
        self._conditions = conditions or Conditions(noise=4.0 if surroundings.noise else 0.0)
        self._random = np.random.default_rng(seed)
        self._store: Numbers = np.empty(0)

    def pair(self, camera: Camera, pose: Pose, time: float = 0.0) -> tuple[Picture, Picture]:
        """Return the pictures of the left and the right eye."""
        flicker = 1.0 + self._conditions.flicker * sin(2.1 * time + 0.7)
        light = self._conditions.light * flicker
        left, right = (self._picture(camera, pose, side, time, light) for side in (LEFT, RIGHT))
        return left, right

    def _picture(self, camera: Camera, pose: Pose, side: float, time: float, light: float) -> Picture:
        canvas = self._background(camera, pose, side, time)
        for thing in sorted(self._surroundings.things, key=lambda each: -_distance(each, camera, pose)):
            _DRAWN.get(thing.kind, _nothing)(_Canvas(canvas, camera, pose, side, self._water), thing)
        canvas = np.float32(light) * np.asarray(cv2.GaussianBlur(canvas, (3, 3), 0.8), np.float32)
        if self._conditions.noise > 0.0:
            canvas += self._noise(canvas.shape)
        return np.clip(canvas, 0.0, 255.0).astype(np.uint8)

    def _noise(self, shape: tuple[int, ...]) -> Numbers:
        """Return noise of each pixel: another part of a store each time, since drawing it takes long."""
        size = int(np.prod(shape))
        if self._store.size < size + _OFFSETS:
            amount = np.float32(self._conditions.noise)
            self._store = amount * self._random.standard_normal(size + _OFFSETS, dtype=np.float32)
        begin = int(self._random.integers(_OFFSETS))
        return self._store[begin : begin + size].reshape(shape)

    def _background(self, camera: Camera, pose: Pose, side: float, time: float) -> Numbers:
        """Return water, bottom and surface; drawn coarsely, since nothing there has edges."""
        width, height = camera.width // _COARSE, camera.height // _COARSE
        columns = (np.arange(width) + 0.5) * _COARSE - 0.5 - camera.middle[0]
        rows = (np.arange(height) + 0.5) * _COARSE - 0.5 - camera.middle[1]
        across, down = np.meshgrid(columns / camera.focal, rows / camera.focal)
        rays = np.stack((across, down, np.ones_like(across)), axis=-1) @ camera.axes @ pose.axes.T
        eye = camera.eye(pose, side)
        sinks = rays[..., 2]
        steep = np.where(np.abs(sinks) < 1e-3, 1e-3, sinks)
        times = np.where(steep > 0.0, (self._surroundings.bottom - eye[2]) / steep, -max(0.0, eye[2]) / steep)
        times = np.clip(times, 0.0, 1e3)
        metres = times * np.linalg.norm(rays, axis=-1)
        spots = eye[:2] + rays[..., :2] * times[..., None]
        colour = np.where((sinks > 0.0)[..., None], _FLOOR, _SURFACE)
        bright = 1.0 + self._conditions.ripple * _ripple(spots[..., 0], spots[..., 1], time)
        seen = self._water.seen(colour * bright[..., None], metres).astype(np.float32)
        grown = cv2.resize(seen, (camera.width, camera.height), interpolation=cv2.INTER_LINEAR)
        return np.asarray(grown, np.float32)


@dataclass(frozen=True, slots=True)
class _Canvas:
    """A picture on which one eye's view is drawn."""

    pixels: Numbers
    camera: Camera
    pose: Pose
    side: float
    water: Water

    def seen(self, points: Numbers) -> Numbers:
        return self.camera.seen(points, self.pose, self.side)

    def polygon(self, seen: Numbers, colour: Numbers) -> None:
        """Draw a flat polygon, given as an eye sees its corners."""
        seen = _ahead(seen)
        if len(seen) < 3:
            return
        metres = np.array(float(np.linalg.norm(seen.mean(axis=0))))
        corners = np.clip(self.camera.pixels(seen), -4e3, 4e3)
        if (part := self._part(corners.min(axis=0), corners.max(axis=0))) is not None:
            mask, origin, pixels = part
            spots = np.rint((corners - origin) * _FINEST).astype(np.int32)
            cv2.fillPoly(mask, [spots], 255, cv2.LINE_AA, _SHIFT)
            _blend(pixels, mask, self.water.seen(colour, metres))

    def disc(self, centre: Numbers, radius: float, colour: Numbers) -> None:
        """Draw a sphere, given as an eye sees its centre; it is brighter above."""
        if centre[2] < radius + NEAR:
            return
        metres = np.array(float(np.linalg.norm(centre)))
        spot = self.camera.pixels(centre[None, :])[0]
        size = self.camera.focal * radius / float(np.sqrt(centre[2] ** 2 - radius**2))
        if (part := self._part(spot - size, spot + size)) is not None:
            mask, origin, pixels = part
            column, row = (int(each) for each in np.rint((spot - origin) * _FINEST))
            cv2.circle(mask, (column, row), round(size * _FINEST), 255, -1, cv2.LINE_AA, _SHIFT)
            above = np.clip((spot[1] - origin[1] - np.arange(len(mask))) / size, -1.0, 1.0)
            shaded = colour * (0.85 + 0.25 * above)[:, None, None]
            _blend(pixels, mask, self.water.seen(shaded, metres))

    def _part(self, low: Numbers, high: Numbers) -> tuple[Picture, Numbers, Numbers] | None:
        """Return an empty mask for a part of the picture, the part's origin and its pixels; None: outside."""
        height, width = self.pixels.shape[:2]
        left, top = max(0, int(low[0]) - 2), max(0, int(low[1]) - 2)
        right, bottom = min(width, int(high[0]) + 3), min(height, int(high[1]) + 3)
        if left >= right or top >= bottom:
            return None
        mask = np.zeros((bottom - top, right - left), np.uint8)
        return mask, np.array((left, top), dtype=float), self.pixels[top:bottom, left:right]


def _blend(pixels: Numbers, mask: Picture, colour: Numbers) -> None:
    share = (mask.astype(np.float32) / 255.0)[..., None]
    pixels += share * (colour.astype(np.float32) - pixels)


def _ahead(seen: Numbers) -> Numbers:
    """Return the part of a polygon that lies ahead of an eye."""
    found = []
    for one, other in zip(seen, np.roll(seen, -1, axis=0), strict=True):
        if one[2] >= NEAR:
            found.append(one)
        if (one[2] < NEAR) != (other[2] < NEAR):
            found.append(one + (other - one) * ((NEAR - one[2]) / (other[2] - one[2])))
    return np.array(found).reshape(-1, 3)


def _draw_buoy(canvas: _Canvas, thing: Thing) -> None:
    centre = canvas.seen(np.array(((thing.north, thing.east, thing.depth),)))[0]
    canvas.disc(centre, thing.size / 2.0, bgr(thing.colour))


def _draw_path(canvas: _Canvas, thing: Thing) -> None:
    along, across = directions(thing.heading)
    half, side = along * (thing.size / 2.0), across * (thing.size / 16.0)
    corners = np.array((half + side, half - side, -half - side, side - half))
    canvas.polygon(canvas.seen(corners + middle_of(thing)), bgr(thing.colour))


def _draw_gate(canvas: _Canvas, thing: Thing) -> None:
    port, starboard = gate_ends(thing)
    down = np.array((0.0, 0.0, thing.size / 2.0))
    for begin, end in ((port, starboard), (port, port + down), (starboard, starboard + down)):
        _draw_pole(canvas, begin, end, bgr(thing.colour))


def _draw_pole(canvas: _Canvas, begin: Numbers, end: Numbers, colour: Numbers) -> None:
    """Draw a round pole as flat pieces that face the eye, each with its own haze."""
    along = (end - begin) / np.linalg.norm(end - begin)
    stops = np.linspace(begin - POST * along, end + POST * along, _PIECES + 1)
    seen = canvas.seen(stops)
    across = np.cross(seen[-1] - seen[0], seen.mean(axis=0))
    across *= POST / max(1e-9, float(np.linalg.norm(across)))
    for one, other in pairwise(seen):
        canvas.polygon(np.array((one + across, other + across, other - across, one - across)), colour)


def _nothing(canvas: _Canvas, thing: Thing) -> None:
    pass


_DRAWN = {BUOY: _draw_buoy, PATH: _draw_path, GATE: _draw_gate}


def middle_of(thing: Thing) -> Numbers:
    """Return north, east, depth of a thing."""
    return np.array((thing.north, thing.east, thing.depth))


def directions(heading: float) -> tuple[Numbers, Numbers]:
    """Return unit vectors along a heading and to starboard of it."""
    angle = radians(heading)
    return np.array((cos(angle), sin(angle), 0.0)), np.array((-sin(angle), cos(angle), 0.0))


def gate_ends(thing: Thing) -> tuple[Numbers, Numbers]:
    """Return the ends of a gate's bar, to port and to starboard of who passes it."""
    across = directions(thing.heading)[1] * (thing.size / 2.0)
    return middle_of(thing) - across, middle_of(thing) + across


def _distance(thing: Thing, camera: Camera, pose: Pose) -> float:
    return float(np.linalg.norm(middle_of(thing) - camera.eye(pose, 0.0)))


def _ripple(north: Numbers, east: Numbers, time: float) -> Numbers:
    """Return the light that waves throw on the bottom, from -1 to 1."""
    found: Numbers = np.zeros_like(north)
    for number, (length, turn) in enumerate(((0.9, 0.3), (0.6, 1.4), (0.45, 2.5))):
        phase = 2.0 * pi / length * (north * cos(turn) + east * sin(turn)) + (1.3 + number) * time
        found += np.sin(phase + 0.8 * np.sin(0.7 * phase))
    clipped: Numbers = np.clip(found / 3.0, -1.0, 1.0)
    return clipped
