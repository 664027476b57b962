"""What robots report is read at a ground station that looks on, and told to who asks how they are."""

import socket
from contextlib import suppress
from dataclasses import replace

import pytest
from mmrs_multicopter.testing import LAND, robot_program, take_off
from ports import free_port
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_core.testing.programs import feedback, move, program
from mmrs_mavlink.sitl import Settings, SimulatedVehicle
from mmrs_runtime.orders.ordering import give

pytestmark = pytest.mark.real_time("controllers")

LONG = "a word that is longer than one frame of MAVLink can carry"
STAYS = replace(move("stay", "HoldPosition", duration=40.0), before=(feedback("seen", ("what", LONG)),))
REPORTS = program(robot_program("alpha", [take_off("up", 5.0), STAYS, LAND]))
STATION = mavlink.MAVLink_heartbeat_message(mavlink.MAV_TYPE_GCS, mavlink.MAV_AUTOPILOT_INVALID, 0, 0, 4, 3)


@pytest.fixture
def looking():
    """Return the socket of a ground station, which is not a robot's."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as station:
        station.bind(("127.0.0.1", 0))
        station.settimeout(0.1)
        yield station


def read(station, process) -> list:
    """Return the texts that programs have sent, while a station looks on to the end of a process."""
    codec, found = mavlink.MAVLink(None, srcSystem=254, srcComponent=190), []
    while process.poll() is None:
        with suppress(TimeoutError):
            data, peer = station.recvfrom(65_535)
            station.sendto(STATION.pack(codec), peer)
            found += [
                each
                for each in codec.parse_buffer(data) or ()
                if each.get_type() == "STATUSTEXT" and each.get_srcComponent() != 1
            ]
    return found


def test_a_report_is_read_at_a_ground_station(controllers, looking):
    port = free_port()
    with SimulatedVehicle(port, Settings(system=7, ground=looking.getsockname()), speedup=20.0):
        made = controllers(REPORTS)
        with made.start("fleet.py", "--speedup", "20", "--connect", f"udpin:127.0.0.1:{port}") as process:
            pieces = read(looking, process)
            _, said = process.communicate()
    assert process.returncode == 0, said
    assert "".join(piece.text for piece in pieces) == f"alpha: seen: what {LONG}"
    assert {piece.get_srcSystem() for piece in pieces} == {7}


def test_who_asks_is_told_what_a_robot_has_reported_last(controllers):
    made = controllers(REPORTS)
    with made.start("fleet.py", "--dry-run", "--speedup", "20") as process:
        made.await_step("stay")
        (told,) = give(made.logs, "status", ["alpha"])
        process.communicate(timeout=60)
    assert told["reported"] == {"name": "seen", "content": {"what": LONG}}
