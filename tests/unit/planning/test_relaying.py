"""Robots that stay as relays, in scenes made by hand: any rule may ask for one, whatever its task is."""

import re
from dataclasses import replace
from itertools import pairwise

import pytest
from plain_scenes import CRAWLER, DRONE, robot, scene, task, visit
from plan_replay import complaints

from mmrs_core.errors import InfeasibleError
from mmrs_core.planning.explaining import explain
from mmrs_core.planning.planner import plan
from mmrs_core.planning.separation import distance_to_keep, first_conflict
from mmrs_core.planning.timeline import timelines_of
from mmrs_core.scene import Await, Corridor, Launch, Part, Recover, Serve, Signal, Stroke, Transit, Work
from mmrs_core.scene.relays import RELAY

FAR = (500.0, 0.0, 30.0)
NEAR = (60.0, 0.0, 30.0)
RIDGE = (280.0, 0.0, 40.0)


def radio(name, east, *, reach=300.0, relay=None, **more):
    """Return a robot at home whose radio reaches so far, and that is a relay if it has a relay's range."""
    one = robot(name, (east, 0.0, 0.0), **more)
    figures = {"communicationRange": reach} | ({} if relay is None else {"relayRange": relay})
    part = replace(one.type.part, attributes=figures)
    return replace(one, type=replace(one.type, name=f"{one.type.name} {relay}", part=part))


def staying(at):
    """Return the work of a robot that stays somewhere as a relay."""
    return Work((Stroke((at,)),), divisible=False, rule="any", relays=True)


TEAM = (radio("a", 0.0), radio("b", 20.0), radio("c", 40.0, relay=300.0))


def planned(works=None, robots=TEAM, **more):
    works = works or {"far": visit(FAR), "ridge": {"c": staying(RIDGE)}}
    return plan(scene(robots, works, **more))


def steps(plan, name):
    return next(each.steps for each in plan.robots if each.robot == name)


def kinds(plan, name):
    return [type(step).__name__ for step in steps(plan, name)]


def test_a_robot_leaves_home_for_what_its_radio_does_not_reach_when_the_relay_is_in_place():
    found = planned()
    user = next(name for name in "ab" if steps(found, name))
    assert kinds(found, user)[:3] == ["Await", "Launch", "Transit"]
    (arrived,) = [step for step in steps(found, "c") if isinstance(step, Signal)]
    wait, launch, *_ = steps(found, user)
    assert wait.signals == (arrived.signal,)
    assert launch.begin == arrived.end > 0.0


def test_the_relay_stays_until_the_last_of_the_others_is_back_in_range():
    found = planned({"far": visit(FAR), "also far": visit(FAR, hold=30.0), "ridge": {"c": staying(RIDGE)}})
    told = {each.robot: step for each in found.robots for step in each.steps if isinstance(step, Signal)}
    stay = next(step for step in steps(found, "c") if isinstance(step, Await))
    assert set(stay.signals) == {step.signal for name, step in told.items() if name != "c"}
    assert stay.end == max(step.end for name, step in told.items() if name != "c")
    assert found.begins["ridge"] <= stay.begin
    assert found.ends["ridge"] == stay.end


def test_the_task_of_a_relay_is_done_when_nobody_needs_it_any_more_and_only_then():
    first, second = [step for step in steps(planned(), "c") if isinstance(step, Serve)]
    assert (first.first, first.last, second.first, second.last) == (True, False, False, True)


def test_a_robot_that_stays_in_its_own_range_waits_for_no_relay():
    found = planned(
        {"near": visit(NEAR), "far": visit(FAR), "ridge": {"c": staying(RIDGE)}}, minimum_separation=5.0
    )
    waiting = [
        each.robot for each in found.robots if any(isinstance(s, Await) and s.signals for s in each.steps)
    ]
    assert "c" in waiting
    for each in found.robots:
        served = {step.task for step in each.steps if isinstance(step, Serve)}
        if each.robot != "c" and "far" not in served:
            assert each.robot not in waiting


def test_a_relay_that_no_robot_needs_comes_back_at_once_and_is_noted():
    found = planned({"near": visit(NEAR), "ridge": {"c": staying(RIDGE)}})
    assert not any(isinstance(step, Await | Signal) for step in steps(found, "c"))
    assert found.notes[0] == "no robot needs 'c' as relay 'ridge'"


def test_the_robot_with_the_nearer_home_becomes_the_relay_of_robots_alike():
    robots = [radio(name, east, relay=300.0) for name, east in (("a", 0.0), ("b", 30.0), ("c", 15.0))]
    found = planned({"far": visit(FAR), "ridge": staying(RIDGE)}, robots)
    assert [s.task for s in steps(found, "b") if isinstance(s, Serve)] == ["ridge", "ridge"]


def test_of_robots_unlike_each_other_that_one_is_the_relay_with_which_the_mission_ends_sooner():
    """The slow one is nearer, but holds up all others."""
    slow = replace(DRONE, cruise=1.0, fastest=2.0)
    robots = [
        radio("a", 0.0),
        radio("quick", 30.0, relay=300.0),
        radio("slow", 60.0, relay=301.0, kinematics=slow),
    ]
    works = {"far": {"a": visit(FAR)}, "ridge": {"quick": staying(RIDGE), "slow": staying(RIDGE)}}
    found = planned(works, robots)
    assert [s.task for s in steps(found, "quick") if isinstance(s, Serve)] == ["ridge", "ridge"]


def test_a_robot_whose_relay_reaches_too_short_is_not_taken_though_it_is_nearer():
    robots = [radio("a", 0.0), radio("weak", 60.0, relay=210.0), radio("strong", 0.0, relay=300.0)]
    works = {"far": {"a": visit(FAR)}, "ridge": {"weak": staying(RIDGE), "strong": staying(RIDGE)}}
    assert [s.task for s in steps(planned(works, robots), "strong") if isinstance(s, Serve)] == ["ridge"] * 2
    del works["ridge"]["strong"]
    with pytest.raises(
        InfeasibleError, match=r"'weak' at 'ridge' as relay: .*a: would be .* from (home|relay)"
    ):
        planned(works, robots)


def test_a_chain_of_relays_is_put_up_one_after_the_other_and_taken_down_in_reverse():
    robots = [radio("a", 0.0), radio("b", 20.0, relay=300.0), radio("c", 40.0, relay=300.0)]
    works = {
        "second": {"c": staying((520.0, 0.0, 40.0))},
        "first": {"b": staying(RIDGE)},
        "far": {"a": visit((700.0, 0.0, 30.0))},
    }
    found = planned(works, robots)
    assert found.begins["first"] < found.begins["second"] < found.begins["far"]
    assert found.ends["far"] < found.ends["second"] < found.ends["first"]
    assert any(isinstance(step, Await) and len(step.signals) == 2 for step in steps(found, "a"))


def test_relays_of_the_context_lead_to_a_robot_that_is_one():
    mast = Part((RELAY,), {"name": "mast", "position": (250.0, 0.0, 0.0), "range": 400.0})
    works = {"far": visit((700.0, 0.0, 30.0)), "ridge": {"c": staying((500.0, 0.0, 40.0))}}
    assert planned(works, elements=(mast,)).begins.keys() == {"far", "ridge"}
    with pytest.raises(InfeasibleError, match="'c' as relay: "):
        planned(works)


def test_a_robot_that_does_not_launch_waits_where_it_is_still_in_range():
    rover = replace(CRAWLER, ceiling=60.0, floor=-10.0, cruise=5.0, fastest=6.0)
    robots = [radio("rover", 0.0, kinematics=rover), radio("c", 40.0, relay=300.0)]
    ground = {"rover": visit((50.0, 0.0, 0.0), (450.0, 0.0, 0.0))}
    found = planned({"round": ground, "ridge": {"c": staying(RIDGE)}}, robots)
    names = kinds(found, "rover")
    assert names.index("Await") > names.index("Serve")


def test_others_keep_their_distance_from_the_place_of_a_relay():
    """Their straight path leads through its place: they pass it at 20 m and more."""
    level = (280.0, 0.0, 30.0)
    found = planned({"far": visit(FAR), "ridge": {"c": staying(level)}}, minimum_separation=20.0)
    rides = timelines_of(found, {each.name: each for each in TEAM})
    legs = [ride.points for name in "ab" for ride in rides[name].rides if len(ride.points) > 1]
    for one, two in [pair for points in legs for pair in pairwise(points)]:
        for share in range(101):
            place = [a + share / 100 * (b - a) for a, b in zip(one, two, strict=True)]
            assert sum((a - b) ** 2 for a, b in zip(place, level, strict=True)) ** 0.5 >= 20.0


def test_a_stay_that_takes_longer_than_a_charge_is_refused_with_figures_and_what_would_help():
    works = {"far": visit(FAR, hold=900.0), "ridge": {"c": staying(RIDGE)}}
    short = replace(DRONE, endurance=900.0)
    robots = [TEAM[0], radio("c", 40.0, relay=300.0, kinematics=short)]
    words = (
        r"'c' would be out for up to \d+ s as relay 'ridge' of 'a', it has 900 s a charge: \d+ s too long; a"
        r" lifetime of \d+ s \(now \d+ s\) would do"
    )
    with pytest.raises(InfeasibleError, match=words) as refused:
        planned(works, robots)
    used, over, lifetime, now = map(int, re.findall(r"(\d+) s(?! a charge)", str(refused.value)))
    assert used - over == 900
    enough = replace(DRONE, endurance=900.0 * lifetime / now)
    planned(works, [TEAM[0], radio("c", 40.0, relay=300.0, kinematics=enough)])
    less = replace(enough, endurance=enough.endurance - 3.0)
    with pytest.raises(InfeasibleError):
        planned(works, [TEAM[0], radio("c", 40.0, relay=300.0, kinematics=less)])


def test_a_robot_that_ends_beyond_the_relay_is_refused():
    robots = [replace(TEAM[0], return_home=False), TEAM[2]]
    with pytest.raises(InfeasibleError, match="'a' ends where its radio needs the relay 'ridge'"):
        planned({"far": {"a": visit(FAR)}, "ridge": {"c": staying(RIDGE)}}, robots)


def test_what_a_relay_cannot_do_is_refused_by_name():
    works = {"far": visit(FAR), "ridge": {"c": staying(RIDGE)}}
    with pytest.raises(InfeasibleError, match="it cannot come before 'far'; remove the dependency"):
        planned(works, after=[("ridge", "far")])
    with pytest.raises(InfeasibleError, match="wants 2 robots, but one robot is the relay"):
        planned(works, tasks={"ridge": task("ridge", wanted=2)})
    with pytest.raises(InfeasibleError, match="has an earliestStart"):
        planned(works, tasks={"ridge": task("ridge", earliest=10.0)})


def test_times_of_all_tasks_are_kept_or_refused():
    works = {"far": visit(FAR), "ridge": {"c": staying(RIDGE)}}
    assert planned(works, tasks={"far": task("far", deadline=200.0)}).ends["far"] <= 200.0
    with pytest.raises(InfeasibleError, match="no plan keeps all times: task 'far' ends"):
        planned(works, tasks={"far": task("far", deadline=90.0)})


@pytest.mark.parametrize("name", ["far", "ridge"])
def test_a_deadline_that_would_do_is_named_where_robots_wait_for_relays(name):
    works = {"far": visit(FAR), "ridge": {"c": staying(RIDGE)}}
    with pytest.raises(InfeasibleError) as caught:
        planned(works, tasks={name: task(name, deadline=90.0)})
    (enough,) = re.findall(r"; a deadline of (\d+) s would do$", str(caught.value))
    ends = planned(works, tasks={name: task(name, deadline=float(enough))}).ends[name]
    assert ends == pytest.approx(float(enough), abs=1.0)


def test_two_relays_want_two_robots():
    works = {"far": visit(FAR), "ridge": {"c": staying(RIDGE)}, "hill": {"c": staying(NEAR)}}
    with pytest.raises(InfeasibleError, match=r"2 tasks want a robot each .* and only 'c' can do them"):
        planned(works)


def test_a_team_of_relays_only_is_refused():
    with pytest.raises(
        InfeasibleError, match="with 'c' at 'ridge' as relay, no robot is left for the other tasks"
    ):
        planned({"far": visit(FAR), "ridge": staying(RIDGE)}, [TEAM[2]])


def test_the_lower_bound_holds_and_the_same_scene_gives_the_same_plan():
    found = planned()
    assert 0.0 < found.lower_bound <= found.makespan
    assert found == planned()


def test_positions_that_are_uncertain_shorten_the_links_of_a_relay_at_both_ends():
    far = {"far": visit((575.0, 0.0, 40.0)), "ridge": {"c": staying(RIDGE)}}
    planned(far, position_error=2.0)
    with pytest.raises(InfeasibleError):
        planned(far, position_error=3.0)


def test_an_explanation_says_what_waiting_for_the_relay_costs():
    works = {"far": visit(FAR), "ridge": {"c": staying(RIDGE)}}
    whole = scene(TEAM, works)
    found = explain(whole, plan(whole))
    (limit,) = [each for each in found.limits if each.name == "relays"]
    assert limit.cost > 40.0
    (charge,) = [each for each in found.limits if each.name == "charge"]
    assert charge.margin.startswith("'c' uses up to ")
    assert [each.task for each in found.tasks] == ["far"]


def test_an_explanation_says_how_near_deadlines_are_after_waits_for_the_relay():
    works = {"far": visit(FAR), "ridge": {"c": staying(RIDGE)}}
    whole = scene(TEAM, works, tasks={"far": task("far", deadline=900.0)})
    made = plan(whole)
    (limit,) = [each for each in explain(whole, made).limits if each.name == "deadlines"]
    assert limit.margin == f"'far' ends {900.0 - made.ends['far']:.0f} s before its deadline"


def test_an_explanation_names_the_relay_among_those_that_use_corridors():
    gate = Corridor("gate", ((120.0, 0.0), (180.0, 0.0)), 40.0)
    works = {"far": visit(FAR), "ridge": {"c": staying(RIDGE)}}
    whole = scene(TEAM, works, corridors=(gate,))
    made = plan(whole)
    user = next(name for name in "ab" if steps(made, name))
    (limit,) = [each for each in explain(whole, made).limits if each.name == "corridors"]
    assert f"'{user}', 'c' come in through 'gate'" in limit.margin


def test_an_explanation_of_a_relay_with_nothing_else_to_do_names_no_waits():
    whole = scene(TEAM, {"ridge": staying(RIDGE)}, minimum_separation=5.0)
    found = explain(whole, plan(whole))
    assert [each.name for each in found.limits] == ["charge"]


def test_a_relay_leaves_in_time_for_the_first_robot_that_needs_it_and_not_before():
    tasks = {"far": task("far", earliest=600.0)}
    found = planned({"far": visit(FAR), "ridge": {"c": staying(RIDGE)}}, tasks=tasks)
    name = next(each.robot for each in found.robots if each.robot != "c" and each.steps)
    there = next(step for step in steps(found, "c") if isinstance(step, Signal))
    launched = next(step for step in steps(found, name) if isinstance(step, Launch))
    assert launched.begin - 1.0 < there.begin <= launched.begin
    assert found.begins["far"] == pytest.approx(600.0)


def test_a_chain_of_relays_leaves_in_time_for_what_is_beyond_it():
    robots = [radio("a", 0.0), radio("b", 20.0, relay=300.0), radio("c", 40.0, relay=300.0)]
    one, two = staying(RIDGE), staying((530.0, 0.0, 40.0))
    works = {
        "one": {"b": one, "c": one},
        "two": {"b": two, "c": two},
        "farther": {"a": visit((760.0, 0.0, 30.0))},
    }
    found = planned(works, robots, tasks={"farther": task("farther", earliest=900.0)})
    leaves = sorted(step.begin for name in "bc" for step in steps(found, name) if isinstance(step, Launch))
    (launched,) = [step.begin for step in steps(found, "a") if isinstance(step, Launch)]
    assert 600.0 < leaves[0] < leaves[1] < launched
    assert found.begins["farther"] == pytest.approx(900.0)


CROSSED = {
    "behind": {"a": visit(FAR)},
    "aside": {"b": visit((400.0, 250.0, 30.0))},
    "ridge": {"c": staying(RIDGE)},
}
"""The path home of `a` leads along that of the relay, that of `b` does not."""


def test_a_relay_goes_home_as_soon_as_another_robot_is_out_of_its_way_not_only_when_that_one_is_home():
    whole = scene(TEAM, CROSSED, minimum_separation=8.0)
    found = plan(whole)
    assert complaints(whole, found) == []
    assert first_conflict(whole, found, distance_to_keep(whole)) is None
    home = min(step.end for name in "ab" for step in steps(found, name) if isinstance(step, Recover))
    stay = next(step for step in reversed(steps(found, "c")) if isinstance(step, Serve))
    assert stay.end < home
    assert found.makespan < 1.05 * planned(CROSSED).makespan


def test_robots_tell_a_relay_on_their_way_home_that_they_are_back_in_range():
    found = planned(CROSSED, minimum_separation=8.0)
    for name in "ab":
        assert kinds(found, name).index("Signal") < kinds(found, name).index("Recover")


def test_launches_come_after_waits_so_that_no_robot_hovers_for_a_relay():
    found = planned()
    for each in found.robots:
        if each.robot != "c" and each.steps:
            names = [type(step) for step in each.steps]
            assert names.index(Await) < names.index(Launch) < names.index(Transit)
