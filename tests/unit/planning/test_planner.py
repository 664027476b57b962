from dataclasses import replace

import pytest
from plain_scenes import (
    CRAWLER,
    DRONE,
    box,
    control,
    field_work,
    photo,
    road,
    robot,
    scene,
    task,
    visit,
    with_kinematics,
)
from sound_plans import complaints, sound, steps_of

from mmrs_core.errors import InfeasibleError
from mmrs_core.planning import deconfliction
from mmrs_core.planning.assembly import why_idle
from mmrs_core.planning.effort import Effort
from mmrs_core.planning.planner import plan
from mmrs_core.planning.separation import first_conflict
from mmrs_core.planning.team import Team
from mmrs_core.scene import (
    Await,
    Branch,
    Corridor,
    Launch,
    Recharge,
    Recover,
    Serve,
    SharedWorks,
    Signal,
    Transit,
)
from mmrs_runtime.timing import LegTiming

TWO = (robot("r1"), robot("r2", (20.0, 0.0, 0.0)))
FIELD = ((100.0, 100.0), (300.0, 100.0), (300.0, 300.0), (100.0, 300.0))
PLACES = ((100.0, 0.0, 20.0), (0.0, 100.0, 20.0))
CUTS = tuple(range(50, 1000, 50))


def test_one_robot_goes_does_it_and_comes_back():
    found = sound(scene([robot()], {"a": visit((100.0, 0.0, 20.0))}))
    kinds = [type(step) for step in found.robots[0].steps]
    assert kinds == [Launch, Transit, Serve, Transit, Recover]
    assert found.makespan == pytest.approx(5 + 20 / 3 + 10 + 10 + 10 + 5)
    assert found.robots[0].energy == pytest.approx(200.0 * found.makespan)
    assert found.robots[0].sorties == 1


def test_a_robot_that_does_not_launch_sets_out_once_its_motors_run():
    place = {"a": visit((60.0, 0.0, 0.0))}
    plain, slow = (scene([with_kinematics(robot(kinematics=CRAWLER), launch=each)], place) for each in (0, 2))
    assert sound(slow).makespan == pytest.approx(sound(plain).makespan + 2.0)
    assert sound(slow).lower_bound <= sound(slow).makespan


def test_the_energy_of_a_robot_whose_power_nobody_knows_is_not_known():
    found = sound(scene([with_kinematics(robot(), power=0.0)], {"a": visit((100.0, 0.0, 20.0))}))
    assert found.robots[0].energy is None


def test_a_robot_without_work_takes_no_energy():
    found = sound(scene(TWO, {"a": visit((100.0, 0.0, 20.0))}))
    assert min(each.energy for each in found.robots) == 0.0


def test_a_robot_without_work_has_no_steps():
    found = sound(scene(TWO, {"a": visit((100.0, 0.0, 20.0))}))
    assert sorted(len(each.steps) for each in found.robots) == [0, 5]


def test_a_plan_says_that_it_is_for_calm_air_where_nobody_states_the_wind():
    calm = "the context states no windSpeed: this is a plan for calm air"
    silent = scene([robot()], {"a": visit((100.0, 0.0, 20.0))})
    assert calm in plan(silent).notes
    assert calm not in plan(replace(silent, environment={"windSpeed": 2.0})).notes


def test_a_plan_for_robots_on_the_ground_asks_for_no_wind():
    driving = scene([robot(kinematics=CRAWLER)], {"a": visit((100.0, 0.0, 0.0))})
    assert [note for note in plan(driving).notes if "windSpeed" in note] == []


def test_a_field_is_shared_by_robots_that_are_back_at_about_the_same_time():
    empty = scene(TWO, {})
    alone = sound(scene(TWO[:1], {"a": field_work(empty, FIELD)}))
    found = sound(scene(TWO, {"a": field_work(empty, FIELD)}))
    ends = [each.steps[-1].end for each in found.robots]
    assert found.makespan < 0.65 * alone.makespan
    assert abs(ends[0] - ends[1]) < 0.15 * found.makespan


def test_a_stroke_is_split_at_its_cuts():
    work = road((0.0, 50.0, 20.0), (1000.0, 50.0, 20.0), cuts=CUTS)
    found = sound(scene((robot("r1"), robot("r2", (1000.0, 0.0, 0.0))), {"a": work}))
    shares = [step.stroke for each in found.robots for step in each.steps if isinstance(step, Serve)]
    assert len(shares) == 2
    assert all(end[0] % 50 == pytest.approx(0.0) for s in shares for end in (s.points[0], s.points[-1]))


def test_indivisible_work_is_done_by_one_robot():
    work = visit((100.0, 0.0, 20.0), (200.0, 0.0, 20.0), (100.0, 100.0, 20.0))
    found = sound(scene(TWO, {"a": work}))
    assert sum(bool(each.steps) for each in found.robots) == 1


def test_two_tasks_go_to_two_robots():
    works = {"a": visit((400.0, 0.0, 20.0)), "b": visit((-400.0, 0.0, 20.0))}
    found = sound(scene(TWO, works))
    assert all(each.steps for each in found.robots)


def test_the_same_seed_gives_the_same_plan():
    whole = scene(
        TWO, {name: field_work(scene(TWO, {}), FIELD, altitude=up) for name, up in (("a", 20.0), ("b", 30.0))}
    )
    assert plan(whole, seed=4) == plan(whole, seed=4)


def test_a_search_that_is_stopped_keeps_its_best_plan():
    many = scene(TWO, {f"t{k}": visit((50.0 * (k % 5), 40.0 * k, 20.0)) for k in range(12)})
    shown = []
    effort = Effort(3600.0, show=lambda best, least: shown.append((best, least)) or effort.stop())
    assert not effort.stop()
    found = plan(many, effort=effort)
    assert len(shown) == 1
    assert shown[0][0] >= found.makespan >= found.lower_bound == shown[0][1] > 0.0
    assert complaints(many, found) == []


def test_a_longer_time_finds_a_plan_that_is_no_worse():
    many = scene(TWO, {f"t{k}": visit((70.0 * (k * 7 % 12), 55.0 * (k * 5 % 12), 20.0)) for k in range(12)})
    ticks = iter(range(10**6))
    longer = plan(many, effort=Effort(400.0, lambda: float(next(ticks))))
    assert next(ticks) >= 400
    assert longer.makespan <= plan(many).makespan


@pytest.mark.parametrize("returns", [True, False])
def test_a_plan_that_cannot_be_better_is_at_its_lower_bound(returns):
    still = with_kinematics(robot(returns=returns), launch=0.0, recovery=0.0, floor=0.0, launches=False)
    found = plan(scene([still], {"a": visit((300.0, 0.0, 0.0), hold=3.0)}))
    assert found.lower_bound == pytest.approx(found.makespan) == (63.0 if returns else 33.0)


@pytest.mark.parametrize("robots", [1, 2])
def test_the_lower_bound_counts_the_charging_that_no_plan_can_do_without(robots):
    """Each of four tasks takes a charge; each robot returns to charge between two of its own."""
    at_once = {"launch": 0.0, "recovery": 0.0, "floor": 0.0}
    team = [with_kinematics(each, endurance=70.0, recharge=20.0, **at_once) for each in TWO[:robots]]
    works = {
        f"{east} {north}": visit((east, north, 0.0), hold=3.0)
        for east, north in ((300.0, 0.0), (-300.0, 0.0), (0.0, 300.0), (0.0, -300.0))
    }
    found = sound(scene(team, works))
    charged = 4 // robots * 63.0 + (4 // robots - 1) * 20.0
    assert 0.9 * charged <= found.lower_bound <= found.makespan
    assert found.makespan == pytest.approx(charged, rel=0.05)


def test_a_robot_that_reports_legs_as_done_before_their_end_has_a_lower_bound():
    hasty = with_kinematics(robot(), timing=LegTiming(0.5, settling=-0.75))
    found = plan(scene([hasty], {"a": visit((300.0, 0.0, 20.0), hold=3.0)}))
    assert 60.0 <= found.lower_bound <= found.makespan


def test_robots_of_one_sort_that_can_do_different_tasks_share_what_is_laid_out():
    one, two = map(visit, PLACES)
    works = SharedWorks({"r1": 0, "r2": 0})
    works.add("a", (one,), b"\1\0")
    works.add("b", (two,), b"\0\1")
    works.add("c", (one,), b"\1\1")
    assert works == {("a", "r1"): one, ("b", "r2"): two, ("c", "r1"): one, ("c", "r2"): one}
    whole = replace(scene(TWO, {"a": one, "b": two, "c": one}), works=works)
    team = Team(whole)
    assert [team.able(task) for task in "abc"] == [("r1",), ("r2",), ("r1", "r2")]
    assert team.forwards("b", "r1") is None
    assert team.forwards("c", "r1") is team.forwards("c", "r2")
    assert [step.task for step in steps_of(sound(whole), "r2", Serve)] == ["b"]


def test_a_task_waits_for_another_robots_share_of_the_one_before():
    works = {"a": {"r1": visit((300.0, 0.0, 20.0))}, "b": {"r2": visit((30.0, 0.0, 20.0))}}
    found = sound(scene(TWO, works, after=[("a", "b")]))
    (signal,) = steps_of(found, "r1", Signal)
    (wait,) = steps_of(found, "r2", Await)
    assert wait.signals == (signal.signal,)
    assert signal.receivers == ("r2",)
    assert found.begins["b"] >= found.ends["a"]


def test_a_robot_that_has_done_nothing_yet_waits_on_the_ground():
    works = {"a": {"r1": visit((300.0, 0.0, 20.0))}, "b": {"r2": visit((30.0, 0.0, 20.0))}}
    found = sound(scene(TWO, works, after=[("a", "b")]))
    assert isinstance(found.robots[1].steps[0], Await)


def test_a_robot_that_is_away_waits_where_its_work_begins():
    works = {
        "a": {"r1": visit((300.0, 0.0, 20.0))},
        "first": {"r2": visit((60.0, 0.0, 20.0))},
        "b": {"r2": visit((30.0, 0.0, 20.0))},
    }
    soon = {"first": task("first", deadline=16.0)}
    whole = scene(TWO, works, after=[("a", "b"), ("first", "b")], tasks=soon)
    steps = sound(whole).robots[1].steps
    wait = next(i for i, step in enumerate(steps) if isinstance(step, Await))
    assert isinstance(steps[wait + 1], Serve)
    assert steps[wait].end > steps[wait].begin


def test_a_robots_own_order_needs_no_signal():
    works = {"a": visit((300.0, 0.0, 20.0)), "b": visit((30.0, 0.0, 20.0))}
    found = sound(scene([robot()], works, after=[("a", "b")]))
    assert not [step for step in found.robots[0].steps if isinstance(step, Signal | Await)]


def test_fork_and_join_pass_the_order_on():
    works = {name: visit((100.0 * k, 50.0, 20.0)) for k, name in enumerate("abcd", 1)}
    after = [("a", "fork"), ("fork", "b"), ("fork", "c"), ("b", "join"), ("c", "join"), ("join", "d")]
    whole = scene(TWO, works, after=after, controls=(control("fork", "Fork"), control("join", "Join")))
    found = sound(whole)
    assert found.begins["fork"] == found.ends["a"]
    assert found.begins["d"] >= found.ends["join"] >= max(found.ends["b"], found.ends["c"])


def test_each_ending_share_has_a_signal_of_its_own():
    empty = scene(TWO, {})
    works = {"a": field_work(empty, FIELD), "b": field_work(empty, FIELD, altitude=40.0)}
    found = sound(scene(TWO, works, after=[("a", "b")]))
    signals = [step.signal for each in found.robots for step in each.steps if isinstance(step, Signal)]
    assert len(signals) == len(set(signals)) == 2


def test_wanted_robots_all_get_a_share():
    team = [robot(f"r{k}", (10.0 * k, 0.0, 0.0)) for k in range(4)]
    work = road((0.0, 50.0, 20.0), (400.0, 50.0, 20.0), cuts=CUTS[:7])
    whole = scene(team, {"a": work}, tasks={"a": task("a", wanted=3)})
    assert sum(bool(each.steps) for each in sound(whole).robots) == 3


def test_an_earliest_time_is_kept_by_the_clock():
    whole = scene([robot()], {"a": visit((100.0, 0.0, 20.0))}, tasks={"a": task("a", earliest=500.0)})
    found = sound(whole)
    assert found.begins["a"] == pytest.approx(500.0)
    assert found.robots[0].busy < 60.0


def test_an_earliest_time_is_kept_even_by_a_robot_that_does_not_stop_at_corners():
    sluggish = with_kinematics(robot(), timing=LegTiming(0.5))
    works = {"a": visit((300.0, 0.0, 20.0)), "b": visit((300.0, 300.0, 20.0))}
    after, tasks = [("a", "b")], {"b": task("b", earliest=130.0)}
    found = sound(scene([sluggish], works, after=after, tasks=tasks))
    wait = next(step for step in steps_of(found, "r1", Await) if step.until is not None)
    without_stops = wait.begin - 2 * 20.0
    assert without_stops + (wait.until - wait.begin) >= 130.0 - 1e-6


def test_an_earliest_time_is_kept_even_by_a_robot_whose_charging_ends_at_once():
    works = {"a": visit((600.0, 0.0, 20.0)), "b": visit((-600.0, 0.0, 20.0))}
    short = with_kinematics(robot(), endurance=200.0, recharge=50.0)
    found = sound(scene([short], works, after=[("a", "b")], tasks={"b": task("b", earliest=230.0)}))
    (charging,) = steps_of(found, "r1", Recharge)
    assert found.begins["b"] - (charging.end - charging.begin) == pytest.approx(230.0)


def test_a_deadline_that_cannot_be_kept_is_refused_with_how_late_it_is():
    whole = scene([robot()], {"a": visit((1000.0, 0.0, 20.0))}, tasks={"a": task("a", deadline=100.0)})
    with pytest.raises(InfeasibleError, match=r"its deadline is 100 s: 12 s late"):
        plan(whole)


def test_a_duration_that_is_exceeded_is_refused_with_by_how_much():
    work = road((0.0, 0.0, 20.0), (1000.0, 0.0, 20.0))
    whole = scene([robot()], {"a": work}, tasks={"a": task("a", longest=60.0)})
    with pytest.raises(InfeasibleError, match=r"takes 100 s, 60 s are allowed: 40 s too long"):
        plan(whole)


def test_a_longest_duration_that_a_plan_keeps_anyway_changes_nothing():
    works = {
        "a": road((-200.0, 100.0, 20.0), (200.0, 100.0, 20.0), cuts=CUTS[:3]),
        "b": road((200.0, 300.0, 20.0), (700.0, 300.0, 20.0), cuts=CUTS[:3]),
    }
    team = [robot(f"r{k}", (20.0 * k, 0.0, 0.0)) for k in range(3)]
    found = sound(scene(team, works))
    kept = {name: task(name, longest=found.ends[name] - found.begins[name]) for name in works}
    assert plan(scene(team, works, tasks=kept)) == found


def test_a_higher_priority_comes_first():
    works = {"a": visit((300.0, 0.0, 20.0)), "b": visit((-300.0, 0.0, 20.0))}
    whole = scene([robot()], works, tasks={"b": task("b", priority=5)})
    found = sound(whole)
    assert found.begins["b"] < found.begins["a"]


def test_all_reasons_are_given_at_once():
    whole = scene([robot()], {"a": visit((9.0, 9.0, 500.0)), "b": visit((9.0, 9.0, 0.0))})
    with pytest.raises(InfeasibleError) as caught:
        plan(whole)
    assert len(caught.value.reasons) == 2
    assert "380.0 m short" in caught.value.reasons[0]
    assert "1.0 m short" in caught.value.reasons[1]


def test_work_within_a_clearance_is_refused_with_the_area():
    whole = scene([robot()], {"a": visit((105.0, 0.0, 20.0))}, areas=[box("tower", 100, -10, 110, 10)])
    with pytest.raises(InfeasibleError, match="within the clearance of 'tower'"):
        plan(whole)


def test_a_missing_device_is_told():
    work = visit((9.0, 9.0, 9.0), actions=(replace(photo(0.0), action="sample"),))
    with pytest.raises(InfeasibleError, match="r1: has no device for action 'sample'"):
        plan(scene([robot()], {"a": work}))


def test_a_crawler_neither_launches_nor_recovers():
    rover = robot(kinematics=CRAWLER)
    found = sound(scene([rover], {"a": visit((50.0, 10.0, 0.0))}))
    assert [type(step) for step in found.robots[0].steps] == [Transit, Serve, Transit]


def test_a_choice_is_one_robots_work_and_counts_its_longer_arm():
    works = {
        "a": visit((100.0, 0.0, 20.0)),
        "near": visit((120.0, 0.0, 20.0)),
        "far": visit((500.0, 0.0, 20.0)),
    }
    works["z"] = visit((0.0, 100.0, 20.0))
    after = [("a", "f"), ("f", "near", "windy"), ("f", "far"), ("near", "j"), ("far", "j"), ("j", "z")]
    whole = scene(TWO, works, after=after, controls=(control("f", "Fork"), control("j", "Join")))
    found = sound(whole)
    (branch,) = [step for each in found.robots for step in each.steps if isinstance(step, Branch)]
    assert [condition for condition, _ in branch.arms] == ["windy", None]
    assert found.begins["z"] >= branch.end
    assert branch.end - branch.begin == pytest.approx(
        max(arm[-1].end for _, arm in branch.arms) - branch.begin
    )


def test_a_choice_may_do_nothing_otherwise():
    works = {"a": visit((100.0, 0.0, 20.0)), "b": visit((200.0, 0.0, 20.0))}
    after = [("a", "f"), ("f", "b", "sunny"), ("f", "j"), ("b", "j")]
    whole = scene([robot()], works, after=after, controls=(control("f", "Fork"), control("j", "Join")))
    (branch,) = steps_of(sound(whole), "r1", Branch)
    assert branch.arms[-1][0] is None
    assert not [step for step in branch.arms[-1][1] if isinstance(step, Serve)]


def test_a_fork_without_an_else_arm_is_refused():
    works = {"a": visit((100.0, 0.0, 20.0)), "b": visit((200.0, 0.0, 20.0))}
    after = [("f", "a", "sunny"), ("f", "b", "windy")]
    whole = scene([robot()], works, after=after, controls=(control("f", "Fork"),))
    with pytest.raises(InfeasibleError, match="fork 'f' has 0 outgoing dependencies without a condition"):
        plan(whole)


def test_tasks_in_a_circle_are_refused_with_the_circle():
    works = {"a": visit((100.0, 0.0, 20.0)), "b": visit((200.0, 0.0, 20.0))}
    with pytest.raises(InfeasibleError, match=r"circle: .*a.*b"):
        plan(scene([robot()], works, after=[("a", "b"), ("b", "a")]))


def test_robots_that_would_meet_are_kept_apart():
    team = (robot("r1", (0.0, 0.0, 0.0)), robot("r2", (200.0, 0.0, 0.0)))
    works = {"a": {"r1": visit((200.0, 5.0, 20.0))}, "b": {"r2": visit((0.0, 5.0, 20.0))}}
    near = scene(team, works)
    assert first_conflict(near, plan(near), 20.0) is not None
    apart = replace(near, minimum_separation=20.0)
    found = sound(apart)
    assert first_conflict(apart, found, 20.0) is None


def test_robots_that_work_at_one_place_take_turns():
    works = {
        "a": {"r1": visit((100.0, 0.0, 20.0), hold=100.0)},
        "b": {"r2": visit((101.0, 0.0, 20.0), hold=100.0)},
    }
    whole = scene(TWO, works, minimum_separation=5.0)
    found = sound(whole)
    assert first_conflict(whole, found, 5.0) is None


def test_no_tasks_make_an_empty_plan():
    found = plan(scene(TWO, {}))
    assert found.makespan == 0.0
    assert all(not each.steps for each in found.robots)


def test_a_deadline_within_a_choice_is_checked():
    works = {"a": visit((900.0, 0.0, 20.0)), "b": visit((200.0, 0.0, 20.0))}
    whole = scene(
        [robot()],
        works,
        after=[("f", "a", "sunny"), ("f", "b")],
        controls=(control("f", "Fork"),),
        tasks={"a": task("a", deadline=50.0)},
    )
    with pytest.raises(InfeasibleError, match="its deadline is 50 s"):
        plan(whole)


def test_a_choice_cannot_be_shared():
    works = {"a": visit((900.0, 0.0, 20.0)), "b": visit((200.0, 0.0, 20.0))}
    after = [("f", "a", "sunny"), ("f", "b")]
    tasks = {"a": task("a", wanted=2)}
    whole = scene(TWO, works, after=after, controls=(control("f", "Fork"),), tasks=tasks)
    with pytest.raises(InfeasibleError) as caught:
        plan(whole)
    assert any("one robot's work" in reason for reason in caught.value.reasons)


def test_a_robot_that_does_not_move_is_refused():
    whole = scene([with_kinematics(robot(), cruise=0.0)], {"a": visit((9.0, 9.0, 9.0))})
    with pytest.raises(InfeasibleError, match="r1: its cruise speed is zero"):
        plan(whole)


def test_names_that_look_like_signals_stay_apart():
    works = {
        "a": {"b ended by c": visit((300.0, 0.0, 20.0))},
        "a ended by b": {"c": visit((200.0, 0.0, 20.0))},
    }
    works["z"] = {"d": visit((100.0, 0.0, 20.0))}
    team = [robot(name, (10.0 * k, 0.0, 0.0)) for k, name in enumerate(("b ended by c", "c", "d"))]
    found = sound(scene(team, works, after=[("a", "z"), ("a ended by b", "z")]))
    (wait,) = steps_of(found, "d", Await)
    assert len(set(wait.signals)) == 2


def test_a_robot_without_work_has_a_reason_and_one_with_work_has_none():
    works = {"a": visit((100.0, 0.0, 20.0)), "b": {"r1": visit((110.0, 0.0, 20.0))}}
    found = sound(scene(TWO, works, after=[("a", "b")]))
    busy, idle = found.robots
    assert busy.idle == ""
    assert "'a': one robot must do all of it" in idle.idle
    assert "'b': has no work for it" in idle.idle


def test_a_robot_that_can_do_none_of_many_tasks_stays_at_home():
    names = [f"t{k}" for k in range(8)]
    works = {name: {"r1": visit((100.0 + 10.0 * k, 0.0, 20.0))} for k, name in enumerate(names)}
    low = with_kinematics(robot("low", (15.0, 0.0, 0.0)), cruise=3.0)
    found = sound(scene((robot("r1"), low), works))
    assert [bool(each.steps) for each in found.robots] == [True, False]


def test_a_robot_without_work_names_the_separation_only_where_it_is_known_to_be_idle_for_it():
    team = (robot("r1"), robot("r2", (32.0, 0.0, 0.0)))
    places = {"a": (50.0, 60.0, 20.0), "b": (70.0, 60.0, 20.0), "c": (60.0, 70.0, 20.0)}
    works = {name: visit(place) for name, place in places.items()}
    apart = scene(team, works, minimum_separation=30.0)
    free = plan(replace(apart, minimum_separation=None))
    assert all(each.steps for each in free.robots)
    assert sound(apart).makespan - free.makespan == pytest.approx(4.0, abs=0.5)
    assert (
        sound(apart)
        .robots[1]
        .idle.endswith("; it would make the mission end 4 s sooner if robots did not keep 30 m apart")
    )
    alone = sound(scene(team, {"a": works["a"]}, minimum_separation=30.0))
    assert [each.idle for each in alone.robots if each.idle] == [
        "'a': one robot must do all of it, and the mission ends no later with another one"
    ]


def test_a_robot_without_work_names_the_number_of_robots_only_where_the_mission_states_one():
    line = road((0.0, 50.0, 20.0), (100.0, 50.0, 20.0), cuts=(25.0, 50.0, 75.0))
    whole = scene(TWO, {"a": line})
    one = scene(TWO, {"a": line}, tasks={"a": task("a", wanted=1)})
    assert "the task wants 1" in why_idle(Team(one), "r2")
    tried = Team(whole).wanting({"a": 1})
    for team in (tried, tried.changed(None), tried.at_home(frozenset())):
        assert why_idle(team, "r2") == "'a': no plan was found in which it makes the mission end sooner"


def test_robots_stay_at_home_where_others_keep_apart_for_less_without_them(monkeypatch):
    lane = Corridor("lane", ((10.0, 60.0), (10.0, 200.0)), 20.0, low=30.0, high=90.0)
    kinematics = replace(DRONE, timing=LegTiming(spread=0.1))
    team = [robot(f"r{k}", (10.0 * k, 0.0, 0.0), kinematics=kinematics) for k in range(6)]
    shell = ((-60.0, 400.0), (100.0, 400.0), (100.0, 500.0), (-60.0, 500.0))
    works = {
        "field": field_work(scene(team, {}), shell, altitude=40.0),
        "mill": visit((160.0, 560.0, 25.0)),
        "timber": visit((-140.0, 540.0, 25.0)),
    }
    wanted = {"field": task("field", wanted=4)}
    whole = scene(team, works, tasks=wanted, minimum_separation=8.0, transit_altitude=55.0, corridors=(lane,))
    found = sound(whole)
    idle = [each.idle for each in found.robots if not each.steps]
    assert idle
    assert all("stays at home, so that robots keep apart" in each for each in idle)
    monkeypatch.setattr(deconfliction, "_PARTS", ())
    assert found.makespan < 0.95 * plan(whole).makespan


def test_too_few_robots_of_one_sort_are_named_with_those_that_they_cannot_share_with():
    works = {
        "a": {
            "r1": road((0.0, 50.0, 20.0), (90.0, 50.0, 20.0)),
            "r2": road((0.0, 50.0, 20.0), (90.0, 60.0, 20.0)),
        }
    }
    with pytest.raises(InfeasibleError, match="1 short \\(r1 cannot share it with r2: sensors or clearances"):
        plan(scene(TWO, works, tasks={"a": task("a", wanted=2)}))


def test_a_shared_task_that_takes_too_many_charges_names_who_cannot_share_it():
    two = [with_kinematics(each, endurance=90.0, recharge=None) for each in TWO]
    three = [*two, replace(two[0], name="r3")]
    corners = tuple((float(50 * (i % 2)), 50.0, 20.0) for i in range(81))
    line = road(*corners, cuts=tuple(range(50, 4000, 50)))
    works = {"a": {"r1": line, "r2": line, "r3": road((0.0, 60.0, 20.0), (50.0, 60.0, 20.0))}}
    with pytest.raises(InfeasibleError, match="r1 and r2 cannot share it with r3"):
        plan(scene(three, works, tasks={"a": task("a", wanted=2)}))


def test_one_robot_that_is_wanted_is_the_one_that_needs_fewer_sorties():
    corners = [(500.0 if 0 < i % 4 < 3 else 100.0, 50.0 + 20.0 * (i // 2), 20.0) for i in range(12)]
    line = road(*corners, cuts=tuple(range(50, 2450, 50)))
    near = with_kinematics(robot("near", (100.0, 0.0, 0.0)), endurance=150.0)
    far = robot("far")
    found = sound(scene((near, far), {"a": line}, tasks={"a": task("a", wanted=1)}))
    assert found.robots[0].idle
    assert found.makespan < plan(scene((near,), {"a": line})).makespan


def test_a_robot_that_may_end_where_it_works_is_chosen_for_that():
    stays = replace(robot("stays", (-100.0, 0.0, 0.0)), return_home=False)
    found = sound(scene((robot("returns"), stays), {"a": visit((600.0, 0.0, 20.0))}))
    assert found.robots[0].idle
    assert found.robots[1].steps[-1].at[:2] == (600.0, 0.0)


def test_one_stop_ends_a_search_with_deadlines():
    """A plan without them is sought first, which misses one here."""
    works = {f"t{k}": visit((70.0 * (k * 7 % 12), 55.0 * (k * 5 % 12), 20.0)) for k in range(12)}
    late = max(plan(scene(TWO, works)).ends.items(), key=lambda each: each[1])
    tasks = {late[0]: task(late[0], deadline=late[1] - 30.0)}
    ticks, stops = iter(range(10**6)), list[bool]()
    effort = Effort(
        3600.0, lambda: float(next(ticks)), lambda best, least: None if stops else stops.append(effort.stop())
    )
    plan(scene(TWO, works, tasks=tasks), effort=effort)
    assert effort.stopped
    assert next(ticks) < 1000
