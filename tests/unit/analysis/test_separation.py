"""Robots that are under way at once, at 2 m/s."""

from dataclasses import replace

import pytest
from checking import MOVE_KINDS, finding, findings, given, kind, land, recharge, strange, take_off, uneven

from mmrs_core.contributions.checks import Status
from mmrs_core.testing.small_programs import go, hold, notify, robot, robot_type, use


def separation(*robots, least=3.0, **more):
    return findings("separation", given(*robots, minimum_separation=least, **more))


def crossing(wait=None, before=0.0):
    """Return two robots whose ways cross at right angles; the second may wait before it goes."""
    a = robot("a", [go("east", (40.0, 0.0, 0.0), after=(notify("b.go"),))], home=(0.0, 0.0, 0.0))
    moves = [hold("before", before), go("north", (20.0, 20.0, 0.0))]
    waits = {"before": [wait]} if wait else {}
    return a, robot("b", moves, waits=waits, slots=["go"], home=(20.0, -20.0, 0.0))


def test_nothing_is_checked_unless_it_is_asked_for():
    verdict = finding("separation", given(*crossing()))
    assert (verdict.status, verdict.message) == (Status.NOT_CHECKED, "the mission sets no minimum separation")


def test_robots_that_meet_at_a_crossing_are_violated():
    (verdict,) = separation(*crossing())
    assert (verdict.status, verdict.robot, verdict.move) == (Status.VIOLATED, "a", "east")
    assert "b on 'north'" in verdict.message
    assert verdict.margin < 0.0


def test_robots_that_pass_a_crossing_one_after_the_other_are_safe():
    assert [verdict.status for verdict in separation(*crossing(before=4.0))] == [Status.SAFE]


def test_a_little_later_is_not_enough():
    assert [verdict.status for verdict in separation(*crossing(before=2.0))] == [Status.VIOLATED]


def test_waiting_for_the_other_is_enough_however_uncertain_times_are():
    a, b = crossing(wait="go")
    assert [verdict.status for verdict in separation(a, b, moves=uneven())] == [Status.SAFE]


def test_uncertain_times_leave_a_crossing_undecided():
    (verdict,) = separation(*crossing(before=10.0), moves=uneven())
    assert verdict.status is Status.UNKNOWN
    assert "let one wait for the other" in verdict.message


def test_ways_that_are_far_enough_apart_are_safe():
    a = robot("a", [go("east", (40.0, 0.0, 0.0))])
    b = robot("b", [go("east", (40.0, 3.0, 0.0))], home=(0.0, 3.0, 0.0))
    assert [verdict.status for verdict in separation(a, b)] == [Status.SAFE]


def test_the_position_error_of_both_robots_counts():
    a = robot("a", [go("east", (40.0, 0.0, 0.0))])
    b = robot("b", [go("east", (40.0, 3.0, 0.0))], home=(0.0, 3.0, 0.0))
    (verdict,) = separation(a, b, position_error=0.1)
    assert verdict.status is Status.VIOLATED
    assert verdict.margin == pytest.approx(-0.2)


def test_different_heights_keep_robots_apart():
    a = robot("a", [go("east", (40.0, 0.0, 0.0))])
    b = robot("b", [go("north", (20.0, 20.0, 5.0))], home=(20.0, -20.0, 5.0))
    assert [verdict.status for verdict in separation(a, b)] == [Status.SAFE]


def test_following_at_a_distance_is_safe():
    a = robot("a", [go("east", (60.0, 0.0, 0.0))], home=(10.0, 0.0, 0.0))
    b = robot("b", [go("east", (40.0, 0.0, 0.0))])
    assert [verdict.status for verdict in separation(a, b)] == [Status.SAFE]


def test_stopping_in_the_way_is_violated():
    a = robot("a", [go("east", (20.0, 0.0, 0.0))], home=(10.0, 0.0, 0.0))
    b = robot("b", [go("east", (40.0, 0.0, 0.0))])
    (verdict,) = separation(a, b)
    assert (verdict.status, verdict.robot) == (Status.VIOLATED, "a")


@pytest.mark.parametrize(("overshoot", "status"), [(0.1, Status.SAFE), (0.2, Status.VIOLATED)])
def test_a_robot_that_stops_late_may_come_too_near_to_what_is_ahead(overshoot, status):
    a = robot("a", [go("east", (20.0, 0.0, 0.0))])
    b = robot("b", [hold("look", 60.0)], home=(23.3, 0.0, 0.0))
    (verdict,) = separation(a, b, robot_kind=kind(overshoot=overshoot))
    assert verdict.status is status
    assert ("a: beyond the end of 'east' is 2.90 m from b" in verdict.message) == (status is Status.VIOLATED)


def test_a_robot_that_stops_late_is_there_only_as_it_comes():
    a = robot("a", [hold("late", 20.0), go("east", (20.0, 0.0, 0.0))])
    b = robot("b", [hold("look", 20.0), go("away", (23.3, 60.0, 0.0))], home=(23.3, 0.0, 0.0))
    (verdict,) = separation(a, b, robot_kind=kind(overshoot=0.2))
    assert verdict.status is Status.SAFE


def test_a_robot_is_not_beyond_the_end_of_a_movement_while_it_does_something_before_that():
    drone = robot_type(devices={"camera": {"Film": 10.0}})
    a = robot("a", [go("east", (20.0, 0.0, 0.0), before=(use("camera", "Film"),))], home=(18.0, 0.0, 0.0))
    b = robot("b", [hold("look", 8.0), go("away", (23.3, 60.0, 0.0))], home=(23.3, 0.0, 0.0))
    (verdict,) = separation(a, b, type=drone, robot_kind=kind(overshoot=0.2))
    assert verdict.status is Status.SAFE


def test_to_wait_until_another_arrives_is_not_to_wait_until_it_is_back():
    a = robot("a", [go("east", (20.0, 0.0, 0.0), after=(notify("b.go"),))])
    moves = [hold("before", 0.0), go("north", (23.3, 30.0, 0.0))]
    b = robot("b", moves, waits={"before": ["go"]}, slots=["go"], home=(23.3, -4.0, 0.0))
    status = {
        overshoot: {each.status for each in separation(a, b, robot_kind=kind(overshoot=overshoot))}
        for overshoot in (0.0, 0.4)
    }
    assert status[0.0] == {Status.SAFE}
    assert Status.SAFE not in status[0.4]


def test_a_robot_is_beyond_the_first_of_two_legs_of_a_movement_before_that_is_over():
    goes = ("urn:mmrs:behaviour:1.0", "GoTo")
    around = replace(
        MOVE_KINDS[goes], path=lambda move, here, home: (here, (20.0, 0.0, 0.0), (20.0, 99.0, 0.0))
    )
    detour = ("urn:mmrs:test:1.0", "Around")
    first = go("around", (20.0, 99.0, 0.0))
    a = robot("a", [replace(first, metaclasses=(detour, *first.metaclasses))])
    b = robot("b", [hold("look", 20.0), go("off", (23.3, -90.0, 0.0))], home=(23.3, 0.0, 0.0))
    moves = {**MOVE_KINDS, detour: replace(around, metaclass=detour)}
    status = {
        overshoot: {
            each.status for each in separation(a, b, robot_kind=kind(overshoot=overshoot), moves=moves)
        }
        for overshoot in (0.0, 0.4)
    }
    assert status[0.0] == {Status.SAFE}
    assert Status.SAFE not in status[0.4]


def charging_before_it_crosses(wait=None):
    """Return two robots whose ways cross; the second charges first, and may wait for the other one."""
    a, b = crossing(wait)
    return a, replace(b, moves=(b.moves[0], recharge("before", 20.0), *b.moves[2:]))


def test_a_robot_whose_charging_an_operator_may_end_at_once_is_not_kept_apart_by_that():
    (verdict,) = separation(*charging_before_it_crosses())
    assert (verdict.status, verdict.move) == (Status.UNKNOWN, "east")
    assert "let one wait for the other" in verdict.message


def test_a_robot_that_charges_and_waits_for_the_other_is_safe_whenever_its_charging_ends():
    assert [verdict.status for verdict in separation(*charging_before_it_crosses("go"))] == [Status.SAFE]


def test_robots_that_charge_are_safe_only_as_long_as_they_do_so_for_no_longer_than_counted():
    a = robot("a", [recharge("charge", 30.0)])
    b = robot("b", [go("east", (40.0, 9.0, 0.0))], home=(0.0, 9.0, 0.0))
    (verdict,) = separation(a, b)
    assert verdict.status is Status.SAFE
    assert verdict.caveat.startswith("provided that a charges for no longer than checks count")
    (other,) = separation(b, robot("c", [hold("look", 30.0)]))
    assert other.caveat == ""


def test_all_of_the_stretch_beyond_a_target_counts():
    a = robot("a", [go("east", (20.0, 0.0, 0.0))])
    b = robot("b", [hold("look", 60.0)], home=(20.5, 2.98, 0.0))
    (verdict,) = separation(a, b, robot_kind=kind(overshoot=0.5))
    assert (verdict.status, verdict.margin) == (Status.UNKNOWN, pytest.approx(-0.02))


def test_holding_in_the_way_is_violated():
    moves = [go("east", (20.0, 0.0, 0.0)), hold("look", 60.0), go("off", (20.0, 90.0, 0.0))]
    a = robot("a", moves, home=(10.0, 0.0, 0.0))
    b = robot("b", [hold("late", 10.0), go("east", (40.0, 0.0, 0.0))])
    (verdict,) = separation(a, b)
    assert (verdict.status, verdict.move) == (Status.VIOLATED, "look")


def flights(second_waits):
    moves = [take_off("up", 10.0), go("over", (20.0, 0.0, 10.0)), land("down", after=(notify("b.go"),))]
    a = robot("a", moves, home=(0.0, 0.0, 0.0))
    waits = {"start": ["go"]} if second_waits else {}
    b = robot("b", [take_off("up", 10.0), land("down")], waits=waits, slots=["go"], home=(1.0, 0.0, 0.0))
    return separation(a, b, robot_kind=kind(launches=True))


def test_a_robot_may_stand_beside_the_home_that_another_leaves_upright_and_is_named_for_it():
    (verdict,) = flights(second_waits=True)
    assert verdict.status is Status.SAFE
    assert "a and b (1.00 m)" in verdict.caveat


@pytest.mark.parametrize(("north", "status"), [(0.0, Status.VIOLATED), (3.1, Status.SAFE)])
def test_robots_that_nobody_runs_stand_at_their_homes(north, status):
    idle = robot("idle", [], home=(20.0, north, 0.0))
    (verdict,) = separation(robot("a", [go("east", (40.0, 0.0, 0.0))]), idle=(idle,))
    assert verdict.status is status


def test_launching_side_by_side_is_violated():
    assert [verdict.status for verdict in flights(second_waits=False)] == [Status.VIOLATED]


def test_a_move_of_an_unknown_kind_leaves_it_undecided():
    a = robot("a", [strange("dig")])
    b = robot("b", [], home=(50.0, 0.0, 0.0))
    assert [verdict.status for verdict in separation(a, b)] == [Status.UNKNOWN]


def test_a_chain_of_waits_keeps_robots_apart():
    a = robot("a", [go("east", (40.0, 0.0, 0.0)), go("off", (40.0, 40.0, 0.0), after=(notify("c.go"),))])
    c = robot("c", [hold("pass", after=(notify("b.go"),))], waits={"start": ["go"]}, home=(90.0, 90.0, 0.0))
    b = robot("b", [go("north", (20.0, 20.0, 0.0))], waits={"start": ["go"]}, home=(20.0, -20.0, 0.0))
    assert [verdict.status for verdict in separation(a, b, c, moves=uneven())] == [Status.SAFE]


def test_robots_that_stand_at_their_homes_are_excused():
    a = robot("a", [hold("rest", 5.0)])
    b = robot("b", [hold("idle", 500.0)], home=(0.0, 2.0, 0.0))
    (verdict,) = separation(a, b)
    assert (verdict.status, "a and b (2.00 m)" in verdict.caveat) == (Status.SAFE, True)


def test_a_robot_that_moves_off_sideways_beside_the_home_of_another_is_violated():
    a = robot("a", [go("east", (40.0, 0.0, 0.0)), go("back", (0.0, 0.0, 0.0))])
    b = robot("b", [hold("idle", 500.0)], home=(0.0, 2.0, 0.0))
    assert [verdict.status for verdict in separation(a, b)] == [Status.VIOLATED]


FLYERS = {"robot_kind": kind(launches=True)}


def flight(name, home, *places, at=10.0, before=0.0, slots=(), waits=None):
    """Return a robot that takes off, goes to these places at one height and lands at the last one."""
    moves = [hold("late", before), take_off("up", at)]
    moves += [go(f"to {i}", (*place, at)) for i, place in enumerate(places)]
    return robot(name, [*moves, land("down")], home=home, slots=slots, waits=waits or {})


@pytest.mark.parametrize("moves", [None, uneven()], ids=["exact times", "uncertain times"])
@pytest.mark.parametrize(
    ("place", "at", "apart"),
    [
        pytest.param((30.0, 0.3), 10.0, 0.3, id="lands beside one that has landed"),
        pytest.param((90.0, 0.0), 1.2, 1.2, id="flies low over one that has landed"),
    ],
)
def test_a_robot_that_has_landed_keeps_its_place(place, at, apart, moves):
    more = FLYERS | ({"moves": moves} if moves else {})
    a = flight("a", (0.0, 0.0, 0.0), (30.0, 0.0))
    b = flight("b", (0.0, 0.3 if at < 2 else 20.0, 0.0), (0.0, 0.0), place, at=at, before=500.0)
    (verdict,) = separation(a, b, **more)
    assert verdict.status is Status.VIOLATED
    assert verdict.margin == pytest.approx(apart - 3.0, abs=1e-6)


def test_a_robot_that_waits_to_launch_keeps_its_place():
    a = flight("a", (30.0, 0.0, 0.0), before=500.0)
    b = flight("b", (0.0, 0.0, 0.0), (30.0, 0.5))
    (verdict,) = separation(a, b, **FLYERS)
    assert (verdict.status, verdict.margin) == (Status.VIOLATED, pytest.approx(-2.5))


def test_landing_at_the_home_of_another_that_is_there_is_not_excused():
    a = flight("a", (1.0, 0.0, 0.0))
    b = flight("b", (0.0, 0.0, 0.0), (20.0, 0.0), (1.0, 0.0), before=500.0)
    assert [verdict.status for verdict in separation(a, b, **FLYERS)] == [Status.VIOLATED]


@pytest.mark.parametrize(
    ("home", "at", "status"),
    [
        pytest.param((0.0, 0.0, 2.0), 10.0, Status.VIOLATED, id="takes off through one above"),
        pytest.param((0.0, 0.0, 2.0), 2.0, Status.VIOLATED, id="hovers where one is parked"),
        pytest.param((0.05, 0.0, 2.9), 10.0, Status.VIOLATED, id="takes off past one above"),
        pytest.param((0.0, 0.0, 0.0), 10.0, Status.VIOLATED, id="at one place"),
        pytest.param((0.0, 2.0, 0.5), 10.0, Status.SAFE, id="on a slope"),
    ],
)
def test_a_robot_above_its_home_is_excused_only_as_far_from_another_as_their_homes_are(home, at, status):
    moves = [take_off("up", at), hold("look", 60.0), land("down")]
    robots = robot("a", moves, home=(0.0, 0.0, 0.0)), robot("c", [], home=home)
    assert [verdict.status for verdict in separation(*robots, **FLYERS)] == [status]


def test_a_column_ends_where_its_robot_leaves_it_sideways():
    """Level flight 2 m above the own home, 1 m beside a robot that waits there, is not straight up."""
    a = flight("a", (1.0, 0.0, 0.0), before=500.0)
    low = flight("b", (0.0, 0.0, 0.0), (20.0, 0.0), (0.0, 0.0), at=2.0)
    high = flight("b", (0.0, 0.0, 0.0), (20.0, 0.0), (0.0, 0.0), at=4.0)
    assert [verdict.status for verdict in separation(a, low, **FLYERS)] == [Status.VIOLATED]
    assert [verdict.status for verdict in separation(a, high, **FLYERS)] == [Status.SAFE]


def test_a_robot_that_certainly_hovers_in_the_way_is_violated_however_uncertain_times_are():
    a = robot("a", [hold("look", 400.0)], home=(20.0, 0.0, 0.0))
    b = robot("b", [hold("late", 10.0), go("east", (40.0, 0.0, 0.0))])
    (verdict,) = separation(a, b, moves=uneven())
    assert (verdict.status, verdict.margin) == (Status.VIOLATED, pytest.approx(-3.0))


@pytest.mark.parametrize("moves", [None, uneven()], ids=["exact times", "uncertain times"])
@pytest.mark.parametrize(
    ("least", "status", "apart"),
    [(3.0, Status.VIOLATED, 1.2), (1.3, Status.VIOLATED, 1.2), (1.1, Status.UNKNOWN, -1.2)],
)
def test_curves_of_a_robot_take_no_more_certainty_than_their_radius(least, status, apart, moves):
    """One drives through another that is parked, off the line by its turning radius at most."""
    more = {"robot_kind": kind(turning_radius=1.2)} | ({"moves": moves} if moves else {})
    a = robot("a", [go("east", (40.0, 0.0, 0.0))], home=(0.0, 0.0, 0.0))
    (verdict,) = separation(a, robot("c", [], home=(20.0, 0.0, 0.0)), least=least, **more)
    assert (verdict.status, "is at most" in verdict.message) == (status, status is Status.VIOLATED)
    assert verdict.margin == pytest.approx(apart - least)


def test_a_robot_that_waits_for_the_one_that_passes_it_is_violated_though_no_time_is_certain():
    leave = go("off", (20.0, 90.0, 0.0))
    a = robot("a", [leave], waits={"start": ["go"]}, slots=["go"], home=(20.0, 0.0, 0.0))
    b = robot("b", [hold("late", 10.0), go("east", (40.0, 0.0, 0.0), after=(notify("a.go"),))])
    (verdict,) = separation(a, b, moves=uneven(0.01, 100.0))
    assert (verdict.status, verdict.move) == (Status.VIOLATED, "start")


def swap(aside=0.0, *detour):
    """Return two robots that swap their places on one line, 80 m apart; the second may make a detour."""
    a = flight("a", (0.0, 0.0, 0.0), (80.0, 0.0))
    return a, flight("c", (80.0, aside, 0.0), *detour, (0.0, aside), before=50.0)


@pytest.mark.parametrize("aside", [0.0, 2.5])
def test_robots_that_swap_places_on_nearly_one_line_meet_however_long_their_moves_take(aside):
    (verdict,) = separation(*swap(aside), moves=uneven(0.1, 10.0), **FLYERS)
    assert verdict.status is Status.VIOLATED
    assert "cannot pass each other" in verdict.message


def test_robots_that_swap_places_but_for_a_detour_are_undecided():
    (verdict,) = separation(*swap(0.0, (60.0, 20.0), (40.0, 0.0)), moves=uneven(0.1, 10.0), **FLYERS)
    assert verdict.status is Status.UNKNOWN


def test_robots_on_a_line_of_which_one_may_wait_for_the_other_elsewhere_are_undecided():
    a = robot("a", [go("out", (0.0, 80.0, 0.0)), go("back", (0.0, 0.0, 0.0)), go("on", (40.0, 0.0, 0.0))])
    c = robot("c", [go("over", (0.0, 0.0, 0.0)), go("away", (0.0, -80.0, 0.0))], home=(40.0, 0.0, 0.0))
    assert [verdict.status for verdict in separation(a, c, moves=uneven())] == [Status.UNKNOWN]


def test_a_robot_that_may_have_gone_before_another_passes_is_undecided():
    a = robot("a", [hold("look", 8.0), go("off", (20.0, 90.0, 0.0))], home=(20.0, 0.0, 0.0))
    b = robot("b", [go("east", (40.0, 0.0, 0.0))])
    assert [verdict.status for verdict in separation(a, b, moves=uneven())] == [Status.UNKNOWN]


def test_the_nearest_approach_of_moving_robots_is_exact():
    """Two robots at right angles, 2 m/s each, the second 4 m behind: nearest at 4 / sqrt(2) m."""
    a, b = crossing(before=2.0)
    (verdict,) = separation(a, b, least=3.0)
    assert verdict.margin == pytest.approx(4.0 / 2.0**0.5 - 3.0, abs=0.01)
    assert [verdict.status for verdict in separation(a, b, least=2.82)] == [Status.SAFE]
