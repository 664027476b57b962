"""Generated controllers with a simulated vehicle that behaves as PX4's documents say."""

from math import dist

import pytest
from mmrs_multicopter.testing import LAND, go_to, robot_program, take_off

from mmrs_core.behaviour.program import Transition
from mmrs_core.testing.programs import program

pytestmark = pytest.mark.real_time("controllers")

OFFBOARD, TAKE_OFF, MISSION, LANDING = 0x6_0000, 0x204_0000, 0x404_0000, 0x604_0000
PASSED = 2.5
"""Metres from a place of a run at which it counts as passed, and what a vehicle flies in a tick."""
ROUND = [(0.0, 60.0, 20.0), (0.0, 120.0, 20.0), (0.0, 180.0, 20.0), (60.0, 180.0, 20.0)]


def mission():
    """Return a robot that steps to a first place, flies a run of three, and steps back."""
    moves = [take_off("up", 20.0), *(go_to(f"p{n}", place) for n, place in enumerate(ROUND))]
    moves += [go_to("back", (0.0, 0.0, 20.0)), LAND]
    fluid = {n: Transition(n, n + 1, fluid=True) for n in (3, 4)}
    return program(robot_program("alpha", moves, transitions=fluid))


@pytest.fixture(scope="module")
def flown(new_controllers, new_hangar, tmp_path_factory):
    """Return the controllers, what they said, and the vehicle after the flight."""
    made = new_controllers(tmp_path_factory.mktemp("px4") / "controllers", mission())
    with new_hangar() as switch_on:
        vehicles, links = switch_on(made.program, speedup=20.0, firmware="px4")
        code, said = made.run("fleet.py", *links, patience=120.0)
    assert code == 0, said
    return made, said, vehicles["alpha"].autopilot


def test_a_controller_steps_in_offboard_and_flies_runs_as_missions(flown):
    """A PX4 that has landed returns to the last mode that it may be armed in."""
    made, _, autopilot = flown
    assert made.replayed().complaints == ()
    modes = [mode for _, mode in autopilot.modes if mode in (OFFBOARD, MISSION, TAKE_OFF, LANDING)]
    assert modes == [TAKE_OFF, OFFBOARD, MISSION, OFFBOARD, LANDING, OFFBOARD]


def test_every_place_is_passed(flown):
    track = flown[2].track
    for east, north, up in ROUND:
        assert min(dist((n, e, u), (north, east, up)) for _, n, e, u in track) < PASSED


def test_a_px4_that_was_planned_as_an_ardupilot_is_reported_once(flown):
    assert flown[1].count("the vehicle's autopilot is px4, and it was planned for ardupilot (warning:") == 1


def test_a_px4_is_told_what_to_do_when_the_link_is_lost(flown):
    _, said, autopilot = flown
    assert autopilot.parameters["NAV_DLL_ACT"] == 2
    assert "NAV_DLL_ACT = " in said
