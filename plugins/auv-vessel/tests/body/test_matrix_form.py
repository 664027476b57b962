"""The motion against the equations as Fossen writes them, in matrices and Euler angles.

M dnu/dt + C(nu) nu + D(nu) nu + g(eta) = tau, with the Coriolis matrix from the blocks of M (Fossen 2011,
3.46), the restoring vector (4.6) of a body with its centre of buoyancy above its centre of gravity, and
the Jacobian of roll, pitch, yaw (2.40).
"""

from dataclasses import replace
from math import cos, degrees, radians, sin, tan

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sample_vessels import heavy_sheet, pool_sheet, torpedo_sheet

from auv_vessel.body.dynamics import body_of, runge_kutta, slopes, thrust
from auv_vessel.body.rotation import angles_of, of_angles, rows_of

ANGLES = st.tuples(st.floats(-170.0, 170.0), st.floats(-80.0, 80.0), st.floats(0.0, 359.0))
SPEEDS = st.tuples(*[st.floats(-2.0, 2.0)] * 6)
BODIES = st.sampled_from(
    [
        body_of(replace(each(), extra={"munk": 1.0}), (0.0, 0.0), 1000.0)
        for each in (pool_sheet, heavy_sheet, torpedo_sheet)
    ]
)
FORCES = st.floats(-35.0, 35.0)


def skew(vector):
    x, y, z = vector
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


def accelerations(body, angles, nu, tau):
    """Return dnu/dt of the matrix form, for a body that is deep in the water."""
    mass = np.diag(body.inertia)
    one, two = nu[:3], nu[3:]
    coriolis = np.zeros((6, 6))
    coriolis[:3, 3:] = -skew(mass[:3, :3] @ one)
    coriolis[3:, :3] = -skew(mass[:3, :3] @ one)
    coriolis[3:, 3:] = -skew(mass[3:, 3:] @ two)
    damping = np.diag(np.array(body.hull.linear) + np.array(body.hull.quadratic) * abs(nu))
    roll, pitch, _ = (radians(angle) for angle in angles)
    surplus, arm = body.weight - body.buoyancy, -body.hull.righting_arm
    restoring = np.array(
        [
            surplus * sin(pitch),
            -surplus * cos(pitch) * sin(roll),
            -surplus * cos(pitch) * cos(roll),
            arm * -body.buoyancy * cos(pitch) * sin(roll),
            arm * -body.buoyancy * sin(pitch),
            0.0,
        ]
    )
    return np.linalg.solve(mass, tau - coriolis @ nu - damping @ nu - restoring)


def turning(angles, rates):
    """Return how fast roll, pitch and heading change, degrees per second."""
    roll, pitch, _ = (radians(angle) for angle in angles)
    jacobian = np.array(
        [
            [1.0, sin(roll) * tan(pitch), cos(roll) * tan(pitch)],
            [0.0, cos(roll), -sin(roll)],
            [0.0, sin(roll) / cos(pitch), cos(roll) / cos(pitch)],
        ]
    )
    return [degrees(rate) for rate in jacobian @ rates]


@settings(deadline=None)
@given(BODIES, ANGLES, SPEEDS, FORCES)
def test_accelerations_are_those_of_the_matrix_form(body, angles, speeds, force):
    state = (0.0, 0.0, 100.0, *of_angles(*angles), *speeds)
    thrusts = [force / (number + 1) for number in range(len(body.jets))]

    change = slopes(body, state, thrusts)

    wanted = accelerations(body, angles, np.array(speeds), np.array(thrust(body, state, thrusts)))
    assert change[7:] == pytest.approx(list(wanted), rel=1e-9, abs=1e-9)


@settings(deadline=None)
@given(BODIES, ANGLES, SPEEDS)
def test_attitude_changes_by_the_jacobian_of_its_angles(body, angles, speeds):
    tiny = 1e-5
    state = (0.0, 0.0, 100.0, *of_angles(*angles), *speeds)
    still = [0.0] * len(body.jets)

    before, after = (
        angles_of(rows_of(*runge_kutta(body, state, (still,) * 3, sign * tiny)[3:7])) for sign in (-1.0, 1.0)
    )

    changes = [
        ((one - other + 180.0) % 360.0 - 180.0) / (2.0 * tiny)
        for one, other in zip(after, before, strict=True)
    ]
    assert changes == pytest.approx(turning(angles, speeds[3:]), abs=0.01, rel=1e-4)


@settings(deadline=None)
@given(BODIES, st.lists(FORCES, min_size=8, max_size=8))
def test_thrust_is_a_matrix_of_directions_and_levers(body, forces):
    columns = [[*jet.wrench[:3], *np.cross(jet.position, jet.wrench[:3])] for jet in body.jets]
    wanted = np.array(columns).T @ np.array(forces[: len(columns)])

    found = thrust(body, (0.0, 0.0, 100.0, 1.0, *(0.0,) * 9), forces[: len(columns)])

    assert found == pytest.approx(list(wanted), abs=1e-9)
