from dataclasses import replace

from mmrs_multicopter.testing import quad, robot_program, target_input

from mmrs_core.generation.safety import clearance_of, policies_of
from mmrs_core.scene import Policy
from mmrs_core.testing.programs import program


def test_clearance_is_half_the_diagonal_and_the_position_error():
    assert clearance_of(quad(), 1.0) == 1.5
    assert clearance_of(None, 1.0) == 1.0


def test_a_policy_of_the_type_counts_where_mission_and_robot_say_nothing():
    type = replace(quad(), policies=(Policy("PEER_LOST", "LAND", 7.0), Policy("LINK_LOST", "LAND")))
    robot = replace(robot_program("a", []), policies=(Policy("LINK_LOST", "HOLD", 1.0),))
    given = replace(target_input(program(robot), [type]), robot_kinds={})
    assert policies_of(robot, given) == (Policy("LINK_LOST", "HOLD", 1.0), Policy("PEER_LOST", "LAND", 7.0))
