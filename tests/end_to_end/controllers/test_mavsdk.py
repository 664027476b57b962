"""The upload and command path against a peer that is not ours: MAVSDK."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

from mmrs_core import flight
from mmrs_core.flight import missions
from mmrs_core.flight.clock import Clock
from mmrs_core.flight.commands import command
from mmrs_core.flight.link import Link
from mmrs_core.flight.ports import open_port
from mmrs_core.flight.uploads import mission_of

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

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.communicate()

    def next(self):
        for line in self.process.stdout:
            if line.startswith("peer "):
                return json.loads(line.removeprefix("peer "))
        raise AssertionError("the peer has ended")


@pytest.fixture
def link(free_port):
    port = free_port()
    made = Link(open_port(f"udpin:127.0.0.1:{port}"), Clock())
    yield made, str(port)
    made.close()


def test_mavsdk_as_the_autopilot_accepts_upload_and_arming(link):
    made, port = link
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
    items, _ = mission_of(robot)
    with Peer("mavsdk_autopilot.py", port) as peer:
        assert made.wait(lambda: made.component, 30.0), "MAVSDK is not heard"
        assert peer.next()["what"] == "ready"
        missions.upload(made, items)
        found = peer.next()
        assert [item[0] for item in found["items"]] == [16, 178, 16, 16, 16, 17]
        assert found["items"][2] == [16, 3, 423701000, 133500000, 20.0, 1.0, 0.0]
        missions.verify(made, items)
        command(made, 400, 1)
        assert peer.next() == {"what": "arm", "arm": True}
