"""Signed frames: who is believed, and what holds over restarts."""

import json
import stat
import time

import pytest
from mavlink_peer import HERE, QUICK, Wire, eventually, heartbeat
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.links.link import Link
from mmrs_mavlink.links.radio import Radio
from mmrs_mavlink.links.signing import BEHIND, EPOCH, TICKS, Signed, Signer, signer_for
from mmrs_runtime.clock import Clock

KEY = bytes(range(32))
ITEM = mavlink.MAVLink_mission_current_message(3)


def now() -> int:
    return int((time.time() - EPOCH) * TICKS)


class Vehicle:
    """Signs what it says, from a time stamp on."""

    def __init__(self, key: bytes = KEY, stamp: int | None = None) -> None:
        self._mav = mavlink.MAVLink(None, srcSystem=1, srcComponent=1)
        self._mav.signing.secret_key = key
        self._mav.signing.sign_outgoing = True
        self._mav.signing.timestamp = now() if stamp is None else stamp

    def frame(self, message) -> bytes:
        return bytes(message.pack(self._mav))


@pytest.fixture
def heard():
    """Return a function that gives a signer frames, and returns what of them was believed."""

    def hear(signer: Signer, *frames: bytes) -> list[str]:
        parser = Signed(signer, 255, 190)
        parser.robust_parsing = True
        found = [message for frame in frames for message in parser.parse_buffer(frame) or ()]
        return [message.get_type() for message in found]

    return hear


def test_what_is_signed_with_the_key_is_believed(heard):
    assert heard(Signer(KEY), Vehicle().frame(ITEM)) == ["MISSION_CURRENT"]


@pytest.mark.parametrize("key", [bytes(32), b"\xff" * 32])
def test_what_is_signed_with_another_key_is_not(heard, key):
    signer = Signer(KEY)
    assert heard(signer, Vehicle(key).frame(ITEM)) == ["BAD_DATA"]
    assert signer.refused == {"bad signature": 1}


def test_what_is_not_signed_is_not_believed_but_radio_status_is(heard):
    mav = mavlink.MAVLink(None, srcSystem=1, srcComponent=1)
    status = mavlink.MAVLink_radio_status_message(1, 2, 3, 4, 5, 6, 7)
    assert heard(Signer(KEY), bytes(ITEM.pack(mav)), bytes(status.pack(mav))) == ["BAD_DATA", "RADIO_STATUS"]


def test_a_frame_that_is_sent_again_is_refused(heard):
    signer, vehicle = Signer(KEY), Vehicle()
    first, second = vehicle.frame(ITEM), vehicle.frame(ITEM)
    assert heard(signer, first, second, first, second) == ["MISSION_CURRENT"] * 2 + ["BAD_DATA"] * 2
    assert signer.refused == {"replayed": 2}


def test_an_older_frame_is_refused(heard):
    vehicle = Vehicle()
    first, second = vehicle.frame(ITEM), vehicle.frame(ITEM)
    assert heard(Signer(KEY), second, first) == ["MISSION_CURRENT", "BAD_DATA"]


def test_a_stream_may_begin_a_minute_ago_and_not_before(heard):
    assert heard(Signer(KEY), Vehicle(stamp=now() - BEHIND + TICKS).frame(ITEM)) == ["MISSION_CURRENT"]
    assert heard(Signer(KEY), Vehicle(stamp=now() - BEHIND - TICKS).frame(ITEM)) == ["BAD_DATA"]


def test_a_forged_frame_from_the_future_does_not_shut_its_stream(heard):
    forged = Vehicle(bytes(32), now() + 10**9).frame(ITEM)
    assert heard(Signer(KEY), forged, Vehicle().frame(ITEM)) == ["BAD_DATA", "MISSION_CURRENT"]


def test_time_stamps_follow_the_clock_and_never_go_back(monkeypatch):
    signer = Signer(KEY)
    first, second = signer.next_stamp(), signer.next_stamp()
    assert second > first
    real = time.time
    monkeypatch.setattr(time, "time", lambda: real() + 120.0)
    assert signer.next_stamp() >= first + 119 * TICKS
    monkeypatch.setattr(time, "time", lambda: real() - 10**6)
    assert signer.next_stamp() > first + 119 * TICKS


def test_time_stamps_go_on_after_a_restart_even_if_the_clock_was_put_back(tmp_path, monkeypatch):
    path = tmp_path / "stamps"
    before = Signer(KEY, path)
    last = before.next_stamp()
    before.save(at_once=True)
    real = time.time
    monkeypatch.setattr(time, "time", lambda: real() - 10**6)
    assert Signer(KEY, path).next_stamp() > last


def test_a_frame_from_before_a_restart_is_still_refused(heard, tmp_path):
    path = tmp_path / "stamps"
    frame = Vehicle().frame(ITEM)
    before = Signer(KEY, path)
    assert heard(before, frame) == ["MISSION_CURRENT"]
    before.save(at_once=True)
    assert heard(Signer(KEY, path), frame) == ["BAD_DATA"]


def test_stamps_of_two_processes_are_put_together(tmp_path, heard):
    path = tmp_path / "stamps"
    one, other = Signer(KEY, path), Signer(KEY, path)
    frame = Vehicle().frame(ITEM)
    assert heard(one, frame) == ["MISSION_CURRENT"]
    one.save(at_once=True)
    other.save(at_once=True)
    assert "0/1/1" in json.loads(path.read_text("ascii"))["heard"]


def test_stamps_lie_beside_the_key_and_are_its_owners_only(tmp_path):
    key = tmp_path / "key"
    key.write_bytes(KEY)
    key.chmod(0o600)
    signer_for(key).save(at_once=True)
    assert stat.S_IMODE((tmp_path / "key.stamps").stat().st_mode) == 0o600
    assert KEY.hex() not in (tmp_path / "key.stamps").read_text("ascii")


def test_stamps_that_are_none_are_refused_with_their_place(tmp_path):
    path = tmp_path / "stamps"
    path.write_text("[]", "ascii")
    with pytest.raises(ValueError, match=r"stamps: holds no time stamps of signatures"):
        Signer(KEY, path)


def test_stamps_that_cannot_be_kept_are_told_and_stop_nothing(tmp_path):
    signer = Signer(KEY, tmp_path / "nowhere" / "stamps")
    signer.save(at_once=True)
    assert "time stamps cannot be kept" in signer.trouble
    assert signer.next_stamp()


def test_a_link_signs_what_it_sends_and_hears_only_what_is_signed():
    wire, clock = Wire(), Clock()
    link = Link(Radio(wire, clock, Signer(KEY)), clock, retries=QUICK)
    wire.beat(mode=9)
    vehicle = Vehicle()
    wire.put(vehicle.frame(heartbeat()), HERE)
    assert link.wait(lambda: link.component, 5.0)
    assert link.latest("HEARTBEAT").custom_mode == 4
    assert link.dropped["not signed with the key"] == link.garbled == 1
    link.send(ITEM)
    eventually(lambda: wire.sent)
    assert wire.sent[0][0].get_signed() or wire.sent[0][0].get_header().incompat_flags & 1
    link.close()
