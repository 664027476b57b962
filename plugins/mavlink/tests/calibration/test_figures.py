"""Figures of flights whose figures are known."""

from dataclasses import replace

import numpy as np
import pytest
from flight_logs import Sample, dataflash, telemetry
from flown_curves import Curve, flown
from flown_times.calibrated import log_of
from flown_times.simulated import simulate_mission
from real_flights.routes import COPTER as CRAFT
from real_flights.routes import Route, on_px4, routes

from mmrs_mavlink.calibration.figures import HOLDS, corner_radius, fastest, figures_of, nothing
from mmrs_mavlink.calibration.judging import judged
from mmrs_mavlink.calibration.motion import Passage
from mmrs_mavlink.calibration.reading import flight_in
from mmrs_mavlink.profiles import ARDUCOPTER, PROFILES, profile_for

OUT_AND_BACK = [(0.0, 0.0, 20.0), (80.0, 0.0, 20.0), (0.0, 0.0, 20.0), (0.0, 60.0, 20.0), (0.0, 15.0, 20.0)]
UP_AND_DOWN = [(0.0, 0.0, 10.0), (0.0, 0.0, 40.0), (0.0, 0.0, 10.0), (0.0, 0.0, 40.0)]
COPTER = Curve()
GUIDED, AUTO, LAND = 4, 3, 9
PX4 = 12
"""Number of the autopilot."""


def figures(tmp_path, data):
    (tmp_path / "flight").write_bytes(data)
    return {(each.flown_as, each.name): each for each in figures_of([flight_in(tmp_path / "flight")])}


@pytest.mark.parametrize("made", [dataflash, telemetry])
@pytest.mark.parametrize(("rate", "noise"), [(4.0, 0.02), (10.0, 0.0), (10.0, 0.05)])
def test_the_figures_of_level_legs_are_found_again(made, rate, noise, tmp_path):
    found = figures(tmp_path, made(flown(OUT_AND_BACK, COPTER, rate=rate, noise=noise)))
    assert found["STEP", "maxSpeed"].median == pytest.approx(8.0, rel=0.02)
    assert found["STEP", "maxAcceleration"].median == pytest.approx(2.5, rel=0.1)
    assert found["STEP", "maxDeceleration"].median == pytest.approx(1.5, rel=0.1)
    assert found["STEP", "maxJerk"].median == pytest.approx(5.0, rel=0.5)
    usual = ARDUCOPTER.pacing.step  # legs of one speed do not show how far it goes beyond its targets
    beyond = usual.settled(8.0) - usual.settling
    assert found["STEP", "settlingTime"].median == pytest.approx(COPTER.pause - beyond, abs=2.0 / rate)
    assert len(found["STEP", "maxAcceleration"].values) == 4
    assert {each.missing for (flown_as, _), each in found.items() if flown_as == "MISSION"} == {
        "not flown in auto"
    }


def test_a_mission_has_figures_of_its_own(tmp_path):
    steps = list(flown(OUT_AND_BACK, COPTER))
    gentle = Curve(acceleration=2.0, deceleration=2.0, jerk=1.2)
    mission = flown(OUT_AND_BACK, gentle, mode=AUTO, begin=steps[-1].time + 0.1)
    found = figures(tmp_path, dataflash([*steps, *mission]))
    assert found["STEP", "maxJerk"].median == pytest.approx(5.0, rel=0.5)
    assert found["MISSION", "maxJerk"].median == pytest.approx(1.2, rel=0.15)
    assert found["MISSION", "maxAcceleration"].median == pytest.approx(2.0, rel=0.1)
    assert found["MISSION", "cornerRadius"].missing == "no corner was passed without a stop"


def test_the_values_of_several_flights_count_together(tmp_path):
    flights = []
    for rate in (10.0, 5.0):
        (tmp_path / "flight").write_bytes(dataflash(flown(OUT_AND_BACK, COPTER, rate=rate)))
        flights.append(flight_in(tmp_path / "flight"))
    single = zip(*map(figures_of, [[each] for each in flights]), strict=True)
    for both, (one, two) in zip(figures_of(flights), single, strict=True):
        assert both.flown_as != "STEP" or len(both.values) == len(one.values) + len(two.values), both.name


@pytest.mark.parametrize(
    ("stated", "holds"),
    [({}, True), ({"maxAcceleration": 2.4, "maxDeceleration": 1.4}, True), ({"maxAcceleration": 1.5}, False)],
)
def test_what_flights_do_not_contradict_holds(stated, holds, tmp_path):
    """An ArduCopter speeds up by 2.5 m/s², and slows down by 1.5 m/s² leg by leg where its type is silent."""
    flights = []
    for more in (0.9, 1.0, 1.1):
        (tmp_path / "flight").write_bytes(
            dataflash(flown(OUT_AND_BACK, replace(COPTER, acceleration=2.5 * more, deceleration=1.5 * more)))
        )
        flights.append(flight_in(tmp_path / "flight"))

    def current(name, flown_as):
        return stated.get(name) if flown_as == "STEP" else None

    figures = {each.name: each for each in figures_of(flights, current=current) if each.flown_as == "STEP"}
    assert (figures["maxAcceleration"].doubt == HOLDS) is holds
    assert figures["maxDeceleration"].doubt == figures["maxAcceleration"].doubt


def test_a_place_in_line_does_not_end_a_leg(tmp_path):
    plain = list(flown(OUT_AND_BACK, COPTER))
    passing = [
        replace(each, item=2 * each.item + (each.item == 1 and each.place[0] > 40.0)) for each in plain
    ]
    found = [figures(tmp_path, dataflash(each))["STEP", "settlingTime"] for each in (plain, passing)]
    assert found[0] == found[1]


def test_the_lag_of_an_autopilot_is_not_settling(tmp_path):
    (tmp_path / "flight").write_bytes(dataflash(flown(OUT_AND_BACK, COPTER)))
    flight = flight_in(tmp_path / "flight")
    diving = figures_of([replace(flight, profile=profile_for("sub"))])
    settled = [
        each.median
        for each in (*figures_of([flight]), *diving)
        if each.name == "settlingTime" and each.values
    ]
    assert settled[1] < settled[0] - 2.0


def test_a_vehicle_that_comes_near_to_its_speed_only_with_time_lags(tmp_path):
    submarine = Curve(speed=1.35, acceleration=1.0, deceleration=1.0, jerk=1.0, lacks=0.4, gaining=17.0)
    around = [(0.0, 0.0, -5.0), (90.0, 0.0, -5.0), (90.0, 80.0, -5.0), (0.0, 80.0, -5.0)]
    found = figures(tmp_path, dataflash(flown(around, submarine, noise=0.01)))
    assert found["STEP", "lag"].median == pytest.approx(0.4 * 17.0, rel=0.15)
    assert found["STEP", "lagTime"].median == pytest.approx(17.0, rel=0.15)
    at_once = figures(tmp_path, dataflash(flown(around, replace(submarine, lacks=0.0), noise=0.01)))
    assert at_once["STEP", "lag"].values == ()


def test_upright_legs_tell_climb_and_descent(tmp_path):
    curve = Curve(speed=2.5, acceleration=1.0, deceleration=1.0)
    found = figures(tmp_path, dataflash(flown(UP_AND_DOWN, curve)))
    assert found["STEP", "maxClimbRate"].median == pytest.approx(2.5, rel=0.02)
    assert found["STEP", "maxDescentRate"].median == pytest.approx(2.5, rel=0.02)
    assert found["STEP", "maxVerticalAcceleration"].median == pytest.approx(1.0, rel=0.15)
    assert found["STEP", "maxAcceleration"].values == ()


def test_a_slow_leg_does_not_lower_the_largest_speed(tmp_path):
    quick = list(flown(OUT_AND_BACK, COPTER))
    slow = flown(OUT_AND_BACK, replace(COPTER, speed=3.0), begin=quick[-1].time + 0.1)
    found = figures(tmp_path, dataflash([*quick, *slow]))
    assert found["STEP", "maxSpeed"].median == pytest.approx(8.0, rel=0.02)


def test_a_corner_that_is_passed_tells_its_radius(tmp_path):
    found = figures(tmp_path, dataflash(_round_a_corner(radius=6.0, speed=5.0)))
    nearest = 6.0 * (2.0**0.5 - 1.0)
    assert found["MISSION", "cornerRadius"].median == pytest.approx(nearest, abs=0.2)


@pytest.mark.parametrize(
    ("profile", "speed", "radius"),
    [("arducopter", 1.73, 0.8), ("px4-multicopter", 1.73, 2.0), ("px4-multicopter", 4.9, None)],
)
def test_the_radius_of_a_px4_is_the_tangent_of_the_circle_for_which_it_slows_down(profile, speed, radius):
    """It goes round a right angle with half of 3 m/s², so by 1.73 m/s where it is 2 m."""
    corner = Passage(nearest=0.8, turn=np.pi / 2.0, speed=speed, beside=5.0)
    found = corner_radius(corner, PROFILES[profile].pacing.mission)
    assert found == (radius if radius is None else pytest.approx(radius, rel=0.01))


def test_the_corners_of_a_simulated_px4_tell_how_fast_it_passes_them(tmp_path):
    """That is by its radius and its acceleration, of which the flight shows less."""
    places = tuple((30.0 * number, 40.0 + 30.0 * (number % 2), 12.0) for number in range(6))
    on_px4(routes(Route("Alba", CRAFT, places, 8.0, fluid=True)))(tmp_path / "zigzag")
    simulate_mission(tmp_path / "zigzag", "Alba")
    found = figures(tmp_path, log_of(tmp_path / "zigzag", "Alba", PX4))
    radius, acceleration = (found["MISSION", name] for name in ("cornerRadius", "maxAcceleration"))
    assert len(radius.values) >= 3
    pacing = PROFILES["px4-multicopter"].pacing.mission
    shown = radius.median * acceleration.median
    assert shown == pytest.approx(pacing.corner_radius * pacing.acceleration, rel=0.1)


def _round_a_corner(radius, speed, rate=10.0):
    """Yield a mission that goes east, turns north by an arc without a stop, and goes on."""
    length, arc = 40.0, radius * np.pi / 2.0
    for number in range(int((2 * length + arc) / speed * rate)):
        along = number * speed / rate
        angle = np.clip((along - length) / radius, 0.0, np.pi / 2.0)
        east = min(along, length) + radius * np.sin(angle)
        north = radius * (1.0 - np.cos(angle)) + max(0.0, along - length - arc)
        velocity = (speed * np.cos(angle), speed * np.sin(angle), 0.0)
        yield Sample(10.0 + number / rate, (east, north, 20.0), velocity, 90.0 - np.degrees(angle), AUTO)


def test_turns_tell_their_rate(tmp_path):
    headings = np.concatenate([np.zeros(30), np.linspace(0.0, 120.0, 21), np.full(30, 120.0)])
    samples = [
        Sample(n / 10.0, (0.0, 0.0, 20.0), (0.0, 0.0, 0.0), float(each)) for n, each in enumerate(headings)
    ]
    rate = figures(tmp_path, dataflash(samples))["", "maxTurnRate"]
    assert rate.median == pytest.approx(60.0, rel=0.1)


def test_a_landing_tells_its_end(tmp_path):
    heights = np.concatenate([np.arange(30.0, 10.0, -0.15), np.arange(10.0, 0.0, -0.05), np.zeros(60)])
    rates = np.gradient(heights, 0.1)
    samples = [
        Sample(n / 10.0, (0.0, 0.0, height), (0.0, 0.0, rate), mode=LAND, armed=n < len(heights) - 30)
        for n, (height, rate) in enumerate(zip(heights.tolist(), rates.tolist(), strict=True))
    ]
    found = figures(tmp_path, dataflash(samples))
    assert found["", "landingRate"].median == pytest.approx(0.5, rel=0.05)
    assert found["", "landingHeight"].median == pytest.approx(10.0, rel=0.1)
    assert found["", "recoveryTime"].median == pytest.approx(3.0, abs=0.4)


def test_the_end_of_a_missions_landing_is_no_descent_of_its_legs(tmp_path):
    down = np.concatenate([np.full(30, 10.0), np.arange(10.0, 0.0, -0.05), np.zeros(40)])
    rates = np.gradient(down, 0.1)
    samples = [
        Sample(n / 10.0, (0.0, 0.0, height), (0.0, 0.0, rate), mode=AUTO, armed=n < len(down) - 10)
        for n, (height, rate) in enumerate(zip(down.tolist(), rates.tolist(), strict=True))
    ]
    found = figures(tmp_path, dataflash(samples))
    assert found["", "landingRate"].median == pytest.approx(0.5, rel=0.05)
    assert found["MISSION", "maxDescentRate"].values == ()


@pytest.mark.parametrize(("rate", "height", "written"), [(0.2, 6.0, True), (0.48, 10.5, False)])
def test_figures_of_landings_are_written_that_tell_how_long_these_take(rate, height, written, tmp_path):
    """Its autopilot lands from 10 m on at 0.5 m/s, and so it is planned, with a stop before."""
    down = np.concatenate(
        [np.arange(30.0, height, -0.15), np.arange(height, 0.0, -rate / 10.0), np.zeros(40)]
    )
    heights = np.concatenate([np.concatenate([np.arange(0.0, 30.0, 0.1), down])] * 3)
    rates, number = np.gradient(heights, 0.1), len(heights) // 3
    samples = [
        Sample(n / 10.0, (0.0, 0.0, up), (0.0, 0.0, rate), mode=LAND, armed=n % number < number - 5)
        for n, (up, rate) in enumerate(zip(heights.tolist(), rates.tolist(), strict=True))
    ]
    (tmp_path / "flight").write_bytes(dataflash(samples))
    flights = [flight_in(tmp_path / "flight")]
    found = {each.name: each for each in judged(flights, figures_of(flights), nothing)}
    assert len(found["landingRate"].values) == 3
    assert (found["landingRate"].doubt == "") is written
    assert written or found["landingRate"].doubt.startswith("with them, landings would be planned further")


def test_power_tells_how_long_the_battery_lasts(tmp_path):
    found = figures(tmp_path, dataflash(flown(OUT_AND_BACK, COPTER), watts=444.0))
    assert found["", "meanPower"].median == pytest.approx(444.0, rel=1e-5)
    assert found["", "lifetime"].median == pytest.approx(16.0 * 3600.0 / (444.0 / 22.2), rel=1e-5)


@pytest.mark.parametrize(
    ("capacity", "stated", "seconds"),
    [(None, None, 100.0), (36_000.0, 10_000.0, 100.0), (36_000.0, 100_000.0, 10.0), (36_000.0, None, None)],
)
def test_a_charge_is_a_share_of_the_capacity_that_the_autopilot_states(tmp_path, capacity, stated, seconds):
    """One ten times as large as the type's would otherwise last ten times as long."""
    (tmp_path / "flight").write_bytes(telemetry([*_round_a_corner(5.0, 5.0)]))
    flight = flight_in(tmp_path / "flight")
    times = np.array([flight.times[0] + 1.0, flight.times[-1] - 1.0])
    charges = np.column_stack([times, [1.0, 1.0 - (times[1] - times[0]) / 100.0]])
    parameters = {} if stated is None else {"BATT_CAPACITY": stated}
    drained = replace(flight, charges=charges, power=flight.power[:0], parameters=parameters)
    found = next(each for each in figures_of([drained], capacity) if each.name == "lifetime")
    assert found.values == (() if seconds is None else (pytest.approx(seconds),))


@pytest.mark.parametrize(("charges", "lasts"), [((1.0, 0.7, 0.4), True), ((1.0, 0.5, 1.0, 0.9), False)])
def test_a_log_of_a_battery_that_was_charged_in_between_does_not_tell_how_long_it_lasts(
    tmp_path, charges, lasts
):
    (tmp_path / "flight").write_bytes(dataflash(flown(OUT_AND_BACK, COPTER)))
    flight = flight_in(tmp_path / "flight")
    times = np.linspace(flight.times[0] + 5.0, flight.times[-1] - 5.0, len(charges))
    charged = replace(flight, charges=np.column_stack([times, charges]))
    found = next(each for each in figures_of([charged]) if each.name == "lifetime")
    assert bool(found.values) is lasts
    assert found.missing.startswith("it was charged") is not lasts


def test_legs_that_are_all_alike_do_not_show_an_overshoot(tmp_path):
    found = figures(tmp_path, dataflash(flown(OUT_AND_BACK, COPTER)))
    assert found["STEP", "overshoot"].values == ()
    assert found["STEP", "overshoot"].missing == "the legs do not show it: fly short and long ones"


def test_what_a_log_does_not_hold_is_named(tmp_path):
    found = figures(tmp_path, dataflash(flown(OUT_AND_BACK, COPTER)))
    assert found["", "meanPower"].missing == "no voltage and current while it moved"
    assert found["", "landingRate"].missing == "no landing until the motors stopped"
    assert found["STEP", "maxClimbRate"].missing == "no upright leg was long enough for it"


def test_too_few_positions_a_second_are_refused_figures_of_legs(tmp_path):
    found = figures(tmp_path, dataflash(flown([*OUT_AND_BACK, *OUT_AND_BACK], COPTER, rate=2.0)))
    assert found["STEP", "maxAcceleration"].missing == "2.0 positions per second are too few"


def test_the_fastest_are_those_near_the_largest():
    assert fastest([1.0, 9.5, 10.0, 8.0]) == [9.5, 10.0]
