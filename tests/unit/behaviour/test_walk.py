"""Moves as a graph."""

from mmrs_core.behaviour.walk import (
    components,
    in_order,
    moves_reaching_stop,
    reachable,
    reachable_moves,
    reversed_graph,
    successors,
)
from mmrs_core.testing.small_programs import hold, robot


def looped():
    """start, a, b (to c, or back to a), c, stop."""
    return robot("r", [hold("a"), hold("b"), hold("c")], choices={"b": ("c", "c", "a")})


def test_both_arms_of_a_choice_follow_it():
    assert successors(looped()) == ((1,), (2,), (3, 1), (4,), ())


def test_equal_arms_follow_once():
    each = robot("r", [hold("a"), hold("b")], choices={"a": ("c", "b", "b")})
    assert successors(each)[1] == (2,)


def test_a_move_that_is_jumped_over_is_not_reachable():
    each = robot("r", [hold("a"), hold("b"), hold("c")], jumps={"a": "c"})
    assert reachable_moves(each) == {0, 1, 3, 4}


def test_moves_in_a_cycle_without_a_way_out_do_not_reach_stop():
    each = robot("r", [hold("a"), hold("b"), hold("c")], jumps={"b": "a"})
    assert moves_reaching_stop(each) == {3, 4}


def test_moves_come_in_order_with_what_follows_later():
    each = robot("r", [hold("a"), hold("b"), hold("c")], jumps={"a": "c", "c": "b", "b": "stop"})
    assert in_order(each) == (0, 1, 3, 2, 4)


def test_moves_that_nothing_leads_to_are_not_in_order():
    each = robot("r", [hold("a"), hold("b"), hold("c")], jumps={"a": "c"})
    assert 2 not in in_order(each)


def test_components_agree_with_mutual_reachability():
    graph = ((1, 2), (3,), (4,), (1, 5), (2, 0), (), (6, 5))
    for part in components(graph):
        for node in part:
            mutual = {n for n in reachable(graph, (node,)) if node in reachable(graph, (n,))}
            assert mutual == set(part)


def test_turning_a_graph_round_twice_gives_it_back():
    graph = ((1, 2), (2,), ())
    assert reversed_graph(reversed_graph(graph)) == graph


def test_a_long_chain_needs_no_deep_recursion():
    each = robot("r", [hold(f"h{index}") for index in range(20_000)])
    assert len(in_order(each)) == 20_002
