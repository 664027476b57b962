"""Modes that the program has asked for itself, and that the vehicle shows late."""

import threading
from dataclasses import replace

import pytest
from mavlink_peer import acknowledged, eventually, heartbeat, linked

from mmrs_mavlink import Geographic
from mmrs_mavlink.driving.worker import Interrupted
from mmrs_mavlink.profiles import modes
from mmrs_mavlink.vehicles.mode_control import ModeControl
from mmrs_mavlink.vehicles.telemetry import Telemetry
from mmrs_runtime.faults import FaultError

HOME = Geographic(42.37, 13.35, 0.0)
STABILIZE, GUIDED, LOITER, LAND, BRAKE = 0, 4, 5, 9, 17


class Late:
    """A vehicle that shows the first mode only when another one is asked for, and that one a little later."""

    def __init__(self, wire) -> None:
        self.wire, self.asked, self.pause = wire, [], 0.2

    def __call__(self, message):
        if message.get_type() == "COMMAND_LONG":
            yield acknowledged(message.command)
            before, self.asked = self.asked[-1:], [*self.asked, int(message.param2)]
            for mode in before:
                self.wire.beat(mode=mode, armed=True)
                shows = {"mode": self.asked[-1], "armed": True}
                threading.Timer(self.pause, self.wire.beat, kwargs=shows).start()


@pytest.fixture
def late():
    """Return the mode control of a vehicle that stands in STABILIZE, its link, its telemetry and the wire."""
    with linked(speedup=10.0) as (link, wire):
        wire.answer = Late(wire)
        telemetry = Telemetry(link, HOME)
        show(wire, telemetry, STABILIZE)
        yield ModeControl(link, telemetry), link, telemetry, wire


def show(wire, telemetry, mode: int) -> None:
    wire.beat(mode=mode, armed=True)
    eventually(lambda: telemetry.mode() == mode)


def broken_off(mode_control: ModeControl, link, wire, mode: str) -> None:
    """Ask for a mode, and let something else come before the vehicle shows it."""

    def order() -> None:
        if wire.answer.asked:
            raise Interrupted

    link.guard = order
    with pytest.raises(Interrupted):
        mode_control.enter(mode)
    link.guard = lambda: None


def test_a_mode_that_was_asked_for_before_an_order_came_is_no_pilots(late):
    mode_control, link, telemetry, wire = late
    broken_off(mode_control, link, wire, modes.GUIDED)
    mode_control.enter(modes.LAND)
    assert telemetry.mode() == LAND
    assert wire.answer.asked == [GUIDED, LAND]
    mode_control.check()


def test_a_copy_of_an_earlier_request_is_answered_by_asking_again(late):
    mode_control, link, telemetry, wire = late
    wire.answer.pause = 0.0
    link.retries = replace(link.retries, answer=5.0)
    broken_off(mode_control, link, wire, modes.HOLD)
    mode_control.enter(modes.LAND)
    show(wire, telemetry, BRAKE)
    mode_control.check()
    assert wire.answer.asked[-1] == LAND
    eventually(lambda: telemetry.mode() == LAND)
    mode_control.check()


def test_a_pilots_mode_is_a_pilots_however_many_requests_are_on_their_way(late):
    mode_control, link, _, wire = late
    broken_off(mode_control, link, wire, modes.GUIDED)
    wire.answer = lambda message: (acknowledged(176), heartbeat(mode=LOITER, armed=True))
    with pytest.raises(FaultError, match="left mode stabilize for loiter: it is under external control"):
        mode_control.enter(modes.LAND)


def test_what_was_asked_for_long_ago_is_a_pilots_again(late):
    mode_control, link, telemetry, wire = late
    broken_off(mode_control, link, wire, modes.HOLD)
    mode_control.enter(modes.LAND)
    link.clock.skip(10.0)
    show(wire, telemetry, BRAKE)
    with pytest.raises(FaultError, match="left mode land for hold: it is under external control"):
        mode_control.check()
