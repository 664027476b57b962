"""The check of synchronisation against an exploration of all runs."""

import pytest
from hypothesis import assume, given, settings
from random_synchronisation import behaviours, deadlocks

from mmrs_core.analysis.synchronisation.check import SYNCHRONISATION
from mmrs_core.analysis.synchronisation.fixpoint import may_fixpoint, must_fixpoint
from mmrs_core.analysis.synchronisation.network import network_of
from mmrs_core.analysis.synchronisation.search import find_trap
from mmrs_core.behaviour.walk import moves_reaching_stop, reachable_moves
from mmrs_core.contributions.checks import CheckInput, Status


def found(behaviour):
    return {verdict.status for verdict in SYNCHRONISATION.run(CheckInput(behaviour, {}, {}, {}))}


def agrees(behaviour):
    """Compare, orphaned slots aside: these are reported though no run may come to wait for them.

    Robots that share no slots are judged apart, so that some may be safe beside others that are not.
    """
    network = network_of(behaviour)
    assume(not network.awaited - network.givers.keys())
    assume(all(reachable_moves(robot) <= moves_reaching_stop(robot) for robot in behaviour.robots))
    truth = deadlocks(behaviour)
    assume(truth is not None)
    told = found(behaviour)
    assert (Status.VIOLATED in told) == truth
    assert told <= {Status.SAFE, Status.VIOLATED}


@settings(max_examples=20, deadline=None)
@given(behaviours(choices=False))
def test_without_choices_the_check_finds_deadlocks_exactly(behaviour):
    agrees(behaviour)


@settings(max_examples=20, deadline=None)
@given(behaviours())
def test_with_choices_the_check_finds_deadlocks_exactly(behaviour):
    agrees(behaviour)


@settings(max_examples=20, deadline=None)
@given(behaviours(loops=True))
def test_with_loops_the_check_finds_deadlocks_exactly(behaviour):
    agrees(behaviour)


@settings(max_examples=20, deadline=None)
@given(behaviours(resets=True, loops=True))
def test_with_resets_a_deadlock_is_never_called_safe(behaviour):
    if deadlocks(behaviour):
        assert found(behaviour) != {Status.SAFE}


@settings(max_examples=20, deadline=None)
@given(behaviours(resets=True, loops=True).filter(lambda made: may_fixpoint(network_of(made)).blocked))
def test_robots_that_wait_for_ever_at_the_latest_make_a_deadlock(behaviour):
    assume(all(reachable_moves(robot) <= moves_reaching_stop(robot) for robot in behaviour.robots))
    assert deadlocks(behaviour) is not False


@settings(max_examples=20, deadline=None)
@given(behaviours(resets=True, loops=True, most=1))
def test_with_resets_and_notifies_to_single_slots_the_check_is_exact(behaviour):
    agrees(behaviour)


@settings(max_examples=20, deadline=None)
@given(behaviours())
def test_knowing_what_is_certain_does_not_change_what_the_search_finds(behaviour):
    network = network_of(behaviour)
    certain = must_fixpoint(network).active
    assert (find_trap(network, certain) is None) == (find_trap(network, frozenset()) is None)


@pytest.mark.thorough
@settings(max_examples=2000, deadline=None)
@given(behaviours(loops=True))
def test_many_behaviours_with_loops_and_choices_agree_with_the_exploration(behaviour):
    agrees(behaviour)


@pytest.mark.thorough
@settings(max_examples=200, deadline=None)
@given(behaviours(choices=False))
def test_many_behaviours_without_choices_agree_with_the_exploration(behaviour):
    agrees(behaviour)


@pytest.mark.thorough
@settings(max_examples=1500, deadline=None)
@given(behaviours(resets=True, loops=True, most=1))
def test_many_behaviours_with_resets_agree_with_the_exploration(behaviour):
    agrees(behaviour)
