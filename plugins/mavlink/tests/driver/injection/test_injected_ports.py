import threading
import time
from collections import deque

import pytest
from stalls import Stalls

from mmrs_runtime.clock import Clock
from mmrs_runtime.injection import Rehearsal, injections
from mmrs_runtime.ports import NOTHING, Received

pytestmark = pytest.mark.real_time("parts of flights")

URLS = {"alpha": "udpin:127.0.0.1:1"}
PIECES = [b"%04d" % number for number in range(2000)]


class Wire:
    """A port to ourselves: what is written can be looked at, and what was put in is read."""

    def __init__(self, incoming=()) -> None:
        self.incoming = deque(incoming)
        self.written: list[bytes] = []
        self.when: list[float] = []

    def read(self, seconds: float) -> Received:
        if self.incoming:
            return Received(self.incoming.popleft())
        time.sleep(min(seconds, 0.01))
        return NOTHING

    def write(self, data: bytes, to=None) -> None:
        self.written.append(data)
        self.when.append(time.monotonic())

    def close(self) -> None:
        pass


def wrapped(wire: Wire, text: str, clock: Clock | None = None, notes: list | None = None):
    rehearsal = Rehearsal(injections([text], URLS), clock or Clock(), lambda line: None)
    if notes is not None:
        rehearsal.record("alpha", lambda fault, content: notes.append((fault, dict(content))))
    return rehearsal.wrap(wire, ["alpha"])


def sent(text: str, pieces=PIECES) -> list[bytes]:
    wire = Wire()
    port = wrapped(wire, text)
    for piece in pieces:
        port.write(piece)
    port.close()
    return wire.written


def test_without_faults_the_port_is_the_port():
    wire = Wire()
    rehearsal = Rehearsal(injections(["freeze@9+1"], URLS), Clock(), lambda line: None)
    assert rehearsal.wrap(wire, ["alpha"]) is wire


def test_about_that_part_is_lost_and_the_rest_is_unchanged_and_in_order():
    got = sent("loss=0.15")
    assert 0.12 < 1 - len(got) / len(PIECES) < 0.18
    assert got == [piece for piece in PIECES if piece in set(got)]


def test_a_loss_of_one_loses_all_and_one_of_nothing_loses_nothing():
    assert sent("loss=1") == []
    assert sent("loss=0") == PIECES


def test_about_that_part_comes_twice():
    got = sent("duplicate=0.1")
    assert 0.08 < len(got) / len(PIECES) - 1 < 0.12
    assert sorted(set(got)) == PIECES


def test_a_damaged_piece_differs_by_one_bit():
    got = sent("corrupt=0.2")
    differing = [(a, b) for a, b in zip(PIECES, got, strict=True) if a != b]
    assert 0.16 < len(differing) / len(PIECES) < 0.24
    for whole, damaged in differing:
        assert sum((x ^ y).bit_count() for x, y in zip(whole, damaged, strict=True)) == 1


def test_equal_seeds_make_equal_faults_and_others_others():
    assert sent("loss=0.3,seed=7") == sent("loss=0.3,seed=7")
    assert sent("loss=0.3,seed=7") != sent("loss=0.3,seed=8")


def test_what_comes_in_is_lost_as_well_but_not_the_same_pieces():
    port = wrapped(Wire(PIECES), "loss=0.3")
    got = [piece for piece in (port.read(0.0).data or port.read(0.001).data for _ in PIECES) if piece]
    port.close()
    assert 0.25 < 1 - len(got) / len(PIECES) < 0.35
    assert got != sent("loss=0.3")


def test_a_delayed_piece_is_sent_later_by_the_clock_of_the_run():
    wire = Wire()
    port = wrapped(wire, "delay=4", Clock(speedup=20.0))
    begun = time.monotonic()
    port.write(b"late")
    assert wire.written == []
    while not wire.written and time.monotonic() < begun + 5.0:
        time.sleep(0.01)
    port.close()
    assert wire.written == [b"late"]
    assert wire.when[0] - begun >= 0.19


def test_a_delayed_piece_is_heard_later_and_reading_still_returns_in_time():
    port = wrapped(Wire([b"late"]), "delay=0.3")
    stalls, begun = Stalls(), time.monotonic()
    assert port.read(0.05).data == b""
    assert time.monotonic() - begun < 0.25 + stalls.seconds
    assert port.read(5.0).data == b"late"
    assert time.monotonic() - begun >= 0.29
    port.close()


def test_delays_that_differ_change_the_order():
    wire = Wire()
    port = wrapped(wire, "delay=0.1~0.1")
    for piece in PIECES[:200]:
        port.write(piece)
    until = time.monotonic() + 5.0
    while len(wire.written) < 200 and time.monotonic() < until:
        time.sleep(0.01)
    port.close()
    assert sorted(wire.written) == PIECES[:200]
    assert wire.written != PIECES[:200]


@pytest.mark.parametrize(
    ("text", "heard", "passed"),
    [("cut@0", False, False), ("cut-in@0", False, True), ("cut-out@0", True, False)],
)
def test_a_cut_is_both_ways_or_one_way(text, heard, passed):
    wire = Wire([b"in"])
    port = wrapped(wire, text)
    port.write(b"out")
    assert (port.read(0.05).data == b"in", wire.written == [b"out"]) == (heard, passed)
    port.close()


def test_a_cut_ends():
    wire = Wire()
    clock = Clock(speedup=100.0)
    port = wrapped(wire, "cut@0+30", clock)
    port.write(b"lost")
    time.sleep(clock.real(35.0))
    port.write(b"passes")
    port.close()
    assert wire.written == [b"passes"]


def test_what_happened_is_counted_for_the_black_box():
    notes: list = []
    wire = Wire()
    port = wrapped(wire, "loss=0.5,duplicate=0.5", notes=notes)
    for piece in PIECES:
        port.write(piece)
    port.close()
    assert ("loss=0.5", {"state": "asked for", "seed": 0}) in notes
    assert notes[-1][0] == "link"
    counted = notes[-1][1]
    assert counted["state"] == "counted"
    assert len(wire.written) == len(PIECES) - counted["loss"] + counted["duplicate"]


def test_a_port_that_takes_nothing_tells_it_as_before():
    class Broken(Wire):
        def write(self, data: bytes, to=None) -> None:
            raise OSError("gone")

    port = wrapped(Broken(), "loss=0")
    with pytest.raises(OSError, match="gone"):
        port.write(b"x")
    port.close()


def test_a_closed_port_leaves_no_thread_behind():
    before = threading.active_count()
    wrapped(Wire(), "delay=60").close()
    assert threading.active_count() == before
