"""What shows that a vehicle goes where it was told to go."""

from __future__ import annotations

from dataclasses import replace

import pytest

from mmrs_core.flight.program import Local
from mmrs_core.flight.steps.turning import turns_to
from mmrs_core.flight.vehicles.vehicle import State

GOAL = Local(0.0, 0.0, 10.0)
OUT = State(10.0, Local(20.0, 0.0, 10.0), 0.0, 0.0, 1.0, "guided", armed=True)


def moving(north: float) -> State:
    return replace(OUT, velocity=(north, 0.0, 0.0))


@pytest.mark.parametrize(
    ("before", "now", "turns"),
    [
        (0.0, 0.0, False),
        (0.0, -0.5, True),
        (5.0, 5.0, False),
        (5.0, 4.9, False),
        (5.0, 4.5, True),
        (-5.0, -5.0, True),
        (-5.0, 0.0, False),
    ],
)
def test_a_vehicle_turns_when_it_slows_down_or_comes_nearer(before, now, turns):
    assert turns_to(GOAL, moving(before), moving(now)) is turns


def test_a_vehicle_in_another_mode_is_not_steered():
    assert not turns_to(GOAL, moving(0.0), replace(moving(-5.0), mode="auto"))


def test_a_vehicle_that_is_there_need_not_move():
    there = replace(OUT, place=GOAL)
    assert turns_to(GOAL, there, there)
