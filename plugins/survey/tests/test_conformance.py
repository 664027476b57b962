from mmrs_survey import plugin

from mmrs_core.scene import Part
from mmrs_core.testing.conformance import MetamodelConformance, PluginConformance, RuleConformance
from mmrs_core.testing.scenes import sample_device, sample_robot, sample_type

CAMERA = {"sensor.width": "12.0", "sensor.height": "8.0", "focal.length": "8.0"}
CARRIED = {
    "camera": sample_device("camera", "TakePicture", properties=CAMERA),
    "probe": sample_device("probe", "Sample", "seconds"),
}
FIELD = ((10.0, 10.0, 0.0), (90.0, 10.0, 0.0), (90.0, 70.0, 0.0), (50.0, 40.0, 0.0), (10.0, 70.0, 0.0))
HOLE = Part((), {"points": ((20.0, 15.0, 0.0), (30.0, 15.0, 0.0), (30.0, 25.0, 0.0), (20.0, 25.0, 0.0))})
LINE = ((0.0, 0.0, 5.0), (100.0, 0.0, 5.0), (100.0, 80.0, 9.0))
POINT = (50.0, 30.0, 20.0)
TASKS = {
    "photo_grid": {
        "initialPosition": (0.0, 0.0, 0.0),
        "shell": FIELD,
        "holes": (HOLE,),
        "altitude": 20.0,
        "actionName": "TakePicture",
    },
    "go_to": {"point": POINT, "type": "SLOW"},
    "observe": {
        "point": POINT,
        "duration": 30.0,
        "distance": 10.0,
        "altitude": 25.0,
        "deviceId": "camera",
        "actionName": "TakePicture",
    },
    "relay": {"point": POINT},
    "approach": {
        "point": POINT,
        "object": "buoy",
        "distance": 2.0,
        "tolerance": 3.0,
        "deviceId": "camera",
        "actionName": "TakePicture",
    },
    "road": {
        "initialPosition": (-10.0, 0.0, 0.0),
        "points": LINE,
        "altitude": 20.0,
        "width": 30.0,
        "footprintWidth": 12.0,
        "photoDistance": 25.0,
        "actionName": "TakePicture",
    },
    "perimeter": {
        "initialPosition": (-10.0, 0.0, 0.0),
        "shell": FIELD,
        "altitude": 20.0,
        "topAltitude": 26.0,
        "distance": 8.0,
        "faceBorder": True,
        "photoDistance": 25.0,
        "actionName": "TakePicture",
    },
    "orbit": {"point": POINT, "radius": 15.0, "turns": 2, "photoDistance": 9.0, "actionName": "TakePicture"},
    "measure": {"points": LINE, "spacing": 20.0, "actionName": "Sample"},
}


class TestPlugin(PluginConformance):
    plugin = plugin
    name = "survey"


class TestMetamodels(MetamodelConformance):
    plugin = plugin


class TestRules(RuleConformance):
    plugin = plugin
    robot = sample_robot(sample_type(devices=CARRIED))
    tasks = TASKS
