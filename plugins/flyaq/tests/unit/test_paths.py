"""Paths lead from an element to a feature inside it, and make what is missing on their way."""

import pytest
from mmrs_flyaq.rules.paths import Classes, path_from, reach

ROBOT = ("urn:mmrs:robot:1.0", "Robot")
LANGUAGES = {
    "robot": "urn:mmrs:robot:1.0",
    "mission": "urn:mmrs:mission:1.0",
    "behaviour": "urn:mmrs:behaviour:1.0",
    "multicopter": "urn:mmrs:multicopter:1.0",
}


@pytest.fixture
def classes(registry):
    return Classes(registry, LANGUAGES)


@pytest.fixture
def path(classes, registry):
    """Return a function that reads a path for elements of a class, by default robot types."""
    return lambda text, key=ROBOT, **more: path_from(registry.metaclass(*key), text, classes, **more)


@pytest.fixture
def robot(registry):
    return registry.create(*ROBOT, name="tug")


def test_a_plain_path_is_a_feature_of_the_element_itself(robot, path):
    owner, feature = reach(robot, path("name"))
    assert (owner, feature.name) == (robot, "name")


def test_a_path_with_a_number_makes_as_many_elements_as_it_needs(robot, path):
    owner, _ = reach(robot, path("movementCapabilities[1].speed.max"))
    assert owner is robot.movementCapabilities[1].speed
    assert robot.movementCapabilities[0].speed is None


def test_a_path_with_a_key_finds_its_element_again(robot, path):
    first, _ = reach(robot, path("devices[id=hull].properties[name=draught.metres].value"))
    second, _ = reach(robot, path("devices[id=hull].properties[name=draught.metres].value"))
    assert first is second
    assert (len(robot.devices), first.name) == (1, "draught.metres")


@pytest.mark.parametrize("step", ["home:GeoCoordinate", "home:mission:GeoCoordinate"])
def test_a_step_may_say_of_which_class_an_element_is(registry, path, step):
    key = ("urn:mmrs:mission:1.0", "Robot")
    owner, _ = reach(registry.create(*key), path(f"{step}.latitude", key))
    assert type(owner).__name__ == "GeoCoordinate"


def test_a_step_may_name_a_class_of_another_language(robot, path):
    reach(robot, path("size:multicopter:DroneSize.propellers"))
    assert type(robot.size).__name__ == "DroneSize"


def test_what_is_only_referred_to_is_handed_to_who_keeps_it(registry, path):
    key, kept = ("urn:mmrs:behaviour:1.0", "Robot"), []
    robot, where = registry.create(*key), path("home:GeoCoordinate.latitude", key, hoisted=True)
    owner, _ = reach(robot, where, kept.append)
    assert kept == [owner] == [robot.home]
    assert reach(robot, where, kept.append)[0] is owner
    assert len(kept) == 1


@pytest.mark.parametrize(
    "text", ["", "a..b", "size.", "size[x].width", "size[1", "[0].width", "size:.width", ":Size.width"]
)
def test_what_is_no_path_is_refused(path, text):
    with pytest.raises(ValueError, match="no path of features"):
        path(text)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("home.latitude", "Coordinate is abstract: state a concrete class"),
        ("home.latitude", r"\(GeoCoordinate, RelativeCoordinate\), as in home:GeoCoordinate"),
        ("home:Coordinate.latitude", "Coordinate is abstract"),
        ("home:Team.latitude", "Team is no Coordinate, which home takes"),
        ("home:boat:Geo.latitude", "'boat' is none of the languages"),
        ("home:GeoCoordinate.lat", "lat: no feature of GeoCoordinate"),
        ("home:GeoCoordinate", "home is the end, so nothing is made or chosen there"),
    ],
)
def test_a_class_that_a_path_cannot_make_is_refused(path, text, message):
    with pytest.raises(ValueError, match=message):
        path(text, ("urn:mmrs:mission:1.0", "Robot"))


def test_a_path_through_what_is_only_referred_to_needs_a_place_for_it(path):
    with pytest.raises(ValueError, match="home of Robot contains no elements"):
        path("home:GeoCoordinate.latitude", ("urn:mmrs:behaviour:1.0", "Robot"))
