from dataclasses import replace
from itertools import pairwise
from math import dist, inf

import pytest
from plain_scenes import CRAWLER, control, photo, road, robot, scene, visit, with_kinematics

from mmrs_core.errors import InternalError
from mmrs_core.planning import timeline
from mmrs_core.planning.delaying import delayed
from mmrs_core.planning.planner import plan
from mmrs_core.planning.strokes import action_seconds
from mmrs_core.planning.timeline import HomeRelation, Timelines, timelines_of
from mmrs_core.scene import Await, Launch, Look, Plan, Policy, RobotPlan, Serve, Transit
from mmrs_core.scene.robots import BACK_SECONDS
from mmrs_runtime.timing import LegTiming

SWIFT = with_kinematics(robot(), timing=LegTiming(2.0))


def rides_in(whole, name="r1"):
    return timelines_of(plan(whole), {each.name: each for each in whole.robots})[name].rides


def stays(rides):
    return [ride for ride in rides if len(ride.points) == 1 and ride.relation is not HomeRelation.HOME]


def test_a_robot_stands_still_for_actions_and_holds():
    work = road((0.0, 100.0, 20.0), (100.0, 100.0, 20.0), actions=(photo(50.0),), hold=30.0)
    found = stays(rides_in(scene([robot()], {"a": work})))
    assert sorted(round(ride.late - ride.early, 6) for ride in found) == [1.0, 30.0]


def test_rides_follow_each_other_without_gaps_in_space_from_climb_to_touch_down():
    rides = rides_in(scene([robot()], {"a": visit((100.0, 0.0, 20.0)), "b": visit((0.0, 100.0, 40.0))}))
    ends = [(one.points[-1], two.points[0]) for one, two in pairwise(rides)]
    assert all(dist(*pair) == 0.0 for pair in ends)
    assert rides[0].points[0] == rides[-1].points[-1] == (0.0, 0.0, 0.0)


def test_rides_follow_each_other_without_gaps_in_time():
    whole = scene([SWIFT], {"a": road((0.0, 90.0, 20.0), (90.0, 90.0, 20.0), actions=(photo(40.0),))})
    rides = rides_in(whole)
    assert [one.late for one in rides[:-1]] == pytest.approx([two.early for two in rides[1:]])
    assert rides[-2].late == pytest.approx(plan(whole).makespan)
    assert rides[-1].late == inf


def test_a_ride_leaves_open_where_speeding_up_and_slowing_down_is_done():
    whole = scene([SWIFT], {"a": visit((100.0, 0.0, 20.0))})
    way = next(ride for ride in rides_in(whole) if ride.points[-1] == (100.0, 0.0, 20.0))
    assert sum(way.least) == pytest.approx(10.0)
    assert way.late - way.early == pytest.approx(10.0 + 10.0 / 2.0)


def test_a_robot_that_stops_late_is_beyond_its_target_from_before_it_comes_until_it_is_back():
    late = with_kinematics(robot(), timing=LegTiming(2.0, overshoot=0.1))
    whole = scene([late], {"a": visit((100.0, 0.0, 20.0))})
    rides = rides_in(whole)
    way = next(ride for ride in rides if ride.points[-1] == (100.0, 0.0, 20.0))
    beyond = next(ride for ride in rides if ride.points[0] == (100.0, 0.0, 20.0))
    assert beyond.points[1] == pytest.approx((101.0, 0.0, 20.0))
    assert way.early < beyond.early < way.late - BACK_SECONDS + 1e-6
    assert beyond.late == pytest.approx(way.late + BACK_SECONDS)


def test_a_turn_that_may_be_spared_makes_what_follows_early():
    looking = visit((100.0, 0.0, 20.0), look=Look((100.0, 50.0, 0.0)), hold=10.0)
    whole = scene([robot()], {"a": looking})
    rides = rides_in(whole)
    (hold,) = stays(rides)
    home = rides[rides.index(hold) + 1]
    assert hold.late - hold.early == pytest.approx(10.0 + 2.0)
    assert hold.late - home.early == pytest.approx(2.0)


def test_a_wait_for_a_robot_that_may_be_early_may_end_early():
    looking = visit((300.0, 0.0, 20.0), look=Look((100.0, 50.0, 0.0)), hold=10.0)
    team = (robot("r1"), robot("r2", (20.0, 0.0, 0.0)))
    works = {"a": {"r1": looking}, "b": {"r2": visit((30.0, 0.0, 20.0))}}
    whole = scene(team, works, after=[("a", "b")])
    found = plan(whole)
    waiting, launch, *_ = timelines_of(found, {each.name: each for each in team})["r2"].rides
    assert waiting.relation is HomeRelation.HOME
    assert launch.early == pytest.approx(found.ends["a"] - 2.0)


def test_all_arms_of_a_choice_are_ridden():
    works = {"near": visit((120.0, 0.0, 20.0)), "far": visit((500.0, 0.0, 20.0))}
    after = [("f", "near", "windy"), ("f", "far"), ("near", "j"), ("far", "j")]
    controls = (control("f", "Fork"), control("j", "Join"))
    places = {
        ride.points[-1][0] for ride in rides_in(scene([robot()], works, after=after, controls=controls))
    }
    assert {120.0, 500.0} <= places


def test_after_a_choice_a_robot_may_be_as_early_as_its_shorter_arm():
    works = {name: visit((120.0, 0.0, 20.0), hold=hold) for name, hold in (("a", 40.0), ("b", 10.0))}
    works["z"] = visit((0.0, 9.0, 20.0))
    after = [("f", "a", "windy"), ("f", "b"), ("a", "j"), ("b", "j"), ("j", "z")]
    controls = (control("f", "Fork"), control("j", "Join"))
    rides = rides_in(scene([robot()], works, after=after, controls=controls))
    onwards = next(ride for ride in rides if ride.points[-1] == (0.0, 9.0, 20.0))
    assert onwards.late - onwards.early == pytest.approx(sum(onwards.least) + 30.0)


@pytest.mark.parametrize("arms", [(), (("f", "a", "windy"), ("f", "b"), ("a", "j"), ("b", "j"), ("j", "z"))])
def test_what_a_step_takes_longer_than_its_legs_counts_in_the_arms_of_a_choice_too(arms):
    works = {name: visit((120.0, 0.0, 20.0)) for name in ("a", "b")} | {"z": visit((0.0, 9.0, 20.0))}
    controls = (control("f", "Fork"), control("j", "Join")) if arms else ()
    whole = scene([robot()], works, after=list(arms), controls=controls)
    made, robots = plan(whole), {each.name: each for each in whole.robots}
    ends = [
        timelines_of(made, robots, longest=lambda robot, step, most=most: most * isinstance(step, Serve))
        for most in (0.0, 1000.0)
    ]
    (_, usual), (_, longest) = (each["r1"].moments[-1] for each in ends)
    assert longest > usual + (1900.0 if arms else 2900.0)


def test_an_upright_and_a_level_leg_in_a_row_are_one_ride():
    works = {"a": visit((300.0, 0.0, 20.0)), "b": visit((300.0, 300.0, 20.0))}
    rides = rides_in(scene([robot()], works, transit_altitude=60.0))
    between = next(ride for ride in rides if ride.points[0] == (300.0, 0.0, 20.0))
    assert [point[2] for point in between.points] == [20.0, 60.0, 60.0, 20.0]


def test_a_leg_of_a_ride_may_be_as_quick_as_in_a_move_of_its_own():
    unsteady = with_kinematics(robot(), timing=LegTiming(2.0, spread=0.3))
    works = {"a": visit((300.0, 0.0, 20.0)), "b": visit((300.0, 300.0, 20.0))}
    rides = rides_in(scene([unsteady], works, transit_altitude=60.0, minimum_separation=5.0))
    between = next(ride for ride in rides if ride.points[0] == (300.0, 0.0, 20.0))
    even = (40.0 / 3.0, 300.0 / 10.0, 40.0 / 2.0)
    up, level, down = (0.7 * (each + more) for each, more in zip(even, (1.5, 5.0, 1.0), strict=True))
    slowed = even[1] * (up + level + down) / sum(even)
    assert between.least == pytest.approx((up, slowed, down))


def test_a_launch_that_may_take_more_than_twice_as_long_is_not_over_before_it_begins():
    unsteady = with_kinematics(robot(), timing=LegTiming(2.0, spread=1.1))
    assert unsteady.kinematics.upright_bounds(20.0) == pytest.approx((0.0, 20.0, 42.0))


def test_a_robot_stands_at_home_from_before_the_start_until_it_leaves():
    rover = robot(kinematics=CRAWLER)
    team = (rover, robot("r2", (20.0, 0.0, 0.0)))
    works = {"a": {"r2": visit((300.0, 0.0, 20.0))}, "b": {"r1": visit((30.0, 0.0, 0.0))}}
    whole = scene(team, works, after=[("a", "b")])
    found = plan(whole)
    waiting, leaving, *_ = timelines_of(found, {each.name: each for each in team})["r1"].rides
    assert (waiting.points, waiting.early, waiting.relation) == ((rover.home,), -inf, HomeRelation.HOME)
    assert waiting.late == leaving.early == pytest.approx(found.ends["a"])


def test_a_robot_without_work_stands_at_home_for_ever():
    team = (robot("r1"), robot("r2", (20.0, 0.0, 0.0)))
    whole = scene(team, {"a": {"r1": visit((300.0, 0.0, 20.0))}})
    (stay,) = rides_in(whole, "r2")
    assert (stay.points, stay.early, stay.late) == (((20.0, 0.0, 0.0),), -inf, inf)


@pytest.mark.parametrize(("returns", "end"), [(True, (0.0, 0.0, 0.0)), (False, (300.0, 0.0, 0.0))])
def test_a_robot_stays_for_ever_where_it_has_landed(returns, end):
    low = (Policy("BATTERY_LOW", "LAND"),)
    whole = scene([robot(returns=returns)], {"a": visit((300.0, 0.0, 20.0))}, policies=low)
    stay = rides_in(whole)[-1]
    assert (stay.points, stay.late) == ((end,), inf)
    assert (stay.relation is HomeRelation.HOME) == returns


def test_only_upright_rides_over_its_own_home_are_in_a_robots_column():
    found = rides_in(scene([robot()], {"a": visit((300.0, 0.0, 20.0))}))
    column = [ride for ride in found if ride.relation is HomeRelation.COLUMN]
    assert [len(ride.points) for ride in column] == [2, 2]
    assert {point[:2] for ride in column for point in ride.points} == {(0.0, 0.0)}


def test_an_object_may_be_anywhere_within_its_tolerance():
    work = visit((100.0, 0.0, 20.0), object="buoy", object_tolerance=7.0, hold=5.0)
    rides = rides_in(scene([robot()], {"a": work}))
    assert [ride.radius for ride in rides if ride.points[0] == (100.0, 0.0, 20.0)] == [7.0, 7.0]
    assert rides[-1].radius == 0.0


def test_rides_keep_to_the_commanded_speed():
    work = road((0.0, 100.0, 20.0), (100.0, 100.0, 20.0), speed=4.0)
    whole = scene([robot()], {"a": work})
    served = next(ride for ride in rides_in(whole) if len(ride.points) == 2 and sum(ride.least) == 25.0)
    assert set(served.points) == {(0.0, 100.0, 20.0), (100.0, 100.0, 20.0)}


def test_robots_that_wait_for_nobody_in_the_plan_are_an_error():
    whole = scene([robot()], {"a": visit((9.0, 9.0, 9.0))})
    found = plan(whole)
    waiting = replace(found.robots[0], steps=(Await(0.0, 0.0, "a", ("never",)), *found.robots[0].steps))
    with pytest.raises(InternalError, match="wait for each other"):
        timelines_of(replace(found, robots=(waiting,)), {"r1": whole.robots[0]})


def test_two_level_legs_in_a_row_are_two_rides_whatever_comes_after_them():
    route = ((0.0, 0.0, 45.0), (100.0, 0.0, 45.0), (100.0, 90.0, 45.0), (100.0, 90.0, 25.0))
    steps = (Launch(0.0, 20.0, "a", (0.0, 0.0, 0.0), 45.0), Transit(20.0, 60.0, "a", route))
    rides = timelines_of(Plan((RobotPlan("r1", steps),), 60.0, {}, {}), {"r1": SWIFT})["r1"].rides
    assert [ride.points for ride in rides if len(ride.points) > 1][1:] == [route[:2], route[1:]]


def test_a_step_is_gone_through_once_for_all_plans_in_which_it_comes_at_other_times(monkeypatch):
    late = with_kinematics(robot(), timing=LegTiming(2.0, overshoot=0.1, spread=0.2))
    work = road((0.0, 90.0, 20.0), (90.0, 90.0, 20.0), actions=(photo(40.0),), hold=30.0)
    whole = scene([late], {"a": work, "b": visit((0.0, 60.0, 30.0))})
    robots, asked = {"r1": late}, []
    monkeypatch.setattr(timeline, "action_seconds", lambda *each: asked.append(each) or action_seconds(*each))
    times = Timelines(robots)
    first = plan(whole)
    times.of(first)
    before = len(asked)
    second = delayed(whole, first, "r1", {2: 17.3})
    found = times.of(second)["r1"]
    assert before > 0
    assert len(asked) == before
    fresh = timelines_of(second, robots)["r1"]
    assert [*map(rounded, found.rides)] == [*map(rounded, fresh.rides)]
    assert [*map(rounded, found.stops)] == [*map(rounded, fresh.stops)]


def rounded(ride):
    return replace(ride, early=round(ride.early, 6), late=round(ride.late, 6))
