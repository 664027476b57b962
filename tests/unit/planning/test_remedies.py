"""What a refusal proposes is enough, and a little less is not."""

import re
from dataclasses import replace

import pytest
from plain_scenes import box, road, robot, scene, task, visit, with_kinematics

from mmrs_core.errors import InfeasibleError
from mmrs_core.planning import one_search, planner
from mmrs_core.planning.planner import plan
from mmrs_runtime.timing import LegTiming

CUTS = tuple(range(50, 1000, 50))
USABLE = 0.8
FOLDED = road(
    *((500.0 * (k % 2), 20.0 * (k // 2), 20.0) for k in range(12)), cuts=tuple(range(250, 5500, 250))
)
ERRANDS = {name: visit((300.0, 10.0 * k, 20.0), hold=30.0) for k, name in enumerate("abcd")}


def refusal(whole):
    """Return the only reason why there is no plan."""
    with pytest.raises(InfeasibleError) as caught:
        plan(whole)
    (reason,) = caught.value.reasons
    return reason


def with_robots(whole, **features):
    return replace(whole, robots=tuple(with_kinematics(each, **features) for each in whole.robots))


def with_tasks(whole, **features):
    return replace(whole, tasks=tuple(replace(each, **features) for each in whole.tasks))


def more(whole, count):
    """Return a scene with further robots like the first one."""
    first, works = whole.robots[0], dict(whole.works)
    copies = [replace(first, name=f"new{k}") for k in range(count)]
    works |= {
        (name, each.name): work for each in copies for (name, who), work in works.items() if who == first.name
    }
    return replace(whole, robots=(*whole.robots, *copies), works=works)


@pytest.mark.parametrize(
    "whole",
    [
        scene([with_kinematics(robot(), endurance=100.0)], {"a": visit((1000.0, 0.0, 20.0))}),
        scene([with_kinematics(robot(), endurance=115.0)], {"a": visit((400.0, 0.0, 20.0), slow_down=0.5)}),
        scene([with_kinematics(robot(), endurance=120.0, recharge=None)], ERRANDS),
        scene([with_kinematics(robot(), endurance=150.0, recharge=None)], {"a": FOLDED}),
    ],
)
def test_a_lifetime_that_is_proposed_is_enough_and_two_seconds_less_are_not(whole):
    (lifetime,) = re.findall(r"a lifetime of (\d+) s \(now", refusal(whole))
    assert plan(with_robots(whole, endurance=USABLE * int(lifetime), energy=1e9))
    refusal(with_robots(whole, endurance=USABLE * (int(lifetime) - 2.0), energy=1e9))


def test_lifetimes_that_are_proposed_for_long_tasks_are_enough_for_the_whole_mission():
    works = {"far": visit((600.0, 0.0, 20.0)), "field": FOLDED}
    whole = scene([with_kinematics(robot(), endurance=90.0, recharge=None)], works)
    with pytest.raises(InfeasibleError) as caught:
        plan(whole)
    lifetimes = [
        re.findall(r"for 'r1', a lifetime of (\d+) s \(now 112 s\) would do", each)
        for each in caught.value.reasons
    ]
    assert len(lifetimes) == 2
    assert lifetimes[0] == lifetimes[1]
    assert plan(with_robots(whole, endurance=USABLE * int(lifetimes[0][0]), energy=1e9))


def test_a_home_that_is_proposed_is_near_enough_and_two_metres_before_is_not():
    whole = scene([with_kinematics(robot(), endurance=100.0)], {"a": visit((1000.0, 0.0, 20.0))})
    ((east, away),) = re.findall(r"a home at \((\d+), 0\), (\d+) m from 'a'", refusal(whole))
    assert int(east) + int(away) == 1000
    assert plan(replace(whole, robots=(replace(whole.robots[0], home=(float(east), 0.0, 0.0)),)))
    refusal(replace(whole, robots=(replace(whole.robots[0], home=(float(east) - 2.0, 0.0, 0.0)),)))


def test_batteries_that_can_be_charged_are_proposed_where_they_help():
    whole = scene([with_kinematics(robot(), endurance=120.0, recharge=None)], ERRANDS)
    assert "a rechargeTime for the batteries" in refusal(whole)
    assert plan(with_robots(whole, recharge=300.0))


def test_robots_that_are_proposed_are_enough_and_one_less_is_not():
    whole = scene([with_kinematics(robot(), endurance=120.0, recharge=None)], ERRANDS)
    (count,) = re.findall(r"(\d) more robots like 'r1'", refusal(whole))
    assert plan(more(whole, int(count)))
    refusal(more(whole, int(count) - 1))


def test_a_number_of_robots_that_is_proposed_is_enough_and_others_are_not():
    west, east = (
        with_kinematics(robot(name, (east, 0.0, 0.0)), endurance=130.0)
        for name, east in (("west", 0.0), ("east", 1000.0))
    )
    line = road((0.0, 50.0, 20.0), (1000.0, 50.0, 20.0), cuts=CUTS)
    whole = scene([west, east], {"a": line}, tasks={"a": task("a", wanted=1)})
    assert "robotsWanted of 2 would do" in refusal(whole)
    assert plan(with_tasks(whole, wanted=2))


def test_too_many_robots_wanted_may_be_fewer_or_have_company():
    line = road((0.0, 50.0, 20.0), (400.0, 50.0, 20.0), cuts=CUTS[:7])
    whole = scene([robot("r1"), robot("r2", (20.0, 0.0, 0.0))], {"a": line}, tasks={"a": task("a", wanted=4)})
    assert "2 short; robotsWanted of 2, or 2 more like 'r1', would do" in refusal(whole)
    assert plan(with_tasks(whole, wanted=2))
    assert plan(more(whole, 2))
    refusal(more(whole, 1))
    refusal(with_tasks(whole, wanted=3))


@pytest.mark.parametrize(
    ("work", "words"),
    [
        (visit((9.0, 9.0, 9.0)), "but one robot must do all of it; robotsWanted of 1 would do"),
        (
            road((0.0, 9.0, 9.0), (90.0, 9.0, 9.0)),
            "it has no cuts for more than 1 robot; robotsWanted of 1 would do",
        ),
    ],
)
def test_work_that_cannot_be_shared_may_be_one_robots(work, words):
    whole = scene([robot("r1"), robot("r2", (20.0, 0.0, 0.0))], {"a": work}, tasks={"a": task("a", wanted=2)})
    assert words in refusal(whole)
    assert plan(with_tasks(whole, wanted=1))


@pytest.mark.parametrize(
    ("work", "limit", "proposed"),
    [
        (
            visit((1000.0, 0.0, 20.0)),
            "deadline",
            r"no robot can end it sooner; a deadline of (\d+) s would do",
        ),
        (road((0.0, 0.0, 20.0), (1005.0, 0.0, 20.0)), "longest", r"s too long; (\d+) s would do"),
    ],
)
def test_a_time_that_is_proposed_is_enough_and_a_second_less_is_not(work, limit, proposed):
    whole = scene([robot()], {"a": work}, tasks={"a": task("a", **{limit: 30.0})})
    (seconds,) = re.findall(proposed, refusal(whole))
    assert plan(with_tasks(whole, **{limit: float(seconds)}))
    refusal(with_tasks(whole, **{limit: float(seconds) - 1.0}))


def test_deadlines_that_are_proposed_together_are_enough():
    works = {"a": visit((1000.0, 0.0, 20.0)), "b": visit((-300.0, 0.0, 20.0))}
    whole = scene([robot()], works, tasks={name: task(name, deadline=45.0) for name in works})
    with pytest.raises(InfeasibleError) as caught:
        plan(whole)
    found = [re.findall(r"task '(\w)'.*a deadline of (\d+) s", each) for each in caught.value.reasons]
    late = {name: float(seconds) for ((name, seconds),) in found}
    tasks = tuple(replace(each, deadline=late.get(each.name, each.deadline)) for each in whole.tasks)
    assert plan(replace(whole, tasks=tasks))
    assert any("as the only task it would end after 112 s" in each for each in caught.value.reasons)


@pytest.mark.parametrize(("spread", "late"), [(0.0, False), (0.2, True)])
def test_a_window_that_is_narrower_than_a_robot_is_uncertain_is_refused_with_how_early_it_may_be(
    spread, late
):
    """It comes at 112 s, if all goes as expected, or up to 23 s earlier, for which it waits."""
    unsure = with_kinematics(robot(), timing=LegTiming(spread=spread))
    works = {"a": visit((1000.0, 0.0, 20.0), hold=10.0)}
    whole = scene([unsure], works, tasks={"a": task("a", earliest=110.0, deadline=125.0)})
    if not late:
        assert plan(whole).ends["a"] == pytest.approx(121.7, abs=0.1)
        return
    words = refusal(whole)
    assert "'r1' may come to 'a' up to 23 s earlier than planned, and waits until 133 s" in words
    assert "for its earliestStart, 110 s; no robot can end it sooner; a deadline of 143 s would do" in words
    assert plan(with_tasks(whole, deadline=143.0)).begins["a"] > 132.0


def test_a_distance_between_robots_that_is_proposed_can_be_kept():
    team = (robot("r1"), robot("r2", (50.0, 0.0, 0.0)))
    whole = scene(team, {"a": {"r1": visit((50.0, 0.0, 4.0))}}, minimum_separation=6.0)
    (least,) = re.findall(
        r"short, and waiting did not help; a minimumSeparation of ([\d.]+) m would do", refusal(whole)
    )
    assert plan(replace(whole, minimum_separation=float(least)))
    refusal(replace(whole, minimum_separation=float(least) + 0.2))


def test_deadlines_that_are_proposed_where_robots_cannot_keep_apart_in_time_can_be_kept():
    """Both tasks fill the same 40 s, 3 m apart: they can be done by two robots only, and not 10 m apart."""
    team = (robot("r1"), robot("r2", (14.0, 0.0, 0.0)))
    works = {"a": visit((100.0, 100.0, 30.0), hold=20.0), "b": visit((103.0, 100.0, 30.0), hold=20.0)}
    tasks = {name: task(name, earliest=50.0, deadline=90.0) for name in works}
    whole = scene(team, works, tasks=tasks, minimum_separation=10.0)
    words = refusal(whole)
    assert "('r1' going to 'a', 'r2' going to 'b')" in words
    ((least, late, name),) = re.findall(
        r"; a minimumSeparation of ([\d.]+) m or a deadline of (\d+) s for '(\w)' would do", words
    )
    assert plan(replace(whole, minimum_separation=float(least)))
    later = (replace(each, deadline=float(late)) if each.name == name else each for each in whole.tasks)
    assert plan(replace(whole, tasks=tuple(later)))


def test_remedies_for_robots_that_cannot_keep_apart_are_not_explained_in_turn(monkeypatch):
    """No distance will do: with each that is tried there would be reasons, and remedies for these."""
    calls, planned = [], one_search.planned
    for module in (planner, one_search):
        monkeypatch.setattr(module, "planned", lambda *given: calls.append(given) or planned(*given))
    team = (robot("r1"), robot("r2", (14.0, 0.0, 0.0)))
    places = {"a": (100.0, 100.0, 30.0), "b": (100.2, 100.0, 30.0)}
    works = {name: {f"r{k}": visit(at, hold=20.0)} for k, (name, at) in enumerate(places.items(), 1)}
    tasks = {name: task(name, earliest=50.0, deadline=90.0) for name in works}
    assert "a deadline of" in refusal(scene(team, works, tasks=tasks, minimum_separation=10.0))
    assert len(calls) <= 10


RING = [
    box(name, west, south, east, north)
    for name, west, south, east, north in (
        ("north", -50, 30, 50, 40),
        ("south", -50, -40, 50, -30),
        ("west", -50, -40, -40, 40),
        ("east", 40, -40, 50, 40),
    )
]


def test_an_area_that_is_to_be_opened_is_one_that_bars_the_path():
    whole = scene([robot(home=(200.0, 0.0, 0.0))], {"a": visit((0.0, 0.0, 20.0))}, areas=RING)
    found = refusal(whole)
    assert found.startswith("task 'a' can be reached by no robot (r1: no path from")
    assert plan(replace(whole, areas=tuple(RING[1:])))
    assert found.endswith("for 'r1' a passage through 'north' or 'south' or 'west' or 'east' would do")


def test_an_area_that_bars_the_paths_of_several_robots_is_named_once():
    team = [robot("r1", (200.0, 0.0, 0.0)), robot("r2", (220.0, 0.0, 0.0))]
    found = refusal(scene(team, {"a": visit((0.0, 0.0, 20.0))}, areas=RING))
    assert found.endswith(
        "; for 'r1', 'r2' a passage through 'north' or 'south' or 'west' or 'east' would do"
    )
