"""The mission protocol, message by message."""

from __future__ import annotations

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.sitl.items import Item
from mmrs_mavlink.sitl.px4_transfers import Px4Transfers
from mmrs_mavlink.sitl.transfers import ArduPilotTransfers

OLD = [Item(3, 16, (0.0, 0.0, 0.0, 0.0), n, n, 1.0) for n in range(4)]


class Exchange:
    """A vehicle's side of the protocol, and all that it answered."""

    def __init__(self, firmware: str = "ardupilot", **port: bool) -> None:
        self.answers = []
        self.stores = {0: list(OLD), 1: list(OLD), 2: []}
        self.said = []
        say = lambda severity, text: self.said.append(text)  # noqa: E731
        make = Px4Transfers if firmware == "px4" else ArduPilotTransfers
        self.protocol = make(self.stores, self.answers.append, say, **port)

    def take(self, message) -> None:
        message._header.srcSystem, message._header.srcComponent = 255, 190
        self.protocol.take(message)

    def count(self, number: int, kind: int = 0) -> None:
        self.take(mavlink.MAVLink_mission_count_message(1, 1, number, kind))

    def item(self, seq: int, command: int = 16, frame: int = 3, kind: int = 0) -> None:
        head = (1, 1, seq, frame, command, 0, 1)
        self.take(mavlink.MAVLink_mission_item_int_message(*head, 0, 0, 0, 0, 100 + seq, 0, 5, kind))

    @property
    def last(self):
        return self.answers[-1]


@pytest.fixture
def exchange():
    return Exchange()


def test_items_are_asked_for_one_after_another_and_acknowledged_at_the_end(exchange):
    exchange.count(2)
    exchange.item(0)
    exchange.item(1)
    kinds = [(message.get_type(), getattr(message, "seq", None)) for message in exchange.answers]
    assert kinds == [("MISSION_REQUEST_INT", 0), ("MISSION_REQUEST_INT", 1), ("MISSION_ACK", None)]
    assert [item.x for item in exchange.stores[0]] == [100, 101]


def test_an_item_that_ardupilot_has_already_is_answered_and_counts_once(exchange):
    exchange.count(2)
    exchange.item(0)
    exchange.item(0)
    assert exchange.last.type == mavlink.MAV_MISSION_INVALID_SEQUENCE
    exchange.item(1)
    assert exchange.last.type == 0
    assert [item.x for item in exchange.stores[0]] == [100, 101]


def test_an_item_after_the_end_is_no_part_of_anything_for_ardupilot(exchange):
    exchange.count(1)
    exchange.item(0)
    exchange.item(0)
    assert exchange.last.type == mavlink.MAV_MISSION_ERROR


def test_ardupilot_clears_and_gives_nothing_while_it_receives(exchange):
    exchange.count(2)
    exchange.take(mavlink.MAVLink_mission_clear_all_message(1, 1, 0))
    assert exchange.last.type == mavlink.MAV_MISSION_ERROR
    exchange.take(mavlink.MAVLink_mission_request_list_message(1, 1, 0))
    assert exchange.last.type == mavlink.MAV_MISSION_DENIED
    exchange.count(0)
    assert exchange.last.type == 0
    assert exchange.stores[0] == []


def test_ardupilot_begins_anew_for_whoever_sends_the_plan(exchange):
    exchange.count(2)
    exchange.item(0)
    exchange.count(2)
    assert exchange.last.seq == 0


def test_ardupilot_takes_nothing_but_missions_on_an_old_port():
    exchange = Exchange(old=True)
    exchange.count(2, kind=1)
    assert exchange.last.type == mavlink.MAV_MISSION_UNSUPPORTED
    assert exchange.said == ["Need mavlink2 for item transfer"]
    exchange.count(2, kind=0)
    assert exchange.last.seq == 0


def test_an_item_that_px4_has_already_is_passed_over_and_the_last_is_accepted_again():
    exchange = Exchange("px4")
    exchange.count(2)
    exchange.item(0)
    answers = len(exchange.answers)
    exchange.item(0)
    assert len(exchange.answers) == answers
    exchange.item(1)
    exchange.item(1)
    assert [answer.type for answer in exchange.answers[answers:]] == [0, 0]


def test_px4_is_busy_until_it_is_told_that_a_transfer_is_over():
    exchange = Exchange("px4")
    exchange.count(2)
    exchange.item(0)
    exchange.count(2)
    assert (exchange.last.type, exchange.said) == (mavlink.MAV_MISSION_ERROR, ["WPM: REJ. CMD: Busy"])
    exchange.take(mavlink.MAVLink_mission_ack_message(1, 1, mavlink.MAV_MISSION_OPERATION_CANCELLED, 0))
    exchange.count(2)
    assert exchange.last.seq == 0


def test_px4_gives_items_in_their_order_and_breaks_off_otherwise():
    exchange = Exchange("px4")
    exchange.take(mavlink.MAVLink_mission_request_list_message(1, 1, 0))
    for seq in (0, 0, 1):
        exchange.take(mavlink.MAVLink_mission_request_int_message(1, 1, seq, 0))
        assert exchange.last.seq == seq
    exchange.take(mavlink.MAVLink_mission_request_int_message(1, 1, 3, 0))
    assert exchange.last.type == mavlink.MAV_MISSION_ERROR


def test_a_fault_ends_the_transfer(exchange):
    exchange.count(2)
    exchange.item(0, frame=1)
    assert exchange.last.type == mavlink.MAV_MISSION_UNSUPPORTED_FRAME


def test_a_mission_that_breaks_off_is_a_mixture_of_old_and_new(exchange):
    exchange.count(3)
    exchange.item(0)
    exchange.item(1)
    assert [item.x for item in exchange.stores[0]] == [100, 101, 2]


@pytest.mark.parametrize(("firmware", "kind", "command"), [("ardupilot", 1, 5002), ("px4", 0, 16)])
def test_a_fence_and_all_of_px4_stay_as_they_were_until_everything_is_there(firmware, kind, command):
    exchange = Exchange(firmware)
    exchange.count(2, kind)
    exchange.item(0, command=command, kind=kind)
    assert exchange.stores[kind] == OLD


def test_what_does_not_come_is_asked_for_again_and_given_up_in_the_end(exchange):
    exchange.count(2)
    for tick in range(100):
        exchange.protocol.advance(tick * 0.1, 0.0)
    asked = [message for message in exchange.answers if message.get_type() == "MISSION_REQUEST_INT"]
    assert 5 <= len(asked) <= 9
    assert exchange.last.type == mavlink.MAV_MISSION_OPERATION_CANCELLED
    assert exchange.said == ["Mission upload timeout"]


def test_nothing_is_accepted_just_after_a_boot(exchange):
    exchange.protocol.busy = True
    exchange.count(2)
    assert exchange.last.type == mavlink.MAV_MISSION_NO_SPACE
    assert exchange.stores[0] == OLD


def test_a_list_is_given_back_by_both_kinds_of_items(exchange):
    exchange.take(mavlink.MAVLink_mission_request_list_message(1, 1, 0))
    assert exchange.last.count == 4
    exchange.take(mavlink.MAVLink_mission_request_int_message(1, 1, 2, 0))
    assert (exchange.last.get_type(), exchange.last.x) == ("MISSION_ITEM_INT", 2)
    exchange.take(mavlink.MAVLink_mission_request_message(1, 1, 2, 0))
    assert (exchange.last.get_type(), exchange.last.x) == ("MISSION_ITEM", pytest.approx(2e-7))


def test_an_item_that_is_not_there_is_refused(exchange):
    exchange.take(mavlink.MAVLink_mission_request_int_message(1, 1, 9, 0))
    assert exchange.last.type == mavlink.MAV_MISSION_INVALID_SEQUENCE


def test_everything_is_cleared_at_once(exchange):
    exchange.take(mavlink.MAVLink_mission_clear_all_message(1, 1, 255))
    assert exchange.stores == {0: [], 1: [], 2: []}
