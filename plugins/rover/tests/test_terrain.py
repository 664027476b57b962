import pytest
from mmrs_rover.terrain import barrier

from mmrs_core.scene import AreaUse, Part

PAIRS = [("slope", "maxSlope"), ("waterDepth", "wadingDepth"), ("stepHeight", "groundClearance")]


@pytest.mark.parametrize(("feature", "limit"), PAIRS)
def test_terrain_bars_a_rover_only_above_its_limit(feature, limit, rover, ditch):
    able = rover(**{limit: 0.5}).type
    assert barrier(able, ditch(**{feature: 0.5})) is None
    assert barrier(able, ditch(**{feature: 0.51})) is not None


@pytest.mark.parametrize(("feature", "limit"), PAIRS)
def test_a_limit_that_is_not_stated_is_zero(feature, limit, rover, ditch):
    assert barrier(rover().type, ditch(**{feature: 0.01})) is not None
    assert barrier(rover().type, ditch(**{feature: 0.0})) is None


def test_the_barrier_is_the_terrain_at_every_height(rover, ditch):
    found = barrier(rover().type, ditch(waterDepth=1.0, safetyDistance=2.0))
    assert (found.name, found.use, found.safety_distance) == ("ditch", AreaUse.OBSTACLE, 2.0)
    assert (found.low, found.high) == (float("-inf"), float("inf"))
    assert found.shell == ((0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0))


def test_other_elements_bar_nobody(rover):
    assert barrier(rover().type, Part((("urn:test:1.0", "Pond"),), {"waterDepth": 9.0})) is None
