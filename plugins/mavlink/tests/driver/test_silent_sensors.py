"""Sensors that publish no value: silent devices, as policies say."""

import pytest
from flight_crew import manned, robot_of

from mmrs_mavlink.driving.moves import Moves
from mmrs_mavlink.program import Measure, Policy
from mmrs_runtime.faults import DEVICE_SILENT, FaultError

SAMPLE = Measure("gas", "sample", "CO2")


@pytest.fixture
def robot():
    """Return a function that gives a robot with these policies."""
    opened = []

    def man(*policies, **settings):
        made = manned(robot_of(*policies), **settings)
        opened.append(made)
        return made.__enter__()

    yield man
    for made in opened:
        made.__exit__(None, None, None)


def measure(made):
    """Return what is told of a measurement."""
    told = []
    Moves(made.robot, made.vehicle, made.clock, {}, lambda *words: told.append(words)).action(SAMPLE).run()
    return told


def test_a_sensor_that_gives_no_value_is_a_silent_device_after_the_seconds_of_its_policy(robot):
    made = robot(Policy(DEVICE_SILENT, "RETURN", 3.0))
    clock = made.clock
    begun = clock.now()
    with pytest.raises(FaultError, match="gas: CO2: no such value comes") as caught:
        measure(made)
    assert caught.value.event == DEVICE_SILENT
    assert 3.0 <= clock.now() - begun < 3.0 + clock.patience(0.0, 2.0)


def test_a_value_that_is_published_is_measured(robot):
    ((kind, value, content),) = measure(robot(values={"CO2": lambda seconds: 412.5}))
    assert (kind, value, content["device"], content["result"]) == ("measured", "CO2", "gas", 412.5)
