"""Troubles that a hub makes on purpose: loss, corruption, delay, cuts."""

import time
from random import Random

import pytest
from can_hub import Raw, running
from hypothesis import given
from hypothesis import strategies as st
from patience import wait_for

from auv_vessel.hosting import tells_time
from auv_vessel.wire.frame import Frame
from auv_vessel.wire.hub import Hub, Troubles, corrupted


def heard_with(troubles: Troubles, count: int, seed: int = 1) -> list[str]:
    with running(Hub(troubles, seed)) as hub, Raw(hub.port) as said, Raw(hub.port) as heard:
        said.say("".join(f"< send 100 2 {number // 256:x} {number % 256:x} >" for number in range(count)))
        assert wait_for(lambda: hub.hub.counts["frames"] == count)
        time.sleep(troubles.delay)
        said.say("< send 7FF 0 >" * 64)
        words = []
        while (word := heard.word().split())[2] != "7FF":
            words.append(word[4])
        return words


def test_loss_takes_its_part_and_the_same_seed_the_same_frames() -> None:
    words = heard_with(Troubles(loss=0.3), 1000)
    assert 600 <= len(words) <= 800
    assert words == heard_with(Troubles(loss=0.3), 1000)
    assert words != heard_with(Troubles(loss=0.3), 1000, seed=2)


def test_what_is_spared_passes_whatever_becomes_of_the_rest() -> None:
    troubles = Troubles(loss=1.0, delay=60.0)
    with running(Hub(troubles, spared=tells_time)) as hub, Raw(hub.port) as first, Raw(hub.port) as second:
        for said in ("100 0", "001 0", "18FF0004 0"):
            first.say(f"< send {said} >")
        assert [second.word().split()[2] for _ in range(2)] == ["001", "18FF0004"]


def test_corruption_makes_its_part_wrong() -> None:
    words = heard_with(Troubles(corruption=0.5), 600)
    wrong = sum(word != f"{number:04X}" for number, word in enumerate(words))
    assert len(words) == 600
    assert 220 <= wrong <= 380


def test_delay_takes_its_time_and_keeps_the_order() -> None:
    with running(Hub(Troubles(delay=0.2))) as hub, Raw(hub.port) as said, Raw(hub.port) as heard:
        begin = time.monotonic()
        said.say("".join(f"< send 100 1 {number:x} >" for number in range(50)))
        words = [heard.word().split()[4] for _ in range(50)]
        assert 0.2 <= time.monotonic() - begin < 2.0
        assert words == [f"{number:02X}" for number in range(50)]
        hub.hub.troubles = Troubles()
        said.say("< send 101 0 >")
        assert heard.word().startswith("< frame 101 ")


def test_a_bus_that_is_cut_and_mended() -> None:
    with running() as hub, Raw(hub.port) as said, Raw(hub.port) as heard:
        hub.hub.troubles = Troubles(loss=1.0)
        said.say("< send 100 0 >" * 10)
        assert wait_for(lambda: hub.hub.counts["lost"] == 10)
        hub.hub.troubles = Troubles()
        said.say("< send 101 0 >")
        assert heard.word().startswith("< frame 101 ")


@pytest.mark.parametrize(
    "wrong", [{"loss": -0.1}, {"corruption": 1.1}, {"delay": -1.0}, {"loss": float("nan")}]
)
def test_troubles_that_are_none(wrong: dict[str, float]) -> None:
    with pytest.raises(ValueError, match=next(iter(wrong))):
        Troubles(**wrong)


@given(st.binary(min_size=1, max_size=8), st.integers())
def test_corruption_is_one_to_three_bits_of_the_data(data: bytes, seed: int) -> None:
    wrong = corrupted(Frame(5, data), Random(seed))
    bits = (int.from_bytes(data) ^ int.from_bytes(wrong.data)).bit_count()
    assert (wrong.id, len(wrong.data)) == (5, len(data))
    assert 1 <= bits <= 3
