"""Uploads that go wrong in every way that they can, and what the vehicle is left with."""

import pytest
from mavlink_peer import PX4, linked
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.services.exchanges import mark_of
from mmrs_mavlink.services.items import FENCE, MISSION, Item
from mmrs_mavlink.services.missions import upload, verify
from mmrs_mavlink.services.reading import download
from mmrs_runtime.faults import FaultError, RefusedError

ITEMS = [Item(16, (float(n), 0.0, 0.0, 0.0), 423_700_000 + n, 133_500_000, 20.0 + n) for n in range(4)]
ACCEPTED, NO_SPACE, WRONG = 0, 4, 13
TO_US = (255, 191)


class Store:
    """A vehicle's mission service: asks for items, and keeps them.

    Attributes:
        kept: what it has. results: what it acknowledges uploads with, in turn; accepted afterwards.
    """

    def __init__(self, results=(), refuse_at: int | None = None, old_requests: bool = False, deaf=()) -> None:
        self.kept: list[object] = ["old"]
        self.results = list(results)
        self.refuse_at = refuse_at
        self.request = (
            mavlink.MAVLink_mission_request_message
            if old_requests
            else mavlink.MAVLink_mission_request_int_message
        )
        self.deaf = list(deaf)
        self.coming: list[object] = []
        self.expected = 0

    def __call__(self, message):
        kind = message.get_type()
        if kind in self.deaf:
            self.deaf.remove(kind)
            return []
        return list(getattr(self, f"_{kind.lower()}", lambda message: [])(message))

    def _mission_count(self, message):
        if self.results and self.results[0] != ACCEPTED:
            yield self._ack(self.results.pop(0), message.mission_type)
            return
        self.coming, self.expected = [], message.count
        yield self.request(*TO_US, 0, message.mission_type)

    def _mission_item_int(self, message):
        if message.seq == self.refuse_at:
            self.kept = list(self.coming)
            yield self._ack(mavlink.MAV_MISSION_INVALID_PARAM1, message.mission_type)
            return
        if message.seq != len(self.coming):
            yield self._ack(WRONG, message.mission_type)
            yield from self._next(message)
            return
        self.coming.append(message)
        yield from self._next(message)

    def _next(self, message):
        if len(self.coming) == self.expected:
            self.kept = self.coming
            yield self._ack(ACCEPTED, message.mission_type)
        else:
            yield self.request(*TO_US, len(self.coming), message.mission_type)

    def _mission_clear_all(self, message):
        self.kept = []
        yield self._ack(ACCEPTED, message.mission_type)

    def _mission_request_list(self, message):
        yield mavlink.MAVLink_mission_count_message(*TO_US, len(self.kept), message.mission_type)

    def _mission_request_int(self, message):
        yield self.kept[message.seq]

    def _ack(self, result: int, kind: int):
        return mavlink.MAVLink_mission_ack_message(*TO_US, result, kind)


@pytest.mark.parametrize("old_requests", [False, True])
def test_an_upload_is_kept_whichever_way_items_are_asked_for(old_requests):
    store = Store(old_requests=old_requests)
    with linked(store) as (link, _):
        upload(link, ITEMS)
        verify(link, ITEMS)
    assert [kept.seq for kept in store.kept] == [0, 1, 2, 3]


@pytest.mark.parametrize(
    "lost", ["MISSION_COUNT", "MISSION_ITEM_INT", "MISSION_REQUEST_LIST", "MISSION_REQUEST_INT"]
)
def test_what_is_lost_once_is_sent_again(lost):
    store = Store(deaf=[lost])
    with linked(store) as (link, wire):
        upload(link, ITEMS)
        verify(link, ITEMS)
        assert wire.kinds().count(lost) >= 2


def test_an_item_that_the_vehicle_has_already_is_no_fault():
    store = Store()

    def forgetful(message):
        """Lose the first answer to item 1, so that it is sent for the second time."""
        answers = store(message)
        if message.get_type() == "MISSION_ITEM_INT" and message.seq == 1 and not store.__dict__.get("lost"):
            store.__dict__["lost"] = True
            return []
        return answers

    with linked(forgetful) as (link, _):
        upload(link, ITEMS)
    assert [kept.seq for kept in store.kept] == [0, 1, 2, 3]


def test_a_vehicle_that_has_no_space_at_first_is_asked_again():
    store = Store([NO_SPACE])
    with linked(store, speedup=20.0) as (link, wire):
        upload(link, ITEMS)
        assert len(wire.of("MISSION_COUNT")) == 2


def test_a_vehicle_that_takes_nothing_keeps_what_it_had():
    store = Store([NO_SPACE] * 9)
    with (
        linked(store, speedup=20.0) as (link, _),
        pytest.raises(
            RefusedError, match="mission: the vehicle answers 'no space' to the upload; it keeps what it had"
        ),
    ):
        upload(link, ITEMS)
    assert store.kept == ["old"]


def test_a_vehicle_that_refuses_an_item_is_left_with_nothing():
    store = Store(refuse_at=2)
    with (
        linked(store, speedup=20.0) as (link, _),
        pytest.raises(RefusedError, match="'invalid param1' to the upload; it has none now"),
    ):
        upload(link, ITEMS)
    assert store.kept == []


def test_a_vehicle_that_falls_silent_in_the_middle_is_told_as_not_known():
    store = Store(deaf=["MISSION_ITEM_INT"] * 99 + ["MISSION_CLEAR_ALL", "MISSION_REQUEST_LIST"] * 99)
    with (
        linked(store, speedup=20.0) as (link, _),
        pytest.raises(RefusedError, match="answers nothing more to the upload; what it has now is not known"),
    ):
        upload(link, ITEMS)


def test_an_upload_that_is_broken_off_is_cancelled_and_cleared():
    store = Store(deaf=["MISSION_ITEM_INT"] * 99)
    with linked(store) as (link, wire):

        def guard() -> None:
            if "MISSION_ITEM_INT" in wire.kinds():
                raise FaultError("STOPPED", "stop was asked for")

        link.guard = guard
        with pytest.raises(FaultError, match="stop was asked for"):
            upload(link, ITEMS)
        ack, clear = wire.of("MISSION_ACK")[-1], wire.of("MISSION_CLEAR_ALL")[-1]
        assert ack.type == mavlink.MAV_MISSION_OPERATION_CANCELLED
        assert clear.mission_type == MISSION
    assert store.kept == []


def test_an_empty_list_clears():
    store = Store()
    with linked(store) as (link, wire):
        upload(link, [], FENCE)
        assert wire.kinds() == ["MISSION_CLEAR_ALL"]
    assert store.kept == []


def test_answers_about_another_kind_of_plan_are_not_ours():
    store = Store()

    def noisy(message):
        return [mavlink.MAVLink_mission_ack_message(*TO_US, 1, FENCE), *store(message)]

    with linked(noisy) as (link, _):
        upload(link, ITEMS)
    assert len(store.kept) == 4


def test_the_home_of_a_px4_is_no_item_and_is_compared():
    store = Store()
    with linked(store, autopilot=PX4) as (link, _):
        upload(link, ITEMS)
        store.kept[0].x += 100
        with pytest.raises(RefusedError, match="item 0 is"):
            verify(link, ITEMS)


def test_what_is_downloaded_is_what_the_vehicle_has():
    store = Store()
    with linked(store) as (link, wire):
        upload(link, ITEMS)
        assert [item.z for item in download(link)] == [20.0, 21.0, 22.0, 23.0]
        assert wire.of("MISSION_ACK")[-1].type == ACCEPTED


def test_the_id_of_a_plan_is_read_where_pymavlink_knows_no_field():
    mav = mavlink.MAVLink(None, srcSystem=1, srcComponent=1)
    ack = mavlink.MAVLink_mission_ack_message(255, 191, 0, 0)
    payload = bytes([255, 191, 0, 0]) + (0xCAFE).to_bytes(4, "little")
    frame = bytes(ack._pack(mav, ack.crc_extra, payload))
    (found,) = mavlink.MAVLink(None).parse_buffer(frame)
    assert mark_of(found, 4) == 0xCAFE
    (without,) = mavlink.MAVLink(None).parse_buffer(bytes(ack.pack(mav)))
    assert mark_of(without, 4) == 0
