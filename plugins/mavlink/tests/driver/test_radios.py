"""Several vehicles on one port, and who is heard."""

import socket
import threading

import pytest
from mavlink_peer import HERE, QUICK, THERE, Wire, eventually, heartbeat, linked, two_linked
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.links.link import Link
from mmrs_mavlink.links.messages import ANYBODY
from mmrs_mavlink.links.ports import open_port, split_system
from mmrs_mavlink.links.radio import Radio
from mmrs_mavlink.links.radios import Radios
from mmrs_mavlink.vehicles.preparation import HEARING_SECONDS, hear_out
from mmrs_runtime.clock import Clock
from mmrs_runtime.faults import FaultError, RefusedError

pytestmark = pytest.mark.real_time("parts of flights")

ELSEWHERE = ("10.0.0.3", 14_550)
ITEM = mavlink.MAVLink_mission_current_message(3)
NOISE = b"\xfd\x05\x00\x00\x00\x01\x01\x00\x00\x00noise!!"


@pytest.fixture
def shared():
    """Return a wire with two links on it, to systems 1 and 2 at different addresses."""
    with two_linked(Clock()) as made:
        yield made


def test_each_link_hears_its_own_vehicle_only(shared):
    shared.wire.say(ITEM, system=2, sender=THERE)
    assert shared.second.wait(lambda: shared.second.latest("MISSION_CURRENT"), 5.0)
    assert shared.first.latest("MISSION_CURRENT") is None


def test_a_port_that_another_program_listens_on_is_refused_with_the_way_out():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
        other.bind(("127.0.0.1", 0))
        with pytest.raises(OSError, match="another program listens there: end it, or choose another port"):
            open_port(f"udpin:127.0.0.1:{other.getsockname()[1]}")


def test_what_is_sent_goes_to_where_the_system_speaks_from(shared):
    for link in (shared.first, shared.second):
        link.send(mavlink.MAVLink_mission_ack_message(link.system, link.component, 0, 0))
    assert [(message.target_system, to) for message, to in shared.wire.sent] == [(1, HERE), (2, THERE)]


def test_who_is_met_hears_a_heartbeat_at_once():
    with linked() as (_, wire):
        assert HERE in wire.beats


def test_heartbeats_go_to_everybody_who_has_spoken(shared):
    eventually(lambda: {HERE, THERE} <= set(shared.wire.beats))


def position(milliseconds: int, north: float = 0.0):
    latitude = round((42.37 + north / 111_000.0) * 1e7)
    return mavlink.MAVLink_global_position_int_message(
        milliseconds, latitude, 133_500_000, 720_000, 20_000, 0, 0, 0, 0
    )


@pytest.mark.parametrize(
    ("sign", "same"),
    [
        (position(60_200), True),
        (position(60_200, north=8.0), True),
        (position(60_200, north=60.0), False),
        (position(1_200), False),
        (position(99_200), False),
        (ITEM, False),
    ],
    ids=["same", "drifted", "elsewhere", "started later", "started earlier", "no sign"],
)
def test_a_vehicle_that_falls_silent_speaks_from_another_address_if_it_is_the_same(
    shared, monkeypatch, sign, same
):
    monkeypatch.setattr("mmrs_mavlink.links.roaming.ROAMING_SECONDS", 0.05)
    shared.wire.say(position(60_000), system=1, sender=HERE)
    shared.first.wait(lambda: shared.first.latest("GLOBAL_POSITION_INT"), 5.0)
    eventually(lambda: shared.first.silent_for() > 0.1)
    shared.wire.say(sign, system=1, sender=ELSEWHERE)
    shared.wire.beat(system=1, sender=ELSEWHERE, mode=9)
    shared.wire.say(ITEM, system=2, sender=THERE)
    assert shared.second.wait(lambda: shared.second.latest("MISSION_CURRENT"), 5.0)
    assert (shared.first.latest("HEARTBEAT").custom_mode == 9) is same
    shared.first.send(ITEM)
    assert shared.wire.sent[-1][1] == (ELSEWHERE if same else HERE)


def test_a_second_vehicle_with_the_same_id_is_not_heard_and_told():
    with linked() as (link, wire):
        for _ in range(3):
            wire.beat(mode=9, sender=THERE)
            wire.say(ITEM, sender=THERE)
        eventually(link.doubt)
        assert link.latest("MISSION_CURRENT") is None
        assert link.latest("HEARTBEAT").custom_mode == 4
        assert link.doubt() == (
            "there are two vehicles with system id 1: it speaks from 10.0.0.1:14550 and from 10.0.0.2:14550"
        )
        assert link.dropped["HEARTBEAT: from a second system 1"] == 3


def test_without_a_system_two_vehicles_on_one_link_are_told():
    with linked() as (link, wire):
        assert link.doubt() == ""
        wire.beat(system=7)
        eventually(link.doubt)
        assert "system ids 1 and 7 on this link: name one, as URL@1" in link.doubt()


def test_with_a_system_another_vehicle_is_only_counted():
    with linked(system=1) as (link, wire):
        wire.beat(system=7)
        eventually(lambda: link.dropped)
        assert link.doubt() == ""
        assert link.dropped == {"HEARTBEAT: from system 7, which is not a robot's": 1}


def test_a_wrong_system_is_told_when_nobody_else_speaks():
    wire, clock = Wire(), Clock()
    radios = Radios(clock, retries=QUICK, wrap=lambda port, url: port.close() or wire)
    link = radios.open("udpin:127.0.0.1:0", 3)
    wire.beat(system=7)
    with pytest.raises(FaultError, match=r"no vehicle at here; received system 7, and not 3"):
        radios.meet(link, "here", 0.3)
    link.close()


def test_two_robots_cannot_have_the_same_vehicle():
    wire = Wire()
    radios = Radios(Clock(), wrap=lambda port, url: port.close() or wire)
    link = radios.open("udpin:127.0.0.1:0", 3)
    with pytest.raises(RefusedError, match="system 3 has two robots on one link"):
        radios.open("udpin:127.0.0.1:0", 3)
    link.close()


def test_robots_without_a_system_take_different_vehicles():
    wire, clock = Wire(), Clock()
    radio = Radio(wire, clock)
    links = [Link(radio, clock), Link(radio, clock)]
    for system in (4, 4, 9):
        wire.beat(system=system)
    for link in links:
        assert link.wait(lambda link=link: link.component, 5.0)
    assert [link.system for link in links] == [4, 9]
    for link in links:
        link.close()


def test_a_camera_or_a_ground_station_is_no_vehicle():
    wire, clock = Wire(), Clock()
    link = Link(Radio(wire, clock), clock)
    wire.say(heartbeat(kind=mavlink.MAV_TYPE_CAMERA, autopilot=mavlink.MAV_AUTOPILOT_INVALID), component=100)
    wire.say(heartbeat(kind=mavlink.MAV_TYPE_GCS, autopilot=mavlink.MAV_AUTOPILOT_INVALID), system=254)
    wire.beat(system=5)
    assert link.wait(lambda: link.component, 5.0)
    assert (link.system, link.component) == (5, 1)
    link.close()


def test_a_gimbal_that_says_that_it_had_a_generic_autopilot_is_no_vehicle():
    wire, clock = Wire(), Clock()
    link = Link(Radio(wire, clock), clock)
    wire.say(heartbeat(kind=mavlink.MAV_TYPE_GIMBAL, autopilot=0), component=154)
    wire.beat()
    assert link.wait(lambda: link.component, 5.0)
    assert (link.system, link.component) == (1, 1)
    link.close()


def test_a_ground_station_with_the_ids_of_the_vehicle_does_not_speak_for_it():
    with linked() as (link, wire):
        wire.say(heartbeat(mode=0, kind=mavlink.MAV_TYPE_GCS, autopilot=mavlink.MAV_AUTOPILOT_INVALID))
        wire.say(ITEM)
        assert link.wait(lambda: link.latest("MISSION_CURRENT"), 5.0)
        assert link.latest("HEARTBEAT").custom_mode == 4
        assert link.dropped == {"HEARTBEAT: with the vehicle's ids, and no autopilot's": 1}


def test_components_of_the_vehicle_are_heard_by_those_who_ask_for_them():
    image = mavlink.MAVLink_camera_feedback_message(0, 1, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0)
    with linked() as (link, wire):
        with (
            link.inbox("HEARTBEAT", "CAMERA_FEEDBACK") as own,
            link.inbox("CAMERA_FEEDBACK", component=ANYBODY) as all,
        ):
            wire.say(image, component=100)
            wire.say(heartbeat(mode=9), component=100)
            assert link.wait(lambda: len(all), 5.0)
        assert not own
        assert link.latest("HEARTBEAT").custom_mode == 4
        assert link.latest("CAMERA_FEEDBACK") is not None


def test_noise_from_a_stranger_does_not_spoil_what_the_vehicle_says():
    with linked() as (link, wire):
        whole = wire.pack(ITEM)
        wire.put(whole[:6])
        wire.put(NOISE[:9], THERE)
        wire.put(whole[6:])
        assert link.wait(lambda: link.latest("MISSION_CURRENT"), 5.0)


def test_frames_that_are_not_used_are_counted_by_type_and_reason():
    with linked() as (link, wire):
        wire.put(NOISE, THERE)
        unknown = bytearray(wire.pack(ITEM))
        unknown[7:10] = (54_321).to_bytes(3, "little")
        wire.put(bytes(unknown))
        wire.say(ITEM, system=9)
        eventually(lambda: len(link.dropped) >= 3)
        assert link.dropped["message 54321: unknown"] == 1
        assert link.dropped["MISSION_CURRENT: from system 9, which is not a robot's"] == 1
        assert link.dropped["unreadable"] == link.garbled > 0


def test_what_a_radio_says_of_itself_is_told_to_all_who_use_it(shared):
    shared.wire.say(
        mavlink.MAVLink_radio_status_message(180, 170, 100, 30, 30, 0, 0), system=51, component=68
    )
    for link in (shared.first, shared.second):
        assert link.wait(lambda link=link: link.latest("RADIO_STATUS"), 5.0).remrssi == 170


def test_a_message_that_was_overtaken_is_no_news():
    with linked() as (link, wire):
        wire.say(mavlink.MAVLink_mission_current_message(5), seq=20)
        assert link.wait(lambda: link.latest("MISSION_CURRENT"), 5.0)
        with link.inbox("MISSION_CURRENT") as inbox:
            wire.say(mavlink.MAVLink_mission_current_message(4), seq=18)
            assert link.wait(lambda: len(inbox), 5.0)
        assert link.latest("MISSION_CURRENT").seq == 5


def test_a_message_that_only_others_have_overtaken_is_news():
    with linked() as (link, wire):
        wire.say(mavlink.MAVLink_mission_current_message(4), seq=18)
        assert link.wait(lambda: link.latest("MISSION_CURRENT"), 5.0)
        wire.say(position(1000), seq=25)
        assert link.wait(lambda: link.latest("GLOBAL_POSITION_INT"), 5.0)
        wire.say(mavlink.MAVLink_mission_current_message(5), seq=22)
        assert link.wait(lambda: link.latest("MISSION_CURRENT").seq == 5, 5.0)
        assert link.order("MISSION_CURRENT") < link.order("GLOBAL_POSITION_INT")


def test_a_trail_is_what_was_news_in_the_order_in_which_it_was_sent():
    with linked() as (link, wire), link.trail("GLOBAL_POSITION_INT") as trail:
        for milliseconds, seq in ((1000, 20), (3000, 24), (2000, 22), (4000, 26)):
            wire.say(position(milliseconds), seq=seq)
        assert link.wait(lambda: len(trail) >= 3, 5.0)
        assert [message.time_boot_ms for message in trail] == [1000, 3000, 4000]


def test_what_comes_after_a_gap_is_news_whatever_its_number():
    with linked() as (link, wire):
        wire.say(mavlink.MAVLink_mission_current_message(5), seq=20)
        assert link.wait(lambda: link.latest("MISSION_CURRENT"), 5.0)
        link.clock.skip(1.2)
        wire.say(mavlink.MAVLink_mission_current_message(6), seq=220)
        assert link.wait(lambda: link.latest("MISSION_CURRENT").seq == 6, 5.0)


def test_time_in_the_guard_does_not_count():
    with linked() as (link, _):
        holds = [600.0]
        link.guard = lambda: link.clock.skip(holds.pop() if holds else 0.0)
        begun = link.clock.now()
        link.wait(lambda: None, 0.1)
        assert link.clock.now() - begun >= 600.09


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("udpin:0.0.0.0:14550", ("udpin:0.0.0.0:14550", 0)),
        ("tcp:a:1@7", ("tcp:a:1", 7)),
        ("/dev/tty0,9600@255", ("/dev/tty0,9600", 255)),
    ],
)
def test_a_url_may_name_a_system(text, found):
    assert split_system(text) == found


@pytest.mark.parametrize("text", ["tcp:a:1@0", "tcp:a:1@256", "tcp:a:1@x", "tcp:a:1@"])
def test_a_system_that_is_none_is_refused(text):
    with pytest.raises(ValueError, match="must be a MAVLink system from 1 to 255"):
        split_system(text)


def test_a_link_whose_vehicle_nobody_named_is_heard_out_for_others():
    wire, clock = Wire(), Clock(10.0)
    link = Link(Radio(wire, clock), clock, retries=QUICK)
    wire.beat(system=1, sender=HERE)
    assert link.wait(lambda: link.component, 5.0)
    assert link.doubt() == ""
    threading.Timer(0.2, wire.beat, kwargs={"system": 2, "sender": THERE}).start()
    hear_out(link)
    assert "system ids 1 and 2" in link.doubt()
    link.close()


def test_a_vehicle_that_was_named_is_not_waited_for(shared):
    begun = shared.first.clock.now()
    hear_out(shared.first)
    assert shared.first.clock.now() - begun < HEARING_SECONDS / 2
