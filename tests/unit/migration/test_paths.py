"""Paths lead from an element to a feature inside it, and make what is missing on their way."""

import pytest

from mmrs_core.migration.rules.paths import feature_at, reach

ROBOT = ("urn:mmrs:robot:1.0", "Robot")


@pytest.fixture
def robot(registry):
    return registry.create(*ROBOT, name="tug")


def test_a_plain_path_is_a_feature_of_the_element_itself(robot):
    owner, feature = reach(robot, "name")
    assert (owner, feature.name) == (robot, "name")


def test_a_path_with_a_number_makes_as_many_elements_as_it_needs(robot):
    owner, _ = reach(robot, "movementCapabilities[1].speed.max")
    assert owner is robot.movementCapabilities[1].speed
    assert robot.movementCapabilities[0].speed is None


def test_a_path_with_a_key_finds_its_element_again(robot):
    first, _ = reach(robot, "devices[id=hull].properties[name=draught.metres].value")
    second, _ = reach(robot, "devices[id=hull].properties[name=draught.metres].value")
    assert first is second
    assert (len(robot.devices), first.name) == (1, "draught.metres")


@pytest.mark.parametrize("path", ["", "a..b", "size.", "size[x].width", "size[1", "[0].width"])
def test_what_is_no_path_is_refused(registry, path):
    with pytest.raises(ValueError, match="no path of features"):
        feature_at(registry.metaclass(*ROBOT), path)
