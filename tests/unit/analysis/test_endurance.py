"""Time and energy of sorties, worked out by hand: robots go 2 m/s, lifetimes are 1000 s, reserves 20 %."""

import re
from dataclasses import replace
from math import inf

import pytest
from checking import finding, findings, given, kind, land, recharge, rover, take_off, uneven

from mmrs_core.analysis.dependencies import certain_moves
from mmrs_core.analysis.times import times_of
from mmrs_core.behaviour.program import MoveTarget
from mmrs_core.contributions.checks import Status
from mmrs_core.scene import Battery
from mmrs_core.testing.small_programs import go, hold, notify, robot, use

LAUNCHES = {"robot_kind": kind(launches=True)}


def seconds(*robots, **more):
    """Return the limit less the margin of the first robot."""
    verdict = findings("endurance", given(*robots, **more))[0]
    return pytest.approx(800.0 - verdict.margin)


def test_the_margin_is_the_lifetime_less_the_reserve_less_what_is_used():
    verdict = finding("endurance", given(robot("a", [go("m1", (100.0, 0.0, 0.0)), hold("h", 30.0)])))
    assert (verdict.status, verdict.unit, verdict.move) == (Status.SAFE, "s", "h")
    assert verdict.margin == pytest.approx(800.0 - 50.0 - 30.0)


def test_a_sortie_that_is_too_long_is_violated():
    verdict = finding("endurance", given(robot("a", [hold("h", 801.0)])))
    assert (verdict.status, verdict.move) == (Status.VIOLATED, "h")
    assert verdict.margin == pytest.approx(-1.0)
    assert verdict.message == (
        "a: until HoldPosition 'h' it needs up to 801.0 s of one charge, 800.0 s are allowed:"
        " a lifetime of 1002 s would do"
    )


@pytest.mark.parametrize("property", ["endurance", "energy"])
def test_a_lifetime_that_is_proposed_is_enough_and_a_second_less_is_not(property):
    program = robot("a", [hold("h", 1234.5)])
    message = finding(property, given(program)).message
    lifetime = float(re.findall(r"a lifetime of (\d+) s would do", message)[0])
    assert finding(property, given(program, type=rover(lifetime=lifetime))).status is Status.SAFE
    assert finding(property, given(program, type=rover(lifetime=lifetime - 1.0))).status is Status.VIOLATED


def test_the_reserve_is_the_one_that_is_asked_for():
    verdict = finding("endurance", given(robot("a", [hold("h", 801.0)]), reserve=0.1))
    assert verdict.margin == pytest.approx(99.0)


def test_an_action_that_the_type_does_not_know_leaves_endurance_unknown():
    verdict = finding("endurance", given(robot("a", [hold("h", 1.0, after=(use("camera", "shoot"),))])))
    assert verdict.status is Status.UNKNOWN


@pytest.mark.parametrize(("own", "other", "whole"), [(10.0, 300.0, 300.0), (100.0, 30.0, 100.0)])
def test_waiting_for_another_robot_counts_as_long_as_it_takes(own, other, whole):
    waiting = robot("a", [hold("h", own)], waits={"h": ["go"]})
    assert seconds(waiting, robot("b", [hold("n", other, after=(notify("a.go"),))])) == whole


def test_device_actions_count():
    shooting = hold("h", 10.0, before=(use("camera", "shoot"),), after=(use("camera", "shoot"),))
    assert seconds(robot("a", [shooting]), type=rover(devices={"camera": {"shoot": 2.5}})) == 15.0


def test_a_robot_that_launches_may_wait_on_the_ground():
    flight = [take_off("up", 10.0), hold("h", 20.0), land("down")]
    waiting = robot("a", flight, waits={"start": ["go"]})
    slow = robot("b", [hold("n", 900.0, after=(notify("a.go"),))])
    verdict = findings("endurance", given(waiting, slow, **LAUNCHES))[0]
    assert verdict.margin == pytest.approx(800.0 - 30.0)


def test_waiting_in_the_air_counts_from_the_launch():
    flight = [take_off("up", 10.0), land("down")]
    waiting = robot("a", flight, waits={"start": ["first"], "up": ["second"]})
    other = robot(
        "b", [hold("n", 900.0, after=(notify("a.first"),)), hold("o", 60.0, after=(notify("a.second"),))]
    )
    verdict = findings("endurance", given(waiting, other, **LAUNCHES))[0]
    assert verdict.margin == pytest.approx(800.0 - 60.0 - 5.0)


def sorties(*between, **more):
    return robot(
        "a",
        [
            take_off("up", 10.0),
            hold("h", 500.0),
            land("down"),
            *between,
            take_off("up again", 10.0),
            hold("h again", 400.0),
            land("down again"),
        ],
        **more,
    )


def test_a_recharge_begins_a_new_sortie_and_landing_alone_does_not():
    assert seconds(sorties(recharge("charge", 60.0)), **LAUNCHES) == 510.0
    verdict = finding("endurance", given(sorties(), **LAUNCHES))
    assert (verdict.status, verdict.move) == (Status.VIOLATED, "down again")
    assert verdict.margin == pytest.approx(800.0 - 510.0 - 410.0)


def test_the_longer_arm_of_a_choice_counts():
    moves = [hold("fork"), hold("long", 50.0), hold("short", 5.0)]
    made = robot("a", moves, choices={"fork": ("c", "long", "short")}, jumps={"long": "stop"})
    assert seconds(made) == 51.0


def test_a_loop_has_no_bound():
    verdict = finding("endurance", given(robot("a", [hold("h", 5.0)], choices={"h": ("again", "h", "stop")})))
    assert verdict.status is Status.UNKNOWN
    assert verdict.message == "a: HoldPosition 'h': nothing bounds how often the loop 'h' is made"


def test_a_wait_that_nobody_certainly_ends_in_time_is_unknown():
    waiting = robot("a", [hold("h", 10.0)], waits={"h": ["go"]})
    looping = robot(
        "b", [hold("n", 5.0), hold("o", after=(notify("a.go"),))], choices={"n": ("again", "n", "o")}
    )
    verdict = findings("endurance", given(waiting, looping))[0]
    assert (verdict.status, verdict.message) == (
        Status.UNKNOWN,
        "a: HoldPosition 'h': nothing bounds how long it then waits for 'go' from b",
    )


def loop(name, slot="a.go", seconds=50.0):
    """Return a robot that activates a slot after some seconds and a loop without a bound."""
    moves = [hold("long", seconds), hold("n", 5.0), hold("o", after=(notify(slot),))]
    return robot(name, moves, choices={"n": ("again", "n", "o")})


def test_what_is_certainly_used_is_violated_in_a_loop_without_a_bound():
    made = robot("a", [hold("h", 801.0), hold("i", 1.0)], choices={"i": ("again", "h", "stop")})
    for property in ("endurance", "energy"):
        violated, unknown = findings(property, given(made))
        assert (violated.status, violated.move) == (Status.VIOLATED, "h")
        assert unknown.status is Status.UNKNOWN
    assert violated.message.startswith("a: until HoldPosition 'h' it needs at least ")


@pytest.mark.parametrize("waits", ["h", "up"])
def test_what_is_certainly_used_is_violated_before_and_after_a_wait_without_a_bound(waits):
    flight = [take_off("up", 10.0), hold("h", 800.0), land("down")]
    waiting = robot("a", flight, waits={waits: ["go"]})
    verdict = findings("endurance", given(waiting, loop("b"), **LAUNCHES))[0]
    assert (verdict.status, verdict.move) == (Status.VIOLATED, "h")


def test_a_wait_for_what_certainly_takes_long_is_violated_though_it_has_no_bound():
    waiting = robot("a", [hold("h", 1.0)], waits={"h": ["go"]})
    verdict = findings("endurance", given(waiting, loop("b"), type=rover(lifetime=60.0)))[0]
    assert verdict.status is Status.VIOLATED
    assert verdict.message == (
        "a: until HoldPosition 'h' it needs at least 56.0 s of one charge, 48.0 s are allowed"
    )


def test_a_wait_is_not_certain_of_a_robot_that_may_launch_late():
    moves = [take_off("up", 10.0), land("down")]
    waiting = robot("a", moves, waits={"start": ["go"], "up": ["late"]})
    made = given(waiting, loop("b"), loop("c", "a.late", 900.0), **LAUNCHES)
    assert findings("endurance", made)[0].status is Status.UNKNOWN


def test_the_longer_arm_of_a_choice_is_not_certain():
    moves = [hold("fork"), hold("long", 500.0), hold("short", 5.0), hold("join", 400.0)]
    choices = {"fork": ("c", "long", "short"), "join": ("again", "join", "stop")}
    made = robot("a", moves, choices=choices, jumps={"long": "join"})
    assert finding("endurance", given(made)).status is Status.UNKNOWN


def test_what_was_used_before_a_recharge_is_not_certain_of_the_next_sortie():
    again = {"h again": ("again", "h again", "down again")}
    charged = given(sorties(recharge("charge", 60.0), choices=again), **LAUNCHES)
    assert finding("endurance", charged).status is Status.UNKNOWN
    assert findings("endurance", given(sorties(choices=again), **LAUNCHES))[0].status is Status.VIOLATED


def test_a_hold_where_nobody_knows_takes_its_time():
    lost = replace(go("g", (0.0, 0.0, 0.0)), target=MoveTarget(None, "buoy", None))
    for property in ("endurance", "energy"):
        verdict = findings(property, given(robot("a", [lost, hold("h", 801.0)])))[0]
        assert (verdict.status, verdict.move) == (Status.VIOLATED, "h")


@pytest.mark.parametrize("property", ["endurance", "energy"])
def test_what_is_certainly_used_is_violated_though_a_robot_has_no_home(property):
    made = robot("a", [take_off("up", 10.0), hold("h", 801.0), land("down")], home=None)
    violated, unknown = findings(property, given(made, **LAUNCHES))
    assert (violated.status, violated.move) == (Status.VIOLATED, "h")
    assert unknown.message == "a: Start 'start': its home is not given"


def test_a_robot_without_a_home_may_rest_on_the_ground():
    made = robot("a", [hold("h", 801.0)], home=None)
    assert finding("endurance", given(made, **LAUNCHES)).status is Status.UNKNOWN


def test_an_object_may_be_further_than_it_is_expected():
    to_buoy = replace(go("m1", (100.0, 0.0, 0.0)), target=MoveTarget((100.0, 0.0, 0.0), "buoy", 6.0))
    assert seconds(robot("a", [to_buoy])) == 53.0


def test_the_capability_is_that_of_the_smallest_payload_that_suffices():
    type = rover()
    light, heavy = type.capabilities[0], replace(type.capabilities[0], payload=2.0, lifetime=500.0)
    loaded = replace(robot("a", [hold("h", 10.0)]), payload=1.0)
    verdict = finding("endurance", given(loaded, type=replace(type, capabilities=(light, heavy))))
    assert verdict.margin == pytest.approx(400.0 - 10.0)


def test_no_capability_for_the_payload_is_unknown():
    loaded = replace(robot("a", [hold("h", 10.0)]), payload=1.0)
    verdict = finding("endurance", given(loaded))
    assert verdict.message == "a: robot type 'plain' has no movement capability for a payload of 1 kg"


def test_a_lifetime_that_is_not_stated_is_unknown_with_batteries_and_unlimited_without():
    made = robot("a", [hold("h", 1e9)])
    assert finding("endurance", given(made, type=rover(lifetime=None))).status is Status.UNKNOWN
    wired = rover(lifetime=None, energy=0.0)
    assert finding("endurance", given(made, type=wired)).status is Status.NOT_CHECKED
    assert finding("energy", given(made, type=wired)).status is Status.NOT_CHECKED


def test_energy_is_mean_power_times_time():
    verdict = finding("energy", given(robot("a", [hold("h", 300.0)]), type=rover(energy=50_000.0)))
    assert (verdict.status, verdict.unit) == (Status.SAFE, "J")
    assert verdict.margin == pytest.approx(0.8 * 50_000.0 - 50.0 * 300.0)


def test_the_planner_is_not_trusted_with_the_endurance():
    boasting = kind()
    generous = replace(boasting, kinematics=lambda r, s: replace(boasting.kinematics(r, s), endurance=inf))
    made = given(robot("a", [hold("h", 900.0)]), robot_kind=generous)
    assert finding("endurance", made).status is Status.VIOLATED


def test_recharging_takes_as_long_as_the_slowest_battery():
    type = replace(rover(), batteries=(Battery(1.0, 60.0), Battery(1.0, 90.0)))
    verdict = finding("recharge", given(sorties(recharge("charge", 80.0)), type=type, **LAUNCHES))
    assert (verdict.status, verdict.move) == (Status.VIOLATED, "charge")
    assert verdict.margin == pytest.approx(-10.0)


def test_a_battery_that_cannot_be_recharged_is_violated():
    verdict = finding(
        "recharge", given(sorties(recharge("c", 80.0)), type=rover(recharge_time=None), **LAUNCHES)
    )
    assert verdict.message == "a: 'c' recharges, but a battery of its type cannot be recharged"


def test_recharging_away_from_home_is_violated():
    moves = [go("m1", (30.0, 40.0, 0.0)), recharge("charge", 80.0)]
    found = findings("recharge", given(robot("a", moves)))
    assert [verdict.message for verdict in found if verdict.status is Status.VIOLATED] == [
        "a: 'charge' recharges 50.00 m away from home"
    ]


def test_a_robot_that_never_recharges_is_not_checked():
    assert finding("recharge", given(robot("a", []))).status is Status.NOT_CHECKED


def test_times_are_bounded_from_both_sides():
    waiting = robot("a", [hold("h", 10.0), hold("i", 1.0)], waits={"h": ["go"]})
    other = robot("b", [hold("n", 20.0, after=(notify("a.go"),))])
    times = times_of(given(waiting, other, moves=uneven()))
    assert (times.earliest["a", 2], times.latest["a", 2]) == (10.0, 40.0)
    assert times.slots["a", "go"] == (10.0, 40.0)


def test_the_quickest_of_several_activations_counts_for_the_earliest_and_a_certain_one_for_the_latest():
    waiting = robot("a", [hold("h", 1.0)], waits={"h": ["go"]})
    slow = robot("b", [hold("n", 20.0, after=(notify("a.go"),))])
    quick = robot(
        "c",
        [hold("fork", 1.0), hold("tell", 4.0, after=(notify("a.go"),))],
        choices={"fork": ("c", "tell", "stop")},
    )
    times = times_of(given(waiting, slow, quick))
    assert times.slots["a", "go"] == (5.0, 20.0)


GO, BACK = (notify("a.go"),), (notify("a.go", active=False),)


@pytest.mark.parametrize(
    ("moves", "waits", "times"),
    [
        pytest.param([hold("n", 2.0, after=(*GO, *BACK))], {}, (2.0, inf), id="may be missed"),
        pytest.param(
            [hold("n", 2.0, after=GO), hold("o", 2.0, after=BACK)],
            {"n": ["done"]},
            (2.0, 2.0),
            id="reset after use",
        ),
        pytest.param(
            [hold("n", 2.0, after=BACK), hold("o", 2.0, after=GO)], {}, (4.0, 4.0), id="reset before"
        ),
    ],
)
def test_a_slot_that_is_reset_has_a_latest_activation_unless_it_may_be_missed(moves, waits, times):
    after = (notify("b.done"),) if waits else ()
    waiting = robot("a", [hold("h", 1.0), hold("i", after=after)], waits={"h": ["go"]})
    assert times_of(given(waiting, robot("b", moves, waits=waits))).slots["a", "go"] == times


def test_a_move_that_no_run_comes_to_has_no_earliest_begin():
    assert ("a", 2) not in times_of(given(robot("a", [hold("h")], waits={"h": ["go"]}))).earliest


def test_moves_on_every_way_are_certain():
    moves = [hold("fork"), hold("left"), hold("right"), hold("join"), hold("loop")]
    made = robot(
        "a",
        moves,
        choices={"fork": ("c", "left", "right"), "loop": ("again", "loop", "stop")},
        jumps={"left": "join"},
    )
    names = {made.moves[index].id for index in certain_moves(made)}
    assert names == {"start", "fork", "join", "stop"}
