"""Robots that respond to a fault keep from what is forbidden on their way."""

from math import inf

import pytest
import shapely

from mmrs_core.behaviour.program import Program, RobotProgram
from mmrs_core.contributions.vehicles import VehicleInput
from mmrs_core.scene import Area, AreaUse, Capability, Frame, Kinematics, Part, RobotType
from mmrs_core.scene.rally_points import rally_points
from mmrs_core.simulation.escape import Escapes

HOME = (0.0, 0.0, 0.0)
HERE = (100.0, 0.0, 20.0)
WALL = Area("wall", AreaUse.FORBIDDEN, ((40.0, -30.0), (60.0, -30.0), (60.0, 30.0), (40.0, 30.0)))
RING = Area("pit", AreaUse.FORBIDDEN, ((90.0, -9.0), (99.0, -9.0), (99.0, 9.0), (90.0, 9.0)))
PITCH = Area("pitch", AreaUse.EMERGENCY, ((120.0, 20.0), (140.0, 20.0), (140.0, 40.0), (120.0, 40.0)))
TINY = Area("tiny", AreaUse.EMERGENCY, ((101.0, 1.0), (102.0, 1.0), (102.0, 2.0), (101.0, 2.0)))


def escapes_among(*areas, floor=-inf, turning_radius=0.0):
    kind = RobotType("t", (), (), 2.0, None, (Capability(0, None, (0, 10)),), (), {}, Part((), {}))
    robot = RobotProgram("r", "t", "NORMAL", 0.0, HOME, (), (), {}, 0, 0)
    program = Program("p", Frame("EPSG:4326", None, None), (robot,))
    kinematics = Kinematics(
        cruise=5,
        slowest=0,
        fastest=10,
        climb=3,
        descent=3,
        floor=floor,
        launches=True,
        turning_radius=turning_radius,
    )
    return Escapes(VehicleInput(program, {}, {}, {}, areas, robot=robot, type=kind), kinematics, HOME)


def test_the_way_home_leads_around_a_forbidden_area_and_down():
    path = escapes_among(WALL).clear("RETURN", HERE)
    assert (path[0], path[-1]) == (HERE, HOME)
    way = shapely.LineString([point[:2] for point in path[:-1]])
    assert shapely.Polygon(WALL.shell).distance(way) >= 2.0 - 1e-9


def test_a_robot_above_home_comes_straight_down_however_low_it_is():
    low = (0.0, 0.0, 0.5)
    escapes = escapes_among(floor=1.0)
    assert escapes.clear("RETURN", low) == escapes.straight("RETURN", low) == (low, HOME)


def test_a_robot_that_cannot_get_home_comes_down_where_it_is():
    assert escapes_among(RING).clear("RETURN", HERE) == (HERE, (100.0, 0.0, 0.0))


def test_the_nearest_emergency_area_that_is_large_enough_is_taken():
    goal = escapes_among(PITCH, TINY).clear("EMERGENCY_AREA", HERE)[-1]
    inside = shapely.Polygon(PITCH.shell).boundary.distance(shapely.Point(goal[:2]))
    assert inside >= 2.0
    assert goal[2] == 0.0


def test_a_robot_that_turns_in_a_curve_goes_where_the_check_expects_it():
    goal = escapes_among(PITCH, turning_radius=9.0).clear("EMERGENCY_AREA", HERE)[-1]
    assert rally_points(0, [2.0], [PITCH], separation=None, heights=[20.0]).points == (goal[:2],)


def test_the_emergency_area_is_taken_that_is_reached_first_not_the_one_behind_a_wall():
    fence = Area("fence", AreaUse.FORBIDDEN, ((80.0, -90.0), (84.0, -90.0), (84.0, 90.0), (80.0, 90.0)))
    near = Area("near", AreaUse.EMERGENCY, ((50.0, -9.0), (70.0, -9.0), (70.0, 9.0), (50.0, 9.0)))
    far = Area("far", AreaUse.EMERGENCY, ((160.0, -9.0), (180.0, -9.0), (180.0, 9.0), (160.0, 9.0)))
    goal = escapes_among(fence, near, far).clear("EMERGENCY_AREA", HERE)[-1]
    assert shapely.Polygon(far.shell).contains(shapely.Point(goal[:2]))


@pytest.mark.parametrize("response", ["HOLD", "CONTINUE", "STOP_THRUST"])
def test_a_robot_that_holds_stays_where_it_is(response):
    assert escapes_among(WALL).clear(response, HERE) == (HERE,)


def test_without_an_emergency_area_the_robot_comes_down():
    assert escapes_among().clear("EMERGENCY_AREA", HERE) == (HERE, (100.0, 0.0, 0.0))
