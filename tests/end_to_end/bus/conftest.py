"""Ends of the bus in this process, over Zenoh on loopback, with and without certificates."""

import json
import time
from collections.abc import Callable
from datetime import UTC, datetime
from pathlib import Path

import pytest
from ports import free_port

from mmrs_core.cli.bus_access import Holder
from mmrs_core.cli.bus_certificates import make_keys
from mmrs_runtime.bus import CommandId, FileJournal, Member, Node, Owned
from mmrs_runtime.bus.carriers.over_zenoh import ZenohCarrier
from mmrs_runtime.bus.carriers.sessions import Endpoints

NAMES = ("a", "b", "c")
RUN = "run-0"
PLAN = "91d99b94dcb38ab4"
PATIENCE = 20.0


class Ends:
    """Ends of the bus, each for one robot whose slot ``go`` all others may set and reset."""

    def __init__(self, folder) -> None:
        self.folder = folder
        self.ports = {robot: free_port() for robot in NAMES}
        self.nodes: list[Node] = []
        self.keys = None
        self.tell = print

    def certify(self) -> None:
        self.keys = self.folder / "keys"
        holders = [Holder(robot, (robot,)) for robot in NAMES]
        make_keys(self.keys, holders, ["127.0.0.1"], datetime.now(UTC), 2)

    def open(
        self,
        robot: str,
        *,
        certificate: str | None = None,
        run: str = RUN,
        listens: bool = True,
        settle: float = 0.0,
        plan: str = PLAN,
    ) -> Node:
        """Open an end for a robot, with its own certificate if there are any and no other is given."""
        endpoints = self.endpoints(robot, certificate, listens)
        return self.open_at(robot, endpoints, run=run, settle=settle, plan=plan)

    def open_at(
        self, robot: str, endpoints: Endpoints, *, run: str = RUN, settle: float = 0.0, plan: str = PLAN
    ) -> Node:
        """Open an end for a robot that reaches the others so."""
        others = tuple(other for other in NAMES if other != robot)
        member = Member(Owned(robot, ("go",), {"go": others}, {"go": others}), frozenset(others))
        folder = self.folder / f"{robot} {len(self.nodes)}"
        folder.mkdir()
        carrier = ZenohCarrier("mission", run, NAMES, endpoints, plan=plan)
        journals = lambda id: FileJournal(folder / f"{id}.ndjson")  # noqa: E731
        node = Node(
            [member],
            run,
            plan=plan,
            carrier=carrier,
            journals=journals,
            tell=lambda line: self.tell(line),
            settle=settle,
        )
        self.nodes.append(node)
        return node

    def endpoints(self, robot: str, certificate: str | None = None, listens: bool = True) -> Endpoints:
        way = "tls" if self.keys is not None else "tcp"
        file = self.keys / (certificate or robot) / "bus.json5" if self.keys is not None else None
        if file is not None and certificate not in (None, robot):
            file = _without_name(file)
        others = tuple(f"{way}/127.0.0.1:{port}" for other, port in self.ports.items() if other != robot)
        listen = (f"{way}/127.0.0.1:{self.ports[robot]}",) if listens else (f"{way}/127.0.0.1:0",)
        return Endpoints(listen, others, file)


def _without_name(file: Path) -> Path:
    """Return a configuration that does not say for whom its certificate speaks, as a forger has it."""
    forged = file.with_name("forged.json5")
    told = json.loads(file.read_text())
    del told["metadata"]
    forged.write_text(json.dumps(told))
    return forged


def _until(holds: Callable[[], object], seconds: float = PATIENCE) -> float:
    """Wait until something holds; return after how many seconds."""
    begun = time.monotonic()
    while not holds():
        assert time.monotonic() - begun < seconds, "does not come to hold"
        time.sleep(0.002)
    return time.monotonic() - begun


def _notify(
    node: Node, sender: str, owner: str, number: int = 1, *, active: bool = True, seconds: float = 5.0
) -> bool:
    """Have a slot set; return whether its owner has acknowledged in time."""
    delivery = node.prepare(CommandId(RUN, sender, "", number), ((owner, "go"),), active)
    until = time.monotonic() + seconds
    while delivery.lamport is None and time.monotonic() < until:
        node.await_change(0.02)
    if delivery.lamport is None:
        delivery.abort()
        return False
    delivery.send(delivery.lamport)
    while delivery.waiting and time.monotonic() < until:
        node.await_change(0.02)
    return not delivery.waiting


@pytest.fixture
def ends(tmp_path):
    made = Ends(tmp_path)
    yield made
    for node in made.nodes:
        node.close()


@pytest.fixture(scope="session")
def until():
    return _until


@pytest.fixture(scope="session")
def notify():
    return _notify
