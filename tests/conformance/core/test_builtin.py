"""The core's own contributions keep the laws that plug-ins must keep."""

from __future__ import annotations

from dataclasses import replace

from mmrs_core import builtin
from mmrs_core.behaviour.program import Heading, Target
from mmrs_core.testing.conformance import (
    BackendConformance,
    MoveKindConformance,
    RobotKindConformance,
    TargetConformance,
)
from mmrs_core.testing.programs import (
    MULTICOPTER,
    go_to,
    move,
    program,
    robot_program,
    take_off,
    target_input,
)
from mmrs_core.testing.scenes import sample_robot

PLACE = Target((70.0, -40.0, 25.0))


MOVES = {
    "Start": move("start", "Start"),
    "Stop": move("stop", "Stop"),
    "HoldPosition": move("hold", "HoldPosition", duration=12.0),
    "Recharge": move("recharge", "Recharge", duration=600.0),
    "HeadTo": replace(move("head", "HeadTo"), heading=Heading(PLACE)),
    "GoTo": replace(move("go", "GoTo"), target=PLACE, distance=3.0, speed=4.0),
}
FLIGHT = [take_off("up", 20.0), go_to("out", (0.0, 30.0, 20.0)), move("down", "Land", uri=MULTICOPTER)]
ONE_DRONE = target_input(program(robot_program("alpha", FLIGHT)))


class TestRobotKinds(RobotKindConformance):
    plugin = builtin
    robots = {"plain_robot": sample_robot(kinematics=None)}


class TestMoveKinds(MoveKindConformance):
    plugin = builtin
    moves = MOVES


class TestTargets(TargetConformance):
    plugin = builtin
    inputs = {"qgc-plan": ONE_DRONE, "wpl": ONE_DRONE}


class TestBackends(BackendConformance):
    plugin = builtin
