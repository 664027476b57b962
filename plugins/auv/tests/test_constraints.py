import pytest
from mmrs_auv import plugin
from mmrs_auv.constraints import CONSTRAINTS
from mmrs_auv.names import AUV_MOVEMENT, AUV_TASKS, IN_WATER_SIZE, MOUNTING, THRUSTER, VEHICLE

from mmrs_core.languages import context as ctx
from mmrs_core.languages import mission as mml
from mmrs_core.testing.conformance import Case, ConstraintConformance
from mmrs_core.testing.models import breaches, sample_mission, sample_tasks, sample_visit

ROBOT_LANGUAGE = "urn:mmrs:robot:1.0"
ALL_ROUND = ("SURGE", "YAW", "HEAVE")


def thruster(registry, degrees=ALL_ROUND, **features):
    figures = {"id": "T1", "maxDepth": 50.0, "operatingThrust": 20.0, **features}
    return registry.create(*THRUSTER, freedomDegree=list(degrees), **figures)


def movement(registry, *thrusters):
    speed = registry.create(ROBOT_LANGUAGE, "Interval", min=0.0, max=1.0)
    return registry.create(*AUV_MOVEMENT, thrusters=list(thrusters), speed=speed)


def size(registry, **features):
    measures = {"width": 0.5, "length": 0.5, "height": 0.5, "weight": 20.0, "weightInWater": 0.1, **features}
    return registry.create(*IN_WATER_SIZE, **measures)


def vehicle(registry, *thrusters, **features):
    held = list(thrusters or (thruster(registry),))
    moves = [movement(registry, *held)]
    whole = {"name": "Diver", "pressuremeter": True, "size": size(registry), "movementCapabilities": moves}
    return registry.create(*VEHICLE, **{**whole, "thrusters": held, **features})


def mixed(registry):
    plain = registry.create(ROBOT_LANGUAGE, "MovementCapability")
    held = thruster(registry)
    return vehicle(registry, held, movementCapabilities=[movement(registry, held), plain])


def sharing(registry):
    """Return two vehicles; the second moves by the thruster of the first."""
    lender = vehicle(registry)
    return [lender, vehicle(registry, movementCapabilities=[movement(registry, *lender.thrusters)])]


def with_a_spare(registry):
    used = thruster(registry)
    return vehicle(
        registry, used, thruster(registry, id="T2"), movementCapabilities=[movement(registry, used)]
    )


def plainly_sized(registry):
    return vehicle(registry, size=registry.create(ROBOT_LANGUAGE, "Size", width=0.5))


def mission(registry, depth):
    visit = sample_visit(registry, 1.0, 1.0, -3.0 - depth)
    return sample_mission(visit, robot_type="Diver", home=(0.0, 0.0, -3.0))


def lake():
    return ctx.Context(name="lake", surfaceHeight=-3.0, environment=ctx.Environment(waterDensity=1000.0))


def mounted(registry, degrees, place=(0.0, 0.0, 0.0), push=(1.0, 0.0, 0.0), **features):
    names = ("forward", "starboard", "down", "pushForward", "pushStarboard", "pushDown")
    mounting = registry.create(*MOUNTING, **dict(zip(names, (*place, *push), strict=True)))
    return thruster(registry, degrees, mounting=mounting, **features)


def twins(registry, other=(-0.2, 0.1, 0.0), push=(1.0, 0.0, 0.0)):
    port = mounted(registry, ("SURGE", "YAW"), (-0.2, -0.1, 0.0))
    starboard = mounted(registry, ("SURGE", "YAW"), other, push, id="T2")
    return vehicle(registry, port, starboard)


def at(east, north, up=0.0):
    return mml.RelativeCoordinate(x=east, y=north, z=up)


SHELL = ((0.0, 0.0), (50.0, 0.0), (50.0, 50.0))


def survey(registry, **features):
    whole = {"initialPosition": at(0.0, 0.0), "shell": [at(*each) for each in SHELL], "depth": 5.0}
    return asked(registry, "DepthHoldSurveyTask", **{**whole, "swath": 4.0, **features})


def yo_yo(registry, **features):
    whole = {"initialPosition": at(0.0, 0.0), "points": [at(0.0, 0.0), at(90.0, 0.0)], "minDepth": 2.0}
    return asked(registry, "YoYoTask", **{**whole, "maxDepth": 8.0, **features})


def asked(registry, metaclass, **features):
    return sample_mission(registry.create(AUV_TASKS, metaclass, name="it", **features), robot_type="Diver")


def device(registry, id, **properties):
    made = [
        registry.create(ROBOT_LANGUAGE, "Property", name=key.replace("_", "."), value=said)
        for key, said in properties.items()
    ]
    return registry.create(ROBOT_LANGUAGE, "Device", id=id, properties=made)


def sonar(registry, **properties):
    return vehicle(registry, devices=[device(registry, "sonar", **properties)])


def logs(registry, *mosts):
    made = [
        device(registry, f"log{number}", sensor_kind="dvl", dvl_range_max=most)
        for number, most in enumerate(mosts)
    ]
    return vehicle(registry, devices=made)


def pipelines(registry, *names):
    points = [(at(0.0, 0.0), at(50.0, 0.0)) for _ in names]
    made = [
        registry.create(AUV_TASKS, "Pipeline", name=name, points=list(ends))
        for name, ends in zip(names, points, strict=True)
    ]
    return [ctx.Context(name="lake", elements=made)]


def followed(registry, north):
    """Return a task along a pipeline of 50 m, and a block of 2 m beside it."""
    place = ctx.Context(
        name="lake",
        elements=list(pipelines(registry, "outfall")[0].elements),
        obstacles=[
            ctx.Obstacle(
                name="block",
                safetyDistance=1.0,
                shell=[at(e, north + n) for e, n in ((20, 0), (22, 0), (22, 2), (20, 2))],
            )
        ],
    )
    task = asked(registry, "FollowPipelineTask", pipeline=place.elements[0])
    return [vehicle(registry), task, place]


def fix(registry):
    return asked(registry, "SurfaceTask", point=at(5.0, 5.0, -2.0))


CASES = {
    "AUV001": Case(
        lambda r: [vehicle(r, thruster(r, ("YAW", "HEAVE")))], lambda r: [vehicle(r, thruster(r, ("SWAY",)))]
    ),
    "AUV032": Case(sharing, lambda r: [vehicle(r)]),
    "AUV033": Case(lambda r: [with_a_spare(r)], lambda r: [vehicle(r)]),
    "AUV002": Case(lambda r: [vehicle(r, thruster(r, ("SURGE", "YAW")))], lambda r: [vehicle(r)]),
    "AUV003": Case(
        lambda r: [vehicle(r, thruster(r), thruster(r))],
        lambda r: [vehicle(r, thruster(r), thruster(r, id="T2"))],
    ),
    "AUV004": Case(
        lambda r: [vehicle(r), mission(r, 50.5), lake()], lambda r: [vehicle(r), mission(r, 50.0), lake()]
    ),
    "AUV005": Case(
        lambda r: [vehicle(r, thruster(r, maxThrust=19.0))],
        lambda r: [vehicle(r, thruster(r, maxThrust=20.0))],
    ),
    "AUV006": Case(
        lambda r: [vehicle(r, thruster(r, operatingPower=90.0, maxPower=80.0))],
        lambda r: [vehicle(r, thruster(r, operatingPower=90.0, maxPower=90.0))],
    ),
    "AUV007": Case(lambda r: [plainly_sized(r)], lambda r: [vehicle(r)]),
    "AUV008": Case(
        lambda r: [vehicle(r, size=size(r, weightInWater=21.0))],
        lambda r: [vehicle(r, size=size(r, weightInWater=-21.0))],
    ),
    "AUV009": Case(
        lambda r: [vehicle(r, thruster(r, operatingPower=0.0))],
        lambda r: [vehicle(r, thruster(r, operatingPower=1.0))],
    ),
    "AUV010": Case(lambda r: [vehicle(r, pressuremeter=False)], lambda r: [vehicle(r)]),
    "AUV011": Case(lambda r: [mixed(r)], lambda r: [vehicle(r)]),
    "AUV012": Case(
        lambda r: [vehicle(r, thruster(r, (*ALL_ROUND, "YAW")))],
        lambda r: [vehicle(r, thruster(r, ALL_ROUND))],
    ),
    "AUV013": Case(
        lambda r: [vehicle(r, size=size(r, weightInWater=-3.0))],
        lambda r: [vehicle(r, size=size(r, weightInWater=-2.0))],
    ),
    "AUV014": Case(
        lambda r: [vehicle(r, mounted(r, ("SURGE",), push=(0.0, 0.0, 0.0)))],
        lambda r: [vehicle(r, mounted(r, ("SURGE",)))],
    ),
    "AUV015": Case(
        lambda r: [vehicle(r, mounted(r, ("SURGE", "HEAVE")))],
        lambda r: [vehicle(r, mounted(r, ("SURGE", "HEAVE"), push=(1.0, 0.0, 0.1)))],
    ),
    "AUV016": Case(lambda r: [vehicle(r, mounted(r, ("SURGE",), (0.0, 0.1, 0.0)))], lambda r: [twins(r)]),
    "AUV017": Case(
        lambda r: [vehicle(r, mounted(r, ("SURGE",)), thruster(r, id="T2"))],
        lambda r: [vehicle(r, mounted(r, ("SURGE",)), mounted(r, ("SURGE",), id="T2"))],
    ),
    "AUV018": Case(
        lambda r: [vehicle(r, mounted(r, ("SURGE",), (-200.0, 0.0, 0.0)))],
        lambda r: [vehicle(r, mounted(r, ("SURGE",), (-0.2, 0.0, 0.0)))],
    ),
    "AUV019": Case(
        lambda r: [vehicle(r, size=size(r, weightInWater=1.0, dropWeight=0.9))],
        lambda r: [vehicle(r, size=size(r, weightInWater=1.0, dropWeight=1.0))],
    ),
    "AUV020": Case(
        lambda r: [vehicle(r, size=size(r, dropWeight=20.1))],
        lambda r: [vehicle(r, size=size(r, dropWeight=20.0))],
    ),
    "AUV021": Case(
        lambda r: [sonar(r, sonar_aperture="120 deg")],
        lambda r: [sonar(r, sonar_aperture="120", sensor_kind="sonar")],
    ),
    "AUV034": Case(lambda r: [logs(r, "50", "80")], lambda r: [logs(r, "50", "50.0")]),
    "AUV022": Case(
        lambda r: [sonar(r, sonar_aperture="120"), survey(r, swath=None)],
        lambda r: [sonar(r, sonar_aperture="120"), survey(r, swath=None, bottomDepth=8.0)],
    ),
    "AUV023": Case(lambda r: [survey(r, overlap=20.0)], lambda r: [survey(r, overlap=0.2)]),
    "AUV024": Case(lambda r: [survey(r, bottomDepth=5.0)], lambda r: [survey(r, bottomDepth=5.1)]),
    "AUV025": Case(
        lambda r: [yo_yo(r, minDepth=8.0, maxDepth=2.0)], lambda r: [yo_yo(r, minDepth=2.0, maxDepth=8.0)]
    ),
    "AUV026": Case(lambda r: [yo_yo(r, pitch=90.0)], lambda r: [yo_yo(r, pitch=30.0)]),
    "AUV027": Case(lambda r: [survey(r, swath=0.0)], lambda r: [survey(r, swath=0.5)]),
    "AUV028": Case(lambda r: [survey(r, depth=-5.0)], lambda r: [survey(r, depth=0.0)]),
    "AUV029": Case(
        lambda r: [survey(r, stopAction="Stop")],
        lambda r: [survey(r, startAction="Start", stopAction="Stop")],
    ),
    "AUV030": Case(lambda r: pipelines(r, "outfall", ""), lambda r: pipelines(r, "outfall", "inlet")),
    "AUV031": Case(lambda r: [vehicle(r), fix(r)], lambda r: [vehicle(r, gps=True), fix(r)]),
    "AUV035": Case(lambda r: followed(r, 0.0), lambda r: followed(r, 5.0)),
}
BY_CODE = {constraint.code: constraint for constraint in CONSTRAINTS}


class TestConstraints(ConstraintConformance):
    plugin = plugin
    more_metamodels = (sample_tasks(),)
    cases = CASES


@pytest.mark.parametrize("metaclass", [AUV_MOVEMENT, IN_WATER_SIZE, THRUSTER], ids=lambda name: name[1])
def test_elements_without_any_feature_set_break_no_constraint(metaclass, registry):
    empty = registry.create(*metaclass)
    assert [found for each in CONSTRAINTS for found in breaches(each, [empty])] == []


def test_a_plain_robot_breaks_no_constraint_of_underwater_vehicles(registry):
    plain = registry.create(ROBOT_LANGUAGE, "Robot", name="Diver")
    models = [plain, mission(registry, 500.0), lake()]
    assert [found for each in CONSTRAINTS for found in breaches(each, models)] == []


def test_the_hull_counts_for_the_depth_of_tasks(registry):
    models = [vehicle(registry, maxOperatingPressure=200_000.0), mission(registry, 12.0), lake()]
    assert "the team is rated for 10.1 m" in breaches(BY_CODE["AUV004"], models)[0]


def found(code, *models):
    return breaches(BY_CODE[code], models)


def test_two_thrusters_side_by_side_neither_dive_nor_pitch_the_vehicle(registry):
    lift = [
        mounted(registry, ("HEAVE", "ROLL", "PITCH"), (0.0, y, 0.0), (0.0, 0.0, 1.0)) for y in (-0.1, 0.1)
    ]
    messages = found("AUV015", vehicle(registry, *lift))
    assert [message.split(" lists ")[1].split(",")[0] for message in messages] == ["PITCH", "PITCH"]
    assert found("AUV016", vehicle(registry, *lift)) == []


def test_a_thruster_above_the_centre_pitches_the_vehicle_as_it_pushes(registry):
    above = mounted(registry, ("SURGE", "PITCH"), (0.0, 0.0, -0.1))
    assert len(found("AUV016", vehicle(registry, above))) == 2


def test_where_the_mounting_of_one_thruster_is_not_known_nothing_is_said_of_all(registry):
    assert (
        found("AUV016", vehicle(registry, mounted(registry, ("SURGE",), (0.0, 0.1, 0.0)), thruster(registry)))
        == []
    )


@pytest.mark.parametrize("code", ["AUV014", "AUV015", "AUV016", "AUV017", "AUV018"])
def test_the_mountings_of_the_examples_are_sound(code, registry, project_types):
    assert found(code, *project_types) == []


def test_a_yo_yo_is_as_deep_as_its_lower_turning_points(registry):
    deep = yo_yo(registry, maxDepth=51.0)
    assert "is 51 m deep" in found("AUV004", vehicle(registry), deep)[0]
    assert found("AUV004", vehicle(registry), yo_yo(registry, maxDepth=50.0)) == []


def test_a_pipeline_is_as_deep_as_its_lowest_point_less_the_height_above_it(registry):
    pipe = registry.create(
        AUV_TASKS, "Pipeline", name="outfall", points=[at(0.0, 0.0, -5.0), at(9.0, 0.0, -52.0)]
    )
    place = ctx.Context(name="lake", elements=[pipe])
    for height, breached in ((1.9, 1), (2.0, 0)):
        follow = asked(registry, "FollowPipelineTask", pipeline=pipe, height=height)
        assert len(found("AUV004", vehicle(registry), follow, place)) == breached


def test_a_misspelt_property_of_a_sensor_is_told_with_the_nearest_name(registry):
    models = [sonar(registry, sonar_aparture="120"), sonar(registry, sensor_width="13.2", mavlink_camera="0")]
    (said,) = found("AUV021", *models)
    assert said == ("unknown property 'sonar.aparture' of device 'sonar'; did you mean sonar.aperture?")


def test_the_weight_in_water_is_told_once_where_nothing_can_be_dropped(registry):
    (told,) = found("AUV019", vehicle(registry, size=size(registry, weightInWater=0.4)))
    assert told.endswith("weightInWater is 0.4 kg: it does not surface on its own")
