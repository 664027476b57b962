"""Random scenes of which the truth is known, and how detections compare with it."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import cos, radians, sin
from random import Random

import numpy as np
from sample_vessels import pool_sheet

from auv_vessel.body.surroundings import BUOY, GATE, PATH, Surroundings, Thing
from auv_vision.cameras import LEFT, RIGHT, Camera, Pose, cameras_of
from auv_vision.detecting import detect, detections_of, sought_in
from auv_vision.renderer import Conditions, Renderer, directions, gate_ends, middle_of
from auv_vision.water import POOL, TOLD_APART, hazier

NOISES = (2.0, 4.0, 8.0, 16.0)
EDGE = 4.0
FRONT_CAMERA, BOTTOM_CAMERA = cameras_of(pool_sheet())


@dataclass(frozen=True)
class Scene:
    """A thing to see, what else is there, and from where it is seen, with what noise."""

    thing: Thing
    others: tuple[Thing, ...]
    camera: Camera
    pose: Pose
    noise: float
    bottom: float

    @property
    def surroundings(self) -> Surroundings:
        return Surroundings(bottom=self.bottom, things=(self.thing, *self.others))


@dataclass(frozen=True)
class Told:
    """A detection beside the truth.

    Attributes:
        kind: of the thing; its distance from the vehicle, metres; error: metres.
        right: whether name and place are, within 0.3 m or a tenth of the distance.
    """

    kind: str
    name: str
    confidence: float
    distance: float
    error: float
    right: bool


def scene(random: Random) -> Scene:
    """Return a scene: up to three other buoys of any colour, and a vehicle that heels and pitches."""
    bottom, depth, heading = 4.5, random.uniform(0.8, 2.5), random.uniform(0.0, 360.0)
    pose = Pose(0.0, 0.0, depth, random.gauss(0.0, 3.0), random.gauss(0.0, 3.0), heading)
    kind = random.choice((GATE, BUOY, BUOY, PATH))
    colour = random.choice(TOLD_APART if kind == BUOY else ("orange", "red"))
    if kind == PATH:
        place = (random.uniform(-0.4, 0.4), random.uniform(-0.5, 0.5), bottom)
        thing = Thing(kind, kind, *place, random.uniform(0.0, 360.0), colour, 1.2)
        camera = BOTTOM_CAMERA
    else:
        distance, bearing = random.uniform(1.0, 10.0), radians(heading + random.uniform(-20.0, 20.0))
        down = random.uniform(-0.15, 0.15) * distance if kind == BUOY else random.uniform(-0.6, 0.0)
        size = 2.0 if kind == GATE else random.choice((0.2, 0.3, 0.4))
        place = (distance * cos(bearing), distance * sin(bearing), depth + down)
        thing = Thing(kind, kind, *place, heading + random.uniform(-50.0, 50.0), colour, size)
        camera = FRONT_CAMERA
    others = tuple(_other(random, heading, depth, number) for number in range(random.randint(0, 3)))
    return Scene(thing, others, camera, pose, random.choice(NOISES), bottom)


def _other(random: Random, heading: float, depth: float, number: int) -> Thing:
    bearing, distance = radians(heading + random.uniform(-30.0, 30.0)), random.uniform(1.5, 9.0)
    colour = random.choice((*TOLD_APART, "blue", "white", "black"))
    place = (distance * cos(bearing), distance * sin(bearing), depth + random.uniform(-0.5, 0.8))
    return Thing(BUOY, f"other {number}", *place, 0.0, colour, 0.3)


def is_visible(given: Scene) -> bool:
    """Return whether the thing is wholly in both pictures, and nothing else is before it or touches it."""
    for side in (LEFT, RIGHT):
        box = _box(given, given.thing, side)
        if box is None:
            return False
        low, high = box
        inside = (low > EDGE).all() and (high < (given.camera.width - EDGE, given.camera.height - EDGE)).all()
        if not inside or any(_meets(given, other, side, low, high) for other in given.others):
            return False
    return True


def _meets(given: Scene, other: Thing, side: float, low: object, high: object) -> bool:
    box = _box(given, other, side)
    return box is not None and bool((box[0] < np.asarray(high) + EDGE).all() and (box[1] > low - EDGE).all())


def _box(given: Scene, thing: Thing, side: float) -> tuple[np.ndarray, np.ndarray] | None:
    """Return the upper left and the lower right corner of a thing's picture; None: not ahead."""
    seen = given.camera.seen(_corners(thing), given.pose, side)
    if (seen[:, 2] < 0.4).any():
        return None
    pixels = given.camera.pixels(seen)
    round_it = given.camera.focal * (thing.size / 2.0 if thing.kind == BUOY else 0.07) / seen[:, 2].min()
    return pixels.min(axis=0) - round_it, pixels.max(axis=0) + round_it


def _corners(thing: Thing) -> np.ndarray:
    if thing.kind == BUOY:
        return middle_of(thing)[None, :]
    if thing.kind == PATH:
        half = directions(thing.heading)[0] * thing.size / 2.0
        return np.array((middle_of(thing) - half, middle_of(thing) + half))
    down = np.array((0.0, 0.0, thing.size / 2.0))
    return np.array([each for end in gate_ends(thing) for each in (end, end + down)])


def look(given: Scene, seed: int, haze: float = 1.0, believed: float | None = None) -> list[Told]:
    """Return what is detected in a scene, beside the truth.

    Args:
        haze: times that of a clear pool. believed: what detection takes it to be; None: the same.
    """
    around = replace(given.surroundings, haze=haze)
    renderer = Renderer(around, seed, Conditions(noise=given.noise))
    pair = renderer.pair(given.camera, given.pose, 0.3 * seed)
    water = hazier(POOL, haze if believed is None else believed)
    sightings = detect(*pair, given.camera, sought_in(around), water)
    things = {thing.name: thing for thing in around.things}
    found = []
    for told in detections_of(sightings, given.camera, given.pose, 0.0):
        thing = things[told.name]
        error = float(np.linalg.norm(middle_of(thing) - (told.north, told.east, told.depth)))
        distance = distance_of(thing, given.pose)
        right = error < max(0.3, 0.1 * distance)
        found.append(Told(thing.kind, told.name, told.confidence, distance, error, right))
    return found


def distance_of(thing: Thing, pose: Pose) -> float:
    """Return how far a thing is from a vehicle, metres."""
    return float(np.linalg.norm(middle_of(thing) - pose.place))


def trials(
    count: int, seed: int, haze: float = 1.0, believed: float | None = None
) -> Iterator[tuple[Scene, list[Told]]]:
    """Yield scenes with what was detected in them, in water as `look` has it."""
    random = Random(seed)
    for number in range(count):
        given = scene(random)
        yield given, look(given, number, haze, believed)
