"""A small scene with its plan."""

import pytest
from drawn_scene import plan_named, scene_named

from mmrs_core.scene import Plan, Scene


@pytest.fixture
def scene() -> Scene:
    return scene_named({})


@pytest.fixture
def plan() -> Plan:
    return plan_named({})
