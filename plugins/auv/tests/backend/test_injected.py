"""Faults that are made on purpose between a decision centre and its vehicle's bus."""

from collections.abc import Iterator
from contextlib import contextmanager

import pytest
from can_hub import running
from dives import dive, diver
from hypothesis import given
from hypothesis import strategies as st
from mmrs_auv.backend.connected import faults_of
from mmrs_auv.controllers.connected import frame_of, injected, piece_of

from auv_vessel.hosting import clock_frame
from auv_vessel.wire.frame import Frame
from auv_vessel.wire.ports import Port, open_port
from mmrs_core.contributions.vehicles import Live, VehicleInput
from mmrs_core.errors import UsageError
from mmrs_runtime.engine.clocks import RealClock
from mmrs_runtime.injection import Rehearsal

FRAMES = st.builds(Frame, st.integers(0, 0x7FF), st.binary(max_size=8)) | st.builds(
    Frame, st.integers(0, (1 << 29) - 1), st.binary(max_size=8), st.just(True)
)
SAID = Frame(0x123, b"\1\2\3")


def live() -> Live:
    return Live(RealClock(), lambda: None, lambda line: None, "run", announce=lambda line: None)


def asked() -> VehicleInput:
    behaviour = dive()
    return VehicleInput(behaviour, {}, {}, {}, robot=behaviour.robots[0], type=diver())


def faults(text: str) -> Rehearsal:
    found = faults_of(asked(), live(), text)
    assert found is not None
    return found


@contextmanager
def between(text: str) -> Iterator[tuple[Port, Port]]:
    """Yield the ports of a decision centre whose bus has such faults from now on, and of its vehicle."""
    with running() as hub:
        channel = f"can0@127.0.0.1:{hub.port}"
        with open_port("socketcand", channel) as ours, open_port("socketcand", channel) as theirs:
            made = faults(text)
            yield injected(ours, made, "naiad"), theirs
            made.forget("naiad")


@given(FRAMES)
def test_frames_become_bytes_and_frames_again(frame: Frame) -> None:
    assert frame_of(piece_of(frame)) == frame


@given(FRAMES, st.data())
def test_a_wrong_bit_leaves_a_frame(frame: Frame, data: st.DataObject) -> None:
    piece = bytearray(piece_of(frame))
    bit = data.draw(st.integers(0, 8 * len(piece) - 1))
    piece[bit // 8] ^= 1 << bit % 8
    found = frame_of(bytes(piece))
    assert 0 <= found.id < (1 << 29 if found.extended else 1 << 11)


@pytest.mark.parametrize("text", ["loss=1", "naiad:cut@0", "cut-in@0"])
def test_what_is_lost_is_not_heard_but_simulated_time_is(text: str) -> None:
    with between(text) as (centre, vehicle):
        for frame in (SAID, clock_frame(1.0)):
            vehicle.send(frame)
        assert centre.receive(5.0) == clock_frame(1.0)
        assert centre.receive(0.2) is None


def test_what_is_said_is_lost_too() -> None:
    with between("cut-out@0") as (centre, vehicle):
        for frame in (SAID, clock_frame(2.0)):
            centre.send(frame)
        assert vehicle.receive(5.0) == clock_frame(2.0)
        assert vehicle.receive(0.2) is None


def test_a_cut_ends_in_time() -> None:
    with between("cut@0+0.3") as (centre, vehicle):
        vehicle.send(SAID)
        assert centre.receive(0.4) is None
        vehicle.send(SAID)
        assert centre.receive(5.0) == SAID


def test_all_robots_of_a_run_have_the_same_faults() -> None:
    of_run = live()
    assert faults_of(asked(), of_run, "") is None
    first = faults_of(asked(), of_run, "loss=0.1")
    assert faults_of(asked(), of_run, "loss=0.1") is first
    assert first is not None
    first.forget("naiad")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("gps-lost@3", "gps-lost@3: is for vehicles that speak MAVLink"),
        ("ground-cut@3", "ground-cut@3: is for vehicles that speak MAVLink"),
        ("loss=2", "is a part of all"),
        ("flood", "'flood': is not a fault"),
        ("Nobody:loss=0.1", "unknown robot 'Nobody'"),
    ],
)
def test_faults_that_no_vehicle_on_a_bus_has_are_refused(text: str, said: str) -> None:
    with pytest.raises(UsageError, match=said):
        faults(text)
