"""The motion of a vehicle against what is known of it in closed form."""

from dataclasses import replace
from itertools import pairwise
from math import cos, exp, hypot, log2, pi, sqrt, tanh

import pytest
from sample_vessels import heavy_sheet, pool_sheet, torpedo_sheet

from auv_vessel.body.dynamics import (
    at_rest,
    body_of,
    drag,
    energy,
    floating_depth,
    lighter,
    over_ground,
    runge_kutta,
    slopes,
    step,
    thrust,
)
from auv_vessel.body.hydrodynamics import AXES, GRAVITY
from auv_vessel.body.rotation import angles_of, of_angles, rows_of, to_world

DT = 0.01
DEEP = (0.0, 0.0, 50.0)
LEVEL = (1.0, 0.0, 0.0, 0.0)
NEUTRAL = {"weight_in_water": 0.0}
NO_DRAG = {f"{kind}.{axis}": 0.0 for kind in ("linear_drag", "quadratic_drag") for axis in AXES}


def made(extra=None, current=(0.0, 0.0), bottom=1000.0, sheet=None, **changes):
    """Return a body in deep water; what `extra` says counts more than what the sheet does."""
    sheet = replace(sheet or pool_sheet(), **changes)
    return body_of(replace(sheet, extra=sheet.extra | (extra or {})), current, bottom)


def moved(body, state, seconds, thrusts=None, dt=DT):
    forces = [0.0] * len(body.jets) if thrusts is None else thrusts
    for _ in range(round(seconds / dt)):
        state = runge_kutta(body, state, (forces, forces, forces), dt)
    return state


def with_speeds(state, *speeds):
    return (*state[:7], *speeds)


def heading_of(state):
    return angles_of(rows_of(*state[3:7]))[2]


class TestSpeed:
    def test_speed_under_thrust_follows_the_hyperbolic_tangent_of_quadratic_drag(self):
        body = made(NO_DRAG | {"quadratic_drag.surge": 40.0}, **NEUTRAL)
        force, mass = 4.0 * 10.0 * cos(pi / 4.0), body.inertia[0]
        terminal = sqrt(force / 40.0)
        for seconds in (0.5, 2.0, 20.0):
            speed = moved(body, at_rest(body, DEEP, LEVEL), seconds, [10.0] * 4 + [0.0] * 2)[7]
            assert speed == pytest.approx(terminal * tanh(seconds * force / (mass * terminal)), rel=1e-7)

    def test_terminal_speed_is_where_drag_is_thrust(self):
        body = made(**NEUTRAL)
        force, hull = 4.0 * 10.0 * cos(pi / 4.0), body.hull
        linear, quadratic = hull.linear[0], hull.quadratic[0]
        terminal = (-linear + sqrt(linear**2 + 4.0 * quadratic * force)) / (2.0 * quadratic)

        assert moved(body, at_rest(body, DEEP, LEVEL), 60.0, [10.0] * 4 + [0.0] * 2)[7] == pytest.approx(
            terminal
        )

    def test_linear_drag_brings_speed_up_exponentially(self):
        body = made(NO_DRAG | {"linear_drag.surge": 30.0}, **NEUTRAL)
        force, rate = 4.0 * 5.0 * cos(pi / 4.0), 30.0 / body.inertia[0]
        for seconds in (0.3, 1.0, 3.0):
            speed = moved(body, at_rest(body, DEEP, LEVEL), seconds, [5.0] * 4 + [0.0] * 2)[7]
            assert speed == pytest.approx(force / 30.0 * (1.0 - exp(-rate * seconds)), rel=1e-7)

    def test_the_declared_speed_is_reached_with_operating_thrust(self):
        body = made(**NEUTRAL, sheet=torpedo_sheet())

        assert moved(body, at_rest(body, DEEP, LEVEL), 80.0, [18.0, 18.0, 0.0, 0.0])[7] == pytest.approx(
            1.2, rel=1e-3
        )

    def test_buoyancy_alone_rises_as_fast_as_drag_lets_it(self):
        body = made(NO_DRAG | {"quadratic_drag.heave": 100.0}, bottom=1e9)
        rises = moved(body, at_rest(body, (0.0, 0.0, 1000.0), LEVEL), 100.0)[9]

        assert rises == pytest.approx(-sqrt(0.2 * GRAVITY / 100.0))


class TestCurrent:
    def test_a_vehicle_takes_on_the_speed_of_the_current(self):
        body = made(current=(0.3, -0.4), **NEUTRAL)
        state = at_rest(body, DEEP, of_angles(0.0, 0.0, 70.0))
        assert over_ground(body, state) == pytest.approx((0.0, 0.0, 0.0), abs=1e-12)

        later = moved(body, state, 120.0)

        assert over_ground(body, later) == pytest.approx((0.3, -0.4, 0.0), abs=2e-3)

    def test_drift_from_rest_under_linear_drag_is_exponential(self):
        body = made(NO_DRAG | {"linear_drag.surge": 10.0}, current=(0.5, 0.0), **NEUTRAL)
        rate = 10.0 / body.inertia[0]

        state = moved(body, at_rest(body, DEEP, LEVEL), 4.0)

        assert over_ground(body, state)[0] == pytest.approx(0.5 * (1.0 - exp(-4.0 * rate)), rel=1e-7)
        assert state[0] == pytest.approx(0.5 * (4.0 - (1.0 - exp(-4.0 * rate)) / rate), rel=1e-7)

    def test_water_that_moves_as_a_whole_changes_nothing_but_the_place(self):
        still, flows = made(), made(current=(0.7, -0.2))
        start = with_speeds((0.0, 0.0, 30.0, *of_angles(20.0, -10.0, 40.0)), 0.5, 0.2, -0.1, 0.3, -0.2, 0.4)
        thrusts = [5.0, -3.0, 8.0, 2.0, 1.0, -4.0]

        one, other = moved(still, start, 8.0, thrusts), moved(flows, start, 8.0, thrusts)

        assert other[2:] == pytest.approx(one[2:], abs=1e-12)
        assert other[:2] == pytest.approx((one[0] + 0.7 * 8.0, one[1] - 0.2 * 8.0))


class TestRighting:
    @pytest.mark.parametrize(("axis", "angles"), [(3, (0.5, 0.0, 0.0)), (4, (0.0, 0.5, 0.0))])
    def test_a_heeled_vehicle_swings_with_the_period_of_a_pendulum(self, axis, angles):
        body = made(NO_DRAG, **NEUTRAL)
        period = 2.0 * pi * sqrt(body.inertia[axis] / (body.buoyancy * body.hull.righting_arm))
        state = (*DEEP, *of_angles(*angles), *(0.0,) * 6)
        rates = []
        for _ in range(round(3.0 * period / 0.001)):
            state = runge_kutta(body, state, ([0.0] * 6,) * 3, 0.001)
            rates.append(state[7 + axis])

        crossings = [number for number in range(1, len(rates)) if rates[number - 1] < 0.0 <= rates[number]]

        assert 0.001 * (crossings[-1] - crossings[0]) / (len(crossings) - 1) == pytest.approx(
            period, rel=2e-3
        )

    def test_drag_lets_it_come_to_rest_upright(self):
        body = made(**NEUTRAL)

        state = moved(body, (*DEEP, *of_angles(120.0, 40.0, 200.0), *(0.0,) * 6), 30.0)

        roll, pitch, _ = angles_of(rows_of(*state[3:7]))
        assert (roll, pitch) == pytest.approx((0.0, 0.0), abs=1.0)

    def test_a_bare_hull_turns_across_its_way_and_one_with_fins_does_not(self):
        def swerves(munk):
            body = made(NO_DRAG | {"munk": munk}, **NEUTRAL)
            state, most = (*DEEP, *LEVEL, 1.0, 0.01, 0.0, 0.0, 0.0, 0.0), 0.0
            for _ in range(30):
                state = moved(body, state, 0.5)
                most = max(most, abs((heading_of(state) + 180.0) % 360.0 - 180.0))
            return most

        assert swerves(0.0) == pytest.approx(0.0, abs=1e-9)
        assert swerves(1.0) > 45.0


class TestConservation:
    START = with_speeds((0.0, 0.0, 500.0, *of_angles(30.0, 20.0, 100.0)), 1.0, -0.4, 0.6, 0.5, -0.8, 0.3)

    @pytest.mark.parametrize("munk", [0.0, 0.4, 1.0])
    def test_energy_is_kept_without_drag(self, munk):
        body = made(NO_DRAG | {"munk": munk})
        before = energy(body, self.START)

        after = energy(body, moved(body, self.START, 30.0))

        assert after == pytest.approx(before, abs=2e-4)

    def test_momentum_of_hull_and_water_is_kept_in_the_world(self):
        body = made(NO_DRAG | {"munk": 1.0, "righting_arm": 0.0}, **NEUTRAL)

        before, after = _momenta(body, self.START), _momenta(body, moved(body, self.START, 20.0))

        assert after == pytest.approx(before, rel=1e-6, abs=1e-4)

    def test_a_spinning_hull_with_fins_flies_straight_on_if_its_added_mass_is_even(self):
        added = {f"added_mass.{axis}": 9.0 for axis in AXES[:3]}
        body = made(NO_DRAG | added | {"righting_arm": 0.0}, **NEUTRAL)
        velocity = over_ground(body, self.START)

        assert over_ground(body, moved(body, self.START, 20.0)) == pytest.approx(velocity, rel=1e-6)

    @pytest.mark.parametrize("munk", [0.0, 1.0])
    @pytest.mark.parametrize("depth", [0.0, 40.0])
    def test_work_of_thrust_is_what_energy_gains_and_drag_takes(self, depth, munk):
        body = made({"munk": munk})
        thrusts = [6.0, -4.0, 9.0, 3.0, 5.0, -7.0]
        state = (0.0, 0.0, depth, *of_angles(10.0, 5.0, 30.0), 0.4, -0.3, 0.2, 0.3, 0.1, -0.2)
        before, work, dt = energy(body, state), 0.0, 0.002
        gross = 0.0
        for number in range(2001):
            powers = [_power(force, state) for force in (thrust(body, state, thrusts), drag(body, state))]
            weight = dt / 2.0 if number in (0, 2000) else dt
            work += weight * sum(powers)
            gross += weight * abs(powers[0])
            assert powers[1] <= 0.0
            if number < 2000:
                state = runge_kutta(body, state, (thrusts,) * 3, dt)

        assert energy(body, state) - before == pytest.approx(work, abs=1e-4 * gross)

    def test_forces_of_buoyancy_are_the_slope_of_energy_at_the_surface_too(self):
        body = made(NO_DRAG)
        for depth in (-0.1, 0.0, 0.05, 0.15, 0.3):
            for angles in ((0.0, 0.0, 0.0), (25.0, -40.0, 10.0), (100.0, 20.0, 300.0)):
                _compare_slopes(body, (0.0, 0.0, depth, *of_angles(*angles), *(0.0,) * 6))


class TestStraightness:
    def test_a_symmetric_vehicle_stays_on_its_line(self):
        body = made()

        state = moved(body, at_rest(body, DEEP, of_angles(0.0, 0.0, 30.0)), 30.0, [12.0] * 4 + [1.0, 1.0])

        assert state[0] * sqrt(1.0 / 3.0) == pytest.approx(state[1], abs=1e-9)
        assert hypot(state[0], state[1]) > 10.0
        assert angles_of(rows_of(*state[3:7])) == pytest.approx((0.0, 0.0, 30.0), abs=1e-6)

    def test_a_mirrored_start_goes_a_mirrored_way(self):
        body = made({"munk": 1.0})
        one = moved(
            body, (*DEEP, *LEVEL, 0.5, 0.3, 0.1, 0.2, 0.1, 0.4), 10.0, [10.0, 2.0, 5.0, 1.0, 3.0, 6.0]
        )
        other = moved(
            body, (*DEEP, *LEVEL, 0.5, -0.3, 0.1, -0.2, 0.1, -0.4), 10.0, [2.0, 10.0, 1.0, 5.0, 6.0, 3.0]
        )

        assert (other[0], -other[1], other[2]) == pytest.approx(one[:3], abs=1e-9)


class TestMethod:
    def test_halving_the_step_makes_the_error_sixteen_times_less(self):
        body = made({"munk": 1.0})
        start = with_speeds((0.0, 0.0, 50.0, *of_angles(40.0, 30.0, 10.0)), 0.8, 0.5, -0.3, 0.6, -0.9, 1.2)
        thrusts = [8.0, 3.0, 5.0, 9.0, 2.0, -4.0]
        ends = [moved(body, start, 1.28, thrusts, dt) for dt in (0.08, 0.04, 0.02, 0.01)]

        gaps = [max(abs(a - b) for a, b in zip(*pair, strict=True)) for pair in pairwise(ends)]

        assert log2(gaps[0] / gaps[1]) == pytest.approx(4.0, abs=0.4)
        assert log2(gaps[1] / gaps[2]) == pytest.approx(4.0, abs=0.4)

    def test_a_step_is_taken_in_parts_where_drag_would_overshoot(self):
        body = made({"quadratic_drag.surge": 40_000.0}, **NEUTRAL)
        state = (*DEEP, *LEVEL, 3.0, 0.0, 0.0, 0.0, 0.0, 0.0)

        later = step(body, state, ([0.0] * 6,) * 3, DT)

        linear, rate = body.hull.linear[0], 40_000.0 / body.inertia[0]
        assert linear < 0.01 * 40_000.0
        assert later[7] == pytest.approx(3.0 / (1.0 + 3.0 * rate * DT), rel=0.02)

    def test_the_quaternion_stays_one_of_length_one(self):
        body = made()
        state = moved(body, TestConservation.START, 60.0)

        assert sum(each * each for each in state[3:7]) == pytest.approx(1.0, abs=1e-12)


class TestSurface:
    def test_it_floats_where_the_immersed_part_of_the_hull_bears_its_weight(self):
        body = made()
        height, part = body.hull.half[2], body.weight / body.buoyancy

        depth = moved(body, at_rest(body, (0.0, 0.0, 0.5), LEVEL), 60.0)[2]

        immersed = (depth - body.hull.righting_arm + height) / (2.0 * height)
        assert immersed**2 * (3.0 - 2.0 * immersed) == pytest.approx(part, abs=1e-4)
        assert depth == pytest.approx(floating_depth(body), abs=1e-3)

    def test_half_as_heavy_as_its_water_it_floats_half_immersed(self):
        body = made(weight_in_water=-19.0)

        assert floating_depth(body) == pytest.approx(body.hull.righting_arm)

    def test_in_air_it_falls(self):
        body = made()
        change = slopes(body, (0.0, 0.0, -2.0, *LEVEL, *(0.0,) * 6), [0.0] * 6)

        assert change[9] == pytest.approx(GRAVITY * 19.0 / body.inertia[2])

    def test_thrusters_in_air_do_nothing_and_just_below_it_little(self):
        body = made()

        assert thrust(body, (0.0, 0.0, -0.01, *LEVEL, *(0.0,) * 6), [10.0] * 6) == (0.0,) * 6
        assert thrust(body, (0.0, 0.0, 0.2, *LEVEL, *(0.0,) * 6), [10.0] * 6)[0] == pytest.approx(
            40.0 * cos(pi / 4.0)
        )
        assert thrust(body, (0.0, 0.0, 0.05, *LEVEL, *(0.0,) * 6), [10.0] * 6)[0] == pytest.approx(
            0.5 * 40.0 * cos(pi / 4.0)
        )


class TestBottom:
    def test_what_sinks_lies_on_the_bottom_and_stays_there(self):
        body = made(sheet=heavy_sheet(), bottom=5.0)

        state = moved(body, at_rest(body, (0.0, 0.0, 4.6), LEVEL), 40.0)

        lowest = state[2] - body.hull.righting_arm + body.hull.half[2]
        assert lowest == pytest.approx(5.0, abs=0.01)
        assert over_ground(body, state) == pytest.approx((0.0, 0.0, 0.0), abs=1e-3)

    def test_it_holds_there_against_a_slow_current(self):
        body = made(sheet=heavy_sheet(), bottom=5.0, current=(0.02, 0.0), weight_in_water=4.0)

        state = moved(body, at_rest(body, (0.0, 0.0, 4.7), LEVEL), 40.0)

        assert over_ground(body, state)[0] < 0.005

    def test_thrust_does_not_push_it_through(self):
        body = made(bottom=3.0)

        state = moved(body, at_rest(body, (0.0, 0.0, 2.0), LEVEL), 30.0, [0.0] * 4 + [35.0, 35.0])

        assert state[2] - body.hull.righting_arm + body.hull.half[2] < 3.05

    def test_what_hits_it_bounces_no_higher_than_it_came_from(self):
        body = made(bottom=3.0, **NEUTRAL)
        state = (0.0, 0.0, 2.5, *LEVEL, 0.4, 0.0, 1.0, 0.0, 0.0, 0.0)
        before = energy(body, state)

        after = [energy(body, state := moved(body, state, 0.05)) for _ in range(100)]

        assert max(after) <= before + 1e-6
        assert sorted(after, reverse=True) == pytest.approx(after, abs=1e-3)


def test_without_its_drop_weight_a_body_weighs_less_and_moves_more_easily():
    body = made(sheet=heavy_sheet())

    light = lighter(body, 2.0)

    assert body.weight - light.weight == pytest.approx(2.0 * GRAVITY)
    assert body.inertia[2] - light.inertia[2] == pytest.approx(2.0)
    assert light.weight < light.buoyancy < body.weight


@pytest.mark.parametrize(
    "angles", [(0.0, 0.0, 0.0), (10.0, 20.0, 30.0), (-170.0, -60.0, 359.0), (5.0, 89.0, 200.0)]
)
def test_angles_make_a_quaternion_that_tells_them(angles):
    assert angles_of(rows_of(*of_angles(*angles))) == pytest.approx(angles, abs=1e-6)


def _power(force, state):
    return sum(one * other for one, other in zip(force, state[7:], strict=True))


def _momenta(body, state):
    """Return the impulse of hull and water and its moment about the origin, in the world."""
    rows = rows_of(*state[3:7])
    impulse = to_world(
        rows, [mass * speed for mass, speed in zip(body.inertia[:3], state[7:10], strict=True)]
    )
    spin = to_world(rows, [mass * rate for mass, rate in zip(body.inertia[3:], state[10:], strict=True)])
    x, y, z = state[:3]
    a, b, c = impulse
    return (*impulse, spin[0] + y * c - z * b, spin[1] + z * a - x * c, spin[2] + x * b - y * a)


def _compare_slopes(body, state):
    """Compare force and moment with differences of energy over small moves and turns."""
    tiny = 1e-5
    change = slopes(body, state, [0.0] * 6)
    forces = [mass * rate for mass, rate in zip(body.inertia, change[7:], strict=True)]
    rows = rows_of(*state[3:7])
    for axis in range(6):
        ends = []
        for sign in (1.0, -1.0):
            unit = [sign * tiny if each == axis % 3 else 0.0 for each in range(3)]
            if axis < 3:
                place = [one + other for one, other in zip(state[:3], to_world(rows, unit), strict=True)]
                ends.append(energy(body, (*place, *state[3:])))
            else:
                ends.append(energy(body, (*state[:3], *_turned(state[3:7], unit), *state[7:])))
        assert (ends[1] - ends[0]) / (2.0 * tiny) == pytest.approx(forces[axis], abs=2e-4)


def _turned(quaternion, turn):
    w, x, y, z = quaternion
    p, q, r = (each / 2.0 for each in turn)
    found = (
        w - x * p - y * q - z * r,
        x + w * p + y * r - z * q,
        y + w * q + z * p - x * r,
        z + w * r + x * q - y * p,
    )
    norm = sqrt(sum(each * each for each in found))
    return tuple(each / norm for each in found)
