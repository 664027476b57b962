from pathlib import Path

import pytest
from mmrs_solar import plugin
from mmrs_solar.constraints import CONSTRAINTS
from mmrs_solar.names import PANEL_GROUP, SOLAR

from mmrs_core.languages import context, mission, robot
from mmrs_core.scene import Device, DeviceAction, Part
from mmrs_core.testing.conformance import (
    Case,
    ConstraintConformance,
    MetamodelConformance,
    MissionConformance,
    PluginConformance,
    RuleConformance,
)
from mmrs_core.testing.models import breaches
from mmrs_core.testing.scenes import sample_robot, sample_type

EXAMPLE = Path(__file__).parents[3] / "examples" / "solar-park"
BY_CODE = {constraint.code: constraint for constraint in CONSTRAINTS}
OPTICS = ("sensor.width", "sensor.height", "focal.length", "image.width", "image.height")
CAMERA = {**dict.fromkeys((*OPTICS, "exposure.time", "capture.interval"), "1"), "gimbal.pitch.min": "-90"}


def at(east, north):
    return mission.RelativeCoordinate(x=east, y=north)


def group(registry, **features):
    given = {"name": "south", "rows": 4, "pitch": 8.0, "azimuth": 180.0, "tilt": 30.0, "rowWidth": 4.0}
    whole = {**given, "columns": 50, "points": [at(0.0, 0.0), at(100.0, 0.0)], **features}
    return registry.create(SOLAR, "PanelGroup", **whole)


def place(*groups, irradiance=None):
    sun = context.Environment(irradiance=irradiance)
    return context.Context(name="park", elements=list(groups), environment=sun)


def asked(registry, metaclass, of=None, **features):
    task = registry.create(SOLAR, metaclass, name="it", group=of or group(registry), **features)
    return mission.Mission(name="m", tasks=[task], origin=mission.RelativeCoordinate(x=0.0, y=0.0))


def rows(registry, of=None, **features):
    return asked(registry, "ThermalRowTask", of, **features)


def look(registry, row, column, tier=1):
    panel = registry.create(SOLAR, "SuspectedPanel", row=row, column=column, tier=tier)
    return asked(registry, "PanelLookTask", panels=[panel])


def carrier(properties=CAMERA, actions=("StartCapture", "StopCapture"), parameter="minimumIrradiance"):
    camera = robot.Device(
        id="thermal",
        properties=[robot.Property(name=key, value=value) for key, value in properties.items()],
        supportedActions=[
            robot.SupportedAction(name=name, parameters=[robot.Parameter(key=parameter)]) for name in actions
        ],
    )
    return robot.Robot(name="Any", devices=[camera])


def but(**more):
    return {**CAMERA, **{key.replace("_", "."): value for key, value in more.items()}}


CASES = {
    "SOL001": Case(lambda r: [place(group(r, rowWidth=0.0))], lambda r: [place(group(r, rowWidth=0.1))]),
    "SOL002": Case(lambda r: [place(group(r, tilt=90.5))], lambda r: [place(group(r, tilt=90.0))]),
    "SOL003": Case(
        lambda r: [rows(r), place(group(r, azimuth=183.0))],
        lambda r: [rows(r), place(group(r, azimuth=181.0))],
    ),
    "SOL004": Case(lambda r: [place(group(r, pitch=3.4))], lambda r: [place(group(r, pitch=3.5))]),
    "SOL005": Case(
        lambda r: [place(group(r), group(r, name=None))], lambda r: [place(group(r), group(r, name="north"))]
    ),
    "SOL006": Case(lambda r: [rows(r, distance=0.0)], lambda r: [rows(r, distance=0.1)]),
    "SOL007": Case(lambda r: [rows(r, frontOverlap=1.0)], lambda r: [rows(r, frontOverlap=0.99)]),
    "SOL008": Case(lambda r: [rows(r, lastRow=5)], lambda r: [rows(r, firstRow=4, lastRow=4)]),
    "SOL009": Case(lambda r: [look(r, 4, 51)], lambda r: [look(r, 4, 50)]),
    "SOL010": Case(lambda r: [rows(r, pixelSize=0.032)], lambda r: [rows(r, pixelSize=0.031)]),
    "SOL011": Case(
        lambda r: [rows(r, minimumIrradiance=599.0)], lambda r: [rows(r, minimumIrradiance=600.0)]
    ),
    "SOL012": Case(lambda r: [rows(r, speed=2.1)], lambda r: [rows(r, speed=2.0)]),
    "SOL013": Case(lambda r: [rows(r), carrier(actions=("StartCapture",))], lambda r: [rows(r), carrier()]),
    "SOL014": Case(
        lambda r: [rows(r), carrier(but(exposure_time="short"))],
        lambda r: [rows(r), carrier(but(exposure_time="0.001"))],
    ),
    "SOL015": Case(
        lambda r: [carrier(but(mount_pitch="-91"))], lambda r: [carrier(but(mount_pitch="-90", lens="wide"))]
    ),
    "SOL016": Case(lambda r: [rows(r), carrier(parameter="zoom")], lambda r: [rows(r), carrier()]),
    "SOL017": Case(
        lambda r: [rows(r), place(irradiance=599.0)], lambda r: [rows(r), place(irradiance=600.0)]
    ),
}


ACTIONS = {
    name: DeviceAction(name, 1.0, ("minimumIrradiance",))
    for name in ("StartCapture", "StopCapture", "TakePicture")
}
THERMAL = Device(
    "thermal", ACTIONS, {**CAMERA, "sensor.width": "8", "focal.length": "10", "image.width": "800"}
)
GROUP = Part(
    (PANEL_GROUP,),
    {
        "name": "south",
        "points": ((0.0, 0.0, 0.0), (100.0, 0.0, 0.0)),
        "rows": 3,
        "pitch": 8.0,
        "azimuth": 180.0,
        "tilt": 30.0,
        "rowWidth": 4.0,
        "columns": 50,
    },
)
PANEL = Part(((SOLAR, "SuspectedPanel"),), {"row": 2, "column": 7, "tier": 1})
ON_PANELS = {"group": "south", "distance": 12.0, "minimumIrradiance": 600.0}
CAPTURE = {"startAction": "StartCapture", "stopAction": "StopCapture"}
TASKS = {
    "row_inspection": {**ON_PANELS, **CAPTURE, "pixelSize": 2.0, "blur": 0.5, "speed": 2.0},
    "panel_look": {**ON_PANELS, "pixelSize": 2.0, "actionName": "TakePicture", "panels": (PANEL,)},
}


class TestPlugin(PluginConformance):
    plugin = plugin
    name = "solar"


class TestMetamodel(MetamodelConformance):
    plugin = plugin


class TestConstraints(ConstraintConformance):
    plugin = plugin
    cases = CASES


class TestRules(RuleConformance):
    plugin = plugin
    tasks = TASKS
    robot = sample_robot(sample_type(devices={"thermal": THERMAL}))
    elements = (GROUP,)


class TestExample(MissionConformance):
    folder = EXAMPLE
    rules = ("row_inspection", "panel_look")
    targets = ("mavlink-python",)


@pytest.fixture(scope="module")
def registry():
    from mmrs_core.languages.registry import registry_with

    return registry_with(plugin.mmrs_metamodels())


@pytest.mark.parametrize(
    ("code", "models", "message"),
    [
        ("SOL001", lambda r: [place(group(r, height=-1.0))], "height of PanelGroup 'south' is -1"),
        ("SOL001", lambda r: [place(group(r, tiers=0))], "tiers of PanelGroup 'south' is 0"),
        ("SOL002", lambda r: [place(group(r, azimuth=-1.0))], "azimuth of PanelGroup 'south' is -1"),
        ("SOL004", lambda r: [place(group(r, pitch=None))], "pitch of panel group 'south' is missing"),
        ("SOL005", lambda r: [place(group(r, name=""))], "panel group has no name"),
        (
            "SOL006",
            lambda r: [rows(r, minimumIrradiance=-1.0)],
            "minimumIrradiance of ThermalRowTask 'it' is -1",
        ),
        ("SOL008", lambda r: [rows(r, firstRow=0)], "task 'it' asks for rows 0 to 4, 'south' has 1 to 4"),
        ("SOL009", lambda r: [look(r, 0, 1)], "row 0 is suspected by task 'it'"),
        ("SOL009", lambda r: [look(r, 1, 1, 2)], "tier 2 is suspected by task 'it'"),
        ("SOL012", lambda r: [rows(r, sideOverlap=0.5)], "sideOverlap of task 'it' is 0.5"),
        ("SOL013", lambda r: [look(r, 1, 1), carrier()], "task 'it' asks for 'TakePicture', no robot type"),
        ("SOL013", lambda r: [rows(r, deviceId="eye"), carrier()], "has a device 'eye' for that"),
        ("SOL015", lambda r: [carrier(but(gimbal_pitch_max="-91"))], "property 'gimbal.pitch.max' of device"),
        ("SOL015", lambda r: [carrier(but(capture_interval="0"))], "property 'capture.interval' of device"),
    ],
)
def test_other_breaches_are_told_by_what_is_wrong(code, models, message, registry):
    assert any(message in found for found in breaches(BY_CODE[code], models(registry)))


def test_limits_of_a_gimbal_are_in_order(registry):
    crossed = but(gimbal_pitch_min="10", gimbal_pitch_max="-10")
    (found,) = breaches(BY_CODE["SOL015"], [carrier(crossed)])
    assert found == "gimbal.pitch.min of device 'thermal' is above its gimbal.pitch.max"


def test_a_group_out_of_square_is_told_where_its_panels_may_face(registry):
    from mmrs_core.testing.models import findings

    models = [rows(registry), place(group(registry, azimuth=190.0))]
    (found,) = findings(BY_CODE["SOL003"], models)
    assert found.hint == "panels of that row face 0.0 or 180.0 degrees"


def test_a_row_without_length_faces_nowhere(registry):
    point = group(registry, points=[at(5.0, 5.0), at(5.0, 5.0)])
    (found,) = breaches(BY_CODE["SOL003"], [rows(registry), place(point)])
    assert found == "points of panel group 'south' are one point"


@pytest.mark.parametrize("code", ["SOL013", "SOL014", "SOL016"])
def test_a_project_without_robot_types_is_not_blamed_for_its_cameras(code, registry):
    assert breaches(BY_CODE[code], [rows(registry)]) == []


def test_single_images_need_no_exposure_time(registry):
    still = carrier({key: "1" for key in OPTICS}, ("TakePicture",))
    assert breaches(BY_CODE["SOL014"], [look(registry, 1, 1), still]) == []
