"""Steps of a log as visits of moves."""

from mmrs_core.pictures.report.visits import visits_of


def test_a_visit_knows_when_it_was_entered_done_and_left(make):
    first, second = visits_of(
        make.records(
            "alpha",
            (0.0, "begin", "a"),
            (4.0, "end", "a"),
            (5.0, "act", "a", "post:0"),
            (9.0, "take", "a", "b"),
            (9.0, "begin", "b"),
            (12.0, "end", "b"),
        )
    )
    assert (first.entered, first.begun, first.ended, first.done, first.left) == (0.0, 0.0, 4.0, 5.0, 9.0)
    assert (second.entered, second.left, second.complete) == (9.0, None, True)


def test_a_move_that_is_visited_twice_in_a_row_is_two_visits(make):
    loop = [(0.0, "begin", "a"), (1.0, "end", "a"), (1.0, "choose", "a", "true")]
    assert len(visits_of(make.records("alpha", *loop, *loop))) == 2


def test_a_visit_that_a_fault_ended_is_not_complete(make):
    steps = ((0.0, "begin", "a"), (3.0, "fault", "a", "BATTERY_LOW"))
    (visit,) = visits_of(make.records("alpha", *steps))
    assert (visit.fault, visit.complete, visit.done) == ("BATTERY_LOW", False, 3.0)


def test_a_fault_in_the_wait_after_a_move_leaves_it_incomplete(make):
    steps = ((0.0, "begin", "a"), (1.0, "end", "a"), (3.0, "fault", "a", "WAIT_TOO_LONG"))
    (visit,) = visits_of(make.records("alpha", *steps))
    assert (visit.ended, visit.complete) == (1.0, False)
