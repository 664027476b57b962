"""What robots do on one charge, and where their way ends."""

from dataclasses import replace
from math import inf

import pytest
from plain_scenes import box, control, road, robot, scene, task, visit, with_kinematics
from sound_plans import sound, steps_of

from mmrs_core.errors import InfeasibleError
from mmrs_core.planning.planner import plan
from mmrs_core.planning.team import Team
from mmrs_core.scene import Branch, Policy, Recharge
from mmrs_runtime.timing import LegTiming

CUTS = tuple(range(50, 1000, 50))


def folded():
    """Return a road of 5.5 km in a square of half a kilometre: eleven times there and back."""
    points = [(500.0 * (k % 2), 20.0 * (k // 2), 20.0) for k in range(12)]
    return road(*points, cuts=tuple(range(50, 5500, 50)))


def test_work_that_takes_longer_than_a_charge_becomes_several_sorties():
    found = sound(scene([with_kinematics(robot(), endurance=200.0, energy=1e9)], {"a": folded()}))
    assert found.robots[0].sorties > 3
    assert len(steps_of(found, "r1", Recharge)) == found.robots[0].sorties - 1


def test_energy_limits_sorties_as_time_does():
    found = sound(scene([with_kinematics(robot(), energy=200.0 * 200.0)], {"a": folded()}))
    assert found.robots[0].sorties > 3


def test_work_that_no_charge_suffices_for_is_refused_with_what_is_short():
    whole = scene([with_kinematics(robot(), endurance=100.0)], {"a": visit((1000.0, 0.0, 20.0))})
    with pytest.raises(
        InfeasibleError, match=r"takes up to 227 s there and back; one charge allows 100 s: 127 s short"
    ):
        plan(whole)


def test_a_battery_that_cannot_be_recharged_is_told():
    works = {name: visit((300.0, 10.0 * k, 20.0)) for k, name in enumerate("abcd")}
    lone = with_kinematics(robot(), endurance=120.0, recharge=None)
    whole = scene(
        [lone],
        {n: replace(w, strokes=tuple(replace(s, hold=30.0) for s in w.strokes)) for n, w in works.items()},
    )
    with pytest.raises(InfeasibleError, match="cannot recharge"):
        plan(whole)


def test_charges_that_all_together_do_not_suffice_are_told_with_what_is_short():
    lone = with_kinematics(robot(), endurance=150.0, recharge=None)
    with pytest.raises(InfeasibleError, match=r"150 s a charge, cannot recharge.*: at least 400 s short"):
        plan(scene([lone], {"a": folded()}))


def test_pieces_that_are_too_long_for_different_robots_are_not_told_to_be_too_long_for_all():
    west = with_kinematics(robot("west"), endurance=130.0)
    east = with_kinematics(robot("east", (1000.0, 0.0, 0.0)), endurance=130.0)
    line = road((0.0, 50.0, 20.0), (1000.0, 50.0, 20.0), cuts=CUTS)
    sound(scene([west, east], {"a": line}))
    tasks = {"a": task("a", wanted=1)}
    with pytest.raises(
        InfeasibleError, match=r"cannot be done by exactly 1 robot: .*too long for some: west"
    ):
        plan(scene([west, east], {"a": line}, tasks=tasks))


def test_a_robot_does_not_wait_aloft_longer_than_its_charge_bears_if_another_is_late():
    lone = with_kinematics(robot("r1"), endurance=140.0, recharge=60.0)
    works = {
        "first": {"r1": visit((150.0, 0.0, 20.0))},
        "long": {"r2": visit((150.0, 40.0, 20.0), hold=70.0)},
        "b": {"r1": visit((150.0, 20.0, 20.0))},
    }
    for timing, recharges in ((LegTiming(), 0), (LegTiming(spread=0.3), 1)):
        other = with_kinematics(robot("r2", (40.0, 0.0, 0.0)), cruise=5.0, timing=timing)
        after, soon = [("first", "b"), ("long", "b")], {"first": task("first", deadline=27.0)}
        whole = scene((lone, other), works, after=after, tasks=soon)
        assert len(steps_of(sound(whole), "r1", Recharge)) == recharges


def test_a_slow_approach_counts_against_the_charge():
    lone = with_kinematics(robot(), endurance=115.0)
    sound(scene([lone], {"a": visit((400.0, 0.0, 20.0))}))
    with pytest.raises(InfeasibleError, match=r"takes up to 147 s there and back.*: 32 s short"):
        plan(scene([lone], {"a": visit((400.0, 0.0, 20.0), slow_down=0.5)}))


def test_a_robot_that_need_not_return_comes_down_where_it_ends():
    found = sound(scene([robot(returns=False)], {"a": visit((300.0, 0.0, 20.0))}))
    assert found.robots[0].steps[-1].at == (300.0, 0.0, 20.0)
    assert found.robots[0].steps[-1].up == 0.0


def test_a_robot_that_cannot_come_down_where_it_ends_returns():
    whole = scene(
        [robot(returns=False)],
        {"a": visit((300.0, 0.0, 20.0))},
        areas=[box("hut", 290, -9, 310, 9, high=8.0)],
    )
    assert sound(whole).robots[0].steps[-1].at[:2] == (0.0, 0.0)


def test_a_robot_that_need_not_return_goes_home_to_recharge_and_ends_where_it_ends():
    lone = with_kinematics(robot(returns=False), endurance=200.0)
    found = sound(scene([lone], {"a": folded()}))
    assert found.robots[0].sorties > 3
    assert found.robots[0].steps[-1].at[2] == 20.0
    assert found.robots[0].steps[-1].at[:2] != (0.0, 0.0)


def test_a_robot_that_need_not_return_may_go_so_far_that_it_could_not():
    lone = with_kinematics(robot(returns=False), endurance=120.0, recharge=300.0)
    found = sound(scene([lone], {"a": visit((800.0, 0.0, 20.0))}))
    assert found.robots[0].sorties == 1
    assert any("robot 'r1' ends where its charge does not suffice to go home" in note for note in found.notes)


def test_a_robot_that_lands_on_a_low_battery_may_go_so_far_without_a_note():
    lone = with_kinematics(robot(returns=False), endurance=120.0)
    landing = (Policy("BATTERY_LOW", "LAND"),)
    found = sound(scene([lone], {"a": visit((800.0, 0.0, 20.0))}, policies=landing))
    assert not [note for note in found.notes if "r1" in note]


def test_a_robot_that_need_not_return_can_always_go_home_where_that_is_possible():
    lone = with_kinematics(robot(returns=False), endurance=140.0, recharge=60.0)
    works = {"a": visit((400.0, 0.0, 20.0)), "b": visit((0.0, 400.0, 20.0))}
    found = sound(scene([lone], works))
    assert found.robots[0].sorties == 2
    assert not [note for note in found.notes if "r1" in note]


def test_a_charge_that_just_suffices_is_enough():
    works = {name: visit((100.0 * k, 40.0, 20.0)) for k, name in enumerate(("a", "b", "c"), 1)}
    works["d"] = road((0.0, 90.0, 20.0), (400.0, 90.0, 20.0), cuts=CUTS[:7])
    plenty = with_kinematics(robot(), timing=LegTiming(0.5), recharge=None, energy=1e9)
    needed = plan(scene([plenty], works)).makespan
    exact = with_kinematics(plenty, endurance=needed)
    assert sound(scene([exact], works)).makespan == pytest.approx(needed)


def test_a_robot_that_need_not_return_keeps_enough_to_recharge_between_tasks():
    lone = with_kinematics(robot(returns=False), endurance=120.0, recharge=300.0)
    works = {name: visit((450.0, 10.0 * k, 20.0)) for k, name in enumerate("ab")}
    works = {name: replace(w, strokes=(replace(w.strokes[0], hold=10.0),)) for name, w in works.items()}
    far = {"z": visit((-450.0, 0.0, 20.0))}
    assert sound(scene([lone], {**works, **far})).robots[0].sorties >= 2


@pytest.mark.parametrize(("endurance", "stops"), [(300.0, True), (600.0, False)])
def test_robots_stop_at_corners_where_more_fits_into_a_charge_then(endurance, stops):
    slow = LegTiming(0.3)
    lone = with_kinematics(robot(), timing=LegTiming(2.0), mission=slow, endurance=endurance, recharge=300.0)
    zigzag = road(*((100.0 * k, 60.0 * (k % 2), 20.0) for k in range(8)), cuts=(350.0,))
    whole = scene([lone], {"a": zigzag})
    found = sound(whole)
    assert found.timed is stops
    assert found.robots[0].sorties == 1
    assert found.lower_bound == pytest.approx(plan(replace(whole, robots=(tireless(lone),))).lower_bound)


def test_charges_are_counted_along_each_arm_in_which_a_robot_is_charged():
    lone = with_kinematics(robot(), endurance=200.0, recharge=100.0, energy=1e9)
    works = {"a": folded(), "b": visit((100.0, 0.0, 20.0)), "c": visit((100.0, 50.0, 20.0))}
    after = [("fork", "a", "windy"), ("fork", "b", None), ("a", "join", None), ("b", "join", None)]
    controls = control("fork", "Fork"), control("join", "Join")
    whole = scene([lone], works, after=[*after, ("join", "c", None)], controls=controls)
    found, team = sound(whole), Team(whole)
    (branch,) = steps_of(found, "r1", Branch)
    assert branch.end - branch.begin > lone.kinematics.endurance
    assert (team.charges.missing(found), team.charges.short(found)) == (0.0, set())
    assert 100.0 < team.charges.most_used(found)["r1"] <= 200.0
    tired = with_kinematics(lone, endurance=150.0)
    assert 0.0 < Team(replace(whole, robots=(tired,))).charges.missing(found) <= 1.0 / 3.0


def tireless(each):
    return with_kinematics(
        each, timing=each.kinematics.timing, mission=each.kinematics.mission, endurance=inf, energy=inf
    )
