"""Robots that go to an emergency area when something fails keep enough of their charges for that."""

import re
from dataclasses import replace

import pytest
from plain_scenes import CRAWLER, box, road, robot, scene, visit, with_kinematics
from plan_replay import complaints

from mmrs_core.errors import InfeasibleError
from mmrs_core.planning.effort import Effort
from mmrs_core.planning.planner import plan
from mmrs_core.scene import Area, AreaUse
from mmrs_runtime.policies import Policy

ESCAPES = (Policy("LINK_LOST", "EMERGENCY_AREA"),)
FOLDED = road(
    *((500.0 * (k % 2), 20.0 * (k // 2), 20.0) for k in range(12)), cuts=tuple(range(250, 5500, 250))
)


def meadow(east, north=0.0):
    return box("meadow", east - 20.0, north - 20.0, east + 20.0, north + 20.0, use=AreaUse.EMERGENCY)


def flight(away, *, work=FOLDED, endurance=300.0, team=(), areas=(), **features):
    """Return a scene whose robots fly out eastwards, with an emergency area so far to the west."""
    robots = team or (with_kinematics(robot(), endurance=endurance, energy=1e9),)
    features.setdefault("policies", ESCAPES)
    return scene(robots, {"a": work}, areas=(meadow(-away), *areas), **features)


def sound(whole):
    found = plan(whole)
    assert complaints(whole, found) == []
    return found


def reason(whole):
    with pytest.raises(InfeasibleError) as caught:
        plan(whole)
    (words,) = caught.value.reasons
    return words


def test_what_is_kept_for_a_diversion_makes_sorties_shorter():
    near, far = sound(flight(30.0)), sound(flight(1000.0))
    assert far.robots[0].sorties > near.robots[0].sorties


def test_a_search_that_is_stopped_keeps_a_plan_that_leaves_enough_and_says_so():
    whole = flight(1000.0)
    effort = Effort(3600.0, show=lambda best, least: effort.stop())
    found = plan(whole, effort=effort)
    assert effort.stopped
    assert complaints(whole, found) == []


def test_without_a_policy_nothing_is_kept():
    assert sound(flight(1e5, policies=())).robots[0].sorties == sound(flight(30.0)).robots[0].sorties


def test_the_policy_of_a_robot_type_counts_and_the_missions_goes_before_it():
    (one,) = flight(1e5).robots
    typed = replace(one, type=replace(one.type, policies=ESCAPES))
    with pytest.raises(InfeasibleError):
        plan(flight(1e5, team=(typed,), policies=()))
    sound(flight(1e5, team=(typed,), policies=(Policy("LINK_LOST", "RETURN"),)))


def test_the_policy_of_a_robot_kind_counts_and_those_of_type_and_mission_go_before_it():
    (one,) = flight(1e5).robots
    kept = replace(one, policies=ESCAPES)
    with pytest.raises(InfeasibleError):
        plan(flight(1e5, team=(kept,), policies=()))
    home = (Policy("LINK_LOST", "RETURN"),)
    sound(flight(1e5, team=(kept,), policies=home))
    sound(flight(1e5, team=(replace(kept, type=replace(kept.type, policies=home)),), policies=()))


def test_a_robot_that_is_not_to_return_has_landing_for_a_low_battery_before_its_kinds_response():
    (one,) = flight(1e5).robots
    low = replace(one, policies=(Policy("BATTERY_LOW", "EMERGENCY_AREA"),))
    with pytest.raises(InfeasibleError):
        plan(flight(1e5, team=(low,), policies=()))
    sound(flight(1e5, team=(replace(low, return_home=False),), policies=()))


def test_a_robot_that_cannot_come_home_at_the_transit_altitude_diverts_from_the_height_at_which_it_does():
    roof = box("roof", -20.0, -20.0, 20.0, 20.0, low=60.0, high=90.0)
    low = sound(flight(100.0, areas=(roof,), transit_altitude=75.0))
    assert low.makespan == sound(flight(100.0, areas=(roof,), transit_altitude=75.0, policies=())).makespan


def test_a_refusal_tells_the_policy_the_seconds_and_what_would_do():
    whole = flight(5000.0)
    words = reason(whole)
    assert re.search(
        r"r1: from its home to an emergency area \(policy LINK_LOST\) it takes up to \d+ s;"
        r" one charge allows 300 s: \d+ s short\)",
        words,
    )
    (metres,) = re.findall(r"an emergency area within (\d+) m of each home or RETURN as the response", words)
    sound(flight(float(metres) - 1.0))
    reason(flight(float(metres) + 25.0))
    sound(replace(whole, policies=(Policy("LINK_LOST", "RETURN"),)))


def test_a_task_that_is_too_long_beside_a_diversion_tells_what_is_kept():
    words = reason(flight(800.0, work=visit((1000.0, 0.0, 20.0))))
    assert re.search(r"beside \d+ s kept to reach an emergency area from home: \d+ s short", words)
    (lifetime,) = re.findall(r"a lifetime of (\d+) s \(now 375 s\)", words)
    sound(flight(800.0, work=visit((1000.0, 0.0, 20.0)), endurance=0.8 * float(lifetime)))


def test_an_area_behind_a_wall_that_leaves_no_way_is_none():
    outer = ((-300.0, -300.0), (900.0, -300.0), (900.0, 900.0), (-300.0, 900.0), (-300.0, 300.5))
    inner = ((-290.0, 300.5), (-290.0, 890.0), (890.0, 890.0), (890.0, -290.0), (-290.0, -290.0))
    gap = ((-290.0, 299.5), (-300.0, 299.5))
    fence = Area("fence", AreaUse.FORBIDDEN, (*outer, *inner, *gap), safety_distance=2.0)
    assert "no emergency area can be reached from its home (policy LINK_LOST)" in reason(
        flight(600.0, areas=(fence,))
    )


def test_another_robot_does_what_one_without_a_diversion_cannot():
    near = with_kinematics(robot("near", (0.0, 0.0, 0.0)), endurance=200.0, energy=1e9)
    far = with_kinematics(robot("far", (6000.0, 0.0, 0.0)), endurance=200.0, energy=1e9)
    found = sound(flight(50.0, work=visit((100.0, 0.0, 20.0)), team=(far, near)))
    assert [each.robot for each in found.robots if each.steps] == ["near"]
    assert found.robots[0].idle


def test_a_robot_that_ends_where_it_works_needs_an_area_near_there():
    team = (with_kinematics(robot(returns=False), endurance=150.0, energy=1e9),)
    one_way = (*ESCAPES, Policy("BATTERY_LOW", "LAND"))
    work = visit((900.0, 0.0, 20.0))
    sound(flight(-850.0, team=team, work=work, policies=one_way))
    with pytest.raises(InfeasibleError):
        plan(flight(30.0, team=team, work=work, policies=one_way))


def test_robots_on_the_ground_divert_too():
    team = (robot(kinematics=replace(CRAWLER, endurance=500.0, energy=1e9)),)
    work = visit((300.0, 0.0, 0.0))
    sound(flight(300.0, team=team, work=work))
    with pytest.raises(InfeasibleError):
        plan(flight(500.0, team=team, work=work))
