"""The mission protocol, message by message."""

from __future__ import annotations

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.profiles import ARDUPILOT, PX4
from mmrs_mavlink.sitl.items import StoredItem
from mmrs_mavlink.sitl.transfers import Transfers

OLD = [StoredItem(3, 16, (0.0, 0.0, 0.0, 0.0), n, n, 1.0) for n in range(4)]
CANCELLED = mavlink.MAV_MISSION_OPERATION_CANCELLED


class Exchange:
    """A vehicle's side of the protocol, and all its answers."""

    def __init__(self, firmware: str = "ardupilot") -> None:
        self.answers = []
        self.stores = {0: list(OLD), 1: list(OLD), 2: []}
        self.said = []
        say = lambda severity, text: self.said.append(text)  # noqa: E731
        autopilot = {"ardupilot": ARDUPILOT, "px4": PX4}[firmware]
        self.transfers = Transfers(self.stores, self.answers.append, say, autopilot)

    def take(self, message, component: int = 190):
        """Return the answer to a message; None if there is none."""
        message._header.srcSystem, message._header.srcComponent = 255, component
        before = len(self.answers)
        self.transfers.take(message)
        return self.answers[-1] if len(self.answers) > before else None

    def count(self, number: int, kind: int = 0, component: int = 190):
        return self.take(mavlink.MAVLink_mission_count_message(1, 1, number, kind), component)

    def item(self, seq: int, command: int = 16, frame: int = 3, kind: int = 0):
        head = (1, 1, seq, frame, command, 0, 1)
        return self.take(mavlink.MAVLink_mission_item_int_message(*head, 0, 0, 0, 0, 100 + seq, 0, 5, kind))

    def list(self):
        return self.take(mavlink.MAVLink_mission_request_list_message(1, 1, 0))

    def request(self, seq: int):
        return self.take(mavlink.MAVLink_mission_request_int_message(1, 1, seq, 0))

    def clear(self, kind: int = 0):
        return self.take(mavlink.MAVLink_mission_clear_all_message(1, 1, kind))

    def places(self, kind: int = 0) -> list[int]:
        return [item.x for item in self.stores[kind]]


@pytest.fixture
def exchange():
    return Exchange()


@pytest.fixture
def px4():
    return Exchange("px4")


@pytest.mark.parametrize("firmware", ["ardupilot", "px4"])
def test_items_are_requested_in_sequence_and_acknowledged_at_the_end(firmware):
    exchange = Exchange(firmware)
    exchange.count(2)
    exchange.item(0)
    exchange.item(1)
    kinds = [(message.get_type(), getattr(message, "seq", None)) for message in exchange.answers]
    assert kinds == [("MISSION_REQUEST_INT", 0), ("MISSION_REQUEST_INT", 1), ("MISSION_ACK", None)]
    assert exchange.places() == [100, 101]


def test_ardupilot_rejects_a_repeated_item_and_counts_it_once(exchange):
    exchange.count(2)
    exchange.item(0)
    assert exchange.item(0).type == mavlink.MAV_MISSION_INVALID_SEQUENCE
    assert exchange.item(1).type == 0
    assert exchange.places() == [100, 101]
    assert exchange.item(1).type == mavlink.MAV_MISSION_ERROR


def test_ardupilot_clears_nothing_during_an_upload(exchange):
    exchange.count(2)
    assert exchange.clear().type == mavlink.MAV_MISSION_ERROR
    assert exchange.count(0).type == 0
    assert exchange.stores[0] == []


def test_ardupilot_restarts_an_upload_for_its_sender_only(exchange):
    exchange.count(2)
    exchange.item(0)
    assert exchange.count(2, component=1).type == mavlink.MAV_MISSION_DENIED
    assert exchange.count(2).seq == 0


def test_px4_ignores_a_repeated_item_and_accepts_the_last_again(px4):
    px4.count(2)
    px4.item(0)
    assert px4.item(0) is None
    assert [px4.item(1).type, px4.item(1).type] == [0, 0]


def test_px4_is_busy_until_the_transfer_ends(px4):
    px4.count(2)
    px4.item(0)
    assert px4.count(2).type == mavlink.MAV_MISSION_ERROR
    px4.take(mavlink.MAVLink_mission_ack_message(1, 1, CANCELLED, 0))
    assert px4.count(2).seq == 0


@pytest.mark.parametrize("firmware", ["ardupilot", "px4"])
def test_an_invalid_item_ends_the_upload(firmware):
    exchange = Exchange(firmware)
    exchange.count(2)
    assert exchange.item(0, frame=1).type == mavlink.MAV_MISSION_UNSUPPORTED_FRAME
    assert exchange.count(2).seq == 0


def test_an_aborted_mission_is_a_mixture_of_old_and_new(exchange):
    exchange.count(3)
    exchange.item(0)
    exchange.item(1)
    assert exchange.places() == [100, 101, 2]


@pytest.mark.parametrize(("firmware", "kind", "command"), [("ardupilot", 1, 5002), ("px4", 0, 16)])
def test_a_fence_and_every_list_of_px4_are_replaced_as_a_whole(firmware, kind, command):
    exchange = Exchange(firmware)
    exchange.count(2, kind)
    exchange.item(0, command=command, kind=kind)
    assert exchange.stores[kind] == OLD


@pytest.mark.parametrize(
    ("firmware", "requests", "text"),
    [("ardupilot", range(5, 10), "Mission upload timeout"), ("px4", range(12, 20), "Mission upload timeout")],
)
def test_a_missing_item_is_requested_again_until_the_upload_times_out(firmware, requests, text):
    exchange = Exchange(firmware)
    exchange.count(2)
    for tick in range(100):
        exchange.transfers.advance(tick * 0.1, 0.0)
    kinds = [message.get_type() for message in exchange.answers]
    assert kinds.count("MISSION_REQUEST_INT") in requests
    assert exchange.said == [text]
    assert firmware == "px4" or exchange.answers[-1].type == CANCELLED


@pytest.mark.parametrize("firmware", ["ardupilot", "px4"])
def test_nothing_is_accepted_just_after_boot(firmware):
    exchange = Exchange(firmware)
    exchange.transfers.busy = True
    assert exchange.count(2).type == mavlink.MAV_MISSION_NO_SPACE
    assert exchange.stores[0] == OLD


def test_a_list_is_sent_item_by_item(exchange):
    assert exchange.list().count == 4
    item = exchange.request(2)
    assert (item.get_type(), item.x) == ("MISSION_ITEM_INT", 2)
    assert exchange.request(9).type == mavlink.MAV_MISSION_INVALID_SEQUENCE


@pytest.mark.parametrize("firmware", ["ardupilot", "px4"])
def test_all_lists_are_cleared_at_once(firmware):
    exchange = Exchange(firmware)
    assert exchange.clear(255).type == 0
    assert exchange.stores == {0: [], 1: [], 2: []}
