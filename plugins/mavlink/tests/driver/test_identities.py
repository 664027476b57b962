"""A vehicle that starts anew, and two vehicles in turns, told apart by the time since their start."""

from mmrs_mavlink.links.identity import Identity


def told(*milliseconds: float) -> Identity:
    identity = Identity()
    for each in milliseconds:
        identity.booted(each)
    return identity


def test_a_vehicle_that_goes_on_has_not_started_anew():
    identity = told(*range(0, 100_000, 200))
    assert (identity.starts, identity.twin) == (0, "")


def test_a_vehicle_whose_time_begins_again_has_started_anew():
    identity = told(*range(0, 100_000, 200), *range(0, 20_000, 200))
    assert (identity.starts, identity.twin) == (1, "")


def test_each_start_counts():
    assert told(*range(0, 60_000, 200), *range(0, 60_000, 200), *range(0, 60_000, 200)).starts == 2


def test_late_messages_are_no_start():
    assert told(90_000, 90_200, 86_000, 86_200, 86_400, 86_600, 90_400).starts == 0


def test_one_or_two_messages_from_nowhere_are_no_start():
    assert told(90_000, 3, 200, 90_200, 90_400).starts == 0


def test_two_vehicles_that_take_turns_are_told_and_are_no_start():
    turns = [time for n in range(10) for time in (90_000 + 200 * n, 4_000 + 200 * n)]
    identity = told(90_000, *turns)
    assert identity.starts == 0
    assert identity.twin == "messages from two different starts take turns"


WRAP = 2**32


def test_a_vehicle_whose_time_is_counted_from_0_again_after_49_days_has_not_started_anew():
    times = [*range(WRAP - 60_000, WRAP, 200), *range(0, 60_000, 200)]
    identity = told(*times[:-310], times[-301], *times[-310:])
    assert (identity.starts, identity.twin) == (0, "")


def test_a_vehicle_that_starts_anew_after_its_time_was_counted_from_0_again_is_noticed():
    afterwards = range(0, 2_000_000, 200)
    assert told(*range(WRAP - 60_000, WRAP, 200), *afterwards, *range(0, 20_000, 200)).starts == 1


def test_a_vehicle_that_starts_anew_long_before_its_time_would_be_counted_from_0_again_is_noticed():
    assert told(*range(WRAP - 2_000_000, WRAP - 1_000_000, 200), *range(0, 20_000, 200)).starts == 1
