"""What goes over a link, as the black box keeps it."""

import json
import threading

import pytest
from mavlink_peer import heartbeat
from patience import until
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.program import Geographic
from mmrs_mavlink.records.recording import Recording
from mmrs_runtime.clock import Clock
from mmrs_runtime.controllers.state import State
from mmrs_runtime.records.blackbox import BlackBox, black_box_path

pytestmark = pytest.mark.real_time("parts of flights")

BEFORE = State(0.0, Geographic(42.0, 13.0, 5.0), 9.0, 90.0, 0.5, "guided", True)


@pytest.fixture
def fixes(tmp_path):
    """Return a function that records a message, and returns the fixes in the box."""
    path = black_box_path(tmp_path / "alpha.jsonl")
    box = BlackBox(path, "run-0", "alpha", lambda: 1.5)

    def record(*messages, geographic: bool):
        keep = Recording(box, Clock(), lambda: BEFORE, geographic=geographic)
        for message in messages:
            keep(message, False)
        text = path.read_text("ascii") if path.exists() else ""
        lines = (json.loads(line) for line in text.splitlines())
        return [line for line in lines if line["kind"] == "fix"]

    yield record
    box.close()


def test_a_fix_has_place_speed_and_heading_of_one_message(fixes):
    message = mavlink.MAVLink_global_position_int_message(
        0, 420000100, 130000200, 725_000, 6_000, 30, 40, 0, 18_000
    )
    (fix,) = fixes(message, geographic=True)
    assert fix["place"] == {"latitude": 42.00001, "longitude": 13.00002, "height": 6.0}
    assert (fix["speed"], fix["heading"]) == (0.5, 180.0)
    assert (fix["energy"], fix["mode"], fix["armed"]) == (0.5, "guided", True)


def test_a_heading_that_a_message_does_not_tell_stays_as_it_was(fixes):
    message = mavlink.MAVLink_global_position_int_message(0, 420000100, 130000200, 0, 0, 0, 0, 0, 65_535)
    (fix,) = fixes(message, geographic=True)
    assert fix["heading"] == BEFORE.heading


def test_zero_degrees_of_both_are_no_fix(fixes):
    message = mavlink.MAVLink_global_position_int_message(0, 0, 0, 720_000, 100, 0, 0, 0, 18_000)
    assert fixes(message, geographic=True) == []


def test_a_local_fix_has_the_speed_of_its_message(fixes):
    (fix,) = fixes(
        mavlink.MAVLink_local_position_ned_message(0, 1.0, 2.0, -3.0, 0.6, 0.0, -0.8), geographic=False
    )
    assert fix["place"] == {"north": 1.0, "east": 2.0, "height": 3.0}
    assert fix["speed"] == 1.0


HERE = mavlink.MAVLink_global_position_int_message(0, 420000100, 130000200, 0, 0, 0, 0, 0, 18_000)


def test_a_vehicle_that_is_disarmed_is_so_in_the_last_fix_whatever_comes_after(fixes):
    kept = fixes(
        heartbeat(armed=True), HERE, heartbeat(armed=True), heartbeat(), heartbeat(), geographic=True
    )
    assert [fix["armed"] for fix in kept] == [True, False]


def test_other_parts_of_a_vehicle_are_not_armed(fixes):
    camera = heartbeat(autopilot=mavlink.MAV_AUTOPILOT_INVALID)
    assert len(fixes(heartbeat(armed=True), HERE, camera, geographic=True)) == 1


def test_places_are_taken_from_messages_of_the_programs_frame_only(fixes):
    message = mavlink.MAVLink_local_position_ned_message(0, 1.0, 2.0, -3.0, 0.6, 0.0, -0.8)
    assert fixes(message, geographic=True) == []


class Interrupting(Clock):
    """A clock whose reader is interrupted once, by a thread that has a moment to do something."""

    def __init__(self) -> None:
        super().__init__()
        self.meanwhile = None

    def now(self) -> float:
        meanwhile, self.meanwhile = self.meanwhile, None
        if meanwhile is not None:
            thread = threading.Thread(target=meanwhile)
            thread.start()
            thread.join(0.2)
        return super().now()


def test_an_answer_that_comes_while_a_command_is_sent_again_ends_that_command(tmp_path):
    path = black_box_path(tmp_path / "alpha.jsonl")
    box, clock = BlackBox(path, "run-0", "alpha", lambda: 1.5), Interrupting()
    record = Recording(box, clock, lambda: BEFORE)

    def send(confirmation: int = 0) -> None:
        record(mavlink.MAVLink_command_long_message(1, 1, 400, confirmation, 1, *[0] * 6), True)

    def answer() -> None:
        record(mavlink.MAVLink_command_ack_message(400, mavlink.MAV_RESULT_ACCEPTED), False)

    send()
    clock.meanwhile = answer
    send(confirmation=1)
    until(lambda: '"kind": "command"' in path.read_text("ascii"))
    send()
    answer()
    box.close()
    lines = (json.loads(line) for line in path.read_text("ascii").splitlines())
    told = [(line["result"], line["tries"]) for line in lines if line["kind"] == "command"]
    assert told == [("ACCEPTED", 2), ("ACCEPTED", 1)]


def test_a_command_at_a_place_is_told_with_its_place_and_its_tries(tmp_path):
    path = black_box_path(tmp_path / "alpha.jsonl")
    box = BlackBox(path, "run-0", "alpha", lambda: 1.5)
    record = Recording(box, Interrupting(), lambda: BEFORE)
    places = (423_705_000, 423_705_000, 423_706_000)
    for x in places:
        record(mavlink.MAVLink_command_int_message(1, 1, 3, 195, 0, 0, 2, 0, 0, 0, x, 133_500_000, 5.0), True)
    record(mavlink.MAVLink_command_ack_message(195, mavlink.MAV_RESULT_ACCEPTED), False)
    box.close()
    lines = (json.loads(line) for line in path.read_text("ascii").splitlines())
    told = [(line["result"], line["tries"], line["params"][4]) for line in lines if line["kind"] == "command"]
    assert told == [("no answer", 2, places[0]), ("ACCEPTED", 1, places[2])]
