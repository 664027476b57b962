"""Whether a vehicle that stands somewhere is the robot's, and not that of another one."""

from __future__ import annotations

from dataclasses import replace

import pytest
from flight_crew import HOME, robot_of

from mmrs_core.flight.faults import Refused
from mmrs_core.flight.program import Geographic
from mmrs_core.flight.vehicles.recognition import refuse_neighbours


def north(metres: float) -> Geographic:
    return Geographic(HOME.latitude + metres / 111_080.0, HOME.longitude, 0.0)


def beside(metres: float):
    """Return a robot whose neighbours' homes are so far north of its own, and as far south."""
    return replace(robot_of(), neighbours=(("Brezza", north(metres)), ("Cirro", north(-metres))))


def test_a_vehicle_at_the_home_of_another_robot_is_that_ones():
    with pytest.raises(Refused, match="0 m from the home of 'Brezza' and 8 m from that of its program: are"):
        refuse_neighbours(beside(8.0), north(8.0))


def test_a_vehicle_that_is_nearer_to_another_home_than_to_its_own_is_refused():
    with pytest.raises(Refused, match="'Cirro'"):
        refuse_neighbours(beside(8.0), north(-4.3))


@pytest.mark.parametrize(("apart", "away"), [(8.0, 3.7), (8.0, -3.7), (3.0, 1.8), (1.0, 1.0), (60.0, 19.0)])
def test_a_vehicle_near_its_own_home_is_the_robots(apart, away):
    refuse_neighbours(beside(apart), north(away))


def test_a_robot_alone_has_nobody_to_be_taken_for():
    refuse_neighbours(robot_of(), north(19.0))
