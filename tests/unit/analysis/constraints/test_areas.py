"""Emergency areas have room for robots, beside what these keep from, too."""

from __future__ import annotations

import pytest


@pytest.mark.parametrize(("size", "faults"), [(11, 1), (12, 0)])
def test_an_emergency_area_beside_a_forbidden_one_has_room_for_a_robot(models, size, faults):
    models.put(models.context.emergencyAreas[0], shell=models.box(602, 520, size))
    told = [fault.message for fault in models.faults() if fault.code == "CTX015"]
    expected = "Area 'meadow': has no room for a robot that keeps from Area 'airfield'"
    assert told == [expected] * faults
