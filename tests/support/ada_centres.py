"""Decision centres in Ada: generated, compiled with warnings as errors, run with a simulated vehicle."""

from __future__ import annotations

import shutil
import socket
import subprocess
import threading
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace
from hashlib import sha256
from pathlib import Path
from types import MappingProxyType
from typing import Any, TypeAlias

from bus_traces import Trace
from can_hub import RunningHub, running
from dives import diver
from mmrs_auv.sheets import sheet_of
from mmrs_auv.targets.ada.target import ADA
from shared import made_once
from warm_python import python

from auv_vessel.body.surroundings import Surroundings
from auv_vessel.body.vehicle import Vehicle
from auv_vessel.control.actuators import Actuators
from auv_vessel.control.sensors import Sensors
from auv_vessel.eyes import Detection, to_datagram
from auv_vessel.hosting import Rehearsal
from auv_vessel.movement.movement import Movement
from auv_vessel.sheet import Sheet
from auv_vessel.wire.codec import Codec, Received
from auv_vessel.wire.frame import Frame
from auv_vessel.wire.ports import Port, open_port
from mmrs_core.behaviour.log import read_logs
from mmrs_core.behaviour.program import Program
from mmrs_core.behaviour.replay import ReplayResult, replay
from mmrs_core.contributions.targets import TargetInput
from mmrs_core.generation.render import render
from mmrs_core.scene import RobotType
from mmrs_core.testing.programs import installed

Meddle: TypeAlias = "Callable[[World, subprocess.Popen[str]], None]"

STILL = Surroundings(noise=False)
"""Water in which instruments do not err."""

FLAGS = ("-gnat2012", "-gnatwa", "-gnatwe", "-gnata")


def write(behaviour: Program, folder: Path, type: RobotType | None = None) -> Path:
    """Write the decision centres of a behaviour; return the folder of the first robot."""
    kind = type or diver()
    files = render(
        ADA, TargetInput(behaviour, {kind.name: kind}, installed().robot_kinds, installed().move_kinds)
    )
    for file in files:
        path = folder / file.path
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(file.content)
    return next(folder.glob("robot-*"))


def build(robot: Path) -> Path:
    """Compile a decision centre; return the program."""
    return compiled(robot, "../../common/decision_centre.adb")


def compiled(robot: Path, unit: str) -> Path:
    """Compile a program; return it. What programs share is compiled once for all of them.

    Args:
        unit: its file, as seen from a folder inside that of the robot.
    """
    common = sorted([*robot.parent.glob("common/*.ad[bs]"), robot / "mission.ads"])
    name = f"ada-{sha256(b''.join(each.read_bytes() for each in common)).hexdigest()}"
    made = robot / "obj"

    def make(folder: Path) -> None:
        _gnatmake(made, "../../common/decision_centre.adb")
        made.rename(folder)
        for each in (*folder.glob("mission.*"), *folder.glob("conditions.*")):
            each.unlink()

    shutil.copytree(made_once(name, make), made)
    _gnatmake(made, unit)
    return made / Path(unit).stem


def _gnatmake(folder: Path, unit: str) -> None:
    folder.mkdir(exist_ok=True)
    words = ["gnatmake", "-q", "-m", *FLAGS, "-I..", "-I../../common", unit]
    done = subprocess.run(words, cwd=folder, capture_output=True, text=True, timeout=300)
    assert (done.returncode, done.stderr) == (0, "")


def judge(robot: Path, units: Sequence[str] = ("mission.adb", "conditions.adb")) -> str:
    """Return what the compiler has to say of sources; nothing is made."""
    said = ""
    for unit in units:
        words = ["gcc", "-c", "-gnatc", *FLAGS, "-I.", "-I../common", unit]
        said += subprocess.run(words, cwd=robot, capture_output=True, text=True, timeout=120).stderr
    return said


class Bridge:
    """A node that passes on what is said on a real bus, and says there what a rehearsed one says."""

    name = "Bridge"
    period = 0.02

    def __init__(self, port: Port) -> None:
        self._port = port

    def hear(self, frame: Frame, now: float) -> None:
        self._port.send(frame)

    def tick(self, now: float) -> list[Frame]:
        found = []
        while (frame := self._port.receive(0.0)) is not None:
            found.append(frame)
        return found


def leave_alone(world: World, process: subprocess.Popen[str]) -> None:
    """Meddle with nothing."""


class World:
    """A simulated vehicle with its whole control layer in this process, on a hub, in real time at most."""

    def __init__(self, hub: RunningHub, sheet: Sheet, surroundings: Surroundings) -> None:
        self.hub = hub
        self.heard: list[Received] = []
        self._codec = Codec(sheet)
        self.vehicle = Vehicle(sheet, Codec(sheet), surroundings)
        self.actuators = Actuators(sheet, Codec(sheet))
        parts = [Sensors(sheet, Codec(sheet)), self.actuators, Movement(sheet, Codec(sheet))]
        self._port = open_port("socketcand", f"can0@127.0.0.1:{hub.port}")
        self.trace = Trace(sheet)
        self._emergency = self._codec.encode("SensorsEmergency", Reason="ORDERED", Release=False)
        nodes = [self.vehicle, *parts, Bridge(self._port), self.trace]
        self.rehearsal = Rehearsal(nodes, watch=self._watch)

    def _watch(self, now: float, frame: Frame) -> None:
        if (said := self._codec.decode(frame)) is not None:
            self.heard.append(said)

    def said(self, name: str) -> list[Received]:
        """Return what messages of that name said, each time that it was something else."""
        found: list[Received] = []
        for each in self.heard:
            if each.name == name and (not found or each.values != found[-1].values):
                found.append(each)
        return found

    def run(
        self, until: subprocess.Popen[str], seconds: float, meddle: Meddle = leave_alone, **orders: float
    ) -> None:
        """Let time go by until a process ends; `meddle` may do something at every moment.

        An order counts from so many seconds on: ``cut`` ends the bus, ``strange`` has what looks like
        emergencies on it but for their extended identifiers.
        """
        behind = time.monotonic() - self.rehearsal.now
        while until.poll() is None:
            assert self.rehearsal.now < seconds, "it does not end"
            if self.rehearsal.now >= orders.get("cut", seconds):
                self.hub.stop()
                until.wait(30)
                return
            if self.rehearsal.now >= orders.get("strange", seconds):
                self._port.send(self._emergency._replace(extended=True))
            meddle(self, until)
            self.rehearsal.run(0.05)
            time.sleep(max(0.0, self.rehearsal.now + behind - time.monotonic()))


@dataclass
class Dive:
    """What came of a decision centre that ran: its exit status, what it said, its log, the bus."""

    status: int
    errors: str
    replayed: ReplayResult
    world: World
    log: Path


def run(
    program: Path,
    behaviour: Program,
    folder: Path,
    seconds: float = 120.0,
    *,
    robot: int = 0,
    gateway: Path | None = None,
    detections: int = 0,
    options: Sequence[str] = (),
    **how: Any,
) -> Dive:
    """Have the decision centre of a robot command its vehicle until it ends."""

    def words(port: int) -> Sequence[str]:
        given = ["--gateway", str(gateway)] if gateway is not None else []
        given += ["--detections", str(detections)] if detections else []
        return [str(program), "--bus", f"127.0.0.1:{port}", "--logs", str(folder / "logs"), *given, *options]

    return commanded(words, behaviour, folder, seconds, robot=robot, **how)


def commanded(
    words: Callable[[int], Sequence[str]],
    behaviour: Program,
    folder: Path,
    seconds: float = 120.0,
    *,
    robot: int = 0,
    extra: Mapping[str, float] = MappingProxyType({}),
    surroundings: Surroundings = STILL,
    meddle: Meddle = leave_alone,
    **orders: float,
) -> Dive:
    """Have a program, whose words depend on the port of the bus, command a robot's vehicle until it ends.

    More about the vehicle may be given than its type says.
    """
    one = behaviour.robots[robot]
    sheet = sheet_of(diver(), one.id, home=one.home or (0.0, 0.0, 0.0), surface=behaviour.frame.surface)
    sheet = replace(sheet, extra={**sheet.extra, **extra})
    logs = folder / "logs"
    with running() as hub:
        world = World(hub, sheet, surroundings)
        process = subprocess.Popen(
            words(hub.port), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True
        )
        try:
            world.run(process, seconds, meddle, **orders)
        finally:
            process.kill()
            _, errors = process.communicate()
    replayed = replay(behaviour, read_logs([logs]), partial=len(behaviour.robots) > 1)
    return Dive(process.returncode, errors, replayed, world, logs)


@contextmanager
def gateways(behaviour: Path, folder: Path, robots: Sequence[str]) -> Iterator[Mapping[str, Path]]:
    """Have a gateway run for each robot; give the files in which they say where they listen."""
    with socket.create_server(("127.0.0.1", 0)) as free:
        meeting = f"tcp/127.0.0.1:{free.getsockname()[1]}"
    processes, files = [], {}
    for number, robot in enumerate(robots):
        kept = folder / f"gateway-{robot}"
        words = [python(), "-m", "mmrs_core", "bus", "gateway", str(behaviour), "--robot", robot]
        words += ["--log", str(kept), "--connect" if number else "--listen", meeting]
        processes.append(subprocess.Popen(words, stderr=subprocess.DEVNULL))
        files[robot] = kept / "gateway.json"
        until = time.monotonic() + 30
        while not files[robot].exists():
            assert time.monotonic() < until, "there is no gateway"
            time.sleep(0.05)
    try:
        yield files
    finally:
        for process in processes:
            process.kill()
            process.wait()


def unused_port() -> int:
    """Return a port for datagrams that nobody uses now."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as camera:
        camera.bind(("127.0.0.1", 0))
        port: int = camera.getsockname()[1]
        return port


@contextmanager
def telling(port: int, detection: Detection) -> Iterator[None]:
    """Send a detection again and again, and rubbish between."""
    over = threading.Event()

    def tell() -> None:
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as camera:
            while not over.wait(0.2):
                now = replace(detection, time=time.monotonic())
                for data in (b"\xff{", b'{"name": "', to_datagram(now)):
                    with suppress(OSError):
                        camera.sendto(data, ("127.0.0.1", port))

    teller = threading.Thread(target=tell)
    teller.start()
    yield
    over.set()
    teller.join()
