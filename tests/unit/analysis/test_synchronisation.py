"""Who waits for ever, and why."""

import pytest
from checking import finding, findings, given

from mmrs_core.analysis.synchronisation.check import verdicts_of
from mmrs_core.analysis.synchronisation.exploration import find_stuck
from mmrs_core.analysis.synchronisation.fixpoint import must_fixpoint
from mmrs_core.analysis.synchronisation.network import network_of
from mmrs_core.analysis.synchronisation.search import LimitExceededError, find_trap, follow
from mmrs_core.contributions.checks import Status
from mmrs_core.errors import InternalError
from mmrs_core.testing.small_programs import hold, notify, program, robot


def messages(*robots):
    return [verdict.message for verdict in findings("synchronisation", given(*robots))]


def test_robots_that_do_not_wait_are_safe():
    verdict = finding("synchronisation", given(robot("a", [hold("h")])))
    assert (verdict.status, verdict.message) == (Status.SAFE, "no robot waits for another")


def test_two_robots_that_tell_each_other_are_safe():
    a = robot("a", [hold("h", after=(notify("b.go"),))], waits={"h": ["go"]})
    b = robot("b", [hold("n", after=(notify("a.go"),))], waits={"n": ["go"]})
    assert finding("synchronisation", given(a, b)).status is Status.SAFE


def test_a_circle_of_waits_names_both_robots_and_the_reasons():
    a = robot("a", [hold("h"), hold("i", after=(notify("b.go"),))], waits={"h": ["go"]})
    b = robot("b", [hold("n"), hold("o", after=(notify("a.go"),))], waits={"n": ["go"]})
    found = findings("synchronisation", given(a, b))
    assert [(verdict.status, verdict.robot, verdict.move) for verdict in found] == [
        (Status.VIOLATED, "a", "h"),
        (Status.VIOLATED, "b", "n"),
    ]
    assert found[0].message == (
        "a: waits forever after HoldPosition 'h': 'go' would be activated by"
        " b on HoldPosition 'o', which itself waits forever"
    )


def test_a_slot_that_nobody_activates_is_named():
    a = robot("a", [hold("h")], waits={"h": ["go"]})
    assert messages(a, robot("b", [hold("n")])) == [
        "a: waits after HoldPosition 'h' for 'go', which no robot activates"
    ]


def test_a_slot_that_is_only_ever_made_inactive_is_never_activated():
    a = robot("a", [hold("h")], waits={"h": ["go"]})
    b = robot("b", [hold("n", after=(notify("a.go", active=False),))])
    assert messages(a, b) == ["a: waits after HoldPosition 'h' for 'go', which no robot activates"]


def test_who_waits_behind_an_orphaned_slot_is_named_too():
    a = robot("a", [hold("h"), hold("i", after=(notify("b.go"),))], waits={"h": ["never"]})
    b = robot("b", [hold("n")], waits={"n": ["go"]})
    found = findings("synchronisation", given(a, b))
    assert [(verdict.robot, verdict.move) for verdict in found] == [("a", "h"), ("b", "n")]


def test_an_arm_that_does_not_notify_is_named():
    a = robot("a", [hold("h")], waits={"h": ["go"]})
    moves = [hold("fork"), hold("tell", after=(notify("a.go"),)), hold("idle")]
    b = robot("b", moves, choices={"fork": ("c", "tell", "idle")}, jumps={"tell": "stop"})
    assert messages(a, b) == [
        "a: waits forever after HoldPosition 'h' if b continues with HoldPosition 'idle' after"
        " HoldPosition 'fork': 'go' would be activated by b on HoldPosition 'tell'"
    ]


def test_both_arms_notifying_is_safe():
    a = robot("a", [hold("h")], waits={"h": ["go"]})
    moves = [hold("fork"), hold("tell", after=(notify("a.go"),)), hold("say", before=(notify("a.go"),))]
    b = robot("b", moves, choices={"fork": ("c", "tell", "say")}, jumps={"tell": "stop"})
    assert finding("synchronisation", given(a, b)).status is Status.SAFE


def one_of_two_causes():
    """Return three robots whose Choices each tell one of two others, which go on with either.

    Whatever is chosen somebody is told; that is certain of no slot alone.
    """
    left, right = hold("left", after=(notify("b.go"),)), hold("right", after=(notify("c.go"),))
    a = robot(
        "a", [hold("fork"), left, right], choices={"fork": ("c", "left", "right")}, jumps={"left": "stop"}
    )
    b = robot("b", [hold("wait"), hold("tell", after=(notify("c.go"),))], waits={"wait": ["go"]})
    c = robot("c", [hold("wait"), hold("tell", after=(notify("b.go"),))], waits={"wait": ["go"]})
    return program(a, b, c)


def test_a_slot_with_either_of_two_causes_is_proved_by_the_search_alone():
    network = network_of(one_of_two_causes())
    certain = must_fixpoint(network)
    assert sorted(certain.blocked) == [1, 2]
    assert find_trap(network, certain.active) is None
    assert finding("synchronisation", given(*one_of_two_causes().robots)).status is Status.SAFE


def test_a_search_that_is_cut_short_is_no_answer():
    network = network_of(one_of_two_causes())
    with pytest.raises(LimitExceededError):
        find_trap(network, frozenset(), limit=1)


def test_a_search_that_is_cut_short_is_unknown():
    (verdict,) = verdicts_of(given(*one_of_two_causes().robots), limit=0)
    assert verdict.status is Status.UNKNOWN


def test_who_waits_for_ever_in_every_run_is_found_though_the_search_is_cut_short():
    a = robot("a", [hold("h", after=(notify("b.go", "d.never"),))], waits={"start": ["go"]})
    b = robot("b", [hold("i", after=(notify("a.go"),))], waits={"start": ["go"]})
    fork = {"fork": ("c", "left", "right")}
    c = robot("c", [hold("fork"), hold("left", after=(notify("d.go"),)), hold("right")], choices=fork)
    d = robot("d", [hold("n")], waits={"start": ["go"], "n": ["never"]}, slots=["go", "never"])
    found = list(verdicts_of(given(a, b, c, d), limit=0))
    stuck = {(verdict.robot, verdict.move) for verdict in found if verdict.status is Status.VIOLATED}
    assert stuck == {("a", "start"), ("b", "start"), ("d", "n")}
    assert found[-1].status is Status.UNKNOWN


def test_a_run_in_which_nobody_is_stuck_is_no_counterexample():
    network = network_of(program(robot("a", [hold("h", after=(notify("a.go"),))], waits={"h": ["go"]})))
    with pytest.raises(InternalError):
        follow(network, [(0,)])


def resetting(*, late):
    """Return a robot that activates a slot and takes it back, at once or after it is told to."""
    a = robot("a", [hold("h"), hold("i", before=(notify("b.done"),))], waits={"h": ["go"]})
    moves = [hold("set", after=(notify("a.go"),)), hold("reset", after=(notify("a.go", active=False),))]
    return (a, robot("b", moves, waits={"set": ["done"]} if late else {}, slots=["done"]))


def test_a_pulse_that_may_be_missed_is_violated():
    found = findings("synchronisation", given(*resetting(late=False)))
    assert [(verdict.robot, verdict.status) for verdict in found] == [("a", Status.VIOLATED)]
    assert "in some order of events" in found[0].message


def test_a_slot_that_is_taken_back_only_when_it_was_used_is_safe():
    assert finding("synchronisation", given(*resetting(late=True))).status is Status.SAFE


def token_pair(number):
    """Return two robots that share slots with each other only, one of which is taken back."""
    a, b = f"a{number}", f"b{number}"
    getter = robot(a, [hold("h"), hold("i", before=(notify(f"{b}.done"),))], waits={"h": ["go"]})
    moves = [hold("set", after=(notify(f"{a}.go"),)), hold("reset", after=(notify(f"{a}.go", active=False),))]
    return getter, robot(b, moves, waits={"set": ["done"]}, slots=["done"])


def test_robots_that_share_no_slots_are_judged_apart():
    found = findings("synchronisation", given(*(each for i in range(9) for each in token_pair(i))))
    assert [verdict.status for verdict in found] == [Status.SAFE] * 9
    assert found[3].message.startswith("a3, b3: every robot comes to its Stop in any order of events")


def test_who_only_takes_a_slot_back_shares_it():
    """The robot that waits may miss its own notify."""
    thief = robot("thief", [hold("h", before=(notify("a.go", active=False),))])
    waiting = robot("a", [hold("h", after=(notify("a.go"),))], waits={"h": ["go"]}, slots=["go"])
    (found,) = findings("synchronisation", given(thief, waiting))
    assert (found.robot, found.status) == ("a", Status.VIOLATED)


def test_a_robot_that_never_stops_leaves_others_decided():
    lost = robot("lost", [hold("h"), hold("i")], waits={"h": ["never"]}, slots=["never"])
    found = findings("synchronisation", given(lost, *token_pair(0)))
    assert [(verdict.status, verdict.robot) for verdict in found] == [
        (Status.VIOLATED, "lost"),
        (Status.SAFE, ""),
    ]


def test_too_many_orders_of_events_are_no_answer():
    with pytest.raises(LimitExceededError):
        find_stuck(network_of(program(*resetting(late=True))), limit=2)


def test_what_does_not_touch_slots_that_are_taken_back_costs_no_states():
    pair = resetting(late=True)
    others = [
        robot(f"c{i}", [hold("h", after=(notify(f"c{(i + 1) % 20}.go"),))], waits={"h": ["go"]})
        for i in range(20)
    ]
    assert find_stuck(network_of(program(*pair, *others)), limit=200) is None


def test_slots_set_by_one_notify_need_not_change_at_once():
    a = robot("a", [hold("h"), hold("i", before=(notify("b.x", "b.y", active=False),))], waits={"h": ["go"]})
    b = robot(
        "b",
        [hold("set", after=(notify("b.x", "b.y"), notify("a.go"))), hold("n"), hold("o")],
        waits={"n": ["x"], "o": ["y"]},
    )
    assert findings("synchronisation", given(a, b))[0].status is Status.VIOLATED


def test_a_robot_without_a_way_to_stop_leaves_the_rest_undecided():
    a = robot("a", [hold("h")], waits={"h": ["go"]})
    b = robot("b", [hold("n", after=(notify("a.go"),))], jumps={"n": "n"})
    verdict = finding("synchronisation", given(a, b))
    assert verdict.status is Status.UNKNOWN
    assert "no path leads from Start 'start' of b to Stop" in verdict.message


def test_moves_that_do_not_matter_are_passed_over():
    a = robot("a", [hold(f"m{number}") for number in range(100)], waits={"m50": ["go"]})
    b = robot("b", [hold("n", after=(notify("a.go"),))])
    assert [len(net.nodes) for net in network_of(program(a, b)).nets] == [2, 2]
