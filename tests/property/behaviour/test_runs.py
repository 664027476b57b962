"""What holds of every run of every behaviour."""

from itertools import pairwise
from math import dist

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from mmrs_core.behaviour.log import read_logs
from mmrs_core.behaviour.replay import replay
from mmrs_core.contributions.targets import TargetInput
from mmrs_core.simulation.run import simulate
from mmrs_core.simulation.simulation import SIMULATION
from mmrs_core.testing.random_programs import CONDITIONS, answers, programs
from mmrs_core.testing.small_programs import ROBOT_TYPE, robot_type
from mmrs_core.transformation.kinds import MOVE_KINDS, PLAIN_ROBOT
from mmrs_runtime.engine.decisions import assumed
from mmrs_runtime.engine.terms import Terms
from mmrs_runtime.records.log import LogWriter
from mmrs_runtime.records.steps import merge
from mmrs_runtime.semantics import Outcome, apply, enabled, initial, is_deadlock, is_success

TYPE = robot_type(lifetime=None)
KINDS = {
    "robot_kinds": {PLAIN_ROBOT.metaclass: PLAIN_ROBOT},
    "move_kinds": {kind.metaclass: kind for kind in MOVE_KINDS},
}
FAST = settings(max_examples=30, deadline=None, suppress_health_check=[HealthCheck.too_slow])
FULL = settings(max_examples=600, deadline=None, suppress_health_check=[HealthCheck.too_slow])


def run_of(program, answers=None, **options):
    conditions = assumed(answers or dict.fromkeys(CONDITIONS, True))
    given = TargetInput(program, {ROBOT_TYPE: TYPE}, **KINDS)
    return simulate(given, SIMULATION, conditions=conditions, **options)


def terminal_states(program):
    """Return all states in which runs end, by exhaustive search; every Choice goes both ways."""
    program = program.executable
    start = initial(program)
    seen, pending, ends = {start}, [start], []
    while pending:
        state = pending.pop()
        following = [apply(program, state, step) for step in enabled(program, state)]
        if not following:
            ends.append(state)
        for each in following:
            if each not in seen:
                seen.add(each)
                pending.append(each)
    return ends


def check_that_the_log_replays(program, decided):
    run = run_of(program, decided, terms=Terms(steps=500))
    result = replay(program, run.records, partial=True)
    assert result.accepted, result.complaints
    assert result.steps == len(run.records)
    if run.ending.outcome is not Outcome.INCOMPLETE:
        assert replay(program, run.records).outcome is run.ending.outcome
        assert result.waiting == run.ending.waiting


@given(programs(loops=True), answers())
@FAST
def test_every_run_is_a_trace_of_its_behaviour(program, decided):
    check_that_the_log_replays(program, decided)


@pytest.mark.thorough
@given(programs(moves=(0, 6), loops=True), answers())
@FULL
def test_every_run_of_larger_behaviours_is_a_trace(program, decided):
    check_that_the_log_replays(program, decided)


def check_deadlock(program):
    ends = terminal_states(program)
    outcome = run_of(program).ending.outcome
    assert (outcome is Outcome.STUCK) == any(is_deadlock(program.executable, end) for end in ends)
    assert (outcome is Outcome.SUCCESS) == all(is_success(end) for end in ends)


@given(programs(robots=(2, 3), moves=(0, 2), resets=False, choices=False))
@FAST
def test_without_resets_and_choices_one_run_tells_whether_any_gets_stuck(program):
    check_deadlock(program)


@pytest.mark.thorough
@given(programs(robots=(2, 3), moves=(0, 3), resets=False, choices=False))
@FULL
def test_one_run_tells_whether_any_gets_stuck_in_larger_behaviours(program):
    check_deadlock(program)


@given(programs(robots=(2, 3), moves=(0, 2)), answers())
@FAST
def test_a_run_ends_in_a_state_that_exhaustive_search_knows(program, decided):
    run = run_of(program, decided)
    made = program.executable
    state = initial(made)
    for record in run.records:
        state = next(
            apply(made, state, step)
            for step in enabled(made, state)
            if (step.robot, step.label, step.move, step.detail)
            == (record.robot, record.label, record.move, record.detail)
        )
    assert state in terminal_states(program)


@given(programs(moves=(1, 3)), answers(), st.data())
@FAST
def test_a_dropped_step_never_goes_unnoticed(program, decided, data):
    records = run_of(program, decided).records
    index = data.draw(st.integers(0, len(records) - 1))
    assert not replay(program, records[:index] + records[index + 1 :]).accepted


@given(programs(moves=(1, 3)), answers(), st.data())
@FAST
def test_a_step_of_another_kind_never_goes_unnoticed(program, decided, data):
    records = list(run_of(program, decided).records)
    index = data.draw(st.integers(0, len(records) - 1))
    label = data.draw(st.sampled_from(["act", "ntf", "begin", "end", "take", "choose"]))
    if label == records[index].label:
        return
    records[index] = records[index]._replace(label=label)
    assert not replay(program, records).accepted


@given(programs(), answers())
@FAST
def test_the_same_behaviour_gives_the_same_run(program, decided):
    assert run_of(program, decided) == run_of(program, decided)


@given(programs(), answers())
@FAST
def test_merging_by_logical_time_keeps_the_order_of_notifies_and_waits_for_a_slot(program, decided):
    records = run_of(program, decided).records
    for slot in {slot for record in records for slot in touched(program, record)}:
        made = [record for record in records if slot in touched(program, record)]
        assert [record for record in merge(records) if slot in touched(program, record)] == made


def touched(program, record):
    """Return the slots that a step sets or has waited for."""
    if record.label == "ntf":
        return set(record.slot[1:].split(" "))
    if record.label not in ("take", "choose"):
        return set()
    robot = program.robot(record.robot)
    move = next(index for index, move in enumerate(robot.moves) if move.id == record.move)
    return {f"{robot.id}.{slot}" for slot in robot.transitions[move].waits}


@given(programs(robots=(1, 2), moves=(1, 3)), answers())
@FAST
def test_a_track_is_continuous_in_time_and_never_faster_than_the_robot(program, decided):
    for track in run_of(program, decided).tracks.values():
        for before, after in pairwise(track):
            way = dist((before.east, before.north, before.up), (after.east, after.north, after.up))
            assert after.time >= before.time
            assert way <= 4.0 * (after.time - before.time) + 1e-6


@given(programs(), answers())
@settings(FAST, suppress_health_check=[HealthCheck.too_slow, HealthCheck.function_scoped_fixture])
def test_a_log_on_the_disk_replays_like_the_run(tmp_path_factory, program, decided):
    folder = tmp_path_factory.mktemp("logs")
    with LogWriter(folder) as log:
        run = run_of(program, decided, terms=Terms(observe=log.write))
    assert set(read_logs([folder])) == set(run.records)
    assert replay(program, read_logs([folder])).outcome is run.ending.outcome
