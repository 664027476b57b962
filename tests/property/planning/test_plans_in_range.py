"""Plans stay in range of the radio: around obstacles, among relays, with position errors."""

from dataclasses import replace
from math import inf

import pytest
from plain_scenes import DRONE, box, road, robot, scene

from mmrs_core.analysis.checks import CHECKS
from mmrs_core.analysis.verdicts import verify
from mmrs_core.behaviour.reading import program_of
from mmrs_core.contributions.checks import CheckInput, Status
from mmrs_core.errors import InfeasibleError
from mmrs_core.languages.registry import core_registry
from mmrs_core.planning.planner import plan
from mmrs_core.scene import Part
from mmrs_core.scene.relays import RELAY
from mmrs_core.transformation.engine import transform
from mmrs_core.transformation.kinds import MOVE_KINDS, PLAIN_ROBOT, ROBOT

LEVEL = replace(DRONE, floor=0.0, ceiling=0.0, launches=False, endurance=inf, energy=inf)


def relay(name, at, range):
    return Part((RELAY,), {"name": name, "position": at, "range": range})


def range_of(*places, areas=(), relays=(), reach=100.0, kinematics=LEVEL):
    """Return what the check of the range finds in the plan of one robot that visits places in order."""
    one = robot(home=(0.0, 0.0, 0.0), kinematics=kinematics, returns=False)
    part = replace(one.type.part, attributes={"communicationRange": reach})
    one = replace(one, type=replace(one.type, metaclasses=(ROBOT,), half_diagonal=1.0, part=part))
    works = {f"t{i}": road(at, (at[0] + 0.1, at[1], at[2])) for i, at in enumerate(places)}
    order = [(f"t{i}", f"t{i + 1}") for i in range(len(places) - 1)]
    whole = replace(scene([one], works, after=order, areas=areas), elements=tuple(relays))
    kind = replace(PLAIN_ROBOT, name="kind", kinematics=lambda robot, scene: kinematics)
    behaviour, _ = transform(
        whole, plan(whole), rules={}, robot_kinds={ROBOT: kind}, registry=core_registry()
    )
    found = CheckInput(
        program=program_of(behaviour, registry=core_registry()),
        types={one.type.name: one.type},
        robot_kinds={ROBOT: kind},
        move_kinds={each.metaclass: each for each in MOVE_KINDS},
        areas=whole.areas,
        elements=whole.elements,
    )
    (check,) = [each for each in CHECKS if each.name == "range"]
    (verdict,) = verify(found, [check])
    return verdict


def test_a_detour_leads_around_on_the_side_that_is_in_range():
    wall = box("wall", 45.0, 10.0, 55.0, 80.0)
    verdict = range_of((20.0, 75.0, 0.0), (60.0, 75.0, 0.0), areas=[wall])
    assert verdict.status is Status.SAFE, verdict.message


def test_a_robot_goes_from_range_to_range_where_both_overlap():
    verdict = range_of((0.0, 95.0, 0.0), (90.0, 95.0, 0.0), relays=[relay("hill", (90.0, 0.0, 0.0), 100.0)])
    assert verdict.status is Status.SAFE, verdict.message
    assert verdict.margin < 6.0


def test_a_robot_that_climbs_for_an_obstacle_does_not_leave_its_range():
    """Over the wall it would be 101 m from home: it goes around."""
    flying = replace(LEVEL, floor=1.0, ceiling=inf)
    wall = box("wall", 10.0, -30.0, 12.0, 30.0, high=97.0)
    assert range_of((60.0, 0.0, 2.0), areas=[wall], kinematics=flying).status is Status.SAFE
    closed = [box("wall", 10.0, -99.0, 12.0, 99.0, high=97.0)]
    with pytest.raises(InfeasibleError, match=r"keeps clear of 'wall' and stays in range of its radio"):
        range_of((60.0, 0.0, 2.0), areas=closed, kinematics=flying)
