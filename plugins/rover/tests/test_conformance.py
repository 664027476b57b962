from pathlib import Path

from mmrs_rover import plugin
from mmrs_rover.names import ROVER

from mmrs_core.testing.conformance import (
    MetamodelConformance,
    MissionConformance,
    PluginConformance,
    RobotKindConformance,
)
from mmrs_core.testing.scenes import sample_robot, sample_type

CAR = sample_type(
    name="Car",
    metaclasses=(ROVER, ("urn:mmrs:robot:1.0", "Robot")),
    attributes={"drive": "WHEELS", "turningRadius": 1.5},
    speed=(0.1, 3.0),
    acceleration=0.5,
)


class TestPlugin(PluginConformance):
    plugin = plugin
    name = "rover"


class TestMetamodels(MetamodelConformance):
    plugin = plugin


class TestRobotKinds(RobotKindConformance):
    plugin = plugin
    robots = {"rover": sample_robot(CAR, home=(3.0, 4.0, 5.0), kinematics=None)}


class TestExample(MissionConformance):
    folder = Path(__file__).parents[3] / "examples" / "drone-and-rover"
    rules = ("photo_grid", "measure", "observe")
    targets = ("mavlink-python",)
