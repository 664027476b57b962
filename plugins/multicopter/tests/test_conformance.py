from dataclasses import replace

from mmrs_multicopter import plugin
from mmrs_multicopter.names import DRONE, GO_TO, LAND, TAKE_OFF

from mmrs_core.behaviour.program import Move, MoveTarget
from mmrs_core.scene import Battery
from mmrs_core.testing.conformance import (
    MetamodelConformance,
    MoveKindConformance,
    PluginConformance,
    RobotKindConformance,
)
from mmrs_core.testing.scenes import FLYER, ROBOT, sample_robot, sample_type
from mmrs_runtime.timing import LegTiming

QUAD = sample_type(
    name="Quad",
    metaclasses=(DRONE, ROBOT),
    attributes={"maxAltitude": 100.0},
    speed=(4.0, 16.0),
    climb_rate=3.0,
    descent_rate=2.0,
)
ROBOTS = {
    "multicopter": sample_robot(
        replace(QUAD, batteries=(Battery(500_000.0, 90.0),)), home=(10.0, 20.0, 5.0), kinematics=None
    )
}
MOVES = {
    "TakeOff": Move("up", (TAKE_OFF,), {"altitude": 30.0}),
    "Land": Move("down", (LAND,)),
    "GoTo": Move(
        "go", (GO_TO,), {"trajectory": "VERTICAL_FIRST"}, target=MoveTarget((70.0, -40.0, 25.0)), distance=2.0
    ),
}


class TestPlugin(PluginConformance):
    plugin = plugin
    name = "multicopter"


class TestMetamodels(MetamodelConformance):
    plugin = plugin


class TestRobotKinds(RobotKindConformance):
    plugin = plugin
    robots = ROBOTS


class TestMoveKinds(MoveKindConformance):
    plugin = plugin
    moves = MOVES
    kinematics = replace(FLYER, climb=3.0, launch=5.0, recovery=5.0, launches=True, timing=LegTiming(2.0))
