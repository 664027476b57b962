"""The ways that planned robots take to their work, between its places, and home."""

from dataclasses import replace

import pytest
from plain_scenes import box, road, robot, scene, visit, with_kinematics
from sound_plans import sound, steps_of

from mmrs_core.errors import InfeasibleError
from mmrs_core.planning.planner import plan
from mmrs_core.planning.team import Team
from mmrs_core.scene import Launch, Transit


def test_transits_go_around_areas_and_stay_clear():
    whole = scene(
        [robot()],
        {"a": visit((300.0, 0.0, 20.0))},
        areas=[box("wall", 100, -80, 120, 80), box("low", 200, -300, 210, 300, high=12.0)],
    )
    sound(whole)


def test_the_transit_altitude_is_used_between_tasks():
    works = {"a": visit((300.0, 0.0, 20.0)), "b": visit((300.0, 300.0, 20.0))}
    found = sound(scene([robot()], works, transit_altitude=60.0))
    assert all(max(point[2] for point in s.route) == 60.0 for s in steps_of(found, "r1", Transit))
    assert steps_of(found, "r1", Launch)[0].up == 60.0


def test_the_way_from_an_entry_to_the_work_stays_low():
    line = road((300.0, 40.0, 20.0), (300.0, 90.0, 20.0))
    work = replace(line, entry=(300.0, 0.0, 20.0))
    first, second, last = steps_of(sound(scene([robot()], {"a": work}, transit_altitude=60.0)), "r1", Transit)
    assert max(point[2] for point in first.route) == max(point[2] for point in last.route) == 60.0
    assert second.route == ((300.0, 0.0, 20.0), (300.0, 40.0, 20.0))


def test_a_point_is_approached_at_the_speed_of_its_work():
    slow = sound(scene([robot()], {"a": visit((300.0, 0.0, 20.0), slow_down=0.5)}))
    there, back = steps_of(slow, "r1", Transit)
    assert (there.speed, back.speed) == (5.0, None)
    assert there.end - there.begin == pytest.approx(60.0)
    assert back.end - back.begin == pytest.approx(30.0)


def test_a_quick_point_is_approached_as_fast_as_the_robot_goes():
    quick = sound(scene([robot()], {"a": visit((300.0, 0.0, 20.0), speed=float("inf"))}))
    assert steps_of(quick, "r1", Transit)[0].speed == 15.0


def test_a_stroke_is_approached_at_cruise_whatever_its_own_speed():
    line = road((300.0, 0.0, 20.0), (300.0, 90.0, 20.0), speed=4.0)
    assert steps_of(sound(scene([robot()], {"a": line})), "r1", Transit)[0].speed is None


def test_points_of_one_task_are_gone_between_at_their_speed():
    slow = sound(scene([robot()], {"a": visit((300.0, 0.0, 20.0), (300.0, 90.0, 20.0), slow_down=0.5)}))
    assert [step.speed for step in steps_of(slow, "r1", Transit)] == [5.0, 5.0, None]


def test_a_point_that_is_never_reached_is_refused():
    with pytest.raises(InfeasibleError, match="its speed there is zero"):
        plan(scene([robot()], {"a": visit((400.0, 0.0, 20.0), slow_down=0.0)}))


def test_the_first_leg_after_a_launch_begins_late_where_commands_take_time():
    plain, late = (
        Team(scene([with_kinematics(robot(), guiding=seconds)], {"a": visit((90.0, 0.0, 30.0))})).pilots["r1"]
        for seconds in (0.0, 1.8)
    )
    out, later = (each.travel.leave((90.0, 0.0, 30.0)) for each in (plain, late))
    assert (later.seconds, later.longest) == pytest.approx((out.seconds + 1.8, out.longest + 1.8))
    assert later.lead == pytest.approx(out.lead + 1.8)
    back, too = (each.travel.go_home((90.0, 0.0, 30.0)) for each in (plain, late))
    assert back == too
