"""What is planned exactly at a limit is accepted by the checks, wherever the mission lies."""

from dataclasses import replace
from math import cos, inf, sin

from counts import many
from hypothesis import example, given, settings
from hypothesis import strategies as st
from plain_scenes import DRONE, box, road, robot, scene

from mmrs_core.analysis.checks import CHECKS
from mmrs_core.analysis.verdicts import refuses, verify
from mmrs_core.behaviour.reading import program_of
from mmrs_core.contributions.checks import CheckInput, Status
from mmrs_core.errors import InfeasibleError
from mmrs_core.languages.registry import core_registry
from mmrs_core.planning.planner import plan
from mmrs_core.planning.positions import refuse_blocked, refuse_heights
from mmrs_core.scene import Frame
from mmrs_core.transformation.engine import transform
from mmrs_core.transformation.kinds import MOVE_KINDS, PLAIN_ROBOT, ROBOT

FRAMES = {
    "local": Frame("EPSG:4326", None, None, altitude_reference="ORIGIN"),
    "above the sea": Frame("EPSG:4326", 42.37, 13.35, 700.0, "MSL"),
    "of many digits": Frame("EPSG:4326", -33.123456789123, 151.987654321987, 1234.56789123456, "ELLIPSOID"),
    "far north": Frame("EPSG:4326", 78.2, 15.6, 3.00005, "MSL"),
    "without altitude": Frame("EPSG:4326", 0.0, -179.99999, None, "ORIGIN"),
}
ORIGINS = st.sampled_from(list(FRAMES))
LENGTHS = st.floats(0.1, 9.0)
LIMITED = ("clearance", "altitude", "range", "separation")


def verdicts_of(whole, kinematics):
    """Return what the checks find in the behaviour that is planned for a scene."""
    kind = replace(PLAIN_ROBOT, name="kind", kinematics=lambda robot, scene: kinematics)
    behaviour, _ = transform(
        whole, plan(whole), rules={}, robot_kinds={ROBOT: kind}, registry=core_registry()
    )
    found = CheckInput(
        program=program_of(behaviour, registry=core_registry()),
        types={each.type.name: each.type for each in whole.robots},
        robot_kinds={ROBOT: kind},
        move_kinds={each.metaclass: each for each in MOVE_KINDS},
        areas=whole.areas,
    )
    return verify(found, [check for check in CHECKS if check.name in LIMITED])


@given(
    origin=ORIGINS,
    half=LENGTHS,
    error=LENGTHS,
    safety=LENGTHS,
    top=st.floats(1.0, 60.0),
    turn=st.floats(0.0, 6.3),
    far=st.floats(60.0, 3000.0),
    over=st.booleans(),
)
@example(origin="local", half=1.0, error=1.0, safety=1.0, top=1.0, turn=4.0, far=60.0, over=False)
def test_a_stroke_at_the_limit_is_planned_and_safe(origin, half, error, safety, top, turn, far, over):
    """It is as near as may be to an obstacle, to the ceiling, and to the end of the radio's reach."""
    keep = safety + half + error
    west, south = far * sin(turn), far * cos(turn)
    obstacle = box(
        "mast", west, south, west + 7.3, south + 5.1, low=0.0, high=top if over else inf, safety=safety
    )
    line = (west, west + 7.3) if over else (west - keep, west - keep)
    up = top + keep if over else top
    points = ((line[0], south, up), (line[1], south + 5.1, up))
    kinematics = replace(DRONE, floor=-inf, ceiling=up, launches=False, endurance=inf, energy=inf)
    home = (far * sin(turn + 2.0), far * cos(turn + 2.0), up)
    one = robot(home=home, kinematics=kinematics, clearance=half + error, returns=False)
    reach = max(sum((a - b) ** 2 for a, b in zip(home, each, strict=True)) ** 0.5 for each in points)
    part = replace(one.type.part, attributes={"communicationRange": reach + error})
    one = replace(one, type=replace(one.type, metaclasses=(ROBOT,), half_diagonal=half, part=part))
    whole = scene([one], {"a": road(*points)}, areas=[obstacle], position_error=error)
    whole = replace(whole, frame=FRAMES[origin])
    refuse_blocked(one, whole, points, "the road")
    refuse_heights(one, points)
    found = verdicts_of(whole, kinematics)
    assert not refuses(found), [each.message for each in refuses(found)]
    nearest = next(each for each in found if each.property == "clearance")
    assert nearest.status is Status.SAFE
    assert nearest.margin <= 1e-3


@settings(max_examples=many(2000, fast=12))
@given(
    origin=ORIGINS,
    least=st.floats(1.0, 9.0),
    error=LENGTHS,
    turn=st.floats(0.0, 6.3),
    up=st.floats(0.0, 60.0),
)
def test_robots_at_the_least_separation_are_safe_or_not_planned(origin, least, error, turn, up):
    """Two robots begin as near to each other as may be, and go side by side."""
    needed = least + 2.0 * error
    beside = (needed * sin(turn), needed * cos(turn))
    kinematics = replace(DRONE, floor=-inf, launches=False, endurance=inf, energy=inf)
    homes = ((0.0, 0.0, up), (*beside, up))
    team = [
        robot(name, home, kinematics=kinematics, returns=False)
        for name, home in zip("ab", homes, strict=True)
    ]
    team = [replace(each, type=replace(each.type, metaclasses=(ROBOT,))) for each in team]
    works = {
        each.name: {each.name: road(each.home, (each.home[0] + 30.0, each.home[1] + 1.0, up))}
        for each in team
    }
    whole = scene(team, works, minimum_separation=least, position_error=error)
    try:
        found = verdicts_of(replace(whole, frame=FRAMES[origin]), kinematics)
    except InfeasibleError:
        return
    assert not [each for each in found if each.status is Status.VIOLATED]
