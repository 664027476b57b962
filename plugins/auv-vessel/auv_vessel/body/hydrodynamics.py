"""What a hull and the water around it do to each other, as coefficients, from the hull's dimensions.

A robot's type says length, width, height, mass and weight in water. All else is taken as of the ellipsoid
that the hull's box encloses, and may be said better by `Sheet.extra`, under the names of `hull_of`.

Sources: H. Lamb, Hydrodynamics, 6th edition, 1932, articles 114 and 115 (added mass of an ellipsoid);
B. C. Carlson, Computing elliptic integrals by duplication, Numerische Mathematik 33, 1979 (its integrals);
T. I. Fossen, Handbook of Marine Craft Hydrodynamics and Motion Control, 2011, chapters 6 and 7 (the form).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import isfinite, pi, sqrt
from typing import TypeAlias, cast

from auv_vessel.sheet import Sheet, Vector

Six: TypeAlias = tuple[float, float, float, float, float, float]

AXES = ("surge", "sway", "heave", "roll", "pitch", "yaw")
GRAVITY = 9.80665

_BLUFF = 1.0  # drag coefficient across a hull
_SLEEKEST, _BLUNTEST = 0.1, 1.5  # drag coefficients along a hull that its declared speed may tell of
_CREEP = 0.1  # metres per second at which linear drag is as much as quadratic drag
_ARM = 0.1  # centre of buoyancy above centre of gravity, as part of the height


@dataclass(frozen=True, slots=True)
class Hull:
    """A hull in water. Six numbers are surge, sway, heave, roll, pitch, yaw, about the centre of gravity.

    Attributes:
        half: half the length, width and height, metres.
        mass: kilograms in air, drop weight included. volume: of water displaced when immersed, cubic metres.
        righting_arm: metres from the centre of gravity up to the centre of buoyancy.
        rigid: mass thrice, then moments of inertia, kg m2, of the hull alone.
        added: what the water adds to those.
        linear: drag per metre per second, or radian per second: N s/m, N m s.
        quadratic: drag per square of those: N s2/m2, N m s2.
        carried: added mass whose momentum turns with the hull, along the three axes, kg: the same thrice
            where fins balance Munk's moment, as `added` where nothing does.
    """

    half: Vector
    mass: float
    volume: float
    righting_arm: float
    rigid: Six
    added: Six
    linear: Six
    quadratic: Six
    carried: Vector

    @property
    def inertia(self) -> Six:
        """Inertia of hull and water together against a force or moment."""
        return _six([own + water for own, water in zip(self.rigid, self.added, strict=True)])


def hull_of(sheet: Sheet) -> Hull:
    """Return the hull of a vehicle.

    `Sheet.extra` overrides, for each of surge, sway, heave: ``added_mass.AXIS`` (kg), ``linear_drag.AXIS``
    (N s/m), ``quadratic_drag.AXIS`` (N s2/m2); for each of roll, pitch, yaw: ``inertia.AXIS`` (kg m2, of the
    hull alone), ``added_inertia.AXIS`` (kg m2), ``linear_drag.AXIS`` (N m s), ``quadratic_drag.AXIS``
    (N m s2); and ``righting_arm`` (m), ``munk`` (0 to 1).

    Without them, the hull's mass is spread evenly over the ellipsoid. Added mass is that of an ellipsoid of
    the same proportions that displaces as much water as the hull does. Drag across the hull has the
    coefficient 1 on the ellipsoid's outline, and so has turning, strip by strip. Drag ahead is what thrusters
    at operating thrust overcome at the declared speed, if that makes a coefficient from 0.1 to 1.5, else the
    nearer of these. Linear drag equals quadratic drag at 0.1 m/s, at the hull's ends when it turns. The
    centre of buoyancy is a tenth of the height above the centre of gravity. Fins are taken to balance Munk's
    moment, which turns a bare hull across its course; with ``munk`` 1, nothing does.

    Raises:
        ValueError: a dimension, mass or coefficient can't be.
    """
    half = (sheet.length / 2.0, sheet.width / 2.0, sheet.height / 2.0)
    volume = (sheet.mass - sheet.weight_in_water) / sheet.water_density if sheet.water_density > 0.0 else 0.0
    for name, value in (
        ("length", sheet.length), ("width", sheet.width), ("height", sheet.height), ("mass", sheet.mass),
        ("water density", sheet.water_density), ("displaced volume", volume),
        ("mass without the drop weight", sheet.mass - sheet.drop_weight),
    ):  # fmt: skip
        if not (isfinite(value) and value > 0.0):
            raise ValueError(f"{sheet.robot}: {name} is {value:g}, and has to be positive")
    quadratic = quadratic_drag(sheet, half)
    levers = (1.0, 1.0, 1.0, max(half[1:]), max(half[0], half[2]), max(half[:2]))
    linear = tuple(_CREEP / lever * drag for lever, drag in zip(levers, quadratic, strict=True))
    moments = _said(sheet, "inertia", ellipsoid_inertia(half, sheet.mass), AXES[3:])
    swell = (volume / (4.0 / 3.0 * pi * half[0] * half[1] * half[2])) ** (1.0 / 3.0)
    added = added_mass((half[0] * swell, half[1] * swell, half[2] * swell), sheet.water_density)
    masses = _said(sheet, "added_mass", added[:3], AXES[:3])
    mean, bare = sum(masses) / 3.0, min(1.0, _number(sheet, "munk", 0.0))
    turning = _said(sheet, "added_inertia", added[3:], AXES[3:])
    for axis, own, water in zip(AXES[3:], moments, turning, strict=True):
        if own + water <= 0.0:
            raise ValueError(f"{sheet.robot}: inertia.{axis} and added_inertia.{axis} can't both be 0")
    surge, sway, heave = (mean + bare * (mass - mean) for mass in masses)
    return Hull(
        half=half,
        mass=sheet.mass,
        volume=volume,
        righting_arm=_number(sheet, "righting_arm", _ARM * sheet.height),
        rigid=_six([sheet.mass] * 3 + moments),
        added=_six(masses + turning),
        linear=_six(_said(sheet, "linear_drag", linear)),
        quadratic=_six(_said(sheet, "quadratic_drag", quadratic)),
        carried=(surge, sway, heave),
    )


def ellipsoid_inertia(half: Vector, mass: float) -> Vector:
    """Return the moments of inertia of an even ellipsoid with those half axes, kg m2."""
    a, b, c = (axis * axis * mass / 5.0 for axis in half)
    return b + c, a + c, a + b


def added_mass(half: Vector, density: float) -> Six:
    """Return the mass and the moments of inertia that unbounded water adds to an ellipsoid, kg and kg m2."""
    a, b, c = (axis * axis for axis in half)
    extent = half[0] * half[1] * half[2]
    displaced = 4.0 / 3.0 * pi * density * extent
    alpha = 2.0 / 3.0 * extent * _degenerate_integral(b, c, a)
    beta = 2.0 / 3.0 * extent * _degenerate_integral(c, a, b)
    gamma = 2.0 / 3.0 * extent * _degenerate_integral(a, b, c)
    masses = [displaced * one / (2.0 - one) for one in (alpha, beta, gamma)]
    turns = [_turn(b, c, beta, gamma), _turn(c, a, gamma, alpha), _turn(a, b, alpha, beta)]
    return _six(masses + [displaced / 5.0 * turn for turn in turns])


def quadratic_drag(sheet: Sheet, half: Vector) -> Six:
    """Return the quadratic drag of a hull, without the values of `Sheet.extra`."""
    a, b, c = half
    pressure = 0.5 * sheet.water_density
    ahead, across, down = (pressure * pi * one * other for one, other in ((b, c), (a, c), (a, b)))
    thrust = sum(each.operating_thrust * abs(each.direction[0]) for each in sheet.thrusters)
    squared = sheet.speed * (sheet.speed + _CREEP)
    declared = thrust / squared if squared > 0.0 else 0.0
    surge = min(max(declared, _SLEEKEST * ahead), _BLUNTEST * ahead)
    strip = pressure * _BLUFF * 8.0 / 15.0
    roll = strip * (a * b**4 + a * c**4)
    pitch = strip * (b * a**4 + b * c**4)
    yaw = strip * (c * a**4 + c * b**4)
    return surge, _BLUFF * across, _BLUFF * down, roll, pitch, yaw


def _turn(one: float, other: float, integral: float, opposite: float) -> float:
    """Return the added inertia about an axis per fifth of the displaced mass, by the others' squares."""
    difference, total = one - other, one + other
    below = 2.0 * difference + total * (integral - opposite)
    if abs(difference) < 1e-6 * total or below == 0.0:
        return 0.0
    return difference * difference * (opposite - integral) / below


def _degenerate_integral(x: float, y: float, z: float) -> float:
    """Return Carlson's R_D: 3/2 of the integral of 1/((t+z) sqrt((t+x)(t+y)(t+z))) over t from 0 on."""
    total, factor = 0.0, 1.0
    while True:
        mean = (x + y + 3.0 * z) / 5.0
        dx, dy, dz = 1.0 - x / mean, 1.0 - y / mean, 1.0 - z / mean
        if max(abs(dx), abs(dy), abs(dz)) < 1e-3:
            break
        step = sqrt(x * y) + sqrt(y * z) + sqrt(z * x)
        total += factor / (sqrt(z) * (z + step))
        factor /= 4.0
        x, y, z = (x + step) / 4.0, (y + step) / 4.0, (z + step) / 4.0
    ea, eb = dx * dy, dz * dz
    ec, ed = ea - eb, ea - 6.0 * eb
    ee = ed + ec + ec
    series = 1.0 + ed * (-3.0 / 14.0 + 9.0 / 88.0 * ed - 9.0 / 52.0 * dz * ee)
    series += dz * (ee / 6.0 + dz * (-9.0 / 22.0 * ec + dz * 3.0 / 26.0 * ea))
    return 3.0 * total + factor * series / (mean * sqrt(mean))


def _said(sheet: Sheet, name: str, values: Sequence[float], axes: Sequence[str] = AXES) -> list[float]:
    return [_number(sheet, f"{name}.{axis}", value) for axis, value in zip(axes, values, strict=True)]


def _number(sheet: Sheet, name: str, default: float) -> float:
    value = sheet.extra.get(name, default)
    if not (isfinite(value) and value >= 0.0):
        raise ValueError(f"{sheet.robot}: {name} is {value:g}, and has to be 0 or more")
    return value


def _six(values: Sequence[float]) -> Six:
    return cast(Six, tuple(values))
