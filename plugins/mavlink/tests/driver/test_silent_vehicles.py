"""A vehicle that falls silent in the middle of an exchange: the policy's seconds say when it is lost."""

import threading
import time
from contextlib import contextmanager, suppress

import pytest
from mavlink_peer import acknowledged, linked, value
from pymavlink.dialects.v20 import ardupilotmega as mavlink
from stalls import Stalls

from mmrs_mavlink.program import Geographic
from mmrs_mavlink.services import parameters
from mmrs_mavlink.services.commands import command
from mmrs_mavlink.services.items import FENCE, Item
from mmrs_mavlink.services.missions import upload
from mmrs_mavlink.services.reading import download
from mmrs_mavlink.vehicles.px4 import Px4Guidance
from mmrs_mavlink.vehicles.telemetry import Telemetry
from mmrs_runtime.faults import LINK_LOST, FaultError, RefusedError

pytestmark = pytest.mark.real_time("parts of flights")

ARM = mavlink.MAV_CMD_COMPONENT_ARM_DISARM
HOME = Geographic(42.37, 13.35, 0.0)
ITEM = Item(mavlink.MAV_CMD_NAV_WAYPOINT, x=423_700_000, y=133_500_000)
AFTER = 1.2
"""Seconds of the policy: more than twice what all tries of these links take."""

EXCHANGES = {
    "command": lambda link: command(link, ARM, 1.0),
    "read parameters": lambda link: parameters.read(link, ["A", "B"]),
    "write a parameter": lambda link: parameters.write(link, "A", 1.0),
    "upload": lambda link: upload(link, [ITEM, ITEM]),
    "clear": lambda link: upload(link, [], FENCE),
    "download": download,
    "begin an item": lambda link: Px4Guidance(link, Telemetry(link, HOME)).select(3),
}
every_exchange = pytest.mark.parametrize("exchange", list(EXCHANGES))


def lost_after(link, seconds: float):
    """Return a guard that says when the vehicle is lost, as a robot's watch does."""

    def guard() -> None:
        if link.silent_for() > seconds:
            raise FaultError(LINK_LOST, "silent")

    return guard


@contextmanager
def beating(wire):
    """Have the vehicle be heard, whatever it answers."""
    over = threading.Event()

    def beat() -> None:
        while not over.wait(0.02):
            wire.beat()

    thread = threading.Thread(target=beat)
    thread.start()
    try:
        yield
    finally:
        over.set()
        thread.join()


@every_exchange
def test_a_silent_vehicle_is_lost_when_the_policy_says_and_not_when_the_tries_are_used_up(exchange):
    with linked() as (link, _):
        link.guard = lost_after(link, AFTER)
        begun = time.monotonic()
        with pytest.raises(FaultError) as raised:
            EXCHANGES[exchange](link)
        assert raised.value.event == LINK_LOST
        assert time.monotonic() - begun > AFTER - 0.3


@every_exchange
def test_a_vehicle_that_is_heard_and_does_not_answer_is_given_up_after_the_tries(exchange):
    with linked() as (link, wire), beating(wire):
        link.guard = lost_after(link, 60.0)
        stalls = Stalls()
        with suppress(RefusedError):
            EXCHANGES[exchange](link)
        # While this machine stalls, the vehicle is not heard either, and what is sent then does not count.
        most = link.retries.tries * link.retries.tries + stalls.seconds / link.retries.item
        assert 0 < len(wire.sent) <= most


def test_an_exchange_goes_on_when_the_vehicle_is_back_within_the_seconds_of_the_policy():
    back = time.monotonic() + 1.5

    def answer(message):
        if time.monotonic() < back:
            return []
        if message.get_type() == "PARAM_SET":
            return [value("A", 1.0)]
        return [acknowledged(ARM)]

    with linked(answer) as (link, wire):
        link.guard = lost_after(link, 20.0)
        command(link, ARM, 1.0)
        assert parameters.write(link, "A", 1.0)
        assert len(wire.of("COMMAND_LONG")) > link.retries.tries


def test_time_in_which_the_vehicle_is_silent_is_no_time_that_it_takes():
    with linked() as (link, wire):
        link.guard = lost_after(link, 20.0)
        begun = time.monotonic()
        back = threading.Timer(1.2, lambda: None)
        back.start()

        def goes_on() -> None:
            if not back.is_alive():
                wire.beat()

        assert link.wait(goes_on, 0.5, while_received=True) is None
        assert time.monotonic() - begun > 1.2
        back.join()


def test_nobody_waits_for_ever_where_nobody_watches():
    with linked() as (link, wire):
        with pytest.raises(RefusedError, match="no answer to 3 tries"):
            command(link, ARM, 1.0)
        assert len(wire.sent) == 3
