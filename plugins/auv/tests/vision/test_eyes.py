"""What the decision centre takes of what cameras tell."""

from __future__ import annotations

import json
import socket
import time
from collections.abc import Iterator
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st
from mmrs_auv.vessel.eyes import LONGEST, NAMES, Detection, Detections, from_datagram, to_datagram

BUOY = Detection(12.0, "red buoy", 0.9, 3.0, -1.0, 2.0, "front")


class Hands:
    """A clock that is set by hand."""

    now = 0.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture
def clock() -> Hands:
    return Hands()


@pytest.fixture
def eyes(clock: Hands) -> Iterator[Detections]:
    with Detections(clock=clock) as found:
        yield found


def tell(eyes: Detections, *changes: dict[str, object]) -> None:
    for number, change in enumerate(changes):
        eyes.take(to_datagram(replace(BUOY, **({"time": 12.0 + number} | change))))  # type: ignore[arg-type]


def test_a_detection_comes_back_as_it_was_sent() -> None:
    assert from_datagram(to_datagram(BUOY)) == BUOY


@pytest.mark.parametrize(
    ("change", "why"),
    [
        ({"confidence": 1.5}, "confidence out of range"),
        ({"confidence": float("nan")}, "confidence out of range"),
        ({"north": 10**400}, "north out of range"),
        ({"east": True}, "east is no number"),
        ({"depth": "2"}, "depth is no number"),
        ({"camera": "rear"}, "no camera"),
        ({"camera": []}, "no camera"),
        ({"name": ""}, "no name"),
        ({"name": "a\x1bb"}, "no name"),
        ({"name": 3}, "no name"),
        ({"time": -1.0}, "time out of range"),
        ({"colour": "red"}, "other keys"),
    ],
)
def test_what_is_no_detection_is_refused_and_counted(
    eyes: Detections, change: dict[str, object], why: str
) -> None:
    eyes.take(json.dumps(json.loads(to_datagram(BUOY)) | change).encode())
    assert eyes.bad == {why: 1}
    assert eyes.newest("red buoy") is None


@pytest.mark.parametrize(
    "data", [b"", b"\xff\xfe", b"[" * 1000, b"[]", b"null", b"{}", b"9" * LONGEST, b" " * 2000]
)
def test_datagrams_of_anything_are_counted(eyes: Detections, data: bytes) -> None:
    eyes.take(data)
    assert eyes.bad.total() == 1


@given(st.binary(max_size=200))
def test_no_bytes_break_the_reader(data: bytes) -> None:
    with pytest.raises(ValueError):
        from_datagram(data)


def test_one_detection_alone_is_no_place(eyes: Detections) -> None:
    tell(eyes, {})
    assert eyes.place("red buoy") is None
    assert eyes.seen() == frozenset()


def test_the_place_is_the_median_of_those_that_agree(eyes: Detections) -> None:
    tell(eyes, {"north": 3.0}, {"north": 3.2}, {"north": 3.4}, {"north": 90.0})
    assert eyes.place("red buoy") == (3.2, -1.0, 2.0)
    assert eyes.seen() == {"red buoy"}


def test_detections_that_do_not_agree_are_no_place(eyes: Detections) -> None:
    tell(eyes, {"north": 3.0}, {"north": 30.0})
    assert eyes.place("red buoy") is None


def test_what_is_not_confident_counts_for_nothing(eyes: Detections) -> None:
    tell(eyes, {"confidence": 0.4}, {"confidence": 0.3})
    assert eyes.newest("red buoy") is None


def test_detections_are_forgotten(eyes: Detections, clock: Hands) -> None:
    tell(eyes, {}, {})
    clock.now = 9.9
    assert eyes.place("red buoy") is not None
    clock.now = 10.1
    assert eyes.place("red buoy") is None


def test_a_repeated_or_late_datagram_counts_once(eyes: Detections) -> None:
    tell(eyes, {"time": 12.0}, {"time": 12.0}, {"time": 11.0})
    assert eyes.bad == {"late": 2}
    assert eyes.place("red buoy") is None


def test_one_datagram_from_the_far_future_does_not_silence_the_camera(eyes: Detections) -> None:
    tell(eyes, {"time": 1e11}, {"time": 12.0}, {"time": 12.5})
    assert eyes.place("red buoy") is not None


def test_names_without_end_take_no_memory_without_end(eyes: Detections, clock: Hands) -> None:
    tell(eyes, *({"name": f"thing {number}"} for number in range(NAMES + 10)))
    assert eyes.bad == {"too many names": 10}
    clock.now = 20.0
    tell(eyes, {"time": 500.0}, {"time": 501.0})
    assert eyes.place("red buoy") is not None


def test_it_listens_to_datagrams() -> None:
    with Detections() as eyes, socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        for data in (b"nonsense", b"x" * 5000, to_datagram(BUOY), to_datagram(replace(BUOY, time=12.5))):
            sender.sendto(data, ("127.0.0.1", eyes.port))
        until = time.monotonic() + 5.0
        while eyes.place("red buoy") is None and time.monotonic() < until:
            time.sleep(0.01)
        assert eyes.place("red buoy") == (3.0, -1.0, 2.0)
        assert eyes.bad == {"no JSON": 1, "too long": 1}
