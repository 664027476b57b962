"""The judge of logs: it accepts what the rules allow, and nothing that was tampered with."""

from dataclasses import replace

import pytest

from mmrs_core.behaviour.replay import RECHARGE, replay
from mmrs_core.testing.small_programs import go, hold, notify, program, robot, use
from mmrs_runtime.records.steps import StepRecord
from mmrs_runtime.semantics import Outcome, apply, enabled, initial

BEHAVIOUR = program(
    robot(
        "a",
        [
            go("g", (9, 0, 0), before=(use("cam", "on"),), after=(notify("b.s", "a.t"), use("cam", "off"))),
            hold("x", 2.0),
            hold("y", 2.0),
        ],
        choices={"g": ("sunny", "x", "y")},
        jumps={"x": "stop"},
        slots=("t",),
    ),
    robot("b", [hold("h", 5.0, after=(notify("a.t", active=False),))], waits={"start": ["s"]}),
)


def log_of(behaviour, seconds=10.0):
    """Return the log of a run in which the first enabled step is always made, at even times."""
    made = behaviour.executable
    state, records, counts, lamport = initial(made), [], {}, 0
    while (step := next(iter(enabled(made, state)), None)) is not None:
        lamport += 1
        seq = counts.get(step.robot, 0)
        counts[step.robot] = seq + 1
        time = lamport * seconds
        records.append(
            StepRecord("run", step.robot, seq, lamport, time, step.label, step.move, step.detail, step.slot)
        )
        state = apply(made, state, step)
    return records


def renumbered(records):
    """Return the records with sequence, logical time and time as if nothing were wrong."""
    counts, result = {}, []
    for lamport, record in enumerate(records, start=1):
        seq = counts.get(record.robot, 0)
        counts[record.robot] = seq + 1
        result.append(record._replace(seq=seq, lamport=lamport, time=lamport * 10.0))
    return result


LOG = log_of(BEHAVIOUR)
EVERY = range(len(LOG))


def test_an_honest_log_is_accepted_in_any_order_of_robots():
    shuffled = [r for r in LOG if r.robot == "b"] + [r for r in LOG if r.robot == "a"]
    for records in (LOG, shuffled):
        result = replay(BEHAVIOUR, records)
        assert result.accepted
        assert result.outcome is Outcome.SUCCESS
        assert result.steps == len(LOG)


@pytest.mark.parametrize("index", EVERY)
def test_a_dropped_record_is_noticed(index):
    assert not replay(BEHAVIOUR, LOG[:index] + LOG[index + 1 :]).accepted


@pytest.mark.parametrize("index", EVERY)
def test_a_dropped_record_is_noticed_even_when_all_others_are_renumbered(index):
    assert not replay(BEHAVIOUR, renumbered(LOG[:index] + LOG[index + 1 :])).accepted


@pytest.mark.parametrize("index", EVERY)
def test_a_doubled_record_is_noticed(index):
    doubled = [*LOG[: index + 1], *LOG[index:]]
    assert not replay(BEHAVIOUR, doubled).accepted
    assert not replay(BEHAVIOUR, renumbered(doubled)).accepted


@pytest.mark.parametrize("index", [i for i in EVERY[:-1] if LOG[i].robot == LOG[i + 1].robot])
def test_two_swapped_steps_of_a_robot_are_noticed(index):
    swapped = [*LOG[:index], LOG[index + 1], LOG[index], *LOG[index + 2 :]]
    assert not replay(BEHAVIOUR, swapped).accepted
    assert not replay(BEHAVIOUR, renumbered(swapped)).accepted


@pytest.mark.parametrize("index", EVERY)
@pytest.mark.parametrize("field", ["run", "robot", "seq", "label", "move", "detail", "slot"])
def test_an_altered_field_is_noticed(index, field):
    altered = {"seq": LOG[index].seq + 1, "label": "end" if LOG[index].label != "end" else "begin"}
    record = LOG[index]._replace(**{field: altered.get(field, "other")})
    assert not replay(BEHAVIOUR, [*LOG[:index], record, *LOG[index + 1 :]]).accepted


def test_the_alterations_leave_out_no_field_but_those_with_tests_of_their_own():
    tried = {"run", "robot", "seq", "label", "move", "detail", "slot"}
    assert set(StepRecord._fields) - tried == {"lamport", "time"}


def index_of(label, robot_id):
    return next(i for i, record in enumerate(LOG) if (record.label, record.robot) == (label, robot_id))


def test_a_wait_that_was_passed_before_its_notify_is_noticed():
    before = LOG[index_of("ntf", "a")].lamport
    records = [r._replace(lamport=r.seq + 1) if r.robot == "b" and r.seq < 3 else r for r in LOG]
    assert max(r.lamport for r in records if r.robot == "b" and r.seq < 3) < before
    (complaint,) = replay(BEHAVIOUR, records).complaints
    assert (complaint.robot, complaint.seq, complaint.move) == ("b", 2, "start")
    assert "expected no step before s is active" in complaint.message


def test_logical_time_that_does_not_grow_is_noticed():
    records = list(LOG)
    records[1] = records[1]._replace(lamport=records[0].lamport)
    assert not replay(BEHAVIOUR, records).accepted


def test_time_that_goes_back_is_noticed():
    records = list(LOG)
    records[3] = records[3]._replace(time=records[2].time - 1)
    (complaint,) = replay(BEHAVIOUR, records).complaints
    assert "time goes back" in complaint.message


@pytest.mark.parametrize(("seconds", "accepted"), [(5.0, True), (4.9, False)])
def test_a_hold_lasts_at_least_its_duration(seconds, accepted):
    behaviour = program(robot("r", [hold("h", 5.0)]))
    assert replay(behaviour, log_of(behaviour, seconds)).accepted is accepted


def test_a_recharge_is_over_earlier_where_an_operator_changes_the_battery():
    stay = hold("h", 120.0)
    charge = replace(stay, metaclasses=(RECHARGE, *stay.metaclasses))
    behaviour = program(robot("r", [charge]))
    assert replay(behaviour, log_of(behaviour, 20.0)).accepted


def test_a_complaint_names_robot_step_move_and_what_was_expected():
    records = renumbered([record for record in LOG if record.label != "act"])
    (complaint,) = replay(BEHAVIOUR, records).complaints
    assert str(complaint) == "a: step 3 at 'g': is begin of 'g', expected act pre:0 of 'g'"


def test_both_ways_of_a_choice_are_accepted():
    choice = index_of("choose", "a")
    others = [LOG[choice]._replace(detail="false")]
    rest = [r._replace(move="y") if r.move == "x" else r for r in LOG[choice + 1 :]]
    result = replay(BEHAVIOUR, [*LOG[:choice], *others, *rest])
    assert result.accepted


def test_a_log_that_ends_early_is_accepted_only_as_a_part():
    part = LOG[:6]
    assert not replay(BEHAVIOUR, part).accepted
    result = replay(BEHAVIOUR, part, partial=True)
    assert result.accepted
    assert result.outcome is Outcome.INCOMPLETE


def test_an_empty_log_of_a_robot_that_should_move_is_noticed():
    (first, second) = replay(BEHAVIOUR, []).complaints
    assert str(first) == "a: log ends although the robot can continue: expected begin of 'start'"
    assert second.robot == "b"


def test_a_run_that_got_stuck_is_a_trace_and_says_who_waits_for_what():
    behaviour = program(robot("r", [hold("h")], waits={"h": ["s"]}))
    result = replay(behaviour, log_of(behaviour))
    assert result.accepted
    assert result.outcome is Outcome.STUCK
    (waits,) = result.waiting
    assert (waits.robot, waits.move, waits.slots) == ("r", "h", ("s",))


def test_a_fault_is_accepted_anywhere_and_the_run_has_failed():
    behaviour = program(robot("r", [hold("h")]))
    whole = log_of(behaviour)
    for end in range(len(whole)):
        move = whole[end].move
        bad = StepRecord("run", "r", end, 99, 999.0, "fault", move, "WIND")
        result = replay(behaviour, [*whole[:end], bad])
        assert result.accepted, end
        assert result.outcome is Outcome.FAILED
        assert result.faults == {"r": "WIND"}


def test_a_robot_that_has_failed_makes_no_further_step():
    behaviour = program(robot("r", [hold("h")]))
    whole = log_of(behaviour)
    bad = whole[1]._replace(label="fault", detail="WIND")
    assert not replay(behaviour, [whole[0], bad, *whole[2:]]).accepted


def test_a_robot_of_another_behaviour_is_noticed():
    (complaint,) = replay(program(robot("r", [])), [LOG[0]._replace(robot="z")]).complaints
    assert complaint.message == "no such robot in the behaviour"


def test_replay_takes_time_in_proportion_to_the_log():
    behaviour = program(robot("r", [hold(f"h{index}", 0.0) for index in range(10_000)]))
    assert replay(behaviour, log_of_chain(behaviour)).steps == 30_005


def log_of_chain(behaviour):
    records = []
    moves = behaviour.robots[0].moves
    for move, following in zip(moves, (*moves[1:], None), strict=True):
        steps = [("begin", ""), ("end", ""), *([("take", following.id)] if following else [])]
        for label, detail in steps:
            n = len(records)
            records.append(StepRecord("run", "r", n, n + 1, float(n), label, move.id, detail))
    return records
