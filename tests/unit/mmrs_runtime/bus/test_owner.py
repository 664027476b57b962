"""The owner of slots: what it keeps, applies, refuses and survives."""

from dataclasses import replace

import pytest

from mmrs_runtime.bus.journal import FileJournal
from mmrs_runtime.bus.messages import REACH, Abort, Begin, CommandId, Commit, Prepare
from mmrs_runtime.bus.owner import KEPT_SECONDS, Owned, Owner
from mmrs_runtime.bus.watching import LEASE_SECONDS

OWNED = Owned("b", ("go", "stay"), {"go": ("a", "c"), "stay": ("a",)}, {"go": ("a", "c")})


@pytest.fixture
def journal(tmp_path):
    return FileJournal(tmp_path / "b.slots.ndjson")


@pytest.fixture
def owner(journal):
    return Owner(OWNED, "run", journal)


def id(number=1, sender="a", incarnation="1", run="run"):
    return CommandId(run, sender, incarnation, number)


def prepare(number=1, *, active=True, round=1, lamport=0, slots=("go",), **who):
    return Prepare(id(number, **who), round, slots, active, lamport)


def commit(lamport, number=1, *, active=True, slots=("go",), **who):
    return Commit(id(number, **who), slots, active, lamport)


def is_active(owner, now=0.0):
    return owner.state("go", now).active


def test_a_slot_is_granted_after_all_that_has_happened_to_it(owner):
    assert owner.prepare(prepare(), 0.0).lamport == 1
    owner.commit(commit(5))
    owner.passed(("go",), 9)
    assert owner.prepare(prepare(2), 0.0).lamport == 10


def test_a_sender_is_granted_no_time_before_its_own(owner):
    assert owner.prepare(prepare(lamport=70), 0.0).lamport == 70


def test_a_slot_that_is_kept_for_one_is_neither_granted_to_another_nor_passed(owner):
    owner.commit(commit(1))
    owner.prepare(prepare(2, active=False), 0.0)
    assert owner.prepare(prepare(sender="c"), 0.0).what == "busy"
    assert not owner.may_pass(("go",), 99, 0.0)


def test_a_slot_is_free_again_when_the_notify_is_withdrawn(owner):
    owner.commit(commit(1))
    owner.prepare(prepare(2, active=False), 0.0)
    owner.abort(Abort(id(2), 1))
    assert owner.may_pass(("go",), 99, 0.0)
    assert owner.prepare(prepare(sender="c"), 0.0).what == "granted"


def test_a_late_request_for_what_was_withdrawn_keeps_nothing(owner):
    owner.abort(Abort(id(1), 1))
    assert owner.prepare(prepare(), 0.0).what == "stale"
    assert owner.prepare(prepare(round=2), 0.0).what == "granted"


def test_a_late_request_for_what_was_applied_keeps_nothing(owner):
    owner.prepare(prepare(), 0.0)
    owner.commit(commit(1))
    assert owner.prepare(prepare(), 0.0).what == "stale"


def test_a_late_withdrawal_frees_no_later_round(owner):
    owner.prepare(prepare(round=2), 0.0)
    owner.abort(Abort(id(1), 1))
    assert owner.prepare(prepare(sender="c"), 0.0).what == "busy"


def test_a_command_is_applied_once_and_answered_each_time(owner):
    assert [owner.commit(commit(3)).what for _ in range(3)] == ["applied"] * 3
    assert owner.state("go", 0.0).version == 1


def test_a_command_that_arrives_after_a_later_one_changes_nothing(owner):
    owner.commit(commit(7, 2, active=False))
    assert owner.commit(commit(5, 1)).what == "applied"
    assert not is_active(owner)


def test_what_a_lost_sender_may_have_reset_is_in_doubt(owner):
    owner.commit(commit(1))
    owner.prepare(prepare(2, active=False), 0.0)
    assert not is_active(owner, KEPT_SECONDS + 1)
    assert not owner.may_pass(("go",), 2 * REACH, KEPT_SECONDS + 1)


def test_what_a_lost_sender_may_have_set_stays_as_it_was(owner):
    owner.commit(commit(1))
    owner.prepare(prepare(2), 0.0)
    assert is_active(owner, KEPT_SECONDS + 1)


def test_what_happens_after_a_sender_was_lost_is_later_than_anything_it_may_have_recorded(owner):
    least = owner.prepare(prepare(1, active=False), 0.0).lamport
    found = owner.prepare(prepare(sender="c"), KEPT_SECONDS + 1)
    assert found.lamport > least + REACH


def test_doubt_ends_when_the_slot_is_set_again(owner):
    owner.prepare(prepare(1, active=False), 0.0)
    granted = owner.prepare(prepare(sender="c"), KEPT_SECONDS + 1)
    owner.commit(commit(granted.lamport, sender="c"))
    assert is_active(owner, KEPT_SECONDS + 1)


@pytest.mark.parametrize("end", ["aborted", "begun again"])
def test_doubt_ends_when_its_sender_says_that_it_recorded_nothing(owner, end):
    owner.commit(commit(1))
    owner.prepare(prepare(2, active=False), 0.0)
    assert not is_active(owner, KEPT_SECONDS + 1)
    if end == "aborted":
        owner.abort(Abort(id(2), 1))
    else:
        owner.begin(Begin(id(0, incarnation="2"), (("go", True, 1),)))
    assert is_active(owner, KEPT_SECONDS + 1)


def test_a_sender_that_is_out_of_reach_for_longer_than_the_lease_holds_nobody_up(journal):
    owner = Owner(OWNED, "run", journal, lost_at={"a": 2.0}.get)
    owner.prepare(prepare(), 0.0)
    assert owner.prepare(prepare(sender="c"), 1.0).what == "busy"
    assert owner.prepare(prepare(sender="c"), 3.0).what == "granted"


def test_a_slot_is_kept_for_a_sender_that_asks_although_it_seems_out_of_reach(journal):
    owner = Owner(OWNED, "run", journal, lost_at={"a": 2.0}.get)
    granted = owner.prepare(prepare(active=False), 3.0).lamport
    assert not owner.end_lost(owner.next_end() - 0.1), "each round would come later than all before can have"
    assert owner.prepare(prepare(active=False, round=2), 4.0).lamport == granted
    assert owner.next_end() == 4.0 + LEASE_SECONDS
    assert owner.end_lost(owner.next_end())


def test_a_sender_that_was_started_again_has_applied_what_it_had_recorded(owner):
    owner.prepare(prepare(4, active=True), 0.0)
    assert owner.begin(Begin(id(0, incarnation="2"), (("go", True, 6),))).what == "done"
    assert is_active(owner)
    assert owner.prepare(prepare(sender="c"), 0.0).what == "granted"


def test_what_was_recorded_and_applied_before_is_not_applied_again(owner):
    owner.commit(commit(6))
    owner.commit(commit(8, sender="c", active=False))
    owner.begin(Begin(id(0, incarnation="2"), (("go", True, 6),)))
    assert not is_active(owner)
    assert owner.state("go", 0.0).version == 2


def test_an_older_start_of_a_sender_is_not_heard_any_more(owner):
    owner.prepare(prepare(1, incarnation="1"), 0.0)
    owner.begin(Begin(id(0, incarnation="2"), ()))
    assert owner.prepare(prepare(9, incarnation="1"), 0.0).what == "stale"


@pytest.mark.parametrize("incarnation", ["2-other", "1-other", "1"])
def test_a_start_of_a_sender_that_does_not_know_of_an_earlier_one_is_refused(owner, incarnation):
    owner.commit(commit(1, incarnation="2-first"))
    for answer in (
        owner.begin(Begin(id(0, incarnation=incarnation), ())),
        owner.prepare(prepare(9, incarnation=incarnation), 0.0),
        owner.commit(commit(9, 9, incarnation=incarnation)),
    ):
        assert answer.what == "refused"
        assert answer.why == "'a' was started before in this run: resume it from its log"


def test_starts_are_remembered_by_the_journal(owner, journal):
    owner.commit(commit(1, incarnation="1-first"))
    again = Owner(OWNED, "run", journal)
    assert again.prepare(prepare(2, incarnation="1-other"), 0.0).what == "refused"
    assert again.prepare(prepare(2, incarnation="2-second"), 0.0).what == "granted"


def test_a_first_start_leaves_nothing_in_the_journal(owner, journal):
    owner.begin(Begin(id(0), ()))
    assert list(journal.lines()) == []


@pytest.mark.parametrize(
    ("request_", "why"),
    [
        (prepare(sender="d"), "'d' never sets slot 'go' of 'b'"),
        (prepare(sender="c", slots=("stay",)), "'c' never sets slot 'stay' of 'b'"),
        (prepare(slots=("stay",), active=False), "'a' never resets slot 'stay' of 'b'"),
        (prepare(slots=("land",)), "'b' has no slot 'land'"),
        (prepare(run="last week"), "not a word of this run and plan"),
    ],
)
def test_a_command_that_the_model_does_not_know_is_refused_in_both_steps(owner, journal, request_, why):
    assert owner.prepare(request_, 0.0).why == why
    sent = Commit(request_.id, request_.slots, request_.active, 5)
    assert owner.commit(sent).why == why
    assert list(journal.lines()) == []


def test_what_a_restarted_sender_claims_is_refused_where_it_may_not_set_it(owner):
    assert owner.begin(Begin(id(0, sender="d"), (("go", True, 1),))).what == "refused"
    assert not is_active(owner)


def again(journal, floor=0):
    return Owner(OWNED, "run", FileJournal(journal._path), floor=floor)


def test_a_restarted_owner_goes_on_with_what_it_had_applied(owner, journal):
    owner.commit(commit(4))
    restarted = again(journal)
    assert restarted.state("go", 0.0) == owner.state("go", 0.0)
    assert restarted.commit(commit(4)).what == "applied"
    assert restarted.state("go", 0.0).version == 1


def test_a_restarted_owner_doubts_what_it_had_kept_for_a_reset(owner, journal):
    owner.commit(commit(1))
    owner.prepare(prepare(2, active=False), 0.0)
    restarted = again(journal)
    assert not is_active(restarted)
    restarted.commit(commit(2, 2, active=False))
    assert restarted.prepare(prepare(sender="c"), 0.0).what == "granted"


def test_a_restarted_owner_knows_that_a_reset_was_withdrawn(owner, journal):
    owner.commit(commit(1))
    owner.prepare(prepare(2, active=False), 0.0)
    owner.abort(Abort(id(2), 1))
    assert is_active(again(journal))


def test_a_restarted_owner_orders_everything_after_its_log(owner, journal):
    assert again(journal, floor=40).prepare(prepare(), 0.0).lamport == 41


def test_a_journal_of_another_run_is_not_taken_up(owner, journal):
    owner.commit(commit(1))
    with pytest.raises(ValueError, match="were kept in run 'run', not 'next'"):
        Owner(OWNED, "next", FileJournal(journal._path))


def test_a_line_that_was_cut_off_counts_as_not_written(owner, journal):
    owner.commit(commit(1))
    with journal._path.open("a") as file:
        file.write('{"do": "commit", "slots": ["go"], "acti')
    restarted = again(journal)
    assert restarted.state("go", 0.0).version == 1
    restarted.commit(commit(2, 2, active=False))
    assert not is_active(again(journal))


def test_a_damaged_line_is_told_with_its_place(owner, journal):
    owner.commit(commit(1))
    with journal._path.open("a") as file:
        file.write("nonsense\n")
    with pytest.raises(ValueError, match=r"b\.slots\.ndjson:2: damaged"):
        again(journal)


DAMAGED = [
    {"do": "commit", "slots": []},
    {"do": "commit", "slots": 5},
    {"do": "commit", "slots": ["nothing"], "active": True, "lamport": 1},
    {"do": "commit", "slots": ["go"], "active": 1, "lamport": 1},
    {"do": "commit", "slots": ["go"], "active": True, "lamport": "x"},
    {"started": "x"},
    {"started": 1, "robot": "another", "run": "run"},
    {"do": "leave", "sender": ["a"], "lamport": 1},
    {"do": "abort", "round": None},
    {"do": "begin", "recorded": [["go", True]]},
    {"do": "begin", "recorded": [["nothing", True, 1]]},
    {"do": "prepare", "slots": ["nothing"], "round": 1, "active": False, "lamport": 1},
    {"do": "prepare", "slots": ["go"], "round": 1, "active": False},
    {"do": "meet", "robots": 1},
]


@pytest.mark.parametrize("line", DAMAGED)
def test_a_line_of_a_journal_that_makes_no_sense_is_told_with_its_place(journal, line):
    Owner(OWNED, "run", journal).started(1)
    journal.keep({**line, **{k: v for k, v in WHO.items() if k not in line}})
    with pytest.raises(ValueError, match=r"b\.slots\.ndjson:2: damaged: "):
        Owner(OWNED, "run", journal)


WHO = {"run": "run", "sender": "a", "incarnation": "1", "sequence": 1}


SEEN, HEARD = ("float", (3.0, 4.0, -2.0)), ("whale", None)


def test_what_senders_have_detected_is_kept_with_their_notifies(owner, journal):
    owner.commit(replace(commit(3), finds=(SEEN, HEARD)))
    owner.commit(replace(commit(5, 2), finds=(("whale", (1.0, 1.0, 0.0)),)))
    kept = {"float": SEEN, "whale": ("whale", (1.0, 1.0, 0.0))}
    assert owner.finds == kept
    assert Owner(OWNED, "run", journal).finds == kept


def test_what_strangers_say_to_have_detected_is_not_kept(owner):
    assert owner.commit(replace(commit(3, sender="z"), finds=(SEEN,))).what == "refused"
    assert not owner.finds
