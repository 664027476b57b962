"""Bounds on times and on what a charge is used for, against runs with times drawn at random."""

from dataclasses import replace
from heapq import heappop, heappush
from math import inf
from random import Random

from checking import given as input_of
from checking import kind, recharge, uneven
from counts import many
from hypothesis import assume, settings
from hypothesis import given as for_all
from hypothesis import strategies as st
from random_synchronisation import behaviours

from mmrs_core.analysis.order import HappensBefore
from mmrs_core.analysis.sorties import RECHARGE, sorties_of
from mmrs_core.analysis.times import times_of
from mmrs_core.testing.small_programs import hold, notify, program, robot

SLACK = 1e-9
MOST_MOVES = 500


def run(behaviour, random):
    """Return when every move that is made begins, has ended and is left, by (robot, index).

    And the least that a robot had used of its charge when it left the move or ended with it. Holds take
    between half and twice their time. None if the run gets stuck, or makes too many moves.
    """
    robots = {robot.id: robot for robot in behaviour.robots}
    begun, ended, left, active, waiting = {}, {}, {}, set(), {}
    charged, used = {}, {}

    def note(name, index, now):
        used[name, index] = min(used.get((name, index), inf), now - charged.get(name, 0.0))

    order = 0
    agenda = [(0.0, number, robot.id, robot.start, "begin") for number, robot in enumerate(behaviour.robots)]
    while agenda:
        now, _, name, index, event = heappop(agenda)
        move = robots[name].moves[index]
        if order > MOST_MOVES:
            return None
        if event == "begin":
            begun[name, index] = now
            set_now = move.before
            order += 1
            seconds = random.uniform(0.5, 2.0) * move.attributes.get("duration", 0.0)
            heappush(agenda, (now + seconds, 100 + order, name, index, "end"))
        else:
            ended[name, index] = now
            set_now = move.after
            waiting[name] = index
            if move.is_a(RECHARGE):
                charged[name] = now
            if index == robots[name].stop:
                note(name, index, now)
        for action in set_now:
            active = active | set(action.sets) if action.active else active - set(action.sets)
        for other, at in list(waiting.items()):
            transition = robots[other].transitions.get(at)
            if transition and all((other, slot) in active for slot in transition.waits):
                del waiting[other]
                left[other, at] = now
                note(other, at, now)
                order += 1
                way = random.choice(transition.next_moves)
                heappush(agenda, (now, 100 + order, other, way, "begin"))
    stopped = all(robots[name].stop == at for name, at in waiting.items())
    return (begun, ended, left, used) if stopped else None


@settings(max_examples=many(400))
@for_all(behaviours(resets=True), st.integers(0, 10**6))
def test_no_run_leaves_the_bounds(behaviour, seed):
    made = run(behaviour, Random(seed))
    assume(made is not None)
    begun, ended, _, _ = made
    times = times_of(input_of(*behaviour.robots, moves=uneven()))
    for at, time in begun.items():
        assert times.earliest[at] - SLACK <= time <= times.latest.get(at, inf) + SLACK
        assert times.earliest_end(*at) - SLACK <= ended[at] <= times.latest_end(*at) + SLACK


@settings(max_examples=many(400))
@for_all(behaviours(resets=True, single=True), st.integers(0, 10**6))
def test_no_run_takes_longer_on_one_charge_than_is_reckoned_with(behaviour, seed):
    made = run(behaviour, Random(seed))
    assume(made is not None)
    _, ended, left, _ = made
    given = input_of(*behaviour.robots, moves=uneven(), robot_kind=kind())
    for each in behaviour.robots:
        sorties = sorties_of(given, each)
        bounds = {use.move: use.seconds for use in sorties.uses}
        for at, time in (ended | left).items():
            if at[0] == each.id and not sorties.gaps:
                assert time <= bounds[at[1]] + SLACK


def recharging(robot, data):
    """Return the robot with some of its moves made recharges, which take as long."""
    chosen = data.draw(st.sets(st.sampled_from([move.id for move in robot.moves])))
    kinds = recharge("any", 0.0).metaclasses
    moves = (
        replace(move, metaclasses=kinds) if move.id in chosen and "duration" in move.attributes else move
        for move in robot.moves
    )
    return replace(robot, moves=tuple(moves))


@settings(max_examples=many(200))
@for_all(behaviours(loops=True, resets=True), st.integers(0, 10**6), st.data())
def test_no_run_uses_less_of_a_charge_than_is_certain(behaviour, seed, data):
    robots = [recharging(each, data) for each in behaviour.robots]
    made = run(program(*robots), Random(seed))
    assume(made is not None)
    used = made[3]
    given = input_of(*robots, moves=uneven(), robot_kind=kind())
    for each in robots:
        least = {use.move: use.seconds for use in sorties_of(given, each).least}
        for (name, index), seconds in used.items():
            if name == each.id:
                assert seconds >= least[index] - SLACK


@settings(max_examples=many(400))
@for_all(behaviours(single=True), st.integers(0, 10**6))
def test_what_is_certainly_over_is_over_in_every_run(behaviour, seed):
    made = run(behaviour, Random(seed))
    assume(made is not None)
    begun, ended, left, _ = made
    given = input_of(*behaviour.robots, moves=uneven())
    order = HappensBefore(program(*behaviour.robots), times_of(given).dependencies)
    for later, time in begun.items():
        for earlier in begun:
            if earlier[0] != later[0]:
                if order.is_over(earlier, False, later):
                    assert ended[earlier] <= time + SLACK
                if order.is_over(earlier, True, later):
                    assert left[earlier] <= time + SLACK


def test_some_waits_prove_an_order():
    """Guard the law above against being empty."""
    a = robot("a", [hold("h", after=(notify("b.go"),)), hold("i")])
    b = robot("b", [hold("n")], waits={"start": ["go"]})
    order = HappensBefore(program(a, b), times_of(input_of(a, b)).dependencies)
    assert order.is_over(("a", 1), False, ("b", 1))
    assert not order.is_over(("a", 1), True, ("b", 1))
    assert order.is_over(("a", 0), True, ("b", 1))
    assert not order.is_over(("a", 2), False, ("b", 1))
