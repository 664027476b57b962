"""Missions that are uploaded to an ArduSub name no height of 0: it would stay at the depth where it is."""

from __future__ import annotations

from dataclasses import replace

import pytest
from flight_crew import robot_of

from mmrs_mavlink.program import Geographic, GoTo, Run, Start, Step, Stop, Then
from mmrs_mavlink.services.uploads import mission_of

WAYPOINT = 16
DEPTHS = {"down": -8.0, "up": 0.0, "again": -0.5}
STEPS = (
    Step("start", Start(), then=Then("down")),
    *(Step(name, GoTo(Geographic(42.37, 13.35, up), 1.0)) for name, up in DEPTHS.items()),
    Step("stop", Stop()),
)


@pytest.mark.parametrize(("vehicle", "heights"), [("sub", [-8.0, -0.01, -0.5]), ("rover", [-8.0, 0.0, -0.5])])
def test_a_place_at_the_surface_is_a_little_below_it(vehicle, heights):
    robot = replace(robot_of(), vehicle=vehicle, steps=STEPS, runs=(Run(tuple(DEPTHS), (0.0,) * 3),))
    items, _ = mission_of(robot)
    assert [item.z for item in items if item.command == WAYPOINT and item.x][-3:] == heights
