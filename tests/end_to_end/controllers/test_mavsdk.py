"""The upload and command path against a peer that is not ours: MAVSDK."""

import queue
import subprocess
import sys
import threading
from pathlib import Path

import pytest
from lossy_proxy import LossyProxy
from mmrs_multicopter.testing import target_input, two_drones
from peer_lines import said_in
from ports import free_port

import mmrs_mavlink as flight
from mmrs_core.generation.render import render
from mmrs_core.generation.writing import write
from mmrs_mavlink.links.link import Link
from mmrs_mavlink.links.ports import open_port
from mmrs_mavlink.links.retries import Retries
from mmrs_mavlink.plugin.plans.qgc import QGC_PLAN
from mmrs_mavlink.services import missions, parameters
from mmrs_mavlink.services.commands import command
from mmrs_mavlink.services.uploads import mission_of
from mmrs_mavlink.sitl import Settings, SimulatedVehicle
from mmrs_runtime.clock import Clock

pytestmark = pytest.mark.real_time("controllers")

PEERS = Path(__file__).parents[2] / "peers"


class Peer:
    """A program around MAVSDK, which logs to the same output as it talks to."""

    def __init__(self, script: str, *arguments: str) -> None:
        self.process = subprocess.Popen(
            [sys.executable, str(PEERS / script), *arguments],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )
        self.lines: queue.SimpleQueue[str] = queue.SimpleQueue()
        self.reader = threading.Thread(target=self._read, daemon=True)
        self.reader.start()

    def _read(self) -> None:
        for line in self.process.stdout:
            self.lines.put(line)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.wait()
        self.reader.join()
        self.process.stdin.close()
        self.process.stdout.close()

    def next(self):
        said = None
        while said is None:
            line = self.lines.get(timeout=60.0)
            print(line, end="")
            said = said_in(line)
        return said


@pytest.fixture
def link():
    port = free_port()
    made = Link(open_port(f"udpin:127.0.0.1:{port}"), Clock())
    yield made, str(port)
    made.close()


@pytest.fixture
def items():
    robot = flight.Robot(
        id="alpha",
        log="alpha.jsonl",
        vehicle="copter",
        home=flight.Geographic(42.37, 13.35, 0.0),
        start="a",
        steps=tuple(
            flight.Step(move, flight.GoTo(flight.Geographic(latitude, 13.35, 20.0), speed=5.0))
            for move, latitude in (("a", 42.3701), ("b", 42.3702), ("c", 42.3703))
        ),
        runs=(flight.Run(("a", "b", "c"), (1.0, 0.0, 1.0)),),
    )
    return mission_of(robot)[0]


def await_autopilot(link, peer) -> None:
    assert link.wait(lambda: link.component, 30.0), "MAVSDK is not heard"
    assert peer.next()["what"] == "ready"


def test_mavsdk_as_the_autopilot_accepts_upload_and_arming(link, items):
    made, port = link
    with Peer("mavsdk_autopilot.py", port) as peer:
        await_autopilot(made, peer)
        missions.upload(made, items)
        found = peer.next()
        assert [item[0] for item in found["items"]] == [16, 178, 16, 16, 16, 17]
        assert found["items"][2] == [16, 3, 423701000, 133500000, 20.0, 1.0, 0.0]
        missions.verify(made, items)
        command(made, 400, 1)
        assert peer.next() == {"what": "arm", "arm": True}


def test_mavsdk_as_the_autopilot_tells_its_parameters_and_takes_new_values(link):
    made, port = link
    with Peer("mavsdk_autopilot.py", port) as peer:
        await_autopilot(made, peer)
        found = parameters.read(made, ["RTL_ALT", "NO_SUCH", "FS_GCS_ENABLE"])
        assert found == {"RTL_ALT": 1500.0, "FS_GCS_ENABLE": 0.0}
        assert parameters.write(made, "FS_GCS_ENABLE", 3)
        assert parameters.read(made, ["FS_GCS_ENABLE"]) == {"FS_GCS_ENABLE": 3.0}


@pytest.mark.parametrize("seed", [1, *(pytest.param(seed, marks=pytest.mark.thorough) for seed in (2, 3))])
def test_mavsdk_as_the_autopilot_gets_everything_over_a_bad_network(link, items, seed):
    made, port = link
    made.retries = Retries(tries=12, answer=0.6, item=0.3)
    with (
        LossyProxy(("127.0.0.1", int(port)), loss=0.15, double=0.1, late=0.1, seed=seed) as network,
        Peer("mavsdk_autopilot.py", str(network.port)) as peer,
    ):
        await_autopilot(made, peer)
        missions.upload(made, items)
        missions.verify(made, items)
        command(made, 400, 1)
        assert parameters.write(made, "FS_GCS_ENABLE", 3)
        told = [peer.next()]
        while told[-1]["what"] != "arm":
            told.append(peer.next())
        last = [each for each in told if each["what"] == "mission"][-1]
        assert [item[0] for item in last["items"]] == [16, 178, 16, 16, 16, 17]
        assert min(network.lost, network.doubled) > 0


def test_mavsdk_as_the_ground_uploads_a_plan_over_a_network_that_loses_and_doubles(tmp_path):
    # To a PX4: MAVSDK takes what an ArduPilot answers to a doubled item for the end.
    write(render(QGC_PLAN, target_input(two_drones()), allow_lossy=True), tmp_path)
    port = free_port()
    with (
        LossyProxy(("127.0.0.1", port), loss=0.1, double=0.1, seed=4) as network,
        SimulatedVehicle(network.port, Settings(firmware="px4", boot=0.0, ready=0.0)) as vehicle,
        Peer("mavsdk_import.py", str(port), str(tmp_path / "alpha.plan")) as peer,
    ):
        found = peer.next()
        kept = [item.command for item in vehicle.autopilot.stores[0]]
        assert kept == [item[0] for item in found["mission"]]
        assert [item[0] for item in found["downloaded"]] == kept
        assert network.lost > 0
