"""The core's own contributions keep the laws that plug-ins must keep."""

from dataclasses import replace

from mmrs_core import builtin
from mmrs_core.behaviour.program import Heading, MoveTarget
from mmrs_core.testing.conformance import MoveKindConformance, RobotKindConformance, VehicleConformance
from mmrs_core.testing.programs import move
from mmrs_core.testing.scenes import sample_robot

PLACE = MoveTarget((70.0, -40.0, 25.0))


MOVES = {
    "Start": move("start", "Start"),
    "Stop": move("stop", "Stop"),
    "HoldPosition": move("hold", "HoldPosition", duration=12.0),
    "Recharge": move("recharge", "Recharge", duration=600.0),
    "HeadTo": replace(move("head", "HeadTo"), heading=Heading(PLACE)),
    "GoTo": replace(move("go", "GoTo"), target=PLACE, distance=3.0, speed=4.0),
}


class TestRobotKinds(RobotKindConformance):
    plugin = builtin
    robots = {"plain_robot": sample_robot(kinematics=None)}


class TestMoveKinds(MoveKindConformance):
    plugin = builtin
    moves = MOVES


class TestVehicles(VehicleConformance):
    plugin = builtin
