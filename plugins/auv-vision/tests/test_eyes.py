"""What the decision centre takes of what cameras tell."""

import json
import socket
import time
from collections.abc import Iterator
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from auv_vessel.eyes import LONGEST, NAMES, Detection, Detections, from_datagram, owner_of, to_datagram

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
        ({"east": True}, "east is not a number"),
        ({"depth": "2"}, "depth is not a number"),
        ({"camera": "rear"}, "no camera"),
        ({"camera": []}, "no camera"),
        ({"name": ""}, "no name"),
        ({"name": "a\x1bb"}, "no name"),
        ({"name": 3}, "no name"),
        ({"time": -1.0}, "time out of range"),
        ({"robot": 3}, "no robot"),
        ({"robot": "x" * 81}, "no robot"),
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


def test_what_the_cameras_of_another_robot_see_counts_for_nothing(clock: Hands) -> None:
    with Detections(clock=clock, robot="Thetis") as eyes:
        tell(eyes, {"robot": "Otter"}, {"robot": "Otter"}, {"robot": "thetis"})
        assert eyes.place("red buoy") is None
        assert eyes.bad == {"of another robot": 3}
        tell(eyes, {"robot": "Thetis"}, {"robot": ""})
        assert eyes.place("red buoy") == (3.0, -1.0, 2.0)


def test_a_robot_of_a_long_name_knows_its_cameras_by_the_beginning_of_it(clock: Hands) -> None:
    name = "\U0001f991" * 300
    with Detections(clock=clock, robot=name) as eyes:
        tell(eyes, {"robot": owner_of(name)}, {"robot": owner_of(name), "name": "\U0001f991" * 80})
        assert eyes.bad.total() == 0


def test_who_says_nothing_of_robots_is_read_as_before(eyes: Detections) -> None:
    assert b"robot" not in to_datagram(BUOY)
    tell(eyes, {"robot": "Otter"}, {})
    assert eyes.seen() == {"red buoy"}


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
    tell(eyes, {"time": 12.0}, {"time": 12.0})
    assert eyes.bad == {"late": 1}
    assert eyes.place("red buoy") is None
    tell(eyes, {"time": 12.5}, {"time": 11.0}, {"time": 13.0}, {"time": 11.0})
    assert eyes.bad == {"late": 3}


@pytest.mark.parametrize("future", [1e11, 70.0, 13.0])
@pytest.mark.parametrize("before", [0, 1, 2, 5])
def test_one_datagram_from_the_future_does_not_silence_the_camera(
    eyes: Detections, clock: Hands, future: float, before: int
) -> None:
    tell(eyes, *({"time": 12.0 + 0.01 * number} for number in range(before)))
    tell(eyes, {"time": future})
    for number in range(100):
        clock.now += 0.2
        tell(eyes, {"time": 12.1 + 0.005 * number, "north": 4.0})
    assert eyes.place("red buoy") == (4.0, -1.0, 2.0)
    assert eyes.bad == {}


@pytest.mark.parametrize("age", [2.0, 30.0, 300.0, 3000.0])
def test_what_was_told_before_does_not_count_again_beside_what_is_told_now(
    eyes: Detections, clock: Hands, age: float
) -> None:
    for number in range(50):
        clock.now += 0.2
        tell(eyes, {"time": 5000.0 + number})
        if number > 2:
            tell(eyes, *({"time": 5000.0 + number - age - more, "north": 30.0} for more in (0.0, 1.0)))
    assert eyes.place("red buoy") == (3.0, -1.0, 2.0)
    assert eyes.bad["late"] > 90


def test_a_camera_whose_clock_begins_anew_is_heard_again(eyes: Detections, clock: Hands) -> None:
    tell(eyes, *({"time": 500.0 + number} for number in range(9)))
    tell(eyes, {"time": 1.0})
    assert eyes.bad == {"late": 1}
    clock.now += 10.5
    tell(eyes, {"time": 12.0, "north": 4.0}, {"time": 12.2, "north": 4.0})
    assert eyes.place("red buoy") == (4.0, -1.0, 2.0)


def test_the_first_datagram_that_is_refused_for_a_reason_is_logged(
    eyes: Detections, caplog: pytest.LogCaptureFixture
) -> None:
    for _ in range(3):
        eyes.take(b"nonsense")
    assert [each.getMessage() for each in caplog.records] == [
        f"a detection at port {eyes.port} is refused: no JSON"
    ]


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
