"""Targets in GUIDED: sent once, and again where the vehicle does not go there."""

import pytest
from flight_crew import HOME, manned, robot_of

from mmrs_mavlink.program import Geographic
from mmrs_mavlink.services.uploads import Uploads
from mmrs_runtime.controllers.geodesy import distance
from mmrs_runtime.ports import Address

TARGET = 86
"""The number of SET_POSITION_TARGET_GLOBAL_INT."""

FAR = Geographic(42.3703, 13.35, 0.0)
"""33 metres north of home."""


class Lossy:
    """What a program writes, without the first targets in it.

    Attributes:
        sent: how many targets it has sent.
    """

    def __init__(self, made, lost: int) -> None:
        self.sent, self._lost, self._write = 0, lost, made.ears.write
        made.ears.write = self

    def __call__(self, data: bytes, to: Address | None = None) -> object:
        if int.from_bytes(data[7:10], "little") != TARGET:
            return self._write(data, to)
        self.sent += 1
        return None if self.sent <= self._lost else self._write(data, to)


@pytest.fixture(params=["copter", "rover", "sub"])
def ready(request):
    """Give a vehicle of each class that is ready to move, and its place 33 metres further north."""
    with manned(robot_of(vehicle=request.param), kind=request.param) as made:
        made.vehicle.prepare(Uploads())
        made.watch.renew()
        height = {"copter": 10.0, "sub": -4.0}.get(request.param, 0.0)
        if request.param == "copter":
            made.vehicle.take_off(height)
        elif request.param == "sub":
            made.vehicle.go_to(Geographic(HOME.latitude, HOME.longitude, height), None, None, False)
        yield made, Geographic(FAR.latitude, FAR.longitude, height)


def test_a_target_is_not_sent_again_while_the_vehicle_goes_there(ready):
    made, place = ready
    link = Lossy(made, 0)
    made.vehicle.go_to(place, 1.0, None, False)
    assert made.away(place) < 1.0
    assert link.sent <= 3, "33 s at one a second"


def test_a_target_that_is_lost_is_sent_again(ready):
    made, place = ready
    link, begun = Lossy(made, 3), made.clock.now()
    made.vehicle.go_to(place, 1.0, None, False)
    assert made.away(place) < 1.0
    assert 4 <= link.sent <= 7
    assert made.clock.now() - begun < distance(HOME, FAR) / 1.0 + 60.0
