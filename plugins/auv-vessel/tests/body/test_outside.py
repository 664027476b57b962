"""A simulated vehicle whose thrusters' drives are other nodes."""

from sample_vessels import pool_sheet

from auv_vessel.body.devices import HELD
from auv_vessel.body.surroundings import Surroundings
from auv_vessel.body.vehicle import Vehicle
from auv_vessel.hosting import Rehearsal
from auv_vessel.wire.catalogue import STATUS_BASE
from auv_vessel.wire.codec import Codec
from auv_vessel.wire.frame import Frame

AHEAD = (10.0, 10.0, 10.0, 10.0, 0.0, 0.0)


class Drives:
    """Drives that push without being told to."""

    name = "Drives"
    period = 0.1

    def __init__(self) -> None:
        self._codec = Codec(pool_sheet())
        self.heard: list[Frame] = []

    def hear(self, frame: Frame, now: float) -> None:
        self.heard.append(frame)

    def tick(self, now: float) -> list[Frame]:
        return [
            self._codec.encode(f"Thruster{number}Status", Thrust=thrust, Power=1.0, Drive="RUNS")
            for number, thrust in enumerate(AHEAD)
        ]


def at_sea() -> tuple[Vehicle, Drives, Rehearsal]:
    sheet, drives = pool_sheet(), Drives()
    calm = Surroundings(noise=False, bottom=10.0)
    vehicle = Vehicle(sheet, Codec(sheet), calm, place=(0.0, 0.0, 3.0), without_drives=True)
    return vehicle, drives, Rehearsal([vehicle, drives])


def test_it_goes_as_its_drives_say_and_says_nothing_for_them():
    vehicle, drives, water = at_sea()

    water.run(5.0)

    assert vehicle.truth.north > 1.0
    assert not [frame for frame in drives.heard if STATUS_BASE <= frame.id < STATUS_BASE + 6]


def test_it_does_not_go_by_its_own_drives():
    vehicle, _, water = at_sea()
    water.kill("Drives")
    codec = Codec(pool_sheet())

    for _ in range(20):
        water.post(codec.encode("Thruster0Command", Thrust=10.0, Enable=True))
        water.run(0.1)

    assert vehicle.drives[0].thrust == 10.0
    assert set(vehicle.truth.thrusts) == {0.0}


def test_motors_stop_when_their_drives_are_silent():
    vehicle, _, water = at_sea()
    water.run(2.0)
    water.kill("Drives")

    water.run(HELD - 0.2)
    assert vehicle.truth.thrusts[0] > 9.0
    water.run(1.2)

    assert abs(vehicle.truth.thrusts[0]) < 0.1


def test_a_motor_that_is_dead_does_not_push_whatever_its_drive_says():
    vehicle, _, water = at_sea()
    vehicle.faults.dead.add(0)

    water.run(2.0)

    assert vehicle.truth.thrusts[0] == 0.0
    assert vehicle.truth.thrusts[1] > 9.0


def test_nothing_pushes_with_an_empty_battery():
    vehicle, _, water = at_sea()
    water.run(1.0)
    vehicle.charge = 1.0

    water.run(2.0)

    assert abs(vehicle.truth.thrusts[0]) < 0.1
