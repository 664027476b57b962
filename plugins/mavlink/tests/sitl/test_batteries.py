"""Batteries of simulated vehicles."""

import pytest
from simulated import Bench

from mmrs_mavlink.sitl.battery import Battery


def test_a_battery_lasts_for_its_endurance_from_arming_on():
    bench = Bench(energy=120.0)
    bench.wait(30.0)
    assert bench.pilot.battery.level == 1.0
    began = bench.pilot.time
    bench.fly_up(10.0)
    bench.mode("loiter")
    assert bench.wait_for(lambda: bench.pilot.battery.level <= 0.0, 200.0)
    assert bench.pilot.time - began == pytest.approx(120.0, abs=0.2)


@pytest.mark.parametrize(("recharge", "level"), [(0.0, 0.5), (60.0, 1.0)])
def test_a_battery_recharges_on_the_ground_if_configured(recharge, level):
    bench = Bench(recharge=recharge)
    bench.pilot.battery.level = 0.5
    bench.wait(31.0)
    assert bench.pilot.battery.level == pytest.approx(level)


def test_voltage_falls_with_use():
    battery = Battery(1200.0, 5000.0, 3)
    full = battery.voltage
    battery.drain(600.0)
    assert full > battery.voltage > 3 * 3.4
    assert battery.used == pytest.approx(2500.0)
    assert battery.current == pytest.approx(15.0)
