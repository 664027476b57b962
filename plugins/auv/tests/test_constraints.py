from __future__ import annotations

import pytest
from mmrs_auv.constraints import CONSTRAINTS
from mmrs_auv.names import AUV_MOVEMENT, IN_WATER_SIZE, THRUSTER

from mmrs_core.languages import context as ctx
from mmrs_core.languages import mission as mml

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
    point = mml.RelativeCoordinate(x=1.0, y=1.0, z=-3.0 - depth)
    visit = registry.create("urn:test:visits:1.0", "Visit", name="wreck", point=point)
    home = mml.RelativeCoordinate(x=0.0, y=0.0, z=-3.0)
    team = mml.Team(robots=[mml.Robot(name="Otter", type="Diver", home=home)])
    return mml.Mission(name="m", team=team, tasks=[visit], origin=mml.RelativeCoordinate(x=0.0, y=0.0))


def lake():
    return ctx.Context(name="lake", surfaceHeight=-3.0, environment=ctx.Environment(waterDensity=1000.0))


CASES = {
    "AUV001": (
        lambda r: [vehicle(r, thruster(r, ("YAW", "HEAVE")))],
        lambda r: [vehicle(r, thruster(r, ("SWAY",)))],
    ),
    "AUV002": (lambda r: [vehicle(r, thruster(r, ("SURGE", "YAW")))], lambda r: [vehicle(r)]),
    "AUV003": (
        lambda r: [vehicle(r, thruster(r), thruster(r))],
        lambda r: [vehicle(r, thruster(r), thruster(r, id="T2"))],
    ),
    "AUV004": (
        lambda r: [vehicle(r), mission(r, 50.5), lake()],
        lambda r: [vehicle(r), mission(r, 50.0), lake()],
    ),
    "AUV005": (
        lambda r: [vehicle(r, thruster(r, maxThrust=19.0))],
        lambda r: [vehicle(r, thruster(r, maxThrust=20.0))],
    ),
    "AUV006": (
        lambda r: [vehicle(r, thruster(r, operatingPower=90.0, maxPower=80.0))],
        lambda r: [vehicle(r, thruster(r, operatingPower=90.0, maxPower=90.0))],
    ),
    "AUV007": (lambda r: [plainly_sized(r)], lambda r: [vehicle(r)]),
    "AUV008": (
        lambda r: [vehicle(r, size=size(r, weightInWater=21.0))],
        lambda r: [vehicle(r, size=size(r, weightInWater=-21.0))],
    ),
    "AUV009": (
        lambda r: [vehicle(r, thruster(r, operatingPower=0.0))],
        lambda r: [vehicle(r, thruster(r, operatingPower=1.0))],
    ),
    "AUV010": (lambda r: [vehicle(r, pressuremeter=False)], lambda r: [vehicle(r)]),
    "AUV011": (lambda r: [mixed(r)], lambda r: [vehicle(r)]),
    "AUV012": (
        lambda r: [vehicle(r, thruster(r, (*ALL_ROUND, "YAW")))],
        lambda r: [vehicle(r, thruster(r, ALL_ROUND))],
    ),
    "AUV013": (
        lambda r: [vehicle(r, size=size(r, weightInWater=-3.0))],
        lambda r: [vehicle(r, size=size(r, weightInWater=-2.0))],
    ),
}
BY_CODE = {constraint.code: constraint for constraint in CONSTRAINTS}


def test_every_constraint_has_a_failing_and_a_passing_model():
    assert set(CASES) == set(BY_CODE)


@pytest.mark.parametrize("code", sorted(CASES))
def test_a_breach_is_found_and_starts_with_its_culprit(code, registry, breaches):
    found = breaches(BY_CODE[code], CASES[code][0](registry))
    assert len(found) == 1
    assert found[0][0].islower()
    assert not found[0].endswith(".")


@pytest.mark.parametrize("code", sorted(CASES))
def test_a_model_that_keeps_the_constraint_passes(code, registry, breaches):
    assert breaches(BY_CODE[code], CASES[code][1](registry)) == []


@pytest.mark.parametrize("metaclass", [AUV_MOVEMENT, IN_WATER_SIZE, THRUSTER], ids=lambda name: name[1])
def test_elements_without_any_feature_set_break_no_constraint(metaclass, registry, breaches):
    empty = registry.create(*metaclass)
    assert [found for each in CONSTRAINTS for found in breaches(each, [empty])] == []


def test_a_plain_robot_breaks_no_constraint_of_underwater_vehicles(registry, breaches):
    plain = registry.create(ROBOT_LANGUAGE, "Robot", name="Diver")
    models = [plain, mission(registry, 500.0), lake()]
    assert [found for each in CONSTRAINTS for found in breaches(each, models)] == []


def test_the_hull_counts_for_the_depth_of_tasks(registry, breaches):
    models = [vehicle(registry, maxOperatingPressure=200_000.0), mission(registry, 12.0), lake()]
    assert "the team's vehicles bear 10.1 m" in breaches(BY_CODE["AUV004"], models)[0]
