"""Robots on a bus, in one process or in many, over each carrier; every test runs on all of them."""

import subprocess
import threading
import time
from pathlib import Path

import bus_walking
import pytest
from bus_walking import RUN, Gone, Walker, logged
from cut_proxy import CutProxy
from hub import Hub
from ports import free_port
from warm_python import FREEZE, THAW, python

from mmrs_core.behaviour.replay import replay
from mmrs_runtime.bus import FileJournal, Node
from mmrs_runtime.bus.program_bus import ProgramBus, members_of, recorded_of

PATIENCE = 60.0
SCRIPT = Path(bus_walking.__file__)


class Fleet:
    """What all fleets can do: robots are started, killed, frozen, and come to an end."""

    def __init__(self, behaviour: str, size: int, folder: Path) -> None:
        self.behaviour, self.size, self.folder = behaviour, size, folder
        self.program = bus_walking.BEHAVIOURS[behaviour](size)
        self.names = [robot.id for robot in self.program.robots]

    def folder_of(self, robot: str) -> Path:
        return self.folder / robot

    def records(self):
        return [record for robot in self.names for record in logged(self.folder_of(robot), robot)]

    def replayed(self, *, partial: bool = False):
        return replay(self.program, self.records(), partial=partial)

    def await_steps(self, robot: str, number: int) -> None:
        until = time.monotonic() + PATIENCE
        while len(logged(self.folder_of(robot), robot)) < number:
            assert time.monotonic() < until, f"{robot} makes no {number} steps"
            time.sleep(0.01)


class ThreadFleet(Fleet):
    """Robots in threads, each with an end of its own, joined by a hub."""

    def __init__(self, *args) -> None:
        super().__init__(*args)
        self.hub = Hub()
        self.runs: dict[str, _Thread] = {}

    def start(self, robot: str, *die: str, again: bool = False, pause: float = 0.0) -> None:
        self.runs[robot] = _Thread(self, robot, die, again, pause)

    def kill(self, robot: str) -> None:
        self.runs[robot].kill()
        self.runs[robot].thread.join()

    def freeze(self, robot: str) -> None:
        self.runs[robot].freeze()

    def thaw(self, robot: str) -> None:
        self.runs[robot].thaw()

    def split(self) -> None:
        """Cut all ends from each other; every robot goes on where it is."""
        for robot, run in self.runs.items():
            run.carrier.cut = True
            self.hub.noticed(robot, False, run.node)

    def heal(self) -> None:
        for robot, run in self.runs.items():
            run.carrier.cut = False
            self.hub.noticed(robot, True, run.node)

    def ended(self, robot: str) -> bool:
        """Wait until a robot has ended; return whether well."""
        self.runs[robot].thread.join(PATIENCE)
        return self.runs[robot].well

    def close(self) -> None:
        for run in self.runs.values():
            run.kill()
            run.thread.join()


class _Thread:
    def __init__(self, fleet: ThreadFleet, robot: str, die, again: bool, pause: float) -> None:
        self.fleet, self.robot, self.die, self.pause = fleet, robot, die, pause
        self.killed, self.running = threading.Event(), threading.Event()
        self.running.set()
        self.well = False
        folder = fleet.folder_of(robot)
        folder.mkdir(exist_ok=True)
        recorded = recorded_of(fleet.program.executable, [robot], logged(folder, robot)) if again else None
        self.carrier = _Reachable(fleet.hub, self)
        self.node = Node(
            [members_of(fleet.program.executable)[robot]],
            RUN,
            carrier=self.carrier,
            journals=lambda id: FileJournal(folder / f"{id}.slots.ndjson"),
            recorded=recorded,
        )
        self._die_after_applying()
        bus = ProgramBus(self.node, fleet.program.executable)
        bus.await_change = self._await_change
        self.walker = Walker(fleet.program, robot, folder, bus, at=self._at)
        self.thread = threading.Thread(target=self._run)
        self.thread.start()

    def kill(self) -> None:
        self.killed.set()
        self.running.set()
        self.carrier.cut = True
        self.carrier.close()

    def freeze(self) -> None:
        self.running.clear()
        self.carrier.cut = True
        self.fleet.hub.noticed(self.robot, False, self.node)

    def thaw(self) -> None:
        self.carrier.cut = False
        self.fleet.hub.noticed(self.robot, True, self.node)
        self.running.set()

    def _run(self) -> None:
        try:
            self.well = self.walker.walk(time.monotonic() + PATIENCE)
            self.node.close()
        except Gone:
            self.carrier.cut = True
            self.node._pacing.is_over = True
            self.carrier.close()

    def _await_change(self, seconds: float) -> None:
        self.node.await_change(seconds)
        self._at("waiting", -1)

    def _at(self, what: str, number: int) -> None:
        self.running.wait()
        if what == "granted":
            time.sleep(self.pause)
        if self.killed.is_set() or f"{what}:{number}" in self.die:
            raise Gone

    def _die_after_applying(self) -> None:
        owner = self.node._owners._owners[self.robot]
        commit, numbers = (
            owner.commit,
            {int(d.partition(":")[2]) for d in self.die if d.startswith("applied")},
        )

        def dying(sent):
            answer = commit(sent)
            if sent.id.sequence in numbers:
                self.killed.set()
                self.carrier.cut = True
                threading.Thread(target=self.carrier.close).start()
            return answer

        owner.commit = dying


class _Reachable:
    """A hub's carrier that can be cut off both ways."""

    def __init__(self, hub, run) -> None:
        self._inner, self._hub, self._run, self.cut = hub.plug(), hub, run, False

    def open(self, station) -> None:
        self._station = station
        self._inner.open(self)

    def ask(self, sender, owner, request, answered) -> None:
        if not self.cut:
            self._inner.ask(sender, owner, request, lambda text: None if self.cut else answered(text))

    def serve(self, owner, sender, request) -> str:
        answer = "" if self.cut else self._station.serve(owner, sender, request)
        return "" if self.cut else answer

    def noticed(self, robot, here) -> None:
        self._station.noticed(robot, here)

    def shown(self, robot) -> str:
        return self._station.shown(robot)

    def __getattr__(self, name):
        return getattr(self._inner, name)


class ProcessFleet(Fleet):
    """Robots in processes of their own, which reach each other by Zenoh over loopback.

    They know of each other nothing but proxies, which can be cut; nobody tells them of other ways.
    """

    def __init__(self, *args) -> None:
        super().__init__(*args)
        self.ports = {robot: free_port() for robot in self.names}
        self.proxies = {robot: CutProxy(port) for robot, port in self.ports.items()}
        self.processes: dict[str, list[subprocess.Popen]] = {}

    def split(self) -> None:
        for proxy in self.proxies.values():
            proxy.cut()

    def heal(self) -> None:
        for proxy in self.proxies.values():
            proxy.heal()

    def endpoints(self, robot: str) -> list[str]:
        others = [proxy.port for other, proxy in self.proxies.items() if other != robot]
        self.folder_of(robot).mkdir(exist_ok=True)
        alone = self.folder_of(robot) / "no-gossip.json5"
        alone.write_text('{"scouting": {"gossip": {"enabled": false}}}')
        listen = ["--config", str(alone), "--listen", f"tcp/127.0.0.1:{self.ports[robot]}"]
        return listen + [word for port in others for word in ("--connect", f"tcp/127.0.0.1:{port}")]

    def start(self, robot: str, *die: str, again: bool = False, pause: float = 0.0) -> None:
        self.processes[robot] = [self._walker(robot, die, again, pause, self.endpoints(robot))]

    def _walker(self, robot: str, die, again: bool, pause: float, ways: list[str]) -> subprocess.Popen:
        command = [python(), str(SCRIPT), self.behaviour, robot, str(self.folder_of(robot))]
        command += ["--size", str(self.size), "--pause", str(pause), *ways]
        command += [word for each in die for word in ("--die", each)] + (["--again"] if again else [])
        return subprocess.Popen(command)

    def kill(self, robot: str) -> None:
        for process in self.processes[robot]:
            process.kill()
            process.wait()

    def freeze(self, robot: str) -> None:
        for process in self.processes[robot]:
            process.send_signal(FREEZE)

    def thaw(self, robot: str) -> None:
        for process in self.processes[robot]:
            process.send_signal(THAW)

    def ended(self, robot: str) -> bool:
        return self.processes[robot][0].wait(PATIENCE) == 0

    def close(self) -> None:
        for robot in self.processes:
            self.thaw(robot)
            self.kill(robot)
        for proxy in self.proxies.values():
            proxy.close()


class GatewayFleet(ProcessFleet):
    """Robots that know nothing but sockets, each at a gateway of its own."""

    def start(self, robot: str, *die: str, again: bool = False, pause: float = 0.0) -> None:
        folder = self.folder_of(robot)
        folder.mkdir(exist_ok=True)
        (folder / "gateway.json").unlink(missing_ok=True)
        gateway = subprocess.Popen(
            [
                python(),
                "-c",
                GATEWAY,
                self.behaviour,
                str(self.size),
                robot,
                str(folder),
                ",".join(die),
                *self.endpoints(robot),
            ],
            stderr=subprocess.DEVNULL,
        )
        walker = self._walker(robot, die, again, pause, ["--gateway", str(folder)])
        self.processes[robot] = [walker, gateway]

    def freeze(self, robot: str) -> None:
        """Freeze the program alone: the gateway must notice."""
        self.processes[robot][0].send_signal(FREEZE)

    def ended(self, robot: str) -> bool:
        well = super().ended(robot)
        if not well:
            self.kill(robot)
        return well


GATEWAY = f"""
import sys
sys.path.insert(0, {str(SCRIPT.parent)!r})
from pathlib import Path
from bus_walking import BEHAVIOURS, RUN, die_after_applying
from mmrs_core.cli.bus import _until_interrupted
from mmrs_runtime.bus.carriers.over_zenoh import ZenohCarrier
from mmrs_runtime.bus.carriers.sessions import Endpoints
from mmrs_runtime.bus.gateway.server import Gateway
from mmrs_runtime.bus.program_bus import node_of
behaviour, size, robot, folder, die, *ways = sys.argv[1:]
listen = tuple(ways[i + 1] for i, word in enumerate(ways) if word == "--listen")
connect = tuple(ways[i + 1] for i, word in enumerate(ways) if word == "--connect")
endpoints = Endpoints(listen, connect, Path(ways[ways.index("--config") + 1]))
made = BEHAVIOURS[behaviour](int(size))
names = [each.id for each in made.robots]
def enter(recorded):
    carrier = ZenohCarrier("m", RUN, names, endpoints, plan=made.fingerprint)
    given = None if recorded is None else {{robot: recorded}}
    node = node_of(made.shared, [robot], RUN, Path(folder), carrier, given)
    return die_after_applying(node, die.split(","))
_until_interrupted(Gateway(robot, RUN, enter, Path(folder), 0))
"""

FLEETS = {"threads": ThreadFleet, "zenoh": ProcessFleet, "gateway": GatewayFleet}


@pytest.fixture(params=FLEETS)
def fleet(request, tmp_path):
    """Return a function that makes a fleet of robots that walk through a behaviour."""
    made: list[Fleet] = []

    def make(behaviour: str, size: int = 6) -> Fleet:
        made.append(FLEETS[request.param](behaviour, size, tmp_path))
        return made[-1]

    yield make
    for each in made:
        each.close()


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items):
    """Leave to the thorough profile what takes seconds and differs least from what the fast one runs."""
    for item in items:
        if _differs_little(item.name) and item.path.parent == Path(__file__).parent:
            item.add_marker(pytest.mark.thorough)


def _differs_little(name: str) -> bool:
    if "frozen" in name or "split" in name:
        return "[zenoh" not in name
    return any(word in name for word in ("any_moment", "granted", "acknowledged")) and "[threads" not in name
