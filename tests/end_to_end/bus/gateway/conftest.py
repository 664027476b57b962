"""A gateway for robot 'a' in a process of its own, a program that speaks to it, and robot 'b' on the bus."""

import json
import subprocess
import time
from contextlib import suppress

import pytest
from full_pipes import full_pipe
from gateway_client import RunningGateway
from waiting_pair import waiting_pair
from warm_python import python

from mmrs_core import pipeline
from mmrs_core.languages.reading import read_model
from mmrs_runtime.bus import CommandId
from mmrs_runtime.bus.carriers.over_zenoh import ZenohCarrier
from mmrs_runtime.bus.carriers.sessions import Endpoints
from mmrs_runtime.bus.program_bus import node_of

RUN = "run-0"


@pytest.fixture(scope="session")
def behaviour(tmp_path_factory):
    """Return the file of a behaviour in which 'a' and 'b' wait for each other."""
    file = tmp_path_factory.mktemp("models") / "pair.xmi"
    file.write_text(waiting_pair("rover", taken_back=True))
    return file


@pytest.fixture
def gateway(behaviour, ends, tmp_path):
    """Return a gateway for 'a' that runs, and of which nobody reads what it says."""
    command = [python(), "-m", "mmrs_core", "bus", "gateway", str(behaviour), "--robot", "a"]
    command += ["--log", str(tmp_path / "logs"), "--listen", f"tcp/127.0.0.1:{ends.ports['a']}"]
    file = tmp_path / "logs" / "gateway.json"
    with full_pipe() as (_, unread), subprocess.Popen(command, stderr=unread) as process:
        until = time.monotonic() + 20
        while not file.exists():
            assert process.poll() is None and time.monotonic() < until  # noqa: PT018
            time.sleep(0.01)
        told = json.loads(file.read_text())
        yield RunningGateway(process, file, told["port"], told["token"])
        with suppress(ProcessLookupError):
            process.kill()


@pytest.fixture
def client(gateway):
    """Return a client that has said hello."""
    with gateway.connect() as made:
        made.ask(gateway.hello(), "welcome")
        yield made


@pytest.fixture
def peer(behaviour, contributions, ends, tmp_path):
    """Return the bus of robot 'b', by Zenoh in this process."""
    program = pipeline.program_of(read_model(behaviour, contributions.languages).roots[0], contributions)
    reached = Endpoints(connect=(f"tcp/127.0.0.1:{ends.ports['a']}",))
    carrier = ZenohCarrier("pair", RUN, ("a", "b"), reached, plan=program.fingerprint)
    node = node_of(program.shared, ["b"], RUN, tmp_path / "b", carrier, None)
    yield node
    node.close()


@pytest.fixture
def set_ready(peer, until):
    """Return a function by which 'b' sets the slot 'ready' of 'a', and says what it has detected."""

    def set_(*finds):
        delivery = peer.prepare(CommandId(RUN, "b", "", 1), (("a", "ready"),), True, finds)
        until(lambda: delivery.lamport is not None)
        delivery.send(delivery.lamport)
        until(lambda: not delivery.waiting)

    return set_
