"""The list of who is ready, as the first robot keeps it."""

from mmrs_runtime.bus.meeting import Beginning
from mmrs_runtime.bus.messages import CommandId, Meet
from mmrs_runtime.bus.watching import Roster


def ready(robot: str, robots: int = 2) -> Meet:
    return Meet(CommandId("run-0", robot, "1", 0), robots)


def test_all_begin_once_the_last_is_ready():
    meeting = Roster(lambda: 5.0)
    assert meeting.answer(ready("a")).what == "wait"
    assert meeting.answer(ready("b")).at > 5.0


def test_the_answer_says_who_is_ready():
    meeting = Roster()
    assert meeting.answer(ready("b", 3)).ready == ("b",)
    assert meeting.answer(ready("a", 3)).ready == ("a", "b")


def test_a_robot_that_waits_no_longer_is_not_ready():
    meeting = Roster()
    meeting.answer(ready("a"))
    assert meeting.answer(ready("a", 0)).ready == ()
    assert meeting.answer(ready("b")).what == "wait"


def test_a_robot_that_is_gone_is_not_ready():
    meeting = Roster()
    meeting.answer(ready("a"))
    assert meeting.answer(ready("b"), {"a"}.__contains__).what == "wait"


def test_a_robot_that_gives_up_as_all_begin_is_told_so():
    meeting = Roster()
    for robot in "ab":
        meeting.answer(ready(robot))
    assert meeting.answer(ready("a", 0)).what == "begin"


def test_the_instant_is_as_far_off_as_the_slowest_link_needs():
    assert instant_after_asking_twice(2.0) == 2.0 + 6.0


def test_a_robot_that_was_away_makes_nobody_wait():
    assert instant_after_asking_twice(100.0) == 100.0 + 1.0


def instant_after_asking_twice(pause: float) -> float:
    """Return when all begin if the first asks at 0 and again after a pause, at which the second is ready."""
    now = 0.0
    meeting = Roster(lambda: now)
    meeting.answer(ready("a"))
    now = pause
    meeting.answer(ready("a"))
    return meeting.answer(ready("b")).at


def test_people_are_told_skew_offset_and_uncertainty():
    words = str(Beginning(offset=0.0123, uncertainty=0.0004, late=0.0011))
    assert words == "at most 1.5 ms from the instant: 1.1 ms late, by clocks 12.3 ms apart, known to 0.4 ms"
