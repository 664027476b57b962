"""The fence of a vehicle keeps the distances that its mission asks for."""

from dataclasses import replace

import pytest
from mmrs_multicopter.testing import LAND, go_to, robot_program, take_off, target_input
from shapely import LineString, Polygon

from mmrs_core.generation.render import render
from mmrs_core.scene import Area, AreaUse
from mmrs_core.testing.programs import program
from mmrs_mavlink.plugin.controllers import MAVLINK_PYTHON

pytestmark = pytest.mark.real_time("controllers")

SHELL = ((20.0, 0.0), (60.0, 0.0), (60.0, 40.0), (20.0, 40.0))
SAFETY, ERROR, HALF = 2.0, 0.5, 0.5
YARD = Area("yard", AreaUse.FORBIDDEN, SHELL, safety_distance=SAFETY)
EDGE = 20.0 - SAFETY - ERROR - HALF
"""How far to the east a leg may lead along the yard."""


def passing(east: float, *, back: bool = True):
    """Return a robot that flies along the yard to the north, and back."""
    legs = [go_to("out", (east, -20.0, 10.0)), go_to("north", (east, 60.0, 10.0))]
    legs += [go_to("south", (east, -20.0, 10.0))] if back else []
    moves = [take_off("up", 10.0), *legs, LAND]
    return replace(program(robot_program("alpha", moves)), position_error=ERROR)


def made(controllers, flown):
    files = render(MAVLINK_PYTHON, replace(target_input(flown), areas=(YARD,)))
    return controllers(flown, files=files)


def test_a_vehicle_keeps_its_safety_distance_and_breaks_no_fence(controllers, hangar):
    flown = passing(EDGE)
    there = made(controllers, flown)
    vehicles, links = hangar(flown, speedup=10.0)
    code, said = there.run("fleet.py", *links)
    assert code == 0, said
    track = LineString([(east, north) for _, north, east, _ in vehicles["alpha"].autopilot.track])
    assert track.distance(Polygon(SHELL)) >= SAFETY + HALF
    assert not vehicles["alpha"].autopilot.breached
    assert "the fence around" not in said


def test_a_fence_that_a_leg_makes_tighter_than_it_should_be_is_told_at_the_start(controllers, hangar):
    flown = passing(18.5, back=False)
    there = made(controllers, flown)
    _, links = hangar(flown)
    _, said = there.run("fleet.py", *links)
    assert "the fence around 'yard' is 1.0 m from it, although 3.0 m must be kept" in said
