import re
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import pytest
from mmrs_auv.commands.modelled import sheets_in
from mmrs_auv.sheets import action_number, sheet_of

from auv_vessel.control.allocation import Allocation
from auv_vessel.sheet import from_json, to_json
from auv_vessel.wire.database import database_of
from mmrs_core.errors import UnsupportedError
from mmrs_core.grounding.scenes import robot_type_of
from mmrs_core.languages.reading import read_text
from mmrs_core.languages.registry import Registry
from mmrs_core.scene import Part, RobotType

EXAMPLES = Path(__file__).parents[3] / "examples"


@pytest.fixture(scope="module")
def types(project_types: list[object]) -> Mapping[str, RobotType]:
    found = [robot_type_of(each) for each in project_types]  # type: ignore[arg-type]
    return {each.name: each for each in found}


def test_vehicles_of_the_examples_have_a_bus(types: Mapping[str, RobotType]) -> None:
    for type in types.values():
        sheet = sheet_of(type, "Naiad", home=(2.0, 3.0, -0.5))
        assert database_of(sheet).messages
        assert from_json(to_json(sheet)) == sheet
        assert sheet.home == (3.0, 2.0, 0.5)
        surge, _sway, heave, _roll, _pitch, yaw = Allocation(sheet).served([True] * len(sheet.thrusters))
        assert surge
        assert heave
        assert yaw


def test_the_vehicle_in_the_readme_has_a_bus(registry: Registry) -> None:
    page = (Path(__file__).parents[1] / "README.md").read_text(encoding="utf-8")
    (model,) = re.findall(r"```xml\n(.*?)```", page, re.DOTALL)
    (diver,) = read_text(model.encode(), "README.md", registry).roots
    assert database_of(sheet_of(robot_type_of(diver), "Diver")).messages


def test_data_are_those_of_the_type(types: Mapping[str, RobotType]) -> None:
    sheet = sheet_of(types["Pool AUV"], "Naiad", density=997.0, surface=2.0, home=(0.0, 0.0, 1.0))
    assert (sheet.mass, sheet.weight_in_water, sheet.speed) == (19.0, -0.2, 0.8)
    assert sheet.battery == pytest.approx(10.0 * 3600.0 * 22.2)
    assert sheet.home[2] == 1.0
    assert sheet.thrusters[0].position == (0.18, 0.14, 0.0)
    assert sheet.thrusters[0].direction == pytest.approx((0.5**0.5, -(0.5**0.5), 0.0))
    assert sheet.max_depth == pytest.approx((600_000.0 - 101_325.0) / (997.0 * 9.80665))
    assert sheet.devices == ("front-camera", "bottom-camera", "ctd")
    assert sheet.extra["device2.seconds"] == 2.0


def test_actions_have_numbers(types: Mapping[str, RobotType]) -> None:
    pool = types["Pool AUV"]
    assert action_number(pool, "front-camera", "StartVideo") == 1
    assert action_number(pool, "front-camera", "Bake") is None
    assert action_number(pool, "oven", "Bake") is None


def test_all_that_is_missing_is_listed(types: Mapping[str, RobotType]) -> None:
    pool = types["Pool AUV"]
    bare = tuple(
        Part(each.metaclasses, {**each.attributes, "mounting": None, "maxThrust": None})
        for each in pool.part.attributes["thrusters"]  # type: ignore[union-attr]
    )
    size = pool.part.attributes["size"]
    assert isinstance(size, Part)
    light = Part(size.metaclasses, {**size.attributes, "weightInWater": None})
    poor = replace(
        pool,
        part=Part(pool.part.metaclasses, {**pool.part.attributes, "size": light, "thrusters": bare}),
        batteries=(),
    )
    with pytest.raises(UnsupportedError) as refused:
        sheet_of(poor, "Naiad")
    assert len(refused.value.elements) == 14
    for said in ("size: weightInWater", "batteries: none", "thruster 'T3': maxThrust"):
        assert said in refused.value.elements


def test_vehicles_of_missions_are_found() -> None:
    assert list(sheets_in(EXAMPLES / "pool")) == ["Naiad"]
    with pytest.raises(UnsupportedError, match="no underwater vehicle"):
        sheets_in(EXAMPLES / "handwritten/behaviour.xmi")
