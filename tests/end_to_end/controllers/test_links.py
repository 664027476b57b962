"""Links that end, that lose what is sent, and that carry noise."""

import socket
import threading
from contextlib import ExitStack, contextmanager
from dataclasses import replace

import pytest
from mmrs_multicopter.testing import LAND, robot_program, take_off, two_drones
from ports import free_port
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_core.behaviour.earth import degrees_of
from mmrs_core.testing.programs import program
from mmrs_mavlink.links.link import Link
from mmrs_mavlink.links.ports import open_port
from mmrs_mavlink.sitl import Settings, SimulatedVehicle
from mmrs_runtime.clock import Clock
from mmrs_runtime.faults import FaultError
from mmrs_runtime.ports import NOTHING

pytestmark = pytest.mark.real_time("controllers")

UP_AND_DOWN = program(robot_program("alpha", [take_off("up", 5.0), LAND]))
TWO = two_drones()
NOISE = b"\xfd\x05\x00\x00\x00\x01\x01\x00\x00\x00noise"


@contextmanager
def hangs_up_after(seconds: float):
    """Give the url of a peer that takes one TCP connection, and closes it a little later."""
    with socket.create_server(("127.0.0.1", 0)) as server:

        def serve() -> None:
            connection, _ = server.accept()
            with connection:
                threading.Event().wait(seconds)
                connection.settimeout(20.0)
                connection.shutdown(socket.SHUT_WR)
                while connection.recv(1000):
                    pass

        thread = threading.Thread(target=serve)
        thread.start()
        yield f"tcp:127.0.0.1:{server.getsockname()[1]}"
        thread.join()


class Port:
    """A port that hears nothing, and cannot send."""

    def __init__(self) -> None:
        self.reads = 0

    def read(self, seconds: float):
        self.reads += 1
        threading.Event().wait(seconds)
        return NOTHING

    def write(self, data: bytes, to=None) -> None:
        raise OSError("no buffer space")

    def close(self) -> None:
        pass


def test_a_link_whose_peer_hangs_up_ends_every_wait_with_the_reason():
    with hangs_up_after(0.1) as url:
        link = Link(open_port(url), Clock())
        with pytest.raises(FaultError, match="has closed the connection") as fault:
            link.wait(lambda: None, 30.0)
        assert fault.value.event == "LINK_LOST"
        assert not link.listening
        link.close()


def test_what_cannot_be_sent_is_lost_and_the_link_says_why():
    link = Link(Port(), Clock())
    link.send(mavlink.MAVLink_mission_ack_message(1, 1, 0, 0))
    assert link.trouble == "no buffer space"
    assert link.listening
    link.close()


def test_a_controller_says_that_its_peer_has_hung_up(controllers):
    made = controllers(UP_AND_DOWN)
    with hangs_up_after(0.5) as url:
        code, said = made.run("fleet.py", "--connect", f"alpha={url}", patience=20.0)
    assert code == 5
    assert "the vehicle's side has closed the connection" in said


def test_a_port_that_cannot_be_opened_is_a_lost_link_that_the_black_box_tells_of(controllers):
    made = controllers(UP_AND_DOWN)
    code, said = made.run("fleet.py", "--connect", "tcp:127.0.0.1:1")
    assert code == 5
    assert "'alpha': tcp:127.0.0.1:1: Connection refused" in said
    start, decision = made.box("alpha", "start", "decision")
    assert start["plan"]
    assert (decision["what"], decision["response"]) == ("LINK_LOST", "NOTHING")
    assert "Connection refused" in decision["why"]
    assert not (made.logs / "alpha.jsonl").exists()


@pytest.mark.parametrize(
    "url", ["tcp:nowhere", "udpin:127.0.0.1:99999", "udpout::14550", "/dev/ttyUSB0,fast", ",57600"]
)
def test_a_url_that_is_none_is_a_usage_error(controllers, url):
    code, said = controllers(UP_AND_DOWN).run("fleet.py", "--connect", url)
    assert code == 2
    assert f"--connect {url}: is not" in said


def test_frames_that_could_not_be_read_are_told_and_recorded(controllers, hangar):
    made = controllers(UP_AND_DOWN)
    vehicles, links = hangar(UP_AND_DOWN)
    port = int(links[-1].rpartition(":")[2].partition("@")[0])
    with (
        socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as stranger,
        made.start("fleet.py", *links) as process,
    ):
        while not vehicles["alpha"].autopilot.armed:
            assert process.poll() is None
            threading.Event().wait(0.05)
        for _ in range(3):
            stranger.sendto(NOISE, ("127.0.0.1", port))
        _, said = process.communicate(timeout=60)
    assert process.returncode == 0, said
    assert "frames on the link that were not used: " in said
    assert "unreadable (" in said
    (counted,) = made.box("alpha", "counted")
    assert counted["frames"]["unreadable"] > 0


@pytest.fixture
def one_radio():
    """Return a function that switches on vehicles with system ids 1 and 2 behind one port."""
    with ExitStack() as stack:

        def switch_on(homes):
            port, found = free_port(), []
            for number, (latitude, longitude) in enumerate(homes, start=1):
                settings = Settings("copter", latitude, longitude, system=number)
                found.append(stack.enter_context(SimulatedVehicle(port, settings, speedup=20.0)))
            return f"udpin:127.0.0.1:{port}", found

        yield switch_on


def test_two_robots_fly_by_one_radio(controllers, one_radio):
    made = controllers(TWO)
    url, (first, second) = one_radio(homes_of(TWO))
    code, said = made.run(
        "fleet.py", "--speedup", "20", "--connect", f"alpha={url}@1", "--connect", f"beta={url}@2"
    )
    assert code == 0, said
    assert made.replayed().complaints == ()
    for vehicle in (first, second):
        assert max(up for _, _, _, up in vehicle.autopilot.track) > 10.0


def test_a_program_for_one_vehicle_does_not_reach_the_other(controllers, one_radio):
    made = controllers(TWO)
    url, vehicles = one_radio(homes_of(TWO))
    code, said = made.run(
        "fleet.py", "--speedup", "20", "--connect", f"alpha={url}@2", "--connect", f"beta={url}@1"
    )
    assert code == 1
    assert "m from the home of its program" in said
    assert not any(vehicle.autopilot.stores[0] or vehicle.autopilot.armed for vehicle in vehicles)


@pytest.mark.parametrize(("of_alpha", "of_beta"), [(2, 1), (1, 2)])
def test_homes_a_few_metres_apart_are_told_apart(controllers, one_radio, of_alpha, of_beta):
    beside = replace(UP_AND_DOWN.robots[0], id="beta", home=(8.0, 0.0, 0.0))
    pair = program(UP_AND_DOWN.robots[0], beside)
    url, vehicles = one_radio(homes_of(pair))
    systems = ("--connect", f"alpha={url}@{of_alpha}", "--connect", f"beta={url}@{of_beta}")
    code, said = controllers(pair).run("fleet.py", "--speedup", "20", *systems)
    swapped = (of_alpha, of_beta) == (2, 1)
    assert code == (1 if swapped else 0), said
    assert ("0 m from the home of 'beta' and 8 m from that of its program" in said) is swapped
    assert any(vehicle.autopilot.history for vehicle in vehicles) is not swapped


def test_which_of_two_vehicles_is_meant_must_be_said(controllers, one_radio):
    made = controllers(UP_AND_DOWN)
    url, vehicles = one_radio([(42.37, 13.35), (42.37, 13.3501)])
    code, said = made.run("fleet.py", "--speedup", "20", "--connect", url)
    assert code == 1
    assert "vehicles with the system ids 1 and 2 on this link: name one, as URL@" in said
    assert not any(vehicle.autopilot.stores[0] or vehicle.autopilot.armed for vehicle in vehicles)


def test_a_vehicle_of_another_kind_is_refused(controllers):
    port = free_port()
    with SimulatedVehicle(port, Settings("rover"), speedup=20.0):
        code, said = controllers(UP_AND_DOWN).run(
            "fleet.py", "--speedup", "20", "--connect", f"udpin:127.0.0.1:{port}"
        )
    assert code == 1
    assert "the vehicle reports the type 'ground rover'; the program is for vehicle 'copter'" in said


def test_a_system_is_given_to_one_robot_only(controllers):
    url = "udpin:127.0.0.1:14550@1"
    code, said = controllers(TWO).run("fleet.py", "--connect", f"alpha={url}", "--connect", f"beta={url}")
    assert code == 2
    assert f"--connect {url}: used for two robots" in said


def homes_of(program):
    return [degrees_of([robot.home[:2]], program.frame)[0] for robot in program.robots]
