"""Two senders of one message are told from one that begins anew, and from what networks do to its frames."""

from collections.abc import Iterable
from functools import cache
from random import Random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from vessel_sheets import sheet

from auv_vessel.guard import AHEAD, LATE, Senders, emergency_frame, name_of, own_of
from auv_vessel.wire.catalogue import NODES, REASONS, messages_of
from auv_vessel.wire.codec import Codec
from auv_vessel.wire.frame import Frame
from auv_vessel.wire.hub import corrupted

SHEET = sheet(2)


@cache
def all_depths(begin: float) -> tuple[Frame, ...]:
    codec = Codec(SHEET)
    return tuple(
        codec.encode("Depth", Depth=begin + 0.001 * number, Uncertainty=0.1, Trusted=True)
        for number in range(700)
    )


def depths(count: int, begin: float = 0.0, first: int = 0) -> list[Frame]:
    """Return what a sensor controller says whose counter begins there."""
    return list(all_depths(begin)[first : first + count])


def heard(frames: Iterable[Frame], period: float = 0.05) -> str:
    """Return what a node of movement notices that hears those frames."""
    senders = Senders(own_of("Movement"))
    for number, frame in enumerate(frames):
        senders.hear(frame, number * period)
    return senders.fault


def by_turns(*rows: list[Frame]) -> list[Frame]:
    return [frame for turn in zip(*rows, strict=True) for frame in turn]


@settings(deadline=None)
@given(st.integers(0, 255), st.sampled_from([0.05, 0.2, 0.5, 1.0]))
def test_two_senders_are_noticed_wherever_their_counters_are(apart: int, period: float) -> None:
    frames = by_turns(depths(LATE + 4), depths(LATE + 4, 5.0, first=apart))
    assert heard(frames, period / 2.0) == "two nodes say Depth (0x301), which only one is to say"


@settings(deadline=None)
@given(st.integers(0, 255), st.integers(2, 8))
def test_a_slower_sender_is_noticed(number: int, seldom: int) -> None:
    others = iter(depths(40, 9.0, first=number))
    frames = depths(40 * seldom)
    for place in range(seldom, 40 * (seldom + 1), seldom + 1):
        frames.insert(place, next(others))
    assert heard(frames)


def test_a_sender_that_does_not_count_is_noticed() -> None:
    stuck = depths(1, 9.0, first=77)[0]
    assert heard(frame for each in depths(300) for frame in (each, stuck))


@settings(deadline=None)
@given(st.lists(st.integers(1, 300), min_size=1, max_size=4))
def test_a_sender_that_begins_anew_now_and_then_is_one(lives: list[int]) -> None:
    assert (
        heard(frame for number, life in enumerate(lives) for frame in depths(life + 5, float(number + 1)))
        == ""
    )


@settings(deadline=None)
@given(st.integers(0, 2**32))
def test_frames_that_are_lost_come_twice_or_come_late_are_of_one(seed: int) -> None:
    random = Random(seed)
    loss, twice = random.choice([0.0, 0.3, 0.8]), random.choice([0.0, 0.3, 1.0])
    late = random.choice([0.0, 4.0, LATE - 1.0])
    frames = [
        (number + random.uniform(0.0, late), frame)
        for number, frame in enumerate(depths(400))
        if random.random() >= loss
        for _ in range(1 + (random.random() < twice))
    ]
    assert heard(frame for _, frame in sorted(frames, key=lambda each: each[0])) == ""


@settings(deadline=None)
@given(st.integers(0, 2**32), st.sampled_from([0.2, 0.8, 1.0]))
def test_damaged_frames_are_of_one(seed: int, part: float) -> None:
    random = Random(seed)
    frames = [corrupted(frame, random) if random.random() < part else frame for frame in depths(600)]
    assert heard(frames) == ""


def test_a_sender_of_whom_more_is_lost_than_its_counter_tells_is_one() -> None:
    frames = depths(600)
    assert heard([*frames[:50], *frames[50 + AHEAD + 90 : 400], *frames[520:]]) == ""


def test_what_only_oneself_says_is_noticed() -> None:
    codec = Codec(SHEET)
    said = [codec.encode("WrenchForce", Surge=1.0, Sway=0.0, Heave=0.0, Enable=True) for _ in range(3)]
    assert heard(said[:2]) == ""
    assert heard(said) == "another node says WrenchForce (0x080), which only this one is to say"
    assert heard(said, period=5.0) == ""


@settings(deadline=None)
@given(st.integers(0, 2**32))
def test_a_frame_whose_damaged_identifier_is_ones_own_is_none_of_ones_own(seed: int) -> None:
    random = Random(seed)
    damaged = [Frame(each.id ^ 1 << random.randrange(11), each.data) for each in depths(300)]
    assert heard(damaged) == ""


def test_each_node_may_say_emergencies_but_no_two_may_say_the_same() -> None:
    counters = (5, 200, 6, 201, 7, 202, 8, 203)
    others = [node for node in NODES if node != "Movement"]
    assert heard(emergency_frame(node, "LEAK", count) for count in range(40) for node in others) == ""
    two = [emergency_frame("Sensors", "LEAK", number) for number in counters]
    assert heard(two) == "two nodes say SensorsEmergency (0x011), which only one is to say"
    own = [emergency_frame("Movement", "LEAK", number) for number in counters]
    assert heard(own) == "another node says MovementEmergency (0x013), which only this one is to say"


def test_messages_of_others_are_of_no_concern() -> None:
    assert heard([Frame(0x18FF0080, bytes((number, 0)), True) for number in range(9)]) == ""


def test_every_identifier_belongs_to_one_message_of_one_node() -> None:
    assert len({message.id for message in messages_of(SHEET)}) == len(messages_of(SHEET))
    for message in messages_of(SHEET):
        owners = [node for node in NODES if message.id in own_of(node)]
        assert owners == [message.sender]
        assert name_of(message.id) == f"{message.name} (0x{message.id:03X})"
    assert 0x140 not in own_of("Vehicle", drives=False)


@pytest.mark.parametrize("node", NODES)
@pytest.mark.parametrize("reason", REASONS)
def test_emergencies_are_what_the_codec_says(reason: str, node: str) -> None:
    codec = Codec(SHEET)
    for counter in range(260):
        said = codec.encode(f"{node}Emergency", Reason=reason, Release=True)
        assert emergency_frame(node, reason, counter) == said
