"""What a vehicle can do: how fast, how steep, how quick, by its thrusters and its drag."""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt

import numpy as np

from auv_vessel.body.hydrodynamics import GRAVITY, hull_of
from auv_vessel.control.allocation import Allocation, Array
from auv_vessel.sheet import Sheet, afloat_of

USED = 0.7
"""Part of what thrusters can give continually that movement plans with; the rest is to correct."""

STEEPEST, QUICKEST = 0.5, 45.0
"""Metres per second of sinking and rising, and degrees per second of turning, at most."""


@dataclass(frozen=True, slots=True)
class Abilities:
    """Limits of movement. Six numbers are surge, sway, heave, roll, pitch, yaw.

    Attributes:
        mass: with that of the water around: kg, kg m2.
        linear, quadratic: drag by speed and by its square.
        most: force and moment that thrusters together give at operating thrust, N and N.m.
        weight: newtons down when immersed.
        fastest: metres per second forward and to the side through the water.
        braking: metres per second squared, that it can be slowed down with.
        steepest: metres per second of sinking and rising.
        turning: radians per second.
        cruise: metres per second when no speed is said.
        afloat: depth of the centre of gravity, metres, above which it counts as at the surface.
    """

    mass: Array
    linear: Array
    quadratic: Array
    most: Array
    weight: float
    fastest: tuple[float, float]
    braking: float
    steepest: float
    turning: float
    cruise: float
    afloat: float


def abilities_of(sheet: Sheet) -> Abilities:
    """Return what a vehicle can do.

    Raises:
        ValueError: the sheet has a dimension, mass or coefficient that can't be.
    """
    hull = hull_of(sheet)
    most = Allocation(sheet).most(np.array([each.operating_thrust for each in sheet.thrusters], float))
    linear, quadratic, mass = np.array(hull.linear), np.array(hull.quadratic), np.array(hull.inertia)
    weight = sheet.weight_in_water * GRAVITY
    terminal = [_terminal(USED * most[each], linear[each], quadratic[each]) for each in range(6)]
    ahead = min(terminal[0], sheet.speed)
    lift = max(0.0, USED * most[2] - abs(weight))
    steepest = min(STEEPEST, _terminal(lift, linear[2], quadratic[2]))
    return Abilities(
        mass=mass,
        linear=linear,
        quadratic=quadratic,
        most=most,
        weight=weight,
        fastest=(ahead, min(terminal[1], sheet.speed)),
        braking=min(0.3, 0.3 * most[0] / mass[0]),
        steepest=sheet.extra.get("climb.speed", 0.8 * steepest),
        turning=min(np.radians(sheet.extra.get("turn.rate", QUICKEST)), 0.8 * terminal[5]),
        cruise=0.7 * ahead,
        afloat=afloat_of(sheet.height),
    )


def _terminal(force: float, linear: float, quadratic: float) -> float:
    """Return the speed at which drag equals a force."""
    if force <= 0.0:
        return 0.0
    if quadratic <= 0.0:
        return force / linear if linear > 0.0 else 10.0
    return (sqrt(linear * linear + 4.0 * quadratic * force) - linear) / (2.0 * quadratic)
