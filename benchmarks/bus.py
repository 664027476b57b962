"""Measures how soon a robot that waits goes on after another one notifies it, and what a fleet costs.

From the call of notify, its line synced to the disk and the owner's answer synced to its disk, until
the waiting robot has taken its transition and written that down. Within a process the robots are
threads; between processes they are joined by Zenoh over loopback, beside a bare Zenoh query and its
reply between the same two processes. The fleet is interpreted with simulated robots in real time,
several in each process; all processes begin together, and their logs are replayed together.

    python benchmarks/bus.py --seed 1 > benchmarks/results/bus.txt
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
from datetime import date
from pathlib import Path
from statistics import median

import zenoh

from mmrs_core.behaviour.log import read_logs
from mmrs_core.behaviour.program import Program
from mmrs_core.behaviour.replay import replay
from mmrs_core.contributions.vehicles import VehicleInput
from mmrs_core.runtime.simulation import SIMULATION
from mmrs_core.testing.small_programs import go, notify, program, robot, robot_type
from mmrs_core.transformation.kinds import MOVE_KINDS, PLAIN_ROBOT
from mmrs_mavlink.program import Local, Notify, Robot, Start, Step
from mmrs_mavlink.slots import BusSlots, LocalSlots, shared_slots
from mmrs_runtime.bus import begin_together
from mmrs_runtime.bus.carriers.over_zenoh import ZenohCarrier
from mmrs_runtime.bus.carriers.sessions import Endpoints, configuration
from mmrs_runtime.bus.program_bus import shared_bus
from mmrs_runtime.engine.clocks import RealClock
from mmrs_runtime.engine.run import run as carry_out
from mmrs_runtime.engine.terms import Attention, Terms
from mmrs_runtime.records.log import Log, LogWriter
from mmrs_runtime.semantics import Outcome

PROCESSES, ROUNDS, SPEEDUP = 4, 5, 10.0
LATCHED = 50
"""Slots of a robot that are each set once; all are shown to onlookers whenever one is set, so not more."""


def main() -> None:
    """Print the table, or be one of the processes that are measured."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seed", type=int, default=1, help="of the fleet's ways")
    parser.add_argument("--notifies", type=int, default=500)
    parser.add_argument("--robots", type=int, default=100)
    parser.add_argument("--part", default="", help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.part:
        part = json.loads(given.part)
        {"answer": answer, "fleet": run_part, "sit": sit}[part.pop("do")](**part)
        return
    print(
        f"the bus, {date.today()}, seed {given.seed}, {os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}\n"
    )
    latencies(given.notifies)
    print()
    losses(10)
    print()
    fleet(given.robots, given.seed)


def latencies(count: int) -> None:
    """Print how long notifies take."""
    with tempfile.TemporaryDirectory() as folder:
        within = threads(Path(folder), count)
    with tempfile.TemporaryDirectory() as folder:
        between, bare = processes(Path(folder), count)
    with tempfile.TemporaryDirectory() as folder:
        latched, _ = processes(Path(folder), LATCHED, latched=True)
    with tempfile.TemporaryDirectory() as folder:
        disk = [_synced(Path(folder) / "line") for _ in range(count)]
    print(f"notify called until the waiting robot goes on, {count} of each; milliseconds")
    print(f"{'':<44}{'median':>9}{'99 %':>9}{'median / bare':>15}")
    rows = {
        "within a process, logs synced": within,
        "between two processes, logs and slots synced": between,
        f"the same, {LATCHED} slots set once and never reset": latched,
        "bare Zenoh query and reply": bare,
        "one line written and synced to the disk": disk,
    }
    for name, seconds in rows.items():
        found = sorted(seconds)
        ratio = median(found) / median(bare)
        print(
            f"{name:<44}{1e3 * median(found):>9.2f}{1e3 * found[int(0.99 * len(found))]:>9.2f}{ratio:>15.1f}"
        )


def threads(folder: Path, count: int) -> list[float]:
    """Return how long each notify of one thread's robot took until another's went on."""
    a, b = _robots()
    slots, taken = LocalSlots([a, b]), threading.Event()
    logs = {each.id: Log(folder / each.log, "run-0", each.id) for each in (a, b)}
    at = [0.0]

    def wait() -> None:
        for _ in range(count):
            at[0] = _take(slots, logs["b"], "b")
            _notify(slots, logs["b"], "b", ("b", "go"), active=False)
            taken.set()

    waiter = threading.Thread(target=wait)
    waiter.start()
    found = []
    for _ in range(count):
        time.sleep(0.002)
        begun = time.monotonic()
        _notify(slots, logs["a"], "a", ("b", "go"))
        taken.wait()
        taken.clear()
        found.append(at[0] - begun)
    waiter.join()
    return found


def processes(folder: Path, count: int, *, latched: bool = False) -> tuple[list[float], list[float]]:
    """Return how long each notify took between two processes, and each bare query with its reply.

    Where `latched`, each sets a slot of its own, which is never reset; else all set one that is.
    """
    endpoint = f"tcp/127.0.0.1:{_port()}"
    there = {"do": "answer", "endpoint": endpoint, "folder": str(folder / "b"), "count": count}
    there["names"] = names = [f"go{n}" for n in range(count)] if latched else []
    with _started(there) as process:
        a, _ = _robots(*names)
        carrier = ZenohCarrier("bench", "run-0", ("a", "b"), Endpoints(connect=(endpoint,)))
        slots = shared_slots([a], "run-0", folder, carrier)
        log = Log(folder / a.log, "run-0", "a")
        while slots.node.missing(["b"]):
            time.sleep(0.01)
        found = []
        for name in names or ["go"] * count:
            time.sleep(0.002)
            begun = time.monotonic()
            _notify(slots, log, "a", ("b", name))
            found.append(float(process.stdout.readline()) - begun)
        bare = _bare(endpoint, count)
        slots.close()
        process.stdin.close()
    return found, bare


def answer(endpoint: str, folder: str, count: int, names: list[str]) -> None:
    """Be the robot that waits, in a process of its own; tell each time at which it goes on."""
    _, b = _robots(*names)
    Path(folder).mkdir()
    carrier = ZenohCarrier("bench", "run-0", ("a", "b"), Endpoints(listen=(endpoint,)))
    slots = shared_slots([b], "run-0", Path(folder), carrier)
    log = Log(Path(folder) / b.log, "run-0", "b")
    bare = carrier._session.declare_queryable(
        "bench/bare", lambda query: query.reply("bench/bare", b"x" * 64)
    )
    for name in names or ["go"] * count:
        at = _take(slots, log, "b", name)
        if not names:
            _notify(slots, log, "b", ("b", "go"), active=False)
        print(at, flush=True)
    sys.stdin.read()
    bare.undeclare()
    slots.close()


def _bare(endpoint: str, count: int) -> list[float]:
    with zenoh.open(configuration(Endpoints(connect=(endpoint,)))) as session:
        while not list(session.get("bench/bare", timeout=1.0)):
            time.sleep(0.01)
        found = []
        for _ in range(count):
            time.sleep(0.002)
            begun = time.monotonic()
            list(session.get("bench/bare", payload=b"x" * 64, timeout=1.0))
            found.append(time.monotonic() - begun)
    return found


def _robots(*latched: str) -> tuple[Robot, Robot]:
    """Return a robot and another one that it notifies; `latched`: slots that are never reset."""
    names, home = latched or ("go",), Local(0.0, 0.0, 0.0)
    told = tuple(("b", name) for name in names)
    step = Step("start", Start(), after=(Notify(told),))
    senders = tuple((name, ("a",)) for name in names)
    resets = () if latched else (("go", ("b",)),)
    return (
        Robot("a", "a.jsonl", "copter", home, "start", (step,), volatile=() if latched else told),
        Robot("b", "b.jsonl", "copter", home, "start", (), names, senders, resets),
    )


def _notify(slots: BusSlots, log: Log, sender: str, slot: tuple[str, str], *, active: bool = True) -> None:
    def record(lamport: int) -> None:
        log.write("ntf", "start", lamport=lamport, time=0.0, detail="post:0", slot=".".join(slot))

    slots.notify(sender, (slot,), active, record, lambda silent: None)


def _take(slots: BusSlots, log: Log, robot: str, name: str = "go") -> float:
    def record(lamport: int) -> None:
        log.write("take", "start", lamport=lamport, time=0.0)

    while not slots.take(robot, (name,), record):
        slots.await_change(0.1)
    return time.monotonic()


def _synced(path: Path) -> float:
    begun = time.monotonic()
    with path.open("a") as file:
        file.write("x" * 200 + "\n")
        file.flush()
        os.fsync(file.fileno())
    return time.monotonic() - begun


def losses(count: int) -> None:
    """Print how soon a robot is noticed to be gone whose process is killed, or frozen."""
    print(f"until a robot is noticed to be gone, {count} killed and 3 frozen; milliseconds")
    for word, number, times in (("killed", signal.SIGKILL, count), ("frozen", signal.SIGSTOP, 3)):
        found = sorted(_lost_after(number) for _ in range(times))
        print(f"{word:<44}{1e3 * median(found):>9.1f}{1e3 * found[-1]:>9.1f} at most")


def _lost_after(number: signal.Signals) -> float:
    endpoint = f"tcp/127.0.0.1:{_port()}"
    _, b = _robots()
    with tempfile.TemporaryDirectory() as folder:
        slots = shared_slots(
            [b], "run-0", Path(folder), ZenohCarrier("bench", "run-0", "ab", Endpoints((endpoint,)))
        )
        with _started({"do": "sit", "endpoint": endpoint, "folder": str(Path(folder) / "a")}) as process:
            while slots.node.missing(["a"]):
                time.sleep(0.01)
            time.sleep(0.3)
            begun = time.monotonic()
            process.send_signal(number)
            while not slots.lost(["a"]):
                slots.await_change(1.0)
            taken = time.monotonic() - begun
            process.kill()
        slots.close()
    return taken


def sit(endpoint: str, folder: str) -> None:
    """Be a robot that is there, until the process is killed."""
    a, _ = _robots()
    carrier = ZenohCarrier("bench", "run-0", "ab", Endpoints(connect=(endpoint,)))
    shared_slots([a], "run-0", Path(folder), carrier)
    time.sleep(600.0)


def fleet(robots: int, seed: int) -> None:
    """Print what a fleet costs that hands things on in a ring, and at last gathers."""
    made = ring(robots, seed)
    ports = [_port() for _ in range(PROCESSES)]
    with tempfile.TemporaryDirectory() as folder:
        begun, before = time.monotonic(), _used()
        running = [
            _started(
                {"do": "fleet", "robots": robots, "seed": seed, "number": n, "ports": ports, "folder": folder}
            )
            for n in range(PROCESSES)
        ]
        told = [json.loads(process.communicate()[0]) for process in running]
        wall, used = time.monotonic() - begun, _used() - before
        records = read_logs([Path(folder) / str(n) for n in range(PROCESSES)])
    result = replay(made, records)
    assert (result.outcome, result.complaints) == (Outcome.SUCCESS, ()), result
    notifies = [record for record in records if record.label == "ntf"]
    sets = sum(len(record.slot.split()) for record in notifies)
    flown = max(part["seconds"] for part in told)
    print(f"{robots} simulated robots, {PROCESSES} processes, {SPEEDUP:g} times as fast as real time")
    print(f"  {result.duration:.0f} s of the run in {flown:.1f} s; {wall:.1f} s with starting the processes")
    print(f"  {len(records)} steps, {len(notifies)} notifies of {sets} slots")
    print(
        f"  processor: {used:.1f} s in all, {sum(p['run'] for p in told):.1f} s of it after all were ready,"
        f" {sum(p['run'] for p in told) / flown:.2f} cores"
    )
    print(f"  began together within {1e3 * max(part['skew'] for part in told):.1f} ms (each to the first)")
    print("  outcome success; all logs together replay")


def ring(robots: int, seed: int) -> Program:
    """Return robots each of which goes its ways, tells the next, and waits for the one before."""
    import random

    chance = random.Random(seed)
    names = [f"r{number:03}" for number in range(robots)]
    first, others = names[0], names[1:]
    made = []
    for number, name in enumerate(names):
        after, last = names[(number + 1) % robots], f"leg{ROUNDS - 1}"
        ways = [(10.0 * number, chance.uniform(5.0, 30.0) * (1 - leg % 2), 0.0) for leg in range(ROUNDS)]
        moves = [go(f"leg{leg}", way, after=(notify(f"{after}.round{leg}"),)) for leg, way in enumerate(ways)]
        waits = {f"leg{leg}": [f"round{leg}"] for leg in range(ROUNDS)}
        if name == first:
            waits[last] += [f"done_{other}" for other in others]
            moves.append(go("home", (0.0, 0.0, 0.0), before=(notify(*(f"{o}.home" for o in others)),)))
        else:
            tell = notify(f"{first}.done_{name}")
            moves.append(go("back", (10.0 * number, 1.0, 0.0), after=(tell,)))
            waits["back"] = ["home"]
        home = (10.0 * number, 0.0, 0.0)
        made.append(robot(name, moves, waits=waits, home=home))
    return program(*made)


def run_part(robots: int, seed: int, number: int, ports: list[int], folder: str) -> None:
    """Be one process of the fleet; tell what it used."""
    made = ring(robots, seed)
    mine = [each.id for index, each in enumerate(made.robots) if index % PROCESSES == number]
    own = Path(folder) / str(number)
    others = tuple(f"tcp/127.0.0.1:{port}" for port in ports if port != ports[number])
    endpoints = Endpoints((f"tcp/127.0.0.1:{ports[number]}",), others)
    everybody = [each.id for each in made.robots]
    bus = shared_bus(made.shared, mine, "run-0", own, ZenohCarrier("bench", "run-0", everybody, endpoints))
    beginning = begin_together(bus.node, mine[0], everybody, lambda why: None, beside=mine[1:])
    begun, before = time.monotonic(), _used(resource.RUSAGE_SELF)
    clock = RealClock(SPEEDUP)
    kind = {
        "robot_kinds": {PLAIN_ROBOT.metaclass: PLAIN_ROBOT},
        "move_kinds": {k.metaclass: k for k in MOVE_KINDS},
    }
    backends = {
        each.id: SIMULATION.connect(
            VehicleInput(made, each, robot_type(), environment={}, options={}, **kind)
        )
        for each in made.robots
        if each.id in mine
    }
    with LogWriter(own) as log:
        terms = Terms("run-0", observe=log.write, attention=Attention(clock))
        carry_out(made.executable, backends, slots=bus, clock=clock, conditions={}, terms=terms)
    seconds, run = time.monotonic() - begun, _used(resource.RUSAGE_SELF) - before
    print(json.dumps({"seconds": seconds, "run": run, "skew": beginning.skew}), flush=True)
    bus.close()


def _started(part: dict[str, object]) -> subprocess.Popen[str]:
    command = [sys.executable, __file__, "--part", json.dumps(part)]
    return subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)


def _used(who: int = resource.RUSAGE_CHILDREN) -> float:
    usage = resource.getrusage(who)
    return usage.ru_utime + usage.ru_stime


def _port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


if __name__ == "__main__":
    main()
