from math import inf

from mmrs_runtime.engine.event_queue import EventQueue


def taken(queue):
    found = []
    while queue.is_due:
        found.append(queue.take())
    return found


def test_all_are_due_at_first_and_then_none():
    queue = EventQueue(3)
    assert taken(queue) == [0, 1, 2]
    assert queue.next_time == inf


def test_what_is_due_twice_is_taken_once_and_in_order():
    queue = EventQueue(3)
    assert taken(queue) == [0, 1, 2]
    for number in (2, 0, 2, 1, 0):
        queue.put(number)
    assert taken(queue) == [0, 1, 2]


def test_a_later_time_takes_the_place_of_an_earlier_one():
    queue = EventQueue(1)
    assert taken(queue) == [0]
    queue.put_at(0, 5.0)
    queue.put_at(0, 9.0)
    assert queue.next_time == 9.0
    queue.advance(5.0)
    assert not queue.is_due
    queue.advance(9.0)
    assert taken(queue) == [0]


def test_what_has_no_time_any_more_is_never_due():
    queue = EventQueue(1)
    assert taken(queue) == [0]
    queue.put_at(0, 5.0)
    queue.put_at(0, inf)
    queue.advance(10.0)
    assert (queue.next_time, queue.is_due) == (inf, False)
