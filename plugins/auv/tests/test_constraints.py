from __future__ import annotations

import pytest
from mmrs_auv import plugin
from mmrs_auv.constraints import CONSTRAINTS
from mmrs_auv.names import AUV_MOVEMENT, IN_WATER_SIZE, THRUSTER

from mmrs_core.languages import context as ctx
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
    moves = [movement(registry, *(thrusters or (thruster(registry),)))]
    whole = {"name": "Diver", "pressuremeter": True, "size": size(registry), "movementCapabilities": moves}
    return registry.create(ROBOT_LANGUAGE, "Robot", **{**whole, **features})


def mixed(registry):
    plain = registry.create(ROBOT_LANGUAGE, "MovementCapability")
    return vehicle(registry, movementCapabilities=[movement(registry, thruster(registry)), plain])


def plainly_sized(registry):
    return vehicle(registry, size=registry.create(ROBOT_LANGUAGE, "Size", width=0.5))


def mission(registry, depth):
    visit = sample_visit(registry, 1.0, 1.0, -3.0 - depth)
    return sample_mission(visit, robot_type="Diver", home=(0.0, 0.0, -3.0))


def lake():
    return ctx.Context(name="lake", surfaceHeight=-3.0, environment=ctx.Environment(waterDensity=1000.0))


CASES = {
    "AUV001": Case(
        lambda r: [vehicle(r, thruster(r, ("YAW", "HEAVE")))],
        lambda r: [vehicle(r, thruster(r, ("SWAY",)))],
    ),
    "AUV002": Case(lambda r: [vehicle(r, thruster(r, ("SURGE", "YAW")))], lambda r: [vehicle(r)]),
    "AUV003": Case(
        lambda r: [vehicle(r, thruster(r), thruster(r))],
        lambda r: [vehicle(r, thruster(r), thruster(r, id="T2"))],
    ),
    "AUV004": Case(
        lambda r: [vehicle(r), mission(r, 50.5), lake()],
        lambda r: [vehicle(r), mission(r, 50.0), lake()],
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
    assert "the team's vehicles bear 10.1 m" in breaches(BY_CODE["AUV004"], models)[0]
