"""Emergency areas have room for robots, beside what these keep from, too."""

import pytest


@pytest.mark.parametrize(("size", "faults"), [(11, 1), (12, 0)])
def test_an_emergency_area_beside_a_forbidden_one_has_room_for_a_robot(models, size, faults):
    models.put(models.context.emergencyAreas[0], shell=models.box(602, 520, size))
    told = [fault.message for fault in models.faults() if fault.code == "CTX015"]
    expected = "Area 'meadow': has no room for a robot that keeps from Area 'airfield'"
    assert told == [expected] * faults


@pytest.mark.parametrize("distance", [1e200, 1.7e308])
def test_a_distance_that_nothing_keeps_is_a_fault_and_overflows_nowhere(models, distance):
    for area in (*models.context.forbiddenAreas, *models.context.obstacles):
        models.put(area, safetyDistance=distance)
    models.put(models.mission, positionError=distance)
    models.put(models.quad.size, length=distance)
    assert "MML080" in {fault.code for fault in models.faults()}
