"""Robots of an expanded scene have the policies of their kind, and are left out of what they cannot do."""

from dataclasses import replace

from mmrs_core.scene import Capability, Frame, Part, Policy, Robot, RobotType, Scene, Stroke, Work
from mmrs_core.scene.relays import Relay
from mmrs_core.transformation.expand import expand, out_of_reach, unfit
from mmrs_core.transformation.kinds import PLAIN_ROBOT


def robot_with(**attributes):
    kind = RobotType("t", (), (), 0.5, None, (Capability(0, None, (0, 2)),), (), {}, Part((), attributes))
    return Robot("r", kind, (0.0, 0.0, 0.0), True, 0.0, "NORMAL", 0.5)


def scene_at(**environment):
    return Scene("s", Frame("EPSG:4326", None, None), (), (), (), environment=environment)


def work_at(*points):
    return Work((Stroke(points),), divisible=False, rule="rule")


def test_a_robot_does_not_operate_outside_of_its_temperatures():
    warm = robot_with(operatingTemperature=Part((), {"min": 0.0, "max": 40.0}))
    assert unfit(warm, scene_at(temperature=-5.0)) == "operates from 0 to 40 °C, not at -5 °C"
    assert unfit(warm, scene_at(temperature=0.0)) is None


def test_what_is_not_known_of_weather_or_robot_is_no_reason():
    assert unfit(robot_with(), scene_at(temperature=-5.0)) is None
    assert unfit(robot_with(operatingTemperature=Part((), {"min": 0.0, "max": 40.0})), scene_at()) is None


def test_a_work_beyond_the_radio_is_out_of_reach():
    near = robot_with(communicationRange=50.0)
    assert out_of_reach(work_at((30.0, 40.0, 0.0)), near) is None
    assert out_of_reach(work_at((30.0, 41.0, 0.0)), near) == "would be 51 m from home, its radio reaches 50 m"
    assert out_of_reach(work_at((3e4, 0.0, 0.0)), robot_with()) is None


def test_robots_of_an_expanded_scene_have_the_policies_of_their_kind_behind_those_of_mission_and_type():
    kind = replace(
        PLAIN_ROBOT, metaclass=("urn:t", "Cart"), policies={"LINK_LOST": "EMERGENCY_AREA", "OBSTACLE": "HOLD"}
    )
    robot = robot_with()
    robot = replace(robot, type=replace(robot.type, metaclasses=(kind.metaclass,)))
    whole = replace(scene_at(), robots=(robot,), policies=(Policy("OBSTACLE", "LAND"),))
    found = expand(whole, {}, {kind.metaclass: kind}, {})
    assert found.responses(found.robots[0]) == {"OBSTACLE": "LAND", "LINK_LOST": "EMERGENCY_AREA"}


def test_a_position_error_counts_for_the_radio_as_it_does_in_the_check():
    near = robot_with(communicationRange=50.0)
    work = work_at((30.0, 40.0, 0.0))
    assert out_of_reach(work, near, error=0.5) == "would be 51 m from home, its radio reaches 50 m"


def test_a_work_in_range_of_a_relay_with_a_chain_is_in_reach():
    near, far = robot_with(communicationRange=50.0), work_at((0.0, 40.0, 0.0), (0.0, 90.0, 0.0))
    mast = Relay("mast", (0.0, 45.0, 0.0), 50.0)
    assert out_of_reach(far, near, [mast]) is None
    severed = Relay("mast", (0.0, 51.0, 0.0), 60.0)
    assert out_of_reach(far, near, [severed]) == (
        "would be 90.00 m from home at (0.0, 90.0, 0.0), its radio reaches 50.00 m;"
        " no chain of relays leads home from relay 'mast':"
        " it is 51.00 m from home, they reach each other within 50.00 m"
    )
