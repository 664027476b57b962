from __future__ import annotations

from mmrs_auv import plugin
from mmrs_auv.names import AUV_MOVEMENT

from mmrs_core.scene import Part
from mmrs_core.testing.conformance import MetamodelConformance, PluginConformance, RobotKindConformance
from mmrs_core.testing.scenes import sample_robot, sample_scene, sample_type

MOVEMENT = Part((AUV_MOVEMENT,), {"thrusters": (Part((), {"maxDepth": 50.0}),)})
DIVER = sample_type(name="Diver", movement=MOVEMENT, speed=(0.0, 2.0), climb_rate=0.5)
LAKE = sample_scene(surface=-3.0, environment={"waterDensity": 1000.0, "currentSpeed": 0.5})


class TestPlugin(PluginConformance):
    plugin = plugin
    name = "auv"


class TestMetamodels(MetamodelConformance):
    plugin = plugin


class TestRobotKinds(RobotKindConformance):
    plugin = plugin
    robots = {"auv": sample_robot(DIVER, home=(0.0, 0.0, -3.0), kinematics=None)}
    scene = LAKE
