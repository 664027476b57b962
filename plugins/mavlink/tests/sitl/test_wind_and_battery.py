"""Wind and battery."""

from __future__ import annotations

import pytest
from simulated import Bench

from mmrs_mavlink.sitl.battery import Battery
from mmrs_mavlink.sitl.body import wind_of
from mmrs_mavlink.sitl.commands import steer


def test_wind_blows_from_its_origin():
    assert wind_of(5.0, 270.0) == pytest.approx((0.0, 5.0, 0.0))


def flown(wind: tuple[float, float], metres: float = 100.0, speed: float = 5.0) -> Bench:
    """Return a copter that has flown to the west."""
    bench = Bench(wind=wind)
    bench.fly_up(10.0)
    bench.command(178, 1, speed)
    steer(bench.pilot, (0.0, -metres, 10.0), None)
    assert bench.wait_for(lambda: bench.pilot.body.distance_to((0.0, -metres, 10.0)) < 0.3, 600.0)
    return bench


def test_a_moderate_wind_costs_energy_and_no_time():
    calm, head, tail = flown((0.0, 0.0)), flown((5.0, 270.0)), flown((5.0, 90.0))
    assert head.pilot.time == pytest.approx(calm.pilot.time, abs=0.2)
    assert head.pilot.battery.level < calm.pilot.battery.level < tail.pilot.battery.level + 0.01
    assert tail.pilot.battery.level > head.pilot.battery.level


def test_a_side_wind_causes_no_cross_track_error():
    bench = flown((10.0, 0.0))
    assert max(abs(point[1]) for point in bench.pilot.track) < 0.05


def test_a_copter_without_a_position_drifts_with_the_wind():
    bench = Bench(wind=(4.0, 0.0))
    bench.fly_up(10.0)
    bench.pilot.located = False
    bench.mode("altitude_hold")
    bench.wait(20.0)
    assert bench.pilot.body.position[0] == pytest.approx(-75.0, abs=10.0)


def test_a_battery_lasts_for_its_hover_time():
    bench = Bench(energy=120.0)
    bench.fly_up(10.0)
    bench.mode("loiter")
    began = bench.pilot.time
    assert bench.wait_for(lambda: bench.pilot.battery.level <= 0.0, 200.0)
    assert bench.pilot.time - began == pytest.approx(110.0, abs=4.0)


def test_a_copter_falls_with_an_empty_battery():
    bench = Bench(energy=30.0)
    bench.fly_up(20.0)
    assert bench.wait_for(lambda: not bench.pilot.armed, 60.0)
    assert bench.wait_for(lambda: not bench.pilot.airborne, 10.0)
    assert "motors stop" in bench.pilot.said[-1][2]


@pytest.mark.parametrize(("recharge", "level"), [(0.0, 0.5), (60.0, 1.0)])
def test_a_battery_recharges_on_the_ground_if_configured(recharge, level):
    bench = Bench(recharge=recharge)
    bench.pilot.battery.change(0.5)
    bench.wait(31.0)
    assert bench.pilot.battery.level == pytest.approx(level)


def test_voltage_falls_with_use_and_under_load():
    battery = Battery(1200.0, 5000.0, 3)
    full = battery.voltage
    battery.drain(600.0, 1.0)
    half = battery.voltage
    battery.drain(1e-6, 3.0)
    assert full > half > battery.voltage > 0.0
    assert battery.used == pytest.approx(2500.0, rel=1e-3)
