"""Ways from Start to Stop."""

from dataclasses import replace

import pytest
from checking import finding, findings, given

from mmrs_core.behaviour.program import Transition
from mmrs_core.contributions.checks import Status
from mmrs_core.testing.small_programs import go, hold, notify, robot

MOVES = [hold("one"), hold("two")]


def faults(made, *others):
    found = findings("structure", given(made, *others))
    return [
        verdict.message for verdict in found if verdict.robot == "a" and verdict.status is Status.VIOLATED
    ]


def test_a_chain_of_moves_is_safe():
    assert finding("structure", given(robot("a", MOVES))).status is Status.SAFE


def test_a_second_stop_is_violated():
    made = robot("a", MOVES)
    assert faults(
        replace(made, moves=(*made.moves[:-2], replace(made.moves[-1], id="end"), made.moves[-1]))
    ) == ["a: it has 2 Stop moves instead of exactly one"]


def test_a_loop_that_never_ends_is_violated_move_by_move():
    assert faults(robot("a", MOVES, jumps={"two": "one"})) == [
        "a: no path leads from Start 'start' to Stop",
        "a: no path leads from HoldPosition 'one' to Stop",
        "a: no path leads from HoldPosition 'two' to Stop",
    ]


def test_a_loop_that_a_choice_leaves_is_safe():
    made = robot("a", MOVES, choices={"two": ("again", "one", "stop")})
    assert finding("structure", given(made)).status is Status.SAFE


def test_a_move_without_a_transition_is_violated():
    made = robot("a", MOVES)
    cut = replace(made, transitions={0: made.transitions[0], 1: made.transitions[1]})
    assert faults(cut) == ["a: HoldPosition 'two' has no transition to a next move"]


@pytest.mark.parametrize(
    ("to", "words"), [(9, "the transition after 'two' leaves the robot"), (0, "leads back to Start")]
)
def test_a_transition_stays_inside_its_robot_and_out_of_start(to, words):
    made = robot("a", MOVES)
    assert words in faults(replace(made, transitions={**made.transitions, 2: Transition(2, to)}))[0]


def test_a_transition_out_of_stop_is_violated():
    made = robot("a", MOVES)
    leaving = replace(made, transitions={**made.transitions, 3: Transition(3, 1)})
    assert faults(leaving) == ["a: a transition leaves Stop 'stop'"]


def test_waiting_for_a_slot_that_is_not_its_own_is_violated():
    made = replace(robot("a", MOVES, waits={"one": ["go"]}), slots=())
    assert faults(made) == ["a: the transition after 'one' waits for 'go', which is not a slot of the robot"]


def test_notifying_a_slot_that_nobody_has_is_violated():
    made = robot("a", [hold("one", after=(notify("b.go"),))])
    assert faults(made, robot("b", [])) == ["a: 'one' notifies 'b.go', which is not a slot of any robot"]


def test_two_moves_of_one_name_are_violated():
    made = robot("a", [hold("one"), hold("two")])
    twice = replace(made, moves=(*made.moves[:2], replace(made.moves[2], id="one"), made.moves[3]))
    assert faults(twice) == ["a: 2 moves are called 'one'"]


def test_a_move_that_is_never_reached_is_named_but_harmless():
    made = robot("a", [hold("one"), go("dead", (1.0, 0.0, 0.0)), hold("two")], jumps={"one": "two"})
    verdict = finding("structure", given(made))
    assert (verdict.status, verdict.message) == (Status.SAFE, "a: every move is on a path from Start to Stop")


def test_a_task_that_is_never_reached_is_violated():
    lost = replace(go("photo", (1.0, 0.0, 0.0)), task="roof")
    made = robot("a", [hold("one"), lost, hold("two")], jumps={"one": "two"})
    verdict = finding("structure", given(made))
    assert (verdict.status, verdict.move, verdict.place) == (Status.VIOLATED, "photo", lost.place)
    assert verdict.message == ("a: GoTo 'photo' is never reached: its task 'roof' is not carried out there")


def test_actions_that_are_never_reached_are_violated():
    lost = hold("tell", after=(notify("a.done"),))
    made = replace(robot("a", [hold("one"), lost, hold("two")], jumps={"one": "two"}), slots=("done",))
    assert faults(made) == ["a: HoldPosition 'tell' is never reached: its actions are not carried out there"]
