"""A simulated vehicle on its bus, told what to do by frames only."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mmrs_auv.testing import heavy_sheet, pool_sheet
from mmrs_auv.vessel.body.rotation import to_world
from mmrs_auv.vessel.body.surroundings import BUOY, Obstacle, Surroundings, Thing
from mmrs_auv.vessel.body.vehicle import DEVICE_COMMAND, Vehicle
from mmrs_auv.vessel.hosting import Rehearsal, WireFault
from mmrs_auv.vessel.sheet import Sheet
from mmrs_auv.vessel.wire.codec import Codec, Received
from mmrs_auv.vessel.wire.frame import Frame

POOL = Codec(pool_sheet())
QUIET = Surroundings(noise=False, bottom=10.0)


class Helm:
    """A node that commands thrusters, and remembers what all others say."""

    name = "Actuators"
    period = 0.05

    def __init__(self, sheet: Sheet, thrusts: Sequence[float]) -> None:
        self.codec = Codec(sheet)
        self.thrusts = list(thrusts)
        self.enable = True
        self.heard: list[tuple[float, Received]] = []

    def hear(self, frame: Frame, now: float) -> None:
        received = self.codec.decode(frame)
        assert received is not None
        self.heard.append((now, received))

    def tick(self, now: float) -> Sequence[Frame]:
        return [
            self.codec.encode(f"Thruster{number}Command", Thrust=thrust, Enable=self.enable)
            for number, thrust in enumerate(self.thrusts)
        ]

    def last(self, name: str) -> dict[str, float]:
        return dict([received for _, received in self.heard if received.name == name][-1].values)

    def times(self, name: str) -> list[float]:
        return [now for now, received in self.heard if received.name == name]


def at_sea(
    surroundings: Surroundings = QUIET,
    thrusts: Sequence[float] = (0.0,) * 6,
    sheet: Sheet | None = None,
    **how: object,
) -> tuple[Vehicle, Helm, Rehearsal]:
    sheet = sheet or pool_sheet()
    vehicle = Vehicle(sheet, Codec(sheet), surroundings, **({"place": (0.0, 0.0, 3.0)} | how))
    helm = Helm(sheet, thrusts)
    return vehicle, helm, Rehearsal([vehicle, helm])


def test_it_goes_where_its_thrusters_push():
    vehicle, _, water = at_sea(thrusts=(10.0, 10.0, 10.0, 10.0, 0.0, 0.0))

    water.run(10.0)

    assert vehicle.truth.north > 3.0
    assert vehicle.truth.east == pytest.approx(0.0, abs=1e-9)
    assert vehicle.truth.heading == pytest.approx(0.0, abs=1e-9)


def test_instruments_tell_the_truth_when_there_is_no_noise():
    vehicle, helm, water = at_sea(thrusts=(10.0, 4.0, 4.0, 10.0, 5.0, 5.0), heading=350.0)

    water.run(8.0)

    truth = vehicle.truth
    assert helm.last("Pressure")["Pressure"] == pytest.approx(
        101325.0 + 1025.0 * 9.80665 * truth.depth, abs=1.0
    )
    assert helm.last("Attitude")["Heading"] == pytest.approx(truth.heading, abs=0.01)
    assert helm.last("Rates")["Yaw"] == pytest.approx(truth.rates[2], abs=0.01)
    assert helm.last("GroundSpeed")["Surge"] == pytest.approx(truth.speeds[0], abs=0.002)
    assert helm.last("Altitude") == {"Altitude": pytest.approx(10.0 - truth.depth, abs=0.02), "Valid": True}
    assert helm.last("Acceleration")["Heave"] == pytest.approx(-9.807, abs=0.1)


def test_it_begins_at_home_or_where_it_is_put():
    sheet = replace(pool_sheet(), home=(5.0, -6.0, 2.0), heading=120.0)

    home, elsewhere = (
        Vehicle(sheet, Codec(sheet), QUIET, place=place, heading=heading).truth
        for place, heading in ((None, None), ((1.0, 2.0, 3.0), 10.0))
    )

    assert (home.north, home.east, home.depth) == (5.0, -6.0, 2.0)
    assert home.heading == pytest.approx(120.0)
    assert (elsewhere.north, elsewhere.east, elsewhere.depth) == (1.0, 2.0, 3.0)
    assert elsewhere.heading == pytest.approx(10.0)


@pytest.mark.parametrize(("depth", "begins"), [(-1.0, 0.035), (0.0, 0.035), (99.0, 10.0 - 0.175)])
def test_it_begins_neither_in_the_air_nor_in_the_ground(depth, begins):
    sheet = replace(pool_sheet(), weight_in_water=-19.0)

    assert Vehicle(sheet, Codec(sheet), QUIET, place=(0.0, 0.0, depth)).truth.depth == pytest.approx(begins)


def test_acceleration_is_how_velocity_changes_in_the_world():
    vehicle, _, water = at_sea(thrusts=(18.0, 6.0, 2.0, 18.0, 9.0, 4.0))
    water.run(3.0)
    before = vehicle.truth.velocity
    water.run(0.05)
    truth = vehicle.truth
    water.run(0.05)
    after = vehicle.truth.velocity

    assert abs(truth.rates[2]) > 20.0
    assert abs(truth.speeds[1]) > 0.05
    changes = [(one - other) / 0.1 for one, other in zip(after, before, strict=True)]
    assert to_world(truth.axes, truth.acceleration) == pytest.approx(changes, abs=5e-3)


def test_messages_come_as_often_as_the_catalogue_says():
    _, helm, water = at_sea(place=(0.0, 0.0, 0.0))

    water.run(9.95)

    counts = {
        name: len(helm.times(name))
        for name in ("Pressure", "GroundSpeed", "Fix", "VehicleBeat", "Thruster3Status")
    }
    assert counts == {
        "Pressure": 200,
        "GroundSpeed": 50,
        "Fix": 10,
        "VehicleBeat": 20,
        "Thruster3Status": 100,
    }


def test_there_is_a_fix_at_the_surface_only():
    _, helm, water = at_sea(
        Surroundings(noise=False), thrusts=(0, 0, 0, 0, 20.0, 20.0), place=(5.0, -2.0, 0.0)
    )

    water.run(6.0)

    assert helm.times("Fix") == [0.0]
    assert helm.last("Fix") == {"North": 5.0, "East": -2.0}


def test_an_emergency_stops_all_thrust_for_good():
    vehicle, helm, water = at_sea(thrusts=(10.0,) * 6)
    water.run(2.0)

    water.post(helm.codec.encode("Emergency", Reason="ORDERED", Release=False))
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

    water.post(helm.codec.encode("Emergency", Reason="ORDERED", Release=True))
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


@settings(max_examples=40, deadline=None)
@given(st.lists(st.tuples(st.integers(0, 0x7FF), st.binary(max_size=8), st.booleans()), max_size=20))
def test_no_frame_of_chance_moves_or_harms_it(frames):
    vehicle = Vehicle(pool_sheet(), POOL, QUIET, place=(0.0, 0.0, 3.0))
    for id, data, extended in frames:
        for number in (id, 0x100, 0x010, 0x500):
            vehicle.hear(Frame(number, data, extended), 0.0)
    vehicle.tick(0.5)

    assert all(drive.thrust == 0.0 for drive in vehicle.drives)
    assert vehicle.truth.north == 0.0


def test_a_dead_thruster_says_so_and_does_nothing():
    vehicle, helm, water = at_sea(thrusts=(10.0,) * 6)
    vehicle.faults.dead.add(1)

    water.run(2.0)

    assert helm.last("Thruster1Status") == {"Thrust": 0.0, "Power": 0.0, "Drive": "FAULT"}
    assert vehicle.truth.thrusts[1] == 0.0
    assert vehicle.truth.thrusts[0] > 9.0


def test_a_frozen_instrument_repeats_itself_with_a_counter_that_goes_on():
    vehicle, helm, water = at_sea(Surroundings(), thrusts=(0, 0, 0, 0, 10.0, 10.0))
    water.run(1.0)
    vehicle.faults.frozen.add("Pressure")
    frozen = len(helm.times("Pressure"))

    water.run(2.0)

    said = [received for _, received in helm.heard if received.name == "Pressure"][frozen:]
    assert len({each.values["Pressure"] for each in said}) == 1
    assert len({each.sequence for each in said}) == len(said)


def test_a_silent_instrument_says_nothing():
    vehicle, helm, water = at_sea()
    water.run(1.0)
    vehicle.faults.silent.add("Attitude")

    water.run(1.0)

    assert max(helm.times("Attitude")) <= 1.0
    assert max(helm.times("Pressure")) == 2.0


def test_noise_is_as_much_as_a_fault_makes_it():
    vehicle, helm, water = at_sea()
    vehicle.faults.noisy["Attitude"] = 50.0

    water.run(10.0)

    headings = [float(said.values["Roll"]) for _, said in helm.heard if said.name == "Attitude"]
    deviation = (sum(each * each for each in headings) / len(headings)) ** 0.5
    assert 8.0 < deviation < 12.0


def test_the_same_seed_measures_the_same():
    def heard(seed: int) -> list[tuple[float, Received]]:
        _, helm, water = at_sea(Surroundings(current=(0.1, 0.2)), thrusts=(5.0,) * 6, seed=seed)
        water.run(2.0)
        return helm.heard

    assert heard(1) == heard(1)
    assert heard(1) != heard(2)


def test_a_leak_is_told():
    vehicle, helm, water = at_sea()
    vehicle.faults.leak = True

    water.run(0.5)

    assert helm.last("Health")["Leak"] is True


def test_the_doppler_log_is_valid_where_it_has_the_bottom():
    for depth, bottom, valid in ((3.0, 10.0, True), (3.0, 100.0, False), (9.8, 10.0, False)):
        _, helm, water = at_sea(Surroundings(noise=False, bottom=bottom), place=(0.0, 0.0, depth))
        water.run(0.3)
        assert helm.last("GroundSpeed")["Valid"] is valid, (depth, bottom)


@pytest.mark.parametrize(
    ("heading", "seen"),
    [(0.0, 9.7 - 0.5), (90.0, 4.7 - 0.25), (180.0, 655.35), (270.0, 655.35)],
)
def test_the_sonar_sees_what_is_ahead(heading, seen):
    pool = Surroundings(
        noise=False,
        bottom=50.0,
        obstacles=(Obstacle(10.0, 0.0, 0.5), Obstacle(-5.0, 0.0, 0.5, bottom=2.0)),
        things=(
            Thing(BUOY, "ahead", 0.0, 5.0, 3.0, size=0.5),
            Thing(BUOY, "beside", 0.3, -5.0, 3.0, size=0.5),
        ),
    )
    _, helm, water = at_sea(pool, heading=heading)

    water.run(0.1)

    assert helm.last("Health")["SonarRange"] == pytest.approx(seen, abs=0.02)


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


def test_the_battery_pays_for_thrust_and_hotel():
    vehicle, helm, water = at_sea(thrusts=(18.0,) * 6)

    water.run(10.0)

    spent = 799_200.0 - vehicle.charge
    assert spent == pytest.approx((6 * 90.0 + 20.0) * 10.0, rel=0.01)
    assert helm.last("Health")["Power"] == pytest.approx(560.0)


def test_a_device_does_a_request_once_and_says_when_it_is_done():
    vehicle, helm, water = at_sea()
    command = {"Device": 1, "Action": 2, "Parameter": 1.5, "Request": 7}

    for _ in range(10):
        water.post(helm.codec.encode("DeviceCommand", **command))
        water.run(0.1)

    states = [said.values["State"] for _, said in helm.heard if said.name == "DeviceStatus"]
    assert [(each.device, each.action, each.parameter) for each in vehicle.devices.operations] == [
        (1, 2, 1.5)
    ]
    assert states[0] == "ACTIVE"
    assert states[-1] == "REACHED"
    assert states == sorted(states)


def test_a_device_that_is_not_there_fails():
    _, helm, water = at_sea()

    water.post(helm.codec.encode("DeviceCommand", Device=9, Action=0, Parameter=0.0, Request=3))
    water.run(0.2)

    assert helm.last("DeviceStatus") == {"Device": 9.0, "Request": 3.0, "State": "FAILED"}


def test_identifier_of_device_commands_is_that_of_the_catalogue():
    assert (
        Codec(pool_sheet()).encode("DeviceCommand", Device=0, Action=0, Parameter=0.0, Request=0).id
        == DEVICE_COMMAND
    )
