"""How busy a bus is: against sums by hand, and against what a simulated bus with arbitration does."""

from math import ceil

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from vessel_sheets import sheet

from auv_vessel.wire.catalogue import EMERGENCIES, layout_of, messages_of
from auv_vessel.wire.frame import Frame
from auv_vessel.wire.load import length_of, load_of, longest, measured_load


def test_load_is_the_sum_of_lengths_by_periods() -> None:
    eight, none = load_of(sheet(8)), load_of(sheet(0))
    assert eight.most - none.most == pytest.approx(8 * (105 / 0.05 + 125 / 0.1) / 500_000)
    assert eight.least - none.least == pytest.approx(8 * (87 / 0.05 + 103 / 0.1) / 500_000)
    assert load_of(sheet(8, bit_rate=250_000)).most == pytest.approx(2 * eight.most)


def test_what_is_only_said_when_there_is_something_to_say_counts_for_nothing() -> None:
    assert {each.name for each in load_of(sheet()).shares if each.period is None} == {
        "Clock", "DeviceCommand", "DeviceStatus", *EMERGENCIES,
    }  # fmt: skip


def test_the_first_message_waits_for_one_frame_and_the_others_for_all_before() -> None:
    shares = load_of(sheet(2)).shares
    assert shares[0].latest == pytest.approx((135 + 115) / 500_000)
    latest = [each.latest for each in shares if each.period]
    assert latest == sorted(latest, key=lambda each: each or 0.0)


def test_a_bus_that_is_too_slow_has_no_limits() -> None:
    assert load_of(sheet(32, bit_rate=20_000)).most > 1.0
    assert load_of(sheet(32, bit_rate=20_000)).shares[-1].latest is None


@given(st.lists(st.floats(0.0, 1.0), min_size=60, max_size=60), st.sampled_from([50_000, 125_000, 500_000]))
@settings(max_examples=20, deadline=None, suppress_health_check=[HealthCheck.too_slow])
def test_no_message_is_over_later_than_told_on_a_simulated_bus(phases: list[float], bit_rate: int) -> None:
    """Messages begin at any phase, frames are as long as they can be, the lowest identifier goes first."""
    vehicle = sheet(6, bit_rate=bit_rate)
    latest = {each.id: each.latest for each in load_of(vehicle).shares}
    sent = [
        (
            phase * message.period + turn * message.period,
            message.id,
            longest(layout_of(message).length) / bit_rate,
        )
        for message, phase in zip([m for m in messages_of(vehicle) if m.period], phases, strict=False)
        for turn in range(ceil(1.0 / message.period))
    ]
    waiting, free, coming = [], 0.0, sorted(sent)
    while coming or waiting:
        if not waiting:
            free = max(free, coming[0][0])
        while coming and coming[0][0] <= free:
            due, id, length = coming.pop(0)
            waiting.append((id, due, length))
        waiting.sort()
        id, due, length = waiting.pop(0)
        free += length
        limit = latest[id]
        assert limit is None or free - due <= limit + 1e-9


def test_a_busy_tenth_of_a_second_is_found_among_quiet_ones() -> None:
    frame = Frame(0x555, b"\xaa" * 8)
    burst = [(1.02 + 0.001 * number, frame) for number in range(50)]
    found = measured_load([(0.0, frame), *burst, (10.01, frame)], 500_000)
    assert found is not None
    bits = length_of(frame)
    assert found.peak == pytest.approx(50 * bits / 50_000)
    assert (found.median, found.high) == (0.0, pytest.approx(bits / 50_000))
    assert found.mean == pytest.approx(52 * bits / 500_000 / 10.01)


def test_frames_at_the_ends_of_windows_are_shared_out_evenly() -> None:
    found = measured_load([(100.0 + number * 0.05, Frame(0x555, b"\xaa")) for number in range(2001)], 500_000)
    assert found is not None
    assert (
        found.median
        == found.high
        == found.peak
        == pytest.approx(2 * length_of(Frame(0x555, b"\xaa")) / 50_000)
    )


@pytest.mark.parametrize("times", [[], [1.0], [1.0, 1.0]])
def test_no_load_of_no_time(times: list[float]) -> None:
    assert measured_load([(time, Frame(1, b"")) for time in times], 500_000) is None


def test_stuffing_is_that_of_the_frames_that_were_heard() -> None:
    plain, stuffed = (
        measured_load([(0.0, Frame(id, data)), (1.0, Frame(id, data))], 500_000)
        for id, data in ((0x555, b"\xaa" * 8), (0x000, bytes(8)))
    )
    assert plain is not None
    assert stuffed is not None
    assert plain.stuffing < 4 < 14 < stuffed.stuffing
