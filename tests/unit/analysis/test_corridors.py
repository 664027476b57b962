"""Corridors of entry and exit, worked out by hand: robots of half a diagonal of 0.5 m, a gate 6 m wide."""

from dataclasses import replace

import pytest
from checking import finding, findings, given, kind, land, recharge, square, take_off

from mmrs_core.contributions.checks import Status
from mmrs_core.scene import Corridor
from mmrs_core.testing.small_programs import go, hold, robot, use

GATE = Corridor("gate", ((10.0, 0.0), (50.0, 0.0)), 6.0)
LAUNCHES = {"robot_kind": kind(launches=True)}


def through(*moves, corridors=(GATE,), **more):
    """Return the verdict on one robot at (0, 0, 0) that makes these moves."""
    return finding("corridors", given(robot("a", moves), areas=(), corridors=corridors, **more))


def path(name, *places):
    """Return transit through places, (east, north)."""
    return [go(f"{name} {k}", (*place, 0.0), task="t", rule="transit") for k, place in enumerate(places)]


def work(east=80.0, north=0.0, name="work"):
    return go(name, (east, north, 0.0), task="t", rule="visit")


def out_and_in(north=0.0, west=10.0, east=50.0, back=None):
    """Return moves to a task and home again, along a line at the same distance from the gate's."""
    home = north if back is None else back
    there = path("out", (west, north), (east, north), (80.0, north))
    return [*there, work(north=north), *path("back", (east, home), (west, home), (0.0, 0.0))]


def test_the_spare_room_is_half_the_width_less_half_the_diagonal_less_how_far_the_path_is_off_the_line():
    verdict = through(*out_and_in())
    assert (verdict.status, verdict.margin) == (Status.SAFE, pytest.approx(2.5, abs=1e-5))
    verdict = through(*out_and_in(north=1.0))
    assert verdict.margin == pytest.approx(1.5, abs=1e-5)
    verdict = through(*out_and_in(), position_error=0.7)
    assert verdict.margin == pytest.approx(1.8, abs=1e-5)


def test_a_path_that_is_too_far_aside_is_outside_by_so_much_at_a_place():
    verdict = through(*out_and_in(north=4.0))
    assert (verdict.status, verdict.margin) == (Status.VIOLATED, pytest.approx(-1.5, abs=1e-5))
    assert verdict.message.startswith(
        "a: the path to task 't' leads through no corridor: it is outside of 'gate' by 1.50 m"
    )
    assert "GoTo 'out" in verdict.message


IN, OUT = path("out", (10.0, 0.0), (50.0, 0.0)), path("back", (50.0, 0.0), (10.0, 0.0), (0.0, 0.0))


@pytest.mark.parametrize(
    ("moves", "words"),
    [
        ([work(), *OUT], "the path to task 't'"),
        ([*IN, work(), *path("back", (80.0, 40.0), (0.0, 0.0))], "the path home from task 't'"),
        ([*path("out", (30.0, 40.0), (30.0, 0.0), (50.0, 0.0)), work(), *OUT], "the path to task 't'"),
        ([*path("out", (10.0, 0.0), (30.0, 0.0), (30.0, 40.0)), work(), *OUT], "the path to task 't'"),
        ([*path("out", (60.0, 30.0), (50.0, 0.0), (10.0, 0.0)), work(), *OUT], "the path to task 't'"),
    ],
)
def test_the_whole_corridor_is_passed_in_its_direction(moves, words):
    verdict = through(*moves)
    assert verdict.status is Status.VIOLATED
    assert words in verdict.message


def test_waiting_in_a_corridor_does_no_harm():
    there = path("out", (10.0, 0.0), (30.0, 0.0))
    verdict = through(*there, hold("wait", 5.0), *path("on", (50.0, 0.0)), *out_and_in()[3:])
    assert (verdict.status, verdict.margin) == (Status.SAFE, pytest.approx(2.5, abs=1e-5))


def test_a_path_that_cuts_across_from_one_leg_of_a_bent_corridor_to_the_other_does_not_follow_it():
    bent = Corridor("bend", ((0.0, 0.0), (100.0, 0.0), (100.0, 4.0), (0.0, 4.0)), 6.0, use="ENTRY")
    assert (
        through(*path("out", (100.0, 0.0), (100.0, 4.0), (0.0, 4.0)), work(), corridors=(bent,)).status
        is Status.SAFE
    )
    verdict = through(*path("out", (40.0, 0.0), (40.0, 4.0), (0.0, 4.0)), work(), corridors=(bent,))
    assert verdict.status is Status.VIOLATED
    assert verdict.margin < -50.0


def test_of_several_corridors_any_will_do_in_each_direction():
    other = replace(GATE, name="south gate", line=((10.0, -40.0), (50.0, -40.0)))
    verdict = through(*out_and_in(back=-40.0), corridors=(GATE, other))
    assert verdict.status is Status.SAFE


@pytest.mark.parametrize(("use", "margin"), [("ENTRY", 2.5), ("EXIT", -37.5)])
def test_a_direction_that_no_corridor_has_is_free(use, margin):
    verdict = through(*out_and_in(back=40.0), corridors=(replace(GATE, use=use),))
    assert verdict.margin == pytest.approx(margin, abs=1e-5)


def test_heights_are_kept_by_half_the_diagonal():
    def flight(up):
        moves = [take_off("up", up, task="t", rule="launch")]
        moves += [go(f"out {x}", (x, 0.0, up), task="t", rule="transit") for x in (10.0, 50.0)]
        moves += [go("work", (80.0, 0.0, up), task="t", rule="visit")]
        moves += [go(f"back {x}", (x, 0.0, up), task="t", rule="transit") for x in (50.0, 10.0, 0.0)]
        return [*moves, land("land", rule="recover")]

    high = replace(GATE, low=30.0, high=40.0)
    assert through(*flight(32.0), corridors=(high,), **LAUNCHES).margin == pytest.approx(1.5, abs=1e-5)
    verdict = through(*flight(20.0), corridors=(high,), **LAUNCHES)
    assert (verdict.status, verdict.margin) == (Status.VIOLATED, pytest.approx(-10.5, abs=1e-5))


def test_every_sortie_counts():
    moves = [
        *out_and_in(),
        recharge("full", 60.0),
        work(name="second"),
        *path("home", (50.0, 0.0), (10.0, 0.0), (0.0, 0.0)),
    ]
    verdict = through(*moves)
    assert verdict.status is Status.VIOLATED
    assert "the path to task 't'" in verdict.message


def test_between_tasks_a_robot_goes_where_it_likes():
    there, home = path("out", (10.0, 0.0), (50.0, 0.0)), path("back", (50.0, 0.0), (10.0, 0.0), (0.0, 0.0))
    assert (
        through(*there, work(), *path("on", (-50.0, 70.0)), work(90.0, name="next"), *home).status
        is Status.SAFE
    )


def test_each_branch_of_a_choice_comes_through():
    def split(other):
        moves = [*path("out", (10.0, 0.0)), hold("test", rule="choice"), *path("one", (50.0, 0.0)), work()]
        moves += [
            *path("home", (50.0, 0.0), (10.0, 0.0), (0.0, 0.0)),
            *path("two", other),
            work(name="other"),
        ]
        moves += path("again", (50.0, 0.0), (10.0, 0.0), (0.0, 0.0))
        arms = {"test": ("windy", "one 0", "two 0")}
        made = robot("a", moves, choices=arms, jumps={"home 2": "stop"})
        return finding("corridors", given(made, areas=(), corridors=(GATE,)))

    assert split((50.0, 0.0)).status is Status.SAFE
    assert split((50.0, 30.0)).status is Status.VIOLATED


def test_a_robot_that_ends_in_the_field_needs_no_exit_and_that_is_said():
    verdict = through(*out_and_in()[:4])
    assert verdict.status is Status.SAFE
    assert verdict.caveat == "it ends 80 m from its home, so that no exit is asked for"


def test_a_robot_that_ends_where_it_has_worked_needs_no_exit():
    there = path("out", (10.0, 0.0), (50.0, 0.0), (-50.0, 40.0))
    aside = go("aside", (-50.0, 40.0, 0.0), task="aside", rule="visit")
    back = path("back", (-50.0, 40.0))
    verdict = through(*there, aside, work(), *back)
    assert verdict.status is Status.SAFE
    assert verdict.caveat == "it ends 64 m from its home, so that no exit is asked for"
    assert through(*there[:2], work(), *back).status is Status.VIOLATED


def test_a_branch_without_work_that_ends_where_another_one_works_comes_in_only():
    def split(*other, then=()):
        moves = [hold("test", rule="choice"), *path("one", (10.0, 0.0), (50.0, 0.0)), work()]
        moves += [*path("two", *other, (80.0, 0.0)), *then]
        arms = {"test": ("windy", "one 0", "two 0")}
        made = robot("a", moves, choices=arms, jumps={"work": "stop"})
        return finding("corridors", given(made, areas=(), corridors=(GATE,)))

    verdict = split((10.0, 0.0), (50.0, 0.0))
    assert verdict.status is Status.SAFE
    assert verdict.caveat == "it ends 80 m from its home, so that no exit is asked for"
    assert split((10.0, 30.0)).status is Status.VIOLATED
    lost = go("lost", (0.0, 0.0, 0.0), task="t", rule="transit")
    lost = replace(lost, target=replace(lost.target, position=None))
    assert split((10.0, 0.0), (50.0, 0.0), then=(lost,)).status is Status.UNKNOWN


def test_a_robot_that_ends_before_the_corridor_comes_out_through_it():
    beside = [*out_and_in()[:4], *path("back", (80.0, 40.0), (2.0, 3.0))]
    assert through(*beside).status is Status.VIOLATED
    assert through(*out_and_in()[:-1], *path("end", (2.0, 3.0))).status is Status.SAFE
    in_front = [*out_and_in()[:4], work(2.0, 3.0, name="in front"), *path("end", (2.0, 4.0))]
    assert through(*in_front).status is Status.SAFE


def test_what_devices_do_at_home_is_not_work():
    moves = out_and_in()
    start = replace(hold("test", 1.0), after=(use("camera", "photo"),))
    end = replace(hold("save", 1.0), before=(use("camera", "photo"),))
    assert through(start, *moves, end).status is Status.SAFE
    first = replace(moves[0], before=(use("camera", "photo"),))
    assert through(first, *moves[1:]).status is Status.SAFE


@pytest.mark.parametrize(
    ("north", "status"), [(0.0, Status.SAFE), (1.0, Status.SAFE), (30.0, Status.UNKNOWN)]
)
def test_a_branch_without_work_comes_through_in_and_out(north, status):
    out = path("out", (10.0, north), (50.0, north), (80.0, north))
    back = path("back", (50.0, north), (10.0, north), (0.0, 0.0))
    without = [*out, *back, recharge("charge", 60.0)]
    assert through(*without, *out_and_in()).status is status
    assert through(*without).status is Status.UNKNOWN


def test_a_branch_without_work_comes_in_before_it_goes_out():
    beside = path("beside", (0.0, 40.0), (60.0, 40.0), (50.0, 0.0), (10.0, 0.0))
    again = path("again", (50.0, 0.0), (60.0, -40.0), (0.0, -40.0), (0.0, 0.0))
    moves = [*beside, *again, recharge("charge", 60.0), *out_and_in()]
    assert through(*moves).status is Status.UNKNOWN


def test_actions_of_devices_are_work_whatever_the_move_says():
    photo = go("photo", (0.0, 30.0, 0.0), task="t", rule="transit", after=(use("camera", "photo"),))
    assert through(photo, *out_and_in()).status is Status.VIOLATED


def test_moves_that_name_no_task_leave_it_unknown():
    verdict = through(go("there", (80.0, 0.0, 0.0)), go("home", (0.0, 0.0, 0.0)))
    assert verdict.status is Status.UNKNOWN
    assert "names the task that it serves" in verdict.message


def test_a_place_that_is_not_known_leaves_it_unknown_unless_the_rest_leads_through():
    lost = go("lost", (0.0, 0.0, 0.0), task="t", rule="transit")
    lost = replace(lost, target=replace(lost.target, position=None))
    assert through(lost, *out_and_in()).status is Status.SAFE
    verdict = through(lost, *out_and_in(north=9.0, back=0.0))
    assert verdict.status is Status.UNKNOWN


def test_a_robot_that_needs_room_to_turn_keeps_it_from_the_sides():
    verdict = through(*out_and_in(), robot_kind=kind(turning_radius=2.0))
    assert verdict.margin == pytest.approx(0.5, abs=1e-5)


def test_a_corner_that_is_cut_on_the_way_in_takes_room():
    moves = [*path("out", (10.0, 0.0), (50.0, 0.0), (50.0, 30.0)), work(50.0, 60.0), *out_and_in()[4:]]
    made = robot("a", moves, fluid=("out 1",))
    verdict = finding("corridors", given(made, areas=(), corridors=(GATE,)))
    assert verdict.margin == pytest.approx(0.5, abs=1e-5)


def test_stopping_late_takes_room():
    verdict = through(*out_and_in(), robot_kind=kind(overshoot=0.5))
    assert verdict.margin == pytest.approx(1.5, abs=1e-5)


def test_a_corridor_that_is_too_narrow_for_the_robot_lets_nothing_through():
    verdict = through(*out_and_in(), corridors=(replace(GATE, width=0.6),))
    assert (verdict.status, verdict.margin) == (Status.VIOLATED, pytest.approx(-0.2, abs=1e-5))


def test_robots_of_other_types_are_not_checked():
    verdict = through(work(), corridors=(replace(GATE, types=frozenset({"drone"})),))
    assert (verdict.status, verdict.message) == (
        Status.NOT_CHECKED,
        "a: no corridor of the context is for its type",
    )


def test_a_robot_that_stays_at_home_is_not_checked():
    assert through().message == "a: it leaves home for no task"


def test_without_corridors_or_a_context_nothing_is_checked():
    assert findings("corridors", given(robot("a", [work()]), areas=(square(),))) == ()
    assert finding("corridors", given(robot("a", [work()]))).message == "a: no context was given"
