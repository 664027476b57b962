"""The home that a vehicle has for its own where it takes off away from that of its program."""

import pytest
from flight_crew import HOME, manned
from patience import until

from mmrs_mavlink.links.retries import Retries
from mmrs_mavlink.program import Geographic
from mmrs_mavlink.services.uploads import Uploads
from mmrs_mavlink.sitl import commands
from mmrs_mavlink.vehicles.footing import aside, footing
from mmrs_runtime.faults import RefusedError

SET_HOME = 179
HILL = 6.0
"""Metres above home of the ground where the program has landed the vehicle."""

PERCH = Geographic(42.37 + 72.0 / 111_080.0, 13.35, HILL)


@pytest.fixture
def perched():
    """Return a function that gives a vehicle where its program landed it, switched on there or not."""
    opened = []

    def stand(*, restarted: bool, **settings):
        opened.append(manned(**settings))
        made = opened[-1].__enter__()
        vehicle, simulated = made.vehicle, made.simulated
        with simulated.lock:
            simulated.autopilot.body.position = (72.0, 0.0, 0.0)
        if restarted:
            simulated.faults.begin("restart")
            until(lambda: simulated.autopilot.ready)
            vehicle.reports.request()
        until(lambda: aside(vehicle.state().place, PERCH) < 1.0)
        vehicle.start = footing(HOME, PERCH)
        vehicle.prepare(Uploads())
        made.watch.renew()
        return made

    yield stand
    for made in opened:
        made.__exit__(None, None, None)


@pytest.mark.parametrize("firmware", ["ardupilot", "px4"])
def test_one_that_was_switched_on_there_is_told_the_home_of_its_program_and_counts_heights_from_it(
    perched, firmware
):
    made = perched(restarted=True, firmware=firmware)
    autopilot = made.simulated.autopilot
    assert autopilot.home[0] == pytest.approx(PERCH.latitude, abs=1e-6)
    made.vehicle.take_off(16.0)
    assert autopilot.home == pytest.approx((HOME.latitude, HOME.longitude, 720.0 - HILL), abs=0.1)
    assert made.vehicle.state().place.height == pytest.approx(16.0, abs=1.0)
    assert autopilot.body.position[2] == pytest.approx(16.0 - HILL, abs=1.0)


def test_one_that_has_its_home_there_still_keeps_that(perched):
    made = perched(restarted=False)
    home = made.simulated.autopilot.home
    told = []
    made.vehicle._tell = told.append
    made.vehicle.take_off(16.0)
    assert made.simulated.autopilot.home == pytest.approx(home, abs=1e-6)
    assert told == ["takes off 72 m from its home, which the vehicle keeps for its own: 42.370000, 13.350000"]


def test_a_place_near_home_is_home_and_the_vehicle_is_told_nothing(perched):
    made = perched(restarted=False)
    with made.simulated.lock:
        made.simulated.autopilot.body.position = (4.0, 0.0, 0.0)
    made.vehicle.start = footing(HOME, Geographic(42.37 + 4.0 / 111_080.0, 13.35, 0.2))
    made.vehicle.take_off(10.0)
    assert not any(number == SET_HOME for _, number, _ in made.simulated.autopilot.history)


@pytest.mark.parametrize(
    ("settings", "why"),
    [
        ({"refuse": frozenset({SET_HOME})}, "DO_SET_HOME: the vehicle answers 'unsupported'"),
        ({"silent": frozenset({SET_HOME})}, "DO_SET_HOME: no answer to "),
    ],
)
def test_one_that_does_not_take_it_does_not_take_off(perched, settings, why):
    made = perched(restarted=True, **settings)
    made.link.retries = Retries(tries=2)
    with pytest.raises(RefusedError, match="bring it home, and begin again") as refused:
        made.vehicle.take_off(16.0)
    assert f"it takes off 72 m from its home, and the vehicle does not keep that for its own ({why}" in str(
        refused.value
    )
    assert not made.simulated.autopilot.armed


def test_one_that_agrees_and_keeps_another_does_not_take_off(perched, monkeypatch):
    monkeypatch.setitem(commands._HANDLERS, SET_HOME, lambda pilot, params: commands.ACCEPTED)
    made = perched(restarted=True)
    made.link.retries = Retries(tries=2)
    with pytest.raises(RefusedError, match="the vehicle does not confirm it"):
        made.vehicle.take_off(16.0)
    assert not made.simulated.autopilot.armed
