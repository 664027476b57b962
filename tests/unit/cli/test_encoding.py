"""Every value between stages has a JSON form."""

import json
from enum import Enum
from math import inf, nan
from pathlib import Path

import pytest

from mmrs_core.cli.encoding import plain
from mmrs_core.languages import mission


class Colour(Enum):
    RED = "red"


def test_numbers_that_json_lacks_become_words():
    assert plain([inf, -inf, nan, 1.5]) == ["Infinity", "-Infinity", "NaN", 1.5]


def test_a_dataclass_tells_its_class(scene):
    encoded = plain(scene)
    assert encoded["$type"] == "Scene"
    assert encoded["areas"][0]["use"] == "obstacle"
    json.dumps(encoded, allow_nan=False)


def test_a_plan_tells_the_steps_apart(plan):
    steps = plain(plan)["robots"][0]["steps"]
    assert [step["$type"] for step in steps] == ["Launch", "Transit", "Serve", "Signal", "Transit", "Recover"]


def test_mappings_with_other_keys_become_lists(scene):
    works = plain(scene)["works"]
    assert works[0]["key"] == ["field", "Alba"]


def test_sets_enumerations_and_paths_have_a_form():
    assert plain({"a": {3, 1}, "b": Colour.RED, "c": Path("x/y")}) == {"a": [1, 3], "b": "red", "c": "x/y"}


def test_an_element_tells_its_metaclass_and_what_is_set():
    home = mission.RelativeCoordinate(x=1.0, y=2.0, z=0.0)
    encoded = plain(mission.Robot(name="Alba", home=home, type="quad"))
    assert encoded["$type"] == "urn:mmrs:mission:1.0#Robot"
    assert encoded["home"]["x"] == 1.0
    assert "payload" not in encoded


def test_a_reference_becomes_the_path_of_what_it_refers_to():
    first, last = mission.Fork(name="a"), mission.Join(name="b")
    dependency = mission.TaskDependency(from_=first, to=last)
    whole = mission.Mission(tasks=[first, last], taskDependencies=[dependency])
    assert plain(whole)["taskDependencies"][0]["to"] == "/tasks[1]"


def test_other_values_are_refused():
    with pytest.raises(TypeError, match="no such value"):
        plain(object())
