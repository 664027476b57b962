"""What the instruments of a simulated vehicle say on its bus."""

import pytest
from at_sea import at_sea

from auv_vessel.body.surroundings import BUOY, Obstacle, Surroundings, Thing
from auv_vessel.wire.codec import Received


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


def test_there_is_a_fix_at_the_surface_only():
    _, helm, water = at_sea(
        Surroundings(noise=False), thrusts=(0, 0, 0, 0, 20.0, 20.0), place=(5.0, -2.0, 0.0)
    )

    water.run(6.0)

    assert helm.times("Fix") == [0.0]
    assert helm.last("Fix") == {"North": 5.0, "East": -2.0}


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


def test_the_doppler_log_is_valid_where_it_has_the_bottom():
    for depth, bottom, valid in ((3.0, 10.0, True), (3.0, 100.0, False), (9.8, 10.0, False)):
        _, helm, water = at_sea(Surroundings(noise=False, bottom=bottom), place=(0.0, 0.0, depth))
        water.run(0.3)
        assert helm.last("GroundSpeed")["Valid"] is valid, (depth, bottom)


@pytest.mark.parametrize(
    ("heading", "seen"), [(0.0, 9.7 - 0.5), (90.0, 4.7 - 0.25), (180.0, 655.35), (270.0, 655.35)]
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
