from __future__ import annotations

from math import inf

from mmrs_runtime.engine.agenda import Agenda


def taken(agenda):
    found = []
    while agenda.is_due:
        found.append(agenda.take())
    return found


def test_all_are_due_at_first_and_then_none():
    agenda = Agenda(3)
    assert taken(agenda) == [0, 1, 2]
    assert agenda.next_time == inf


def test_what_is_due_twice_is_taken_once_and_in_order():
    agenda = Agenda(3)
    assert taken(agenda) == [0, 1, 2]
    for number in (2, 0, 2, 1, 0):
        agenda.put(number)
    assert taken(agenda) == [0, 1, 2]


def test_a_later_time_takes_the_place_of_an_earlier_one():
    agenda = Agenda(1)
    assert taken(agenda) == [0]
    agenda.put_at(0, 5.0)
    agenda.put_at(0, 9.0)
    assert agenda.next_time == 9.0
    agenda.advance(5.0)
    assert not agenda.is_due
    agenda.advance(9.0)
    assert taken(agenda) == [0]


def test_what_has_no_time_any_more_is_never_due():
    agenda = Agenda(1)
    assert taken(agenda) == [0]
    agenda.put_at(0, 5.0)
    agenda.put_at(0, inf)
    agenda.advance(10.0)
    assert (agenda.next_time, agenda.is_due) == (inf, False)
