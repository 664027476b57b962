"""Which robots have rally points, and for what."""

from dataclasses import replace

from checking import kind, rover, square

from mmrs_core.generation.safety import rally_points_by_policy
from mmrs_core.scene import AreaUse, Policy
from mmrs_core.testing.small_programs import ROBOT_TYPE, go, program, robot

MEADOW = square("meadow", (500.0, 0.0), 20.0, use=AreaUse.EMERGENCY)


def test_robots_that_no_policy_leads_to_the_areas_drawn_for_them_have_rally_points_of_their_own():
    led = replace(
        robot("led", [go("m1", (9.0, 0.0, 0.0))]), policies=(Policy("BATTERY_LOW", "EMERGENCY_AREA"),)
    )
    given = program(led, robot("left", [go("m2", (9.0, 50.0, 0.0))]))
    types, kinds = {ROBOT_TYPE: rover()}, {kind().metaclass: kind()}
    asked, unasked = rally_points_by_policy(given, types, kinds, (MEADOW,))
    assert ([*asked], [*unasked]) == (["led"], ["left"])
    assert asked["led"] != unasked["left"]
    assert rally_points_by_policy(given, types, kinds, ())[1] == {}
    foreign = replace(MEADOW, types=frozenset({"other"}))
    assert rally_points_by_policy(given, types, kinds, (foreign,))[1] == {}
