from dataclasses import replace
from itertools import pairwise
from math import dist, inf

import pytest
from mmrs_multicopter.testing import LAND, go_to, robot_program, take_off, target_input
from shapely import LineString, Polygon

from mmrs_core import pipeline
from mmrs_core.behaviour.rally_points import rally_points_of
from mmrs_core.contributions.targets import TargetInput
from mmrs_core.generation.python.program import robot_view
from mmrs_core.generation.safety import clearance_of
from mmrs_core.plugins import load_plugins
from mmrs_core.resources import shipped
from mmrs_core.scene import Area, AreaUse, Policy
from mmrs_core.testing.programs import installed, move, program
from mmrs_mavlink.plugin.controllers import DRIVER
from mmrs_mavlink.plugin.escapes import escapes_of


def escapes(*moves) -> list[str]:
    robot = robot_program("alpha", moves)
    view = robot_view(robot, target_input(program(robot)), DRIVER)
    return [name for name, _ in dict(view.head)["escapes"]]


def test_there_is_a_way_out_from_above_home_already():
    assert escapes(take_off("up", 10.0), go_to("out", (0.0, 30.0, 10.0)), LAND) == ["up", "out"]


def test_there_is_one_from_every_start_at_home_but_from_no_other_place():
    charge, again = move("charge", "Recharge", duration=20.0), take_off("again", 5.0)
    assert escapes(take_off("up", 10.0), LAND, charge, again, replace(LAND, id="home")) == ["up", "again"]
    assert escapes(take_off("up", 10.0), LAND, again, replace(LAND, id="home")) == ["up"]


def test_the_way_out_is_level():
    robot = robot_program("alpha", [take_off("up", 10.0), LAND])
    ((_, (place,)),) = dict(robot_view(robot, target_input(program(robot)), DRIVER).head)["escapes"]
    assert place.positional[2] == 10.0


REFUGES = [(50.0, 0.0), (-30.0, 0.0)]


def ways(*positions, areas=(), points=REFUGES, error=1.0):
    """Return the way out of each of some places, all moves of one robot at home in the origin."""
    robot = robot_program("alpha", [go_to(f"p{n}", place) for n, place in enumerate(positions)])
    given = replace(target_input(replace(program(robot), position_error=error)), areas=areas)
    return {each.move: each.places for each in escapes_of(robot, given, points)}


def wall(low=-inf, high=inf, distance=0.0, north=(-5.0, 5.0)):
    ring = ((-20.0, north[0]), (-10.0, north[0]), (-10.0, north[1]), (-20.0, north[1]))
    return Area("wall", AreaUse.OBSTACLE, ring, low, high, distance)


def test_the_nearest_refuge_is_taken():
    assert ways((0.0, 0.0, 20.0)) == {"p0": ((-30.0, 0.0, 20.0),)}


def test_a_refuge_farther_off_is_taken_where_the_way_to_the_nearest_one_is_longer():
    high_wall = wall(north=(-80.0, 80.0))
    assert ways((0.0, 0.0, 20.0), areas=[high_wall]) == {"p0": ((50.0, 0.0, 20.0),)}


def test_the_way_leads_round_an_obstacle():
    (places,) = ways((0.0, 0.0, 20.0), areas=[wall()], points=REFUGES[1:]).values()
    assert places[-1] == (-30.0, 0.0, 20.0)
    assert len(places) > 1
    line = LineString([(0.0, 0.0), *(place[:2] for place in places)])
    assert line.distance(Polygon(wall().shell)) >= 1.5


def test_the_way_leads_over_what_the_robot_flies_over_anyway_and_ends_above_the_place():
    line = wall(high=22.0, north=(-500.0, 500.0))
    found = ways((0.0, 0.0, 20.0), (0.0, 60.0, 40.0), areas=[line], points=REFUGES[1:])
    assert [place[2] for place in found["p0"]] == [pytest.approx(23.5, abs=0.1)] * 2
    assert found["p0"][-1][:2] == (-30.0, 0.0)
    low = ways((0.0, 0.0, 20.0), areas=[line], points=REFUGES[1:])["p0"]
    assert {place[2] for place in low} == {20.0}
    assert max(abs(place[1]) for place in low) > 500.0


def test_nobody_comes_down_where_something_stands_below():
    shed = replace(wall(high=3.0), shell=((-31.0, -1.0), (-29.0, -1.0), (-29.0, 1.0), (-31.0, 1.0)))
    assert ways((0.0, 0.0, 20.0), areas=[shed]) == {"p0": ((50.0, 0.0, 20.0),)}


@pytest.mark.parametrize(("north", "safe"), [(7.4, False), (7.6, True)])
def test_a_way_keeps_clearance_and_safety_distance(north, safe):
    long = wall(distance=1.0)
    found = ways((0.0, north, 20.0), areas=[long], points=[(-30.0, north)])
    assert (found["p0"] == ((-30.0, north, 20.0),)) is safe


def carbon_dioxide() -> TargetInput:
    """Return the example mission, planned."""
    contributions = load_plugins().contributions
    models, _ = pipeline.valid_models(shipped("examples") / "carbon-dioxide", contributions)
    scene = pipeline.expand(pipeline.ground(models), contributions)
    behaviour, _ = pipeline.transform(scene, pipeline.plan(scene), contributions)
    place = pipeline.place_of_scene(scene)
    planned = pipeline.program_of(behaviour, contributions)
    return TargetInput(
        planned, place.types, installed().robot_kinds, installed().move_kinds, place.areas or ()
    )


def test_ways_out_of_the_carbon_dioxide_mission_are_short_and_clear():
    given = carbon_dioxide()
    areas = [area for area in given.areas if area.use is not AreaUse.EMERGENCY]
    for robot in given.program.robots:
        points = rally_points_of(robot, given.program, given.types, given.areas).points
        found = escapes_of(robot, given, points)
        assert len(found) > 0.9 * sum(move.target is not None for move in robot.moves)
        own = clearance_of(given.types[robot.type_name], given.program.position_error)
        for way in found:
            legs = list(pairwise([way.begin, *way.places]))
            assert sum(dist(a, b) for a, b in legs) < 450.0
            for area in areas:
                kept = area.safety_distance + own
                beside = [(a, b) for a, b in legs if min(a[2], b[2]) < area.high + kept]
                beside = [(a, b) for a, b in beside if max(a[2], b[2]) > area.low - kept]
                shape = Polygon(area.shell)
                assert all(LineString([a[:2], b[:2]]).distance(shape) >= kept for a, b in beside), area.name


def alone(*moves, response: str = "EMERGENCY_AREA") -> dict:
    robot = replace(robot_program("alpha", moves), policies=(Policy("LINK_LOST", response),))
    return dict(robot_view(robot, target_input(program(robot)), DRIVER).head)


BEHIND_THE_SCHOOL = (160.0, 20.0, 10.0)
"""A place from which the straight line to the meadow leads through the school."""


def test_a_vehicle_may_fly_straight_where_no_area_is_in_between():
    assert alone(take_off("up", 10.0), go_to("out", (0.0, 30.0, 10.0)), LAND).get("straight", True)


def test_a_vehicle_must_not_fly_straight_where_an_area_is_in_between():
    aside, behind = go_to("aside", (90.0, -60.0, 10.0)), go_to("behind", BEHIND_THE_SCHOOL)
    assert alone(take_off("up", 10.0), aside, behind, LAND)["straight"] is False


def test_the_middle_of_a_leg_counts_as_well_as_its_ends():
    under, over = go_to("under", (160.0, -60.0, 10.0)), go_to("over", (160.0, 100.0, 10.0))
    north = go_to("north", (60.0, 160.0, 10.0))
    moves = (take_off("up", 10.0), go_to("aside", (90.0, -60.0, 10.0)), under, over, north, LAND)
    assert alone(*moves)["straight"] is False


def test_lines_are_looked_at_only_where_a_policy_wants_them():
    aside, behind = go_to("aside", (90.0, -60.0, 10.0)), go_to("behind", BEHIND_THE_SCHOOL)
    assert "straight" not in alone(take_off("up", 10.0), aside, behind, LAND, response="RETURN")
