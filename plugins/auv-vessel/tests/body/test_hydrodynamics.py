"""Coefficients of a hull against closed forms of special ellipsoids."""

from dataclasses import replace
from math import atanh, log, nan, pi, sqrt

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sample_vessels import pool_sheet, torpedo_sheet

from auv_vessel.body.hydrodynamics import AXES, added_mass, ellipsoid_inertia, hull_of

DENSITY = 1025.0
HALVES = st.tuples(*[st.floats(0.02, 3.0)] * 3)


def displaced(half):
    return 4.0 / 3.0 * pi * DENSITY * half[0] * half[1] * half[2]


def test_a_sphere_carries_half_the_water_that_it_displaces():
    added = added_mass((0.3, 0.3, 0.3), DENSITY)

    assert added[:3] == pytest.approx([displaced((0.3, 0.3, 0.3)) / 2.0] * 3)
    assert added[3:] == (0.0, 0.0, 0.0)


@pytest.mark.parametrize("slenderness", [1.01, 1.5, 2.0, 4.0, 10.0])
def test_a_spheroid_carries_what_lamb_says_of_it(slenderness):
    long, short = slenderness * 0.1, 0.1
    e = sqrt(1.0 - (short / long) ** 2)
    alpha = 2.0 * (1.0 - e * e) / e**3 * (atanh(e) - e)
    beta = 1.0 / e**2 - (1.0 - e * e) / (2.0 * e**3) * log((1.0 + e) / (1.0 - e))
    turning = e**4 * (beta - alpha) / ((2.0 - e * e) * (2.0 * e * e - (2.0 - e * e) * (beta - alpha)))
    mass = displaced((long, short, short))

    added = added_mass((long, short, short), DENSITY)

    assert added[0] == pytest.approx(mass * alpha / (2.0 - alpha), rel=1e-6)
    assert added[1:3] == pytest.approx([mass * beta / (2.0 - beta)] * 2, rel=1e-6)
    assert added[3] == pytest.approx(0.0, abs=1e-9)
    assert added[4:] == pytest.approx([mass / 5.0 * (long**2 + short**2) * turning] * 2, rel=1e-4)


def test_a_disc_carries_eight_thirds_of_its_radius_cubed():
    radius = 0.5
    added = added_mass((radius, radius, 1e-4), DENSITY)

    assert added[2] == pytest.approx(8.0 / 3.0 * DENSITY * radius**3, rel=1e-3)
    assert added[3] == pytest.approx(16.0 / 45.0 * DENSITY * radius**5, rel=1e-3)


@settings(deadline=None)
@given(HALVES)
def test_added_mass_of_any_ellipsoid_is_that_of_the_integrals(half):
    shares = [_integral(half, axis) for axis in range(3)]

    assert sum(shares) == pytest.approx(2.0, abs=1e-6)
    assert added_mass(half, DENSITY)[:3] == pytest.approx(
        [displaced(half) * share / (2.0 - share) for share in shares], rel=1e-5
    )


@settings(deadline=None)
@given(HALVES)
def test_added_mass_is_never_negative_and_least_along_the_longest_axis(half):
    added = added_mass(half, DENSITY)

    assert min(added) >= 0.0
    assert added[half.index(max(half))] <= min(added[:3]) * (1.0 + 1e-9)


def test_an_even_sphere_has_two_fifths_of_mass_and_radius_squared():
    assert ellipsoid_inertia((0.5, 0.5, 0.5), 10.0) == pytest.approx([1.0] * 3)


def test_operating_thrust_makes_the_declared_speed():
    sheet, hull = torpedo_sheet(), hull_of(torpedo_sheet())

    assert hull.linear[0] * sheet.speed + hull.quadratic[0] * sheet.speed**2 == pytest.approx(36.0)


@pytest.mark.parametrize(("speed", "coefficient"), [(0.0, 0.1), (50.0, 0.1), (0.01, 1.5)])
def test_drag_ahead_stays_what_a_body_can_have(speed, coefficient):
    sheet = replace(pool_sheet(), speed=speed)
    outline = pi / 4.0 * sheet.width * sheet.height

    assert hull_of(sheet).quadratic[0] == pytest.approx(0.5 * DENSITY * coefficient * outline)


@pytest.mark.parametrize(
    ("key", "part", "axes"),
    [
        ("added_mass", "added", range(3)),
        ("inertia", "rigid", range(3, 6)),
        ("added_inertia", "added", range(3, 6)),
        ("linear_drag", "linear", range(6)),
        ("quadratic_drag", "quadratic", range(6)),
    ],
)
def test_a_sheet_may_say_each_coefficient(key, part, axes):
    for axis in axes:
        sheet = replace(pool_sheet(), extra={f"{key}.{AXES[axis]}": 12.5})
        assert getattr(hull_of(sheet), part)[axis] == 12.5


@pytest.mark.parametrize(
    "changes",
    [
        {"length": 0.0},
        {"width": -1.0},
        {"height": nan},
        {"mass": 0.0},
        {"weight_in_water": 20.0},
        {"water_density": 0.0},
        {"drop_weight": 19.0},
        {"extra": {"righting_arm": -0.1}},
        {"extra": {"quadratic_drag.surge": nan}},
        {"extra": {"inertia.roll": 0.0, "added_inertia.roll": 0.0}},
    ],
    ids=str,
)
def test_a_hull_that_cannot_be_is_refused_with_the_vehicle_s_name(changes):
    with pytest.raises(ValueError, match="pool-auv"):
        hull_of(replace(pool_sheet(), **changes))


def _integral(half, axis):
    """Return the integral that Lamb names alpha, beta or gamma, by the trapezoidal rule over log t."""
    t = np.exp(np.arange(-60.0, 60.0, 0.05))
    squares = [each * each for each in half]
    below = (t + squares[axis]) * np.sqrt((t + squares[0]) * (t + squares[1]) * (t + squares[2]))
    return half[0] * half[1] * half[2] * 0.05 * float(np.sum(t / below))
