import pytest
from mmrs_multicopter import plugin
from mmrs_multicopter.constraints import CONSTRAINTS
from mmrs_multicopter.names import DRONE, DRONE_SIZE, GO_TO, LAND, MULTICOPTER, TAKE_OFF

from mmrs_core.languages import behaviour as bl
from mmrs_core.languages import context as ctx
from mmrs_core.languages import mission as mml
from mmrs_core.testing.conformance import Case, ConstraintConformance
from mmrs_core.testing.models import breaches, sample_mission, sample_tasks, sample_visit

ROBOT_LANGUAGE = "urn:mmrs:robot:1.0"


def drone(registry, size=None, **features):
    measures = {"width": 0.5, "length": 0.5, "height": 0.2, "weight": 2.0}
    propellers = {"propellers": 4, "propellerSize": 254.0, **(size or {})}
    whole = registry.create(*DRONE_SIZE, **measures, **propellers)
    return registry.create(*DRONE, **{"name": "Quad", "maxAltitude": 100.0, "size": whole, **features})


def fast(registry, speed):
    whole = registry.create(ROBOT_LANGUAGE, "Interval", min=0.0, max=speed)
    return drone(
        registry, movementCapabilities=[registry.create(ROBOT_LANGUAGE, "MovementCapability", speed=whole)]
    )


def plain(registry):
    return registry.create(ROBOT_LANGUAGE, "Robot", name="Quad")


def plainly_sized(registry):
    return registry.create(*DRONE, name="Quad", size=registry.create(ROBOT_LANGUAGE, "Size", width=0.5))


def mission(registry, altitude=0.0, home_up=0.0, transit=None):
    visit = sample_visit(registry, 1.0, 1.0, altitude)
    made = sample_mission(visit, robot_type="Quad", home=(0.0, 0.0, home_up))
    made.transitAltitude = transit
    return made


def weather(wind):
    return ctx.Context(name="valley", environment=ctx.Environment(windSpeed=wind))


def flying(registry, metaclass, **features):
    move = registry.create(*metaclass, name="m", **features)
    return bl.Behaviour(robots=[bl.Robot(id="a", typeName="Quad", moves=[move])])


CASES = {
    "MUL001": Case(lambda r: [drone(r, maxAltitude=0.0)], lambda r: [drone(r, maxAltitude=1.0)]),
    "MUL002": Case(lambda r: [drone(r, launchType="HTOL")], lambda r: [drone(r, launchType="VTOL")]),
    "MUL003": Case(lambda r: [plainly_sized(r)], lambda r: [drone(r)]),
    "MUL004": Case(lambda r: [drone(r, {"propellers": 2})], lambda r: [drone(r, {"propellers": 3})]),
    "MUL005": Case(
        lambda r: [drone(r, {"propellerSize": 0.0})], lambda r: [drone(r, {"propellerSize": 0.1})]
    ),
    "MUL006": Case(
        lambda r: [drone(r, {"propellerSize": 10.0})], lambda r: [drone(r, {"propellerSize": 127.0})]
    ),
    "MUL007": Case(lambda r: [drone(r, positionHold=0.0)], lambda r: [drone(r)]),
    "MUL008": Case(
        lambda r: [drone(r, positionHold=8.0), mission(r), weather(8.5)],
        lambda r: [drone(r, positionHold=8.0), mission(r), weather(8.0)],
    ),
    "MUL009": Case(
        lambda r: [drone(r), mission(r, altitude=121.0, home_up=20.0)],
        lambda r: [drone(r), mission(r, altitude=120.0, home_up=20.0)],
    ),
    "MUL010": Case(
        lambda r: [flying(r, TAKE_OFF, altitude=0.0)], lambda r: [flying(r, TAKE_OFF, altitude=2.0)]
    ),
    "MUL011": Case(
        lambda r: [drone(r), flying(r, TAKE_OFF, altitude=101.0)],
        lambda r: [drone(r), flying(r, TAKE_OFF, altitude=100.0)],
    ),
    "MUL012": Case(
        lambda r: [plain(r), flying(r, TAKE_OFF, altitude=9.0)],
        lambda r: [drone(r), flying(r, TAKE_OFF, altitude=9.0)],
    ),
    "MUL013": Case(lambda r: [plain(r), flying(r, LAND)], lambda r: [drone(r), flying(r, LAND)]),
    "MUL014": Case(lambda r: [plain(r), flying(r, GO_TO)], lambda r: [drone(r), flying(r, GO_TO)]),
    "MUL015": Case(
        lambda r: [drone(r), mission(r, altitude=20.9, home_up=20.0)],
        lambda r: [drone(r), mission(r, altitude=21.0, home_up=20.0)],
    ),
    "MUL016": Case(
        lambda r: [drone(r), mission(r, altitude=50.0, home_up=20.0, transit=121.0)],
        lambda r: [drone(r), mission(r, altitude=50.0, home_up=20.0, transit=120.0)],
    ),
    "MUL017": Case(lambda r: [fast(r, 43.0)], lambda r: [fast(r, 40.0)]),
}
BY_CODE = {constraint.code: constraint for constraint in CONSTRAINTS}


class TestConstraints(ConstraintConformance):
    plugin = plugin
    more_metamodels = (sample_tasks(),)
    cases = CASES


@pytest.mark.parametrize("metaclass", [DRONE, DRONE_SIZE, TAKE_OFF, LAND, GO_TO], ids=lambda name: name[1])
def test_elements_without_any_feature_set_break_no_constraint(metaclass, registry):
    empty = registry.create(*metaclass)
    assert [found for each in CONSTRAINTS for found in breaches(each, [empty])] == []


def test_a_team_with_a_robot_of_unknown_ceiling_breaks_no_height(registry):
    models = [plain(registry), mission(registry, altitude=500.0)]
    assert breaches(BY_CODE["MUL009"], models) == []


def test_a_task_at_depth_is_too_low_for_drones(registry):
    made = mission(registry)
    made.tasks[0].point = mml.GeoCoordinate(latitude=42.0, longitude=13.0, depth=3.0)
    made.origin = mml.GeoCoordinate(latitude=42.0, longitude=13.0, altitude=0.0)
    (found,) = breaches(BY_CODE["MUL015"], [drone(registry), made])
    assert found == "task 'visit' is at -3 m, the team's drones fly no lower than 1 m"


def test_a_team_with_a_robot_that_is_no_drone_breaks_no_floor(registry):
    assert breaches(BY_CODE["MUL015"], [plain(registry), mission(registry)]) == []


def test_every_code_belongs_to_this_plugin():
    assert all(code.startswith("MUL") for code in BY_CODE)
    assert MULTICOPTER == "urn:mmrs:multicopter:1.0"
