"""Travel modes on simulated vehicles: what is set up before take-off, and what is left to the owner."""

from __future__ import annotations

from dataclasses import replace

import pytest

from mmrs_core.testing.programs import MULTICOPTER, go_to, move, program, robot_program, take_off


def going(mode, position_error=0.0):
    """Return a drone that goes somewhere in a travel mode."""
    land = move("down", "Land", uri=MULTICOPTER)
    drone = robot_program("alpha", [take_off("up", 5.0), go_to("a", (0.0, 12.0, 5.0)), land])
    return replace(program(replace(drone, travel_mode=mode)), position_error=position_error)


@pytest.fixture
def parameters(controllers, hangar):
    """Return a function that flies a mode on a vehicle, and gives the vehicle's parameters afterwards."""

    def flown(mode, **owner):
        made = going(mode)
        vehicles, links = hangar(made, parameters=owner)
        code, said = controllers(made).run("fleet.py", *links)
        assert code == 0, said
        return vehicles["alpha"].autopilot.parameters

    return flown


def test_a_safe_robot_passes_places_more_closely_and_keeps_further_from_obstacles(parameters):
    found = parameters("SAFE", WPNAV_RADIUS=200.0, AVOID_MARGIN=2.0)
    assert (found["WPNAV_RADIUS"], found["AVOID_MARGIN"]) == (100.0, 4.0)


def test_an_owner_who_is_more_careful_is_left_so(parameters):
    found = parameters("SAFE", WPNAV_RADIUS=50.0, AVOID_MARGIN=6.0)
    assert (found["WPNAV_RADIUS"], found["AVOID_MARGIN"]) == (50.0, 6.0)


def test_an_aggressive_robot_leaves_the_owners_margin(parameters):
    found = parameters("AGGRESSIVE", WPNAV_RADIUS=150.0, AVOID_MARGIN=1.0)
    assert (found["WPNAV_RADIUS"], found["AVOID_MARGIN"]) == (150.0, 1.0)
