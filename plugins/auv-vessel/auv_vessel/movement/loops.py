"""Closed loops from what is wanted of speed, depth and heading to a force and a moment on the body."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, pi, radians, sin, sqrt
from typing import NamedTuple

import numpy as np

from auv_vessel.control.allocation import Array
from auv_vessel.movement.abilities import Abilities

SPEED_GAIN, SPEED_INTEGRAL = 1.0, 0.25
DEPTH_GAIN, RISE_GAIN, RISE_INTEGRAL = 0.5, 1.4, 0.35
HEADING_GAIN, TURN_GAIN, TURN_INTEGRAL = 0.8, 2.5, 0.8
TILT_GAIN, TILT_DAMPING = 2.0, 2.0
"""Gains of loops: per second (P of an outer and an inner loop), per second squared (I of an inner one)."""

ERROR, TURN_ERROR = 0.25, 0.5
"""Metres per second, radians per second: errors beyond which integrals wait."""

SLOWING = 0.4
"""Part of yaw moment that braking a turn is planned with."""


class Motion(NamedTuple):
    """The state of the vehicle as the sensor controller says it: metres, degrees, and these per second."""

    north: float = 0.0
    east: float = 0.0
    depth: float = 0.0
    uncertainty: float = 0.0
    roll: float = 0.0
    pitch: float = 0.0
    heading: float = 0.0
    surge: float = 0.0
    sway: float = 0.0
    heave: float = 0.0
    rolling: float = 0.0
    pitching: float = 0.0
    yawing: float = 0.0
    current_north: float = 0.0
    current_east: float = 0.0

    def over_ground(self) -> tuple[float, float, float]:
        """Return the speed to the north, to the east and down."""
        north, east, down = rotation(self.roll, self.pitch, self.heading) @ (
            self.surge,
            self.sway,
            self.heave,
        )
        return float(north), float(east), float(down)


@dataclass(frozen=True, slots=True)
class Aim:
    """What loops are to bring about.

    Attributes:
        north, east: speed over ground, metres per second.
        depth: metres. heading: degrees.
    """

    north: float
    east: float
    depth: float
    heading: float


def rotation(roll: float, pitch: float, heading: float) -> Array:
    """Return the matrix that turns what is along the body's axes into north, east, down; degrees."""
    a, b, c = radians(roll), radians(pitch), radians(heading)
    sa, ca, sb, cb, sc, cc = sin(a), cos(a), sin(b), cos(b), sin(c), cos(c)
    return np.array((
        (cc * cb, cc * sb * sa - sc * ca, cc * sb * ca + sc * sa),
        (sc * cb, sc * sb * sa + cc * ca, sc * sb * ca - cc * sa),
        (-sb, cb * sa, cb * ca),
    ))  # fmt: skip


def turn(wanted: float, heading: float) -> float:
    """Return by how much to turn, degrees, by the shorter way, positive to starboard."""
    return (wanted - heading + 180.0) % 360.0 - 180.0


class Loops:
    """A cascade: place and depth to speed (before, by `Aim`), speed to force; heading to rate to moment.

    Gains are per unit of mass, so that they hold for every vehicle; drag at the wanted speed through the
    water and the weight in water are fed forward, and what is left is integrated. Integrals wait while
    thrusters cannot give what is asked, and while errors are large, unless that would make them less: of a
    vehicle that pressed against the ground nothing is left that keeps it there.

    Args:
        served: of surge, sway, heave, roll, pitch, yaw: whether thrusters can push along it.
    """

    def __init__(self, abilities: Abilities, served: tuple[bool, ...]) -> None:
        self._abilities = abilities
        self.served = served
        self.limited = False
        self._push: Array = np.zeros(3)
        self._twist = 0.0

    def reset(self) -> None:
        """Forget what was integrated."""
        self._push = np.zeros(3)
        self._twist = 0.0

    def wrench(self, aim: Aim, motion: Motion, period: float) -> Array:
        """Return force (N) and moment (N.m) on the body for the next period, seconds."""
        return np.concatenate((self._force(aim, motion, period), self._moment(aim, motion, period)))

    def _force(self, aim: Aim, motion: Motion, period: float) -> Array:
        can = self._abilities
        world = rotation(motion.roll, motion.pitch, motion.heading)
        down = min(max(DEPTH_GAIN * (aim.depth - motion.depth), -can.steepest), can.steepest)
        wanted = np.array((aim.north, aim.east, down))
        error = world.T @ wanted - np.array((motion.surge, motion.sway, motion.heave))
        through = world.T @ (wanted - np.array((motion.current_north, motion.current_east, 0.0)))
        drag = (can.linear[:3] + can.quadratic[:3] * np.abs(through)) * through
        gains = np.array((SPEED_GAIN, SPEED_GAIN, RISE_GAIN))
        force = can.mass[:3] * gains * error + drag + world.T @ np.array((0.0, 0.0, -can.weight))
        self._integrate(world, error, motion, period)
        total = force + world.T @ self._push
        within: Array = np.clip(total, -can.most[:3], can.most[:3]) * np.array(self.served[:3])
        return within

    def _integrate(self, world: Array, error: Array, motion: Motion, period: float) -> None:
        """Integrate the error of speed along the body's axes, and keep it along those of the world."""
        can = self._abilities
        rates = np.array((SPEED_INTEGRAL, SPEED_INTEGRAL, RISE_INTEGRAL))
        gained = can.mass[:3] * rates * error * np.array(self.served[:3]) * period
        less = world @ gained
        more = np.where(less * self._push < 0.0, less, world @ (gained * (np.abs(error) < ERROR)))
        if motion.depth < can.afloat:
            more[2] = max(0.0, more[2])
        if self.limited:
            more = np.where(more * self._push > 0.0, 0.0, more)
        most = float(max(can.most[0], can.most[1]))
        self._push = np.clip(self._push + more, (-most, -most, -can.most[2]), (most, most, can.most[2]))

    def _moment(self, aim: Aim, motion: Motion, period: float) -> Array:
        can = self._abilities
        left = radians(turn(aim.heading, motion.heading))
        braking = SLOWING * can.most[5] / can.mass[5]
        rate = min(can.turning, HEADING_GAIN * abs(left), sqrt(2.0 * braking * abs(left)))
        rate = rate if left > 0.0 else -rate
        error = rate - radians(motion.yawing)
        drag = (can.linear[5] + can.quadratic[5] * abs(rate)) * rate
        more = can.mass[5] * TURN_INTEGRAL * error * period
        less = more * self._twist < 0.0
        if less or (abs(error) < TURN_ERROR and not self.limited):
            self._twist = min(max(self._twist + more, -can.most[5]), can.most[5])
        yaw = can.mass[5] * TURN_GAIN * error + drag + self._twist
        roll = -can.mass[3] * (TILT_GAIN * radians(motion.roll) + TILT_DAMPING * radians(motion.rolling))
        pitch = -can.mass[4] * (TILT_GAIN * radians(motion.pitch) + TILT_DAMPING * radians(motion.pitching))
        most = can.most[3:] * np.array((0.3, 0.3, 1.0))
        within: Array = np.clip(np.array((roll, pitch, yaw)), -most, most) * np.array(self.served[3:])
        return within


def bearing(north: float, east: float) -> float:
    """Return the direction of a vector, degrees clockwise from north."""
    return float(np.arctan2(east, north)) * 180.0 / pi % 360.0
