from __future__ import annotations

from dataclasses import replace

from mmrs_core.mavlink.program import robot_view
from mmrs_core.scene import Policy
from mmrs_core.testing.programs import (
    LAND,
    go_to,
    move,
    program,
    robot_program,
    take_off,
    target_input,
)


def escapes(*moves) -> list[str]:
    robot = robot_program("alpha", moves)
    view = robot_view(robot, target_input(program(robot)))
    return [name for name, _ in dict(view.head)["escapes"]]


def test_there_is_a_way_out_from_above_home_already():
    assert escapes(take_off("up", 10.0), go_to("out", (0.0, 30.0, 10.0)), LAND) == ["up", "out"]


def test_there_is_one_from_every_start_at_home_but_from_no_other_place():
    charge, again = move("charge", "Recharge", duration=20.0), take_off("again", 5.0)
    assert escapes(take_off("up", 10.0), LAND, charge, again, replace(LAND, id="home")) == ["up", "again"]
    assert escapes(take_off("up", 10.0), LAND, again, replace(LAND, id="home")) == ["up"]


def test_the_way_out_is_level():
    robot = robot_program("alpha", [take_off("up", 10.0), LAND])
    ((_, place),) = dict(robot_view(robot, target_input(program(robot))).head)["escapes"]
    assert place.positional[2] == 10.0


def alone(*moves, response: str = "EMERGENCY_AREA") -> dict:
    robot = replace(robot_program("alpha", moves), policies=(Policy("LINK_LOST", response),))
    return dict(robot_view(robot, target_input(program(robot))).head)


BEHIND_THE_SCHOOL = (160.0, 20.0, 10.0)
"""A place from which the straight line to the meadow leads through the school."""


def test_a_vehicle_may_fly_straight_where_no_area_is_in_between():
    assert alone(take_off("up", 10.0), go_to("out", (0.0, 30.0, 10.0)), LAND).get("straight", True)


def test_a_vehicle_must_not_fly_straight_where_an_area_is_in_between():
    aside, behind = go_to("aside", (90.0, -60.0, 10.0)), go_to("behind", BEHIND_THE_SCHOOL)
    assert alone(take_off("up", 10.0), aside, behind, LAND)["straight"] is False


def test_the_middle_of_a_leg_counts_as_well_as_its_ends():
    under, over = go_to("under", (160.0, -60.0, 10.0)), go_to("over", (160.0, 100.0, 10.0))
    north = go_to("north", (60.0, 160.0, 10.0))
    moves = (take_off("up", 10.0), go_to("aside", (90.0, -60.0, 10.0)), under, over, north, LAND)
    assert alone(*moves)["straight"] is False


def test_lines_are_looked_at_only_where_a_policy_wants_them():
    aside, behind = go_to("aside", (90.0, -60.0, 10.0)), go_to("behind", BEHIND_THE_SCHOOL)
    assert "straight" not in alone(take_off("up", 10.0), aside, behind, LAND, response="RETURN")
