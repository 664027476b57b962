"""What becomes of a simulated vehicle when something goes wrong."""

from dataclasses import replace

import pytest
from at_sea import at_sea
from sample_vessels import heavy_sheet

from auv_vessel.hosting import WireFault


def test_an_emergency_stops_all_thrust_for_good():
    vehicle, helm, water = at_sea(thrusts=(10.0,) * 6)
    water.run(2.0)

    water.post(helm.codec.encode("DecisionEmergency", Reason="ORDERED", Release=False))
    water.run(3.0)

    assert [drive.thrust for drive in vehicle.drives] == [0.0] * 6
    assert helm.last("Thruster2Status")["Thrust"] == 0.0
    assert helm.last("VehicleBeat")["State"] == "FAILS_SAFE"
    assert not vehicle.released


def test_what_sinks_comes_up_without_its_drop_weight():
    vehicle, helm, water = at_sea(sheet=heavy_sheet(), place=(0.0, 0.0, 1.0))
    water.kill("Actuators")
    water.run(5.0)
    assert vehicle.truth.depth > 1.05

    water.post(helm.codec.encode("DecisionEmergency", Reason="ORDERED", Release=True))
    water.run(20.0)

    assert vehicle.released
    assert vehicle.truth.antenna < 0.1


def test_the_drop_weight_falls_by_itself_when_nobody_commands_a_vehicle_down_there():
    vehicle, _, water = at_sea(sheet=heavy_sheet(), thrusts=(0.0,) * 8)
    water.run(6.0)
    water.kill("Actuators")

    water.run(4.8)
    assert not vehicle.released
    water.run(0.3)
    assert vehicle.released


@pytest.mark.parametrize(
    ("place", "extra"), [((0.0, 0.0, 0.0), {}), ((0.0, 0.0, 3.0), {"deadman.time": 0.0})]
)
def test_the_drop_weight_stays_at_the_surface_and_where_it_is_to_stay(place, extra):
    vehicle, _, water = at_sea(
        sheet=replace(heavy_sheet(**extra), weight_in_water=-0.5), thrusts=(0.0,) * 8, place=place
    )
    water.run(2.0)
    water.kill("Actuators")

    water.run(6.0)

    assert not vehicle.released


def test_a_vehicle_that_was_never_commanded_keeps_its_drop_weight():
    vehicle, _, water = at_sea(sheet=heavy_sheet(), thrusts=(0.0,) * 8)
    water.kill("Actuators")

    water.run(6.0)

    assert not vehicle.released


def test_thrust_is_zero_in_time_when_commands_end():
    vehicle, _, water = at_sea(thrusts=(10.0,) * 6)
    water.run(2.0)
    assert vehicle.drives[0].thrust == 10.0

    water.kill("Actuators")
    water.run(0.5)

    assert [drive.state for drive in vehicle.drives] == ["WATCHDOG"] * 6
    assert [drive.thrust for drive in vehicle.drives] == [0.0] * 6


def test_corrupted_commands_do_not_keep_the_watchdog_quiet():
    vehicle, helm, water = at_sea(thrusts=(10.0,) * 6)
    water.run(2.0)

    water.disturb(WireFault(corruption=1.0, sender="Actuators"))
    water.run(0.5)

    assert [drive.state for drive in vehicle.drives] == ["WATCHDOG"] * 6
    assert helm.last("Thruster0Status")["Drive"] == "WATCHDOG"


def test_a_dead_thruster_says_so_and_does_nothing():
    vehicle, helm, water = at_sea(thrusts=(10.0,) * 6)
    vehicle.faults.dead.add(1)

    water.run(2.0)

    assert helm.last("Thruster1Status") == {"Thrust": 0.0, "Power": 0.0, "Drive": "FAULT"}
    assert vehicle.truth.thrusts[1] == 0.0
    assert vehicle.truth.thrusts[0] > 9.0


def test_a_leak_is_told():
    vehicle, helm, water = at_sea()
    vehicle.faults.leak = True

    water.run(0.5)

    assert helm.last("Health")["Leak"] is True


def test_a_vehicle_with_an_empty_battery_is_silent_and_drops_its_weight():
    vehicle, helm, water = at_sea(sheet=heavy_sheet(), thrusts=(0.0,) * 8)
    vehicle.charge = 20.0 * 4.0

    water.run(3.9)
    assert not vehicle.released
    water.run(1.0)
    water.post(helm.codec.encode("DeviceCommand", Device=0, Action=0, Parameter=0.0, Request=1))
    water.run(1.0)

    assert 3.9 <= max(helm.times("Pressure")) <= 4.1
    assert vehicle.devices.operations == []
    assert vehicle.charge == 0.0
    assert vehicle.released
    assert [drive.thrust for drive in vehicle.drives] == [0.0] * 8
