"""What the instruments of a simulated vehicle measure, with noise, bias and faults."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import cos, radians, sqrt
from random import Random

from auv_vessel.body.hydrodynamics import GRAVITY
from auv_vessel.body.rotation import Rows
from auv_vessel.body.surroundings import BUOY, Obstacle, Surroundings
from auv_vessel.instruments import instruments_of
from auv_vessel.sheet import Sheet, Vector

SENSORS = ("Pressure", "Rates", "Attitude", "Acceleration", "GroundSpeed", "Altitude", "Fix", "Health")
NOTHING_SEEN = 655.35

_ALTITUDE_NOISE, _RANGE_NOISE, _RANGE = 0.02, 0.05, 50.0
_MAST = 0.6  # height of the antenna above the centre of gravity, as part of the hull's height
_TILT = cos(radians(30.0))


@dataclass(slots=True)
class Faults:
    """What is wrong with a simulated vehicle; may be changed at any time.

    Attributes:
        dead: numbers of thrusters whose motors have failed; their drives say so.
        frozen: messages that repeat what they said when they froze.
        silent: messages that are no longer sent.
        noisy: by message, by how much its noise is greater than that of the instrument.
        leak: whether there is water inside.
    """

    dead: set[int] = field(default_factory=set)
    frozen: set[str] = field(default_factory=set)
    silent: set[str] = field(default_factory=set)
    noisy: dict[str, float] = field(default_factory=dict)
    leak: bool = False


@dataclass(frozen=True, slots=True)
class Truth:
    """Where a simulated vehicle is and how it moves.

    Attributes:
        time: seconds.
        north, east, depth: of the centre of gravity, metres.
        roll, pitch, heading: degrees.
        velocity: over ground, north, east, down, metres per second.
        speeds: over ground, along the body's axes, metres per second.
        rates: about the body's axes, degrees per second.
        acceleration: over ground, along the body's axes, metres per second squared.
        thrusts: in the water, newtons.
        axes: north, east and down, each in body axes.
        antenna: its depth, metres; negative in air.
    """

    time: float
    north: float
    east: float
    depth: float
    roll: float
    pitch: float
    heading: float
    velocity: Vector
    speeds: Vector
    rates: Vector
    acceleration: Vector
    thrusts: tuple[float, ...]
    axes: Rows
    antenna: float


def antenna_of(sheet: Sheet) -> float:
    """Return how high the antenna is, metres above the centre of gravity.

    It is ``antenna.height`` of `Sheet.extra`, else 0.6 of the height: just above the hull.
    """
    return sheet.extra.get("antenna.height", _MAST * sheet.height)


class Sensing:
    """The instruments of one vehicle.

    Noise and bias are those of `instruments_of`; biases are drawn once. `Sheet.extra` may say
    ``sonar.range``, the metres up to which the sonar sees something: 50 if it does not.
    """

    def __init__(self, sheet: Sheet, surroundings: Surroundings, seed: int) -> None:
        self._kit = instruments_of(sheet)
        self._surroundings = surroundings
        self._density = sheet.water_density if surroundings.density is None else surroundings.density
        self._range = sheet.extra.get("sonar.range", _RANGE)
        self._nose = sheet.length / 2.0
        self._random = Random(seed)
        self._amount = 1.0 if surroundings.noise else 0.0
        self._rates_bias = self._biases(self._kit.rates_bias)
        self._heading_bias = self._biases(self._kit.heading_bias)[0]
        self._log_bias = self._biases(self._kit.log_bias)

    def measure(self, name: str, truth: Truth, faults: Faults) -> Mapping[str, float | bool] | None:
        """Return the fields of a message of `SENSORS` but Health; None: the instrument has nothing to say."""
        amount = faults.noisy.get(name, self._amount)
        if name == "Pressure":
            return self._pressure(truth, amount)
        if name == "Rates":
            values = self._noisy(truth.rates, self._rates_bias, amount * self._kit.rates_noise)
            return dict(zip(("Roll", "Pitch", "Yaw"), values, strict=True))
        if name == "Attitude":
            return self._attitude(truth, amount)
        if name == "Acceleration":
            felt = [
                one - GRAVITY * other for one, other in zip(truth.acceleration, truth.axes[2], strict=True)
            ]
            return _along(self._noisy(felt, (0.0, 0.0, 0.0), amount * self._kit.acceleration_noise))
        if name == "GroundSpeed":
            return self._ground_speed(truth, amount)
        if name == "Altitude":
            return self._altitude(truth, amount)
        return self._fix(truth, amount)

    def range_ahead(self, truth: Truth, faults: Faults) -> float:
        """Return the metres from the nose to what the sonar sees ahead, `NOTHING_SEEN` if it sees nothing."""
        ahead = (truth.axes[0][0], truth.axes[1][0], truth.axes[2][0])
        nose = (
            truth.north + self._nose * ahead[0],
            truth.east + self._nose * ahead[1],
            truth.depth + self._nose * ahead[2],
        )
        near = min(_hits(self._surroundings, nose, ahead), default=self._range)
        if near >= self._range:
            return NOTHING_SEEN
        return max(0.0, near + self._drawn(faults.noisy.get("Health", self._amount) * _RANGE_NOISE))

    def _pressure(self, truth: Truth, amount: float) -> dict[str, float | bool]:
        water = self._density * GRAVITY * max(0.0, truth.depth)
        pressure = self._kit.pressure_air + water + self._drawn(amount * self._kit.pressure_noise)
        return {"Pressure": pressure, "Temperature": 15.0 + self._drawn(amount * 0.02)}

    def _attitude(self, truth: Truth, amount: float) -> dict[str, float | bool]:
        noise = amount * self._kit.attitude_noise
        heading = truth.heading + self._heading_bias + self._drawn(amount * self._kit.heading_noise)
        return {
            "Roll": truth.roll + self._drawn(noise),
            "Pitch": truth.pitch + self._drawn(noise),
            "Heading": heading % 360.0,
        }

    def _ground_speed(self, truth: Truth, amount: float) -> dict[str, float | bool]:
        altitude = self._surroundings.bottom - truth.depth
        if not (self._kit.log_least <= altitude <= self._kit.log_most and truth.axes[2][2] >= _TILT):
            return {"Surge": 0.0, "Sway": 0.0, "Heave": 0.0, "Valid": False}
        measured = self._noisy(truth.speeds, self._log_bias, amount * self._kit.log_noise)
        return {**_along(measured), "Valid": True}

    def _altitude(self, truth: Truth, amount: float) -> dict[str, float | bool]:
        altitude = self._surroundings.bottom - truth.depth
        if not 0.0 <= altitude <= self._kit.log_most:
            return {"Altitude": 0.0, "Valid": False}
        return {"Altitude": max(0.0, altitude + self._drawn(amount * _ALTITUDE_NOISE)), "Valid": True}

    def _fix(self, truth: Truth, amount: float) -> dict[str, float | bool] | None:
        if truth.antenna >= self._kit.fix_depth:
            return None
        noise = amount * self._kit.fix_noise
        return {"North": truth.north + self._drawn(noise), "East": truth.east + self._drawn(noise)}

    def _noisy(self, values: Vector | list[float], biases: Vector, noise: float) -> list[float]:
        return [value + bias + self._drawn(noise) for value, bias in zip(values, biases, strict=True)]

    def _biases(self, deviation: float) -> Vector:
        drawn = [self._drawn(self._amount * deviation) for _ in range(3)]
        return drawn[0], drawn[1], drawn[2]

    def _drawn(self, deviation: float) -> float:
        return self._random.gauss(0.0, deviation) if deviation > 0.0 else 0.0


def _along(values: list[float]) -> dict[str, float | bool]:
    return dict(zip(("Surge", "Sway", "Heave"), values, strict=True))


def _hits(surroundings: Surroundings, begin: Vector, along: Vector) -> list[float]:
    """Return how far it is from a point along a unit vector to each thing that is hit."""
    found = []
    if along[2] > 0.0:
        found.append(max(0.0, (surroundings.bottom - begin[2]) / along[2]))
    for obstacle in surroundings.obstacles:
        found += _to_cylinder(obstacle, begin, along)
    for thing in surroundings.things:
        if thing.kind == BUOY:
            centre = (thing.north - begin[0], thing.east - begin[1], thing.depth - begin[2])
            found += _entry(along, centre, thing.size / 2.0)
    return found


def _to_cylinder(obstacle: Obstacle, begin: Vector, along: Vector) -> list[float]:
    flat = sqrt(along[0] ** 2 + along[1] ** 2)
    if flat < 1e-9:
        return []
    direction = (along[0] / flat, along[1] / flat, 0.0)
    centre = (obstacle.north - begin[0], obstacle.east - begin[1], 0.0)
    distances = [distance / flat for distance in _entry(direction, centre, obstacle.radius)]
    return [one for one in distances if obstacle.top <= begin[2] + one * along[2] <= obstacle.bottom]


def _entry(along: Vector, centre: Vector, radius: float) -> list[float]:
    """Return how far it is from the origin along a unit vector to a sphere: one distance or none."""
    ahead = sum(one * other for one, other in zip(along, centre, strict=True))
    apart = sum(each * each for each in centre) - ahead * ahead
    if apart > radius * radius:
        return []
    half = sqrt(radius * radius - apart)
    return [max(0.0, ahead - half)] if ahead + half >= 0.0 else []
