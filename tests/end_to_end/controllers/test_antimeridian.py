"""Flights from one side of the 180th meridian to the other."""

import pytest
from mmrs_multicopter.testing import LAND, go_to, robot_program, take_off

from mmrs_core.behaviour.program import Transition
from mmrs_core.scene import Frame
from mmrs_core.testing.programs import program

pytestmark = pytest.mark.real_time("controllers")

AUTO = 3
FIJI = Frame("EPSG:4326", -17.0, 179.9999, 20.0, "MSL")
"""Ten metres west of the line."""


@pytest.mark.thorough
def test_a_run_and_steps_over_the_antimeridian_are_flown_as_anywhere(controllers, hangar):
    over = [go_to(name, (10.0 * n, 5.0, 8.0)) for n, name in enumerate("abcd", start=1)]
    moves = [take_off("up", 8.0), *over, go_to("home", (0.0, 0.0, 8.0)), LAND]
    fluid = {index: Transition(index, index + 1, fluid=True) for index in (2, 3, 4)}
    made = controllers(program(robot_program("alpha", moves, transitions=fluid), frame=FIJI))
    vehicles, links = hangar(made.program)
    code, said = made.run("fleet.py", *links)
    assert code == 0, said
    assert made.replayed().complaints == ()
    assert AUTO in [number for _, number in vehicles["alpha"].autopilot.modes]
    track = [(north, east) for _, north, east, _ in vehicles["alpha"].autopilot.track]
    assert max(east for _, east in track) < 42.0
    assert min(east for _, east in track) > -2.0
    assert max(abs(north) for north, _ in track) < 7.0
    assert max(map(abs, vehicles["alpha"].autopilot.body.position)) < 0.5
