"""Sensors that publish no value: silent devices, for both executions, as policies say."""

from __future__ import annotations

import pytest
from flight_crew import manned, robot_of

from mmrs_mavlink.driving.moves import Moves
from mmrs_mavlink.program import Measure, Policy
from mmrs_runtime.faults import DEVICE_SILENT, Fault

SAMPLE = Measure("gas", "sample", "CO2")


@pytest.fixture
def crew(tmp_path):
    """Return a function that gives the crew of a robot with these policies."""
    opened = []

    def man(*policies, **settings):
        made = manned(tmp_path, robot_of(*policies), **settings)
        opened.append(made)
        return made.__enter__()

    yield man
    for made in opened:
        made.__exit__(None, None, None)


def generated(made):
    """Measure as generated controllers do."""
    made.crew.pilot._doing.act(SAMPLE, "post:0")


def interpreted(made):
    """Measure as the interpreter does."""
    crew = made.crew
    measured = []
    Moves(crew.robot, crew.vehicle, crew.desk.clock, {}, lambda *told: measured.append(told)).action(
        SAMPLE
    ).run()
    assert measured


EXECUTIONS = pytest.mark.parametrize("measure", [generated, interpreted])


@EXECUTIONS
def test_a_sensor_that_gives_no_value_is_a_silent_device_after_the_seconds_of_its_policy(crew, measure):
    made = crew(Policy(DEVICE_SILENT, "RETURN", 3.0))
    clock = made.crew.desk.clock
    begun = clock.now()
    with pytest.raises(Fault, match="gas: CO2: no such value comes") as caught:
        measure(made)
    assert caught.value.event == DEVICE_SILENT
    assert 3.0 <= clock.now() - begun < 3.0 + clock.patience(0.0, 2.0)


def test_a_policy_may_have_a_robot_carry_on_without_a_value(crew):
    made = crew(Policy(DEVICE_SILENT, "CONTINUE", 3.0))
    generated(made)
    assert [line.label for line in made.crew.desk.log.steps] == ["act"]


@EXECUTIONS
def test_a_value_that_is_published_is_measured(crew, measure):
    measure(crew(values={"CO2": lambda seconds: 412.5}))
