import re

import pytest
from mmrs_survey import plugin
from mmrs_survey.constraints import CONSTRAINTS
from mmrs_survey.names import SURVEY

from mmrs_core.analysis.constraints import CONSTRAINTS as CORE
from mmrs_core.languages import context as cml
from mmrs_core.languages import mission as mml
from mmrs_core.testing.conformance import Case, ConstraintConformance
from mmrs_core.testing.models import breaches, sample_mission

ROBOT_LANGUAGE = "urn:mmrs:robot:1.0"
OPTICS = {"sensor.width": "13.2", "sensor.height": "8.8", "focal.length": "8.8"}
PIXELS = {"image.width": "4000", "image.height": "3000"}


def grid(registry, **features):
    return registry.create(SURVEY, "PhotoGridTask", **{"name": "field", "altitude": 20.0, **features})


def sized(registry, **features):
    return grid(registry, **{"footprintWidth": 9.0, "footprintLength": 6.0, **features})


def measure(registry, *keys, **features):
    pairs = [registry.create("urn:mmrs:behaviour:1.0", "Pair", key=key, value="1") for key in keys]
    given = {"name": "probe", "actionName": "Sample", "points": corners(1), "parameters": pairs}
    return registry.create(SURVEY, "MeasureTask", **{**given, **features})


def task(registry, metaclass, **features):
    return registry.create(SURVEY, metaclass, name="it", **features)


def corners(count):
    return [mml.RelativeCoordinate(x=float(index), y=0.0) for index in range(count)]


def device(registry, name, properties=(), action="TakePicture"):
    parameters = [registry.create(ROBOT_LANGUAGE, "Parameter", key="seconds")]
    return registry.create(
        ROBOT_LANGUAGE,
        "Device",
        id=name,
        name="what people call it",
        properties=[
            registry.create(ROBOT_LANGUAGE, "Property", name=key, value=value)
            for key, value in dict(properties).items()
        ],
        supportedActions=[
            registry.create(ROBOT_LANGUAGE, "SupportedAction", name=action, parameters=parameters)
        ],
    )


def robot(registry, *devices):
    return registry.create(ROBOT_LANGUAGE, "Robot", name="Any", devices=list(devices))


def camera(registry, **properties):
    return robot(registry, device(registry, "camera", properties or PIXELS))


def two_cameras(registry):
    return robot(registry, device(registry, "left"), device(registry, "right"))


def probe(registry):
    return robot(registry, device(registry, "probe", action="Sample"))


def relaying(registry, *, after=False, **features):
    """Return a mission with a relay, and a task that comes after it or does not depend on it."""
    relay = registry.create(SURVEY, "RelayTask", name="ridge", **features)
    rest = [registry.create(SURVEY, "GoToTask", name=name) for name in ("first", "second")]
    edge = mml.TaskDependency(from_=relay if after else rest[0], to=rest[1])
    return [mml.Mission(name="m", tasks=[relay, *rest], taskDependencies=[edge])]


def accepting(registry, *unknowns):
    made = task(registry, "ApproachTask", object="buoy")
    return mml.Mission(name="m", tasks=[made], acceptedUnknowns=list(unknowns))


def field(made, side=100.0):
    corners = ((0.0, 0.0), (side, 0.0), (side, side), (0.0, side))
    made.shell.extend(mml.RelativeCoordinate(x=x, y=y) for x, y in corners)
    return mml.Mission(name="m", tasks=[made], origin=mml.RelativeCoordinate(x=0.0, y=0.0))


def line(*places):
    return [mml.RelativeCoordinate(x=float(x), y=float(y)) for x, y in places]


def road(registry, north, width=20.0):
    features = {"points": line((0, north), (99, north)), "width": width, "footprintWidth": 10.0}
    return task(registry, "RoadTask", **features)


def beside_a_tower(registry, made):
    """Return a mission of one robot 2 m across with that task, and a tower from 45 to 55 m east."""
    shell = line((45, -5), (55, -5), (55, 5), (45, 5))
    tower = cml.Obstacle(name="tower", shell=shell, maxHeight=60.0)
    size = registry.create(ROBOT_LANGUAGE, "Size", length=2.0, width=0.0, height=0.0)
    rover = registry.create(
        ROBOT_LANGUAGE, "Robot", name="Any", size=size, devices=[device(registry, "probe", action="Sample")]
    )
    return [sample_mission(made), cml.Context(name="c", obstacles=[tower]), rover]


CASES = {
    "SUR001": Case(lambda r: [sized(r, gridResolution=12.0)], lambda r: [grid(r, gridResolution=12.0)]),
    "SUR002": Case(lambda r: [grid(r), camera(r)], lambda r: [grid(r), camera(r, **OPTICS)]),
    "SUR003": Case(lambda r: [sized(r, sideOverlap=1.0)], lambda r: [sized(r, sideOverlap=0.99)]),
    "SUR004": Case(lambda r: [grid(r, gridResolution=0.0)], lambda r: [grid(r, gridResolution=0.1)]),
    "SUR005": Case(lambda r: [grid(r, footprintWidth=9.0)], lambda r: [sized(r)]),
    "SUR006": Case(lambda r: [sized(r, groundResolution=0.01)], lambda r: [grid(r, groundResolution=0.01)]),
    "SUR007": Case(
        lambda r: [grid(r, gridResolution=12.0, sideOverlap=0.5)], lambda r: [grid(r, gridResolution=12.0)]
    ),
    "SUR008": Case(
        lambda r: [grid(r, groundResolution=0.01), camera(r, **OPTICS)],
        lambda r: [grid(r, groundResolution=0.01), camera(r, **PIXELS)],
    ),
    "SUR009": Case(
        lambda r: [sized(r), two_cameras(r)], lambda r: [sized(r, deviceId="left"), two_cameras(r)]
    ),
    "SUR010": Case(
        lambda r: [sized(r, deviceId="what people call it"), camera(r)],
        lambda r: [sized(r, deviceId="camera"), camera(r)],
    ),
    "SUR011": Case(lambda r: [measure(r, altitude=1.0, depth=1.0)], lambda r: [measure(r, depth=1.0)]),
    "SUR012": Case(lambda r: [measure(r, points=[])], lambda r: [measure(r)]),
    "SUR013": Case(
        lambda r: [measure(r, shell=corners(3), spacing=1.0)],
        lambda r: [measure(r, points=[], shell=corners(3), spacing=1.0)],
    ),
    "SUR014": Case(lambda r: [measure(r, "minutes"), probe(r)], lambda r: [measure(r, "seconds"), probe(r)]),
    "SUR015": Case(
        lambda r: [camera(r, **{"focal.length": "24 mm"})],
        lambda r: [camera(r, **{"focal.length": "24", "mount": "gimbal"})],
    ),
    "SUR016": Case(lambda r: [accepting(r)], lambda r: [accepting(r, "clearance")]),
    "SUR017": Case(
        lambda r: [task(r, "ObserveTask", duration=1.0)],
        lambda r: [task(r, "ObserveTask", duration=1.0, distance=5.0)],
    ),
    "SUR018": Case(
        lambda r: [field(grid(r, gridResolution=0.7))], lambda r: [field(grid(r, gridResolution=0.71))]
    ),
    "SUR019": Case(
        lambda r: [field(grid(r, gridResolution=0.1))], lambda r: [field(grid(r, gridResolution=10.0))]
    ),
    "SUR020": Case(lambda r: [grid(r, groundResolution=2.0)], lambda r: [grid(r, groundResolution=0.49)]),
    "SUR021": Case(
        lambda r: beside_a_tower(r, measure(r, points=line((0, 0), (50, 0), (99, 0)))),
        lambda r: beside_a_tower(r, measure(r, points=line((0, 0), (99, 0)))),
    ),
    "SUR022": Case(
        lambda r: beside_a_tower(r, measure(r, points=line((0, 0), (99, 0)), spacing=5.0)),
        lambda r: beside_a_tower(r, measure(r, points=line((0, 0), (99, 0)), spacing=5.0, altitude=70.0)),
    ),
    "SUR023": Case(lambda r: beside_a_tower(r, road(r, -4)), lambda r: beside_a_tower(r, road(r, -15))),
    "SUR024": Case(lambda r: relaying(r, after=True), relaying),
}
BY_CODE = {constraint.code: constraint for constraint in CONSTRAINTS}


class TestConstraints(ConstraintConformance):
    plugin = plugin
    cases = CASES


TASKS = ["PhotoGridTask", "GoToTask", "RoadTask", "ObserveTask", "ApproachTask"]


@pytest.mark.parametrize("metaclass", TASKS)
def test_half_a_task_crashes_no_constraint(metaclass, registry):
    codes = {code for code in BY_CODE if breaches(BY_CODE[code], [registry.create(SURVEY, metaclass)])}
    assert codes <= {"SUR002", "SUR012", "SUR016", "SUR017"}


@pytest.mark.parametrize(
    ("metaclass", "feature"),
    [
        ("PhotoGridTask", "speed"),
        ("RoadTask", "photoDistance"),
        ("RoadTask", "width"),
        ("ObserveTask", "duration"),
        ("MeasureTask", "spacing"),
        ("ApproachTask", "tolerance"),
    ],
)
def test_negative_figures_are_found_in_every_task(metaclass, feature, registry):
    (message,) = breaches(BY_CODE["SUR004"], [task(registry, metaclass, **{feature: -1.0})])
    assert message.startswith(f"{feature} of {metaclass} 'it' is -1")


@pytest.mark.parametrize("shell", [corners(2), corners(3)])
def test_a_shell_needs_three_points_and_a_spacing(shell, registry):
    models = [measure(registry, points=[], shell=shell)]
    assert len(breaches(BY_CODE["SUR012"], models)) == 1


def test_a_road_without_photos_needs_no_camera(registry):
    assert breaches(BY_CODE["SUR010"], [task(registry, "RoadTask"), probe(registry)]) == []


def test_a_device_that_only_looks_must_be_carried_too(registry):
    models = [task(registry, "ObserveTask", deviceId="telescope"), probe(registry)]
    assert "no robot type has it" in breaches(BY_CODE["SUR010"], models)[0]


def test_a_device_that_the_team_lacks_is_told_once(registry):
    made = beside_a_tower(registry, measure(registry, deviceId="prob"))
    assert breaches(BY_CODE["SUR010"], made) == []
    assert len([each for core in CORE if core.code == "MML064" for each in breaches(core, made)]) == 1


def test_a_slip_of_the_unit_is_told_with_its_number(registry):
    found = breaches(BY_CODE["SUR019"], [field(grid(registry, gridResolution=0.1))])
    assert found == ["task 'field' takes about 1,000,000 photos"]


@pytest.mark.parametrize(
    ("features", "photos"),
    [
        ({"footprintWidth": 0.5, "footprintLength": 0.4, "frontOverlap": 0.0, "sideOverlap": 0.0}, "50,000"),
        ({"footprintWidth": 1.0, "footprintLength": 1.0, "frontOverlap": 0.5, "sideOverlap": 0.5}, "40,000"),
        ({"groundResolution": 1e-4, "frontOverlap": 0.0, "sideOverlap": 0.0}, "83,333"),
    ],
)
def test_photos_are_counted_by_what_one_covers_less_the_overlaps(features, photos, registry):
    models = [field(grid(registry, **features)), camera(registry)]
    assert breaches(BY_CODE["SUR018"], models) == [f"task 'field' takes about {photos} photos"]


def test_samples_are_counted_by_area_and_by_length(registry):
    area = field(measure(registry, points=[], spacing=0.5))
    line = mml.Mission(
        name="m", origin=mml.RelativeCoordinate(x=0.0, y=0.0), tasks=[measure(registry, points=corners(5))]
    )
    line.tasks[0].spacing = 0.0001
    assert breaches(BY_CODE["SUR018"], [area]) == ["task 'probe' takes about 40,000 samples"]
    assert breaches(BY_CODE["SUR018"], [line]) == ["task 'probe' takes about 40,000 samples"]


def test_photos_of_a_road_are_counted_on_every_pass(registry):
    road = task(registry, "RoadTask", photoDistance=0.001, width=20.0, footprintWidth=4.0, points=corners(6))
    made = mml.Mission(name="m", origin=mml.RelativeCoordinate(x=0.0, y=0.0), tasks=[road])
    assert breaches(BY_CODE["SUR018"], [made]) == ["task 'it' takes about 25,000 photos"]


@pytest.mark.parametrize(
    ("code", "made", "words"),
    [
        (
            "SUR021",
            lambda r: measure(r, points=line((0, 0), (50, 0), (99, 0))),
            "point 2 is inside .* 'tower'; every robot that can do it must keep 1.00 m",
        ),
        (
            "SUR021",
            lambda r: measure(r, points=line((48, 0), (52, 0)), spacing=1.0),
            "every part of its line is too near to .* 'tower' for every robot",
        ),
        (
            "SUR021",
            lambda r: measure(r, points=[], spacing=1.0, shell=line((48, 0), (52, 0), (52, 2))),
            "all of its area is too near to what every robot must keep away from",
        ),
        (
            "SUR022",
            lambda r: measure(r, points=line((0, 0), (99, 0)), spacing=5.0),
            "12.0 of the 99.0 m of its line are too near to .* 'tower' for every robot, from 44.0 m along it",
        ),
        (
            "SUR022",
            lambda r: measure(r, points=[], spacing=1.0, shell=line((40, 0), (60, 0), (60, 4), (40, 4))),
            "about 48 m² of its area, at .*, are too near to .* 'tower' for every robot",
        ),
        (
            "SUR023",
            lambda r: road(r, -10),
            "12.0 of the 99.0 m of pass 2 are too near to .* 'tower' for every robot, from 43.0 m along it",
        ),
    ],
)
def test_where_no_robot_can_be_is_told_as_planning_tells_it(code, made, words, registry):
    (message,) = breaches(BY_CODE[code], beside_a_tower(registry, made(registry)))
    assert re.search(words, message)


def test_a_road_of_one_pass_is_judged_as_the_line_that_it_is(registry):
    assert breaches(BY_CODE["SUR023"], beside_a_tower(registry, road(registry, 0, width=10.0))) == []


@pytest.mark.parametrize(
    ("made", "words"),
    [
        (lambda r: relaying(r, after=True), "task 'ridge' is a relay, it cannot have dependencies"),
        (lambda r: relaying(r, robotsWanted=2), "task 'ridge' is a relay, but wants several robots"),
        (lambda r: relaying(r, earliestStart=5.0), "task 'ridge' is a relay, but has an earliest start"),
    ],
)
def test_a_relay_is_bound_by_nothing_but_what_others_need(made, words, registry):
    (message,) = breaches(BY_CODE["SUR024"], made(registry))
    assert message == words
