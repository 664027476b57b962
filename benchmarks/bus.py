"""Measures how soon a robot that waits goes on after another one notifies it, and what a fleet costs.

From the notify that is about to be written, its line synced to the disk and the owner's answer synced to
its disk, until the waiting robot has taken its transition and written that down. All robots are simulated
and run by the engine in real time; between processes they are joined by Zenoh over loopback, beside a bare
Zenoh query and its reply between the same two processes. Of the fleet several robots are in each process;
all processes begin together, and their logs are replayed together.

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
from collections.abc import Callable, Sequence
from datetime import date
from pathlib import Path
from statistics import median

import zenoh

from mmrs_core.behaviour.log import read_logs
from mmrs_core.behaviour.program import Program
from mmrs_core.behaviour.replay import replay
from mmrs_core.contributions.vehicles import VehicleInput
from mmrs_core.simulation.simulation import SIMULATION
from mmrs_core.testing.small_programs import go, hold, notify, program, robot, robot_type
from mmrs_core.transformation.kinds import MOVE_KINDS, PLAIN_ROBOT
from mmrs_runtime.bus import begin_together
from mmrs_runtime.bus.carriers.over_zenoh import ZenohCarrier
from mmrs_runtime.bus.carriers.sessions import Endpoints, configuration
from mmrs_runtime.bus.program_bus import ProgramBus, shared_bus
from mmrs_runtime.engine.clocks import RealClock
from mmrs_runtime.engine.run import run as carry_out
from mmrs_runtime.engine.terms import Attention, Terms
from mmrs_runtime.records.log import LogWriter
from mmrs_runtime.records.steps import StepRecord
from mmrs_runtime.semantics import Outcome
from mmrs_runtime.slots import LocalSlots, Slots

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
        within = together(Path(folder), count)
    with tempfile.TemporaryDirectory() as folder:
        between, bare = processes(Path(folder), count)
    with tempfile.TemporaryDirectory() as folder:
        latched, _ = processes(Path(folder), LATCHED, latched=True)
    with tempfile.TemporaryDirectory() as folder:
        disk = [_synced(Path(folder) / "line") for _ in range(count)]
    print(f"a notify until the waiting robot goes on, {count} of each; milliseconds")
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


def together(folder: Path, count: int) -> list[float]:
    """Return how long each notify of a robot took until another one of its process went on."""
    made, times = exchange(count), Times()
    carry_on(made, ["a", "b"], LocalSlots(made.executable), RealClock(), folder, times)
    return times.taken_after(times.told)


def processes(folder: Path, count: int, *, latched: bool = False) -> tuple[list[float], list[float]]:
    """Return how long each notify took between two processes, and each bare query with its reply.

    Where `latched`, each sets a slot of its own, which is never reset; else all set one that is.
    """
    endpoint = f"tcp/127.0.0.1:{_port()}"
    there = {"do": "answer", "endpoint": endpoint, "folder": str(folder / "b"), "count": count}
    with _started(there | {"latched": latched}) as process:
        made, times = exchange(count, latched=latched), Times()
        bus = _bus(made, "a", folder / "a", Endpoints(connect=(endpoint,)))
        while bus.node.missing(["b"]):
            time.sleep(0.01)
        carry_on(made, ["a"], bus, RealClock(), folder / "a", times)
        other = Times(times.told, json.loads(process.stdout.readline()))
        bare = _bare(endpoint, count)
        bus.close()
        process.stdin.close()
    return other.taken_after(times.told), bare


def answer(endpoint: str, folder: str, count: int, latched: bool) -> None:
    """Be the robot that waits, in a process of its own; tell each time at which it went on."""
    made, times = exchange(count, latched=latched), Times()
    bus = _bus(made, "b", Path(folder), Endpoints(listen=(endpoint,)))
    bare = bus.node._carrier._session.declare_queryable(
        "bench/bare", lambda query: query.reply("bench/bare", b"x" * 64)
    )
    carry_on(made, ["b"], bus, RealClock(), Path(folder), times)
    print(json.dumps(times.taken), flush=True)
    sys.stdin.read()
    bare.undeclare()
    bus.close()


class Times:
    """When one robot told the other, about to write that down, and when that one went on, and had written it.

    Attributes:
        told, taken: seconds of the monotonic clock, one after the other.
    """

    def __init__(self, told: Sequence[float] = (), taken: Sequence[float] = ()) -> None:
        self.told, self.taken = list(told), list(taken)

    def __call__(self, record: StepRecord, write: Callable[[StepRecord], None]) -> None:
        """Write a step, and keep when."""
        if record.robot == "a" and record.slot.startswith("+"):
            self.told.append(time.monotonic())
        write(record)
        if record.robot == "b" and record.label == "take" and record.move.startswith("m"):
            self.taken.append(time.monotonic())

    def taken_after(self, told: Sequence[float]) -> list[float]:
        """Return how long each took, seconds."""
        return [taken - told for told, taken in zip(told, self.taken, strict=True)]


def exchange(count: int, *, latched: bool = False) -> Program:
    """Return a robot that notifies another so often, each time once that one has told it that it went on."""

    def tell(owner: str, number: int) -> object:
        return notify(f"{owner}.{slot(number)}")

    def slot(number: int) -> str:
        return f"go{number}" if latched else "go"

    def reset(owner: str, number: int) -> tuple[object, ...]:
        return () if latched or number == 0 else (notify(f"{owner}.go", active=False),)

    numbers = range(count)
    waits = {f"m{number}": [slot(number)] for number in numbers}
    a = [hold(f"m{n}", 0.002, before=reset("a", n), after=(tell("b", n),)) for n in numbers]
    b = [hold(f"m{n}", 0.0, before=(*reset("b", n), *((tell("a", n - 1),) if n else ()))) for n in numbers]
    last = hold("last", 0.0, before=(*reset("b", count), tell("a", count - 1)))
    return program(robot("a", a, waits=waits), robot("b", [*b, last], waits=waits))


def carry_on(
    made: Program,
    mine: Sequence[str],
    slots: Slots,
    clock: RealClock,
    folder: Path,
    observe: Callable[[StepRecord, Callable[[StepRecord], None]], None] = lambda record, write: write(record),
) -> None:
    """Run simulated robots of a behaviour to their ends, and write their logs."""
    kinds = {
        "robot_kinds": {PLAIN_ROBOT.metaclass: PLAIN_ROBOT},
        "move_kinds": {kind.metaclass: kind for kind in MOVE_KINDS},
    }
    vehicles = {
        each.id: SIMULATION.connect(
            VehicleInput(made, each, robot_type(), environment={}, options={}, **kinds)
        )
        for each in made.robots
        if each.id in mine
    }
    with LogWriter(folder) as log:
        terms = Terms(
            "run-0",
            observe=lambda record: observe(record, log.write),
            sync=log.sync,
            attention=Attention(clock),
        )
        carry_out(made.executable, vehicles, slots=slots, clock=clock, conditions={}, terms=terms)


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


def _bus(made: Program, own: str, folder: Path, endpoints: Endpoints) -> ProgramBus:
    carrier = ZenohCarrier("bench", "run-0", ("a", "b"), endpoints)
    return shared_bus(made.executable, [own], "run-0", folder, carrier)


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
    with tempfile.TemporaryDirectory() as folder:
        bus, changed = _bus(exchange(1), "b", Path(folder), Endpoints((endpoint,))), threading.Event()
        bus.on_change(changed.set)
        with _started({"do": "sit", "endpoint": endpoint, "folder": str(Path(folder) / "a")}) as process:
            while bus.node.missing(["a"]):
                time.sleep(0.01)
            time.sleep(0.3)
            begun = time.monotonic()
            process.send_signal(number)
            while not bus.lost(["a"]):
                changed.wait(1.0)
                changed.clear()
            taken = time.monotonic() - begun
            process.kill()
        bus.close()
    return taken


def sit(endpoint: str, folder: str) -> None:
    """Be a robot that is there, until the process is killed."""
    _bus(exchange(1), "a", Path(folder), Endpoints(connect=(endpoint,)))
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
    carry_on(made, mine, bus, RealClock(SPEEDUP), own)
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
