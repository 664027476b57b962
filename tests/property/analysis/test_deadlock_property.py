"""The check of synchronisation against an exploration of all runs."""

from dataclasses import replace

from counts import many
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

    Robots that share no slots are judged apart: as many groups are safe as have no deadlock.
    """
    network = network_of(behaviour)
    assume(not network.awaited - network.givers.keys())
    assume(all(reachable_moves(robot) <= moves_reaching_stop(robot) for robot in behaviour.robots))
    truths = [deadlocks(replace(behaviour, robots=group)) for group in apart(behaviour)]
    assume(None not in truths)
    told = [verdict.status for verdict in SYNCHRONISATION.run(CheckInput(behaviour, {}, {}, {}))]
    assert set(told) <= {Status.SAFE, Status.VIOLATED}
    assert (Status.VIOLATED in told) == any(truths)
    assert told.count(Status.SAFE) == (truths.count(False) if truths else 1)


def apart(behaviour):
    """Return groups of robots none of which sets a slot that another waits for; no group without waits."""
    awaited = {(robot.id, slot) for robot in behaviour.robots for slot in waits_of(robot)}
    groups = [({robot.id}, [robot]) for robot in behaviour.robots]
    for robot in behaviour.robots:
        reached = (robot.moves[index] for index in reachable_moves(robot))
        actions = (action for move in reached for action in (*move.before, *move.after))
        names = {robot.id} | {slot[0] for action in actions for slot in action.sets if slot in awaited}
        met = [group for group in groups if group[0] & names]
        groups = [group for group in groups if group not in met]
        groups.append((set().union(*(ids for ids, _ in met)), [each for _, some in met for each in some]))
    return [tuple(robots) for _, robots in groups if any(map(waits_of, robots))]


def waits_of(robot):
    """Return the names of the slots that a robot ever waits for."""
    reached = (robot.transitions[move] for move in reachable_moves(robot) if move in robot.transitions)
    return {slot for transition in reached for slot in transition.waits}


@settings(max_examples=many(200))
@given(behaviours(choices=False))
def test_without_choices_the_check_finds_deadlocks_exactly(behaviour):
    agrees(behaviour)


@settings(max_examples=many(200))
@given(behaviours())
def test_with_choices_the_check_finds_deadlocks_exactly(behaviour):
    agrees(behaviour)


@settings(max_examples=many(2000, fast=20))
@given(behaviours(loops=True))
def test_with_loops_the_check_finds_deadlocks_exactly(behaviour):
    agrees(behaviour)


@settings(max_examples=many(200))
@given(behaviours(resets=True, loops=True))
def test_with_resets_a_deadlock_is_never_called_safe(behaviour):
    if deadlocks(behaviour):
        assert found(behaviour) != {Status.SAFE}


@settings(max_examples=many(200))
@given(behaviours(resets=True, loops=True).filter(lambda made: may_fixpoint(network_of(made)).blocked))
def test_robots_that_wait_for_ever_at_the_latest_make_a_deadlock(behaviour):
    assume(all(reachable_moves(robot) <= moves_reaching_stop(robot) for robot in behaviour.robots))
    assert deadlocks(behaviour) is not False


@settings(max_examples=many(1500, fast=20))
@given(behaviours(resets=True, loops=True, most=1))
def test_with_resets_and_notifies_to_single_slots_the_check_is_exact(behaviour):
    agrees(behaviour)


@settings(max_examples=many(200))
@given(behaviours())
def test_knowing_what_is_certain_does_not_change_what_the_search_finds(behaviour):
    network = network_of(behaviour)
    certain = must_fixpoint(network).active
    assert (find_trap(network, certain) is None) == (find_trap(network, frozenset()) is None)
