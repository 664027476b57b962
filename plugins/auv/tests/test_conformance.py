from dataclasses import replace

import pytest
from dives import dive, diver, swim
from mmrs_auv import plugin
from mmrs_auv.names import AUV_MOVEMENT, PIPELINE

from mmrs_core.scene import Kinematics, Part
from mmrs_core.testing.conformance import (
    MetamodelConformance,
    PluginConformance,
    RobotKindConformance,
    RuleConformance,
    TargetConformance,
    VehicleConformance,
)
from mmrs_core.testing.programs import sample_of
from mmrs_core.testing.scenes import sample_device, sample_robot, sample_scene, sample_type

MOVEMENT = Part((AUV_MOVEMENT,), {"thrusters": ("T1",)})
THRUSTERS = (Part((), {"id": "T1", "maxDepth": 50.0}),)
DIVER = sample_type(
    name="Diver", attributes={"thrusters": THRUSTERS}, movement=MOVEMENT, speed=(0.0, 2.0), climb_rate=0.5
)
SUB = replace(
    sample_of("auv").plain, robot_kinds={each.metaclass: each for each in plugin.mmrs_robot_kinds()}
)
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


SONAR = sample_device("sonar", "Record", properties={"sonar.swath": "8.0"})
CAMERA = sample_device("camera", "TakePicture")
SWIMMER = Kinematics(1.0, 0.0, 2.0, 0.5, 0.5, floor=-50.0, ceiling=0.0)
SHELL = ((10.0, 10.0, 0.0), (40.0, 10.0, 0.0), (40.0, 25.0, 0.0), (10.0, 25.0, 0.0))
LINE = ((10.0, 0.0, -5.0), (60.0, 0.0, -5.0), (60.0, 60.0, -6.0))
BUOY = {"point": (30.0, 20.0, -4.0), "object": "buoy", "distance": 3.0}
RECORDING = {"deviceId": "sonar", "startAction": "Record", "stopAction": None, "speed": 0.8}
PIPE = Part((PIPELINE,), {"name": "outfall", "points": LINE, "diameter": 0.4})


class TestRules(RuleConformance):
    plugin = plugin
    robot = sample_robot(
        sample_type(name="Diver", movement=MOVEMENT, devices={"sonar": SONAR, "camera": CAMERA}),
        home=(0.0, 0.0, -1.0),
        kinematics=SWIMMER,
    )
    elements = (PIPE,)
    tasks = {
        "depth_hold_survey": {
            "initialPosition": (5.0, 5.0, 0.0),
            "shell": SHELL,
            "depth": 6.0,
            "overlap": 0.1,
            **RECORDING,
        },
        "yo_yo": {
            "initialPosition": (5.0, 0.0, 0.0),
            "points": LINE,
            "minDepth": 2.0,
            "maxDepth": 8.0,
            "pitch": 20.0,
        },
        "inspect_object": {**BUOY, "views": 6, "actionName": "TakePicture", "duration": 2.0},
        "align": {**BUOY, "tolerance": 1.0, "bearing": 90.0, "actionName": "TakePicture", "duration": 5.0},
        "follow_pipeline": {"pipeline": "outfall", "height": 1.5, "offset": 1.0, **RECORDING},
        "surface_fix": {"point": (30.0, 20.0, -4.0), "duration": 20.0},
    }


class TestTargets(TargetConformance):
    plugin = plugin
    inputs = {"ada": SUB, "can-c": SUB, "can-python": SUB}


class TestVehicles(VehicleConformance):
    plugin = plugin
    behaviour = dive(swim("out", 3.0, 0.0, 1.0), swim("back", 0.0, 0.0, 1.0))
    type = diver()
    options = {"can-sim": {"noise": "no"}}
    still = {"can-sim": (10.0, 0.05)}  # a body in water bobs until it has come to rest

    @pytest.mark.parametrize(
        ("share", "response"),
        [
            pytest.param(share, response, marks=() if share == 0.3 else pytest.mark.thorough)
            for share in (0.0, 0.3, 1.0)
            for response in ("HOLD", "RETURN", "LAND", "SURFACE", "STOP_THRUST")
        ],
    )
    def test_it_stops_from_any_state_and_stays_there(self, vehicle, response, share):
        super().test_it_stops_from_any_state_and_stays_there(vehicle, response, share)
