from __future__ import annotations

from dataclasses import replace

from mmrs_core.mavlink.program import robot_view
from mmrs_core.testing.programs import (
    MULTICOPTER,
    go_to,
    move,
    program,
    robot_program,
    take_off,
    target_input,
)

LAND = move("down", "Land", uri=MULTICOPTER)


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
