"""How a vehicle that is still in the air comes back to where the leg begins that its program is at."""

from __future__ import annotations

from dataclasses import replace

import pytest

from mmrs_mavlink.program import GoTo, Land, Local, Robot, Run, Step, Stop, TakeOff, Then
from mmrs_mavlink.steps.rejoining import Rejoined, rejoined, way_ahead
from mmrs_runtime.faults import Refused

HOME, OVERHEAD = Local(0.0, 0.0, 0.0), Local(0.0, 0.0, 40.0)
WEST, EAST = Local(100.0, 0.0, 15.0), Local(100.0, 50.0, 15.0)
BACK, LAST = Local(50.0, 50.0, 15.0), Local(50.0, 0.0, 15.0)
MOVES = {
    "up": TakeOff(40.0),
    "out": GoTo(WEST, legs="level first"),
    "east": GoTo(EAST),
    "back": GoTo(BACK),
    "last": GoTo(LAST),
    "down": Land(),
    "stop": Stop(),
}
NAMES = list(MOVES)
ROBOT = Robot(
    "r",
    "r.jsonl",
    "copter",
    HOME,
    "up",
    tuple(
        Step(name, movement, then=Then(NAMES[index + 1]) if index + 1 < len(NAMES) else None)
        for index, (name, movement) in enumerate(MOVES.items())
    ),
    runs=(Run(("east", "back", "last"), (0.0, 0.0, 0.0)),),
)


def found(came, move, here, robot=ROBOT):
    """Return where a vehicle is on its way from home."""
    return rejoined(came[0], came[1:], way_ahead(robot, move, came[-1], lambda go_to: go_to.at), here)


def back_to(came, move, here, robot=ROBOT):
    """Return where a vehicle goes to be where a move begins."""
    there = found(came, move, here, robot)
    return [*there.back, *came[1:][there.behind :]]


def test_on_the_way_that_it_came_it_goes_along_it():
    assert back_to([HOME, OVERHEAD, WEST], "east", Local(30.0, 1.0, 30.0)) == [WEST]
    assert back_to([HOME, OVERHEAD, WEST], "east", Local(0.0, 1.0, 20.0)) == [OVERHEAD, WEST]


@pytest.mark.parametrize(
    "here", [Local(60.0, 2.0, 40.0), Local(100.0, 0.0, 25.0)], ids=["level", "coming down"]
)
def test_a_leg_with_a_corner_is_its_way(here):
    corner = [Local(100.0, 0.0, 40.0)] if here.height < 40.0 else []
    assert back_to([HOME, OVERHEAD], "out", here) == [*corner, OVERHEAD]


def test_the_straight_line_is_no_way_where_the_leg_has_a_corner():
    with pytest.raises(Refused, match="12 m from the way"):
        back_to([HOME, OVERHEAD], "out", Local(50.0, 0.0, 27.5))


@pytest.mark.parametrize(
    ("here", "way"),
    [
        (Local(100.0, 20.0, 15.0), [WEST]),
        (Local(75.0, 50.0, 15.0), [EAST, WEST]),
        (Local(50.0, 3.0, 15.0), [BACK, EAST, WEST]),
    ],
)
def test_a_run_that_the_vehicle_flies_on_by_itself_is_flown_back(here, way):
    assert back_to([HOME, OVERHEAD, WEST], "east", here) == way


def test_a_move_that_is_no_run_leads_no_further_than_to_its_end():
    with pytest.raises(Refused, match="from the way of its program"):
        back_to([HOME, OVERHEAD, WEST], "east", Local(50.0, 20.0, 15.0), replace(ROBOT, runs=()))


def test_a_vehicle_that_was_landing_climbs_to_where_its_landing_began():
    assert back_to([HOME, OVERHEAD, WEST, LAST], "down", Local(50.0, 0.5, 4.0)) == [LAST]


def test_a_vehicle_that_was_taking_off_is_on_its_way():
    assert back_to([HOME], "up", Local(1.0, 0.0, 22.0)) == [HOME]


def test_of_two_legs_along_one_line_the_later_one_is_meant():
    there_and_back = [HOME, OVERHEAD, Local(90.0, 0.0, 40.0), OVERHEAD]
    assert back_to(there_and_back, "down", Local(45.0, 0.0, 40.0)) == [OVERHEAD]


def test_only_what_it_has_passed_is_behind_it():
    assert found([HOME, OVERHEAD, WEST], "east", Local(30.0, 1.0, 30.0)) == Rejoined(1)
    assert found([HOME, OVERHEAD, WEST], "east", Local(0.0, 1.0, 20.0)) == Rejoined(0)
    assert found([HOME, OVERHEAD, WEST], "east", Local(100.0, 20.0, 15.0)).behind == 2


def test_elsewhere_it_is_refused():
    with pytest.raises(Refused, match="40 m from the way"):
        back_to([HOME, OVERHEAD, WEST], "east", Local(140.0, 0.0, 15.0))
