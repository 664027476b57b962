"""Measures what it costs to simulate many robots: CPU seconds and memory, beside SimPy and a bare loop.

Each robot makes moves of 0.5 to 4.5 s on a half-second grid, so that many end at once: it goes somewhere,
then holds. After each tenth one it notifies the next robot, and waits for a slot that the one before it
sets, 600 s at most. Logs are written to a folder. SimPy (a process a robot) and a bare loop (a generator a
robot, one heap) go through the same timeouts, events and deadlines, without logs, energy or places; the last
row only writes as many lines to as many logs. Every figure is that of a process of its own.

    pip install simpy==4.1.2
    python benchmarks/engine.py --seed 1 > benchmarks/results/engine.txt
"""

from __future__ import annotations

import argparse
import json
import os
import random
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Generator, Iterator
from datetime import date
from heapq import heappop, heappush
from pathlib import Path
from resource import RUSAGE_SELF, getrusage

from mmrs_core.behaviour.program import Move, RobotProgram
from mmrs_core.contributions.targets import TargetInput
from mmrs_core.scene import Policy
from mmrs_core.simulation.run import simulate
from mmrs_core.simulation.simulation import SIMULATION
from mmrs_core.testing.small_programs import ROBOT_TYPE, go, hold, notify, program, robot, robot_type
from mmrs_core.transformation.kinds import MOVE_KINDS, PLAIN_ROBOT
from mmrs_runtime.engine.terms import Terms
from mmrs_runtime.records.log import LogWriter
from mmrs_runtime.records.steps import StepRecord

SIZES = ((10, 100), (100, 100), (100, 1000), (1000, 100))
GOAL = (1000, 100, 10.0)
"""Robots, moves, and the CPU seconds in which they are to be simulated, logs included."""

EACH, PATIENCE, SPEED = 10, 600.0, 3.0
LONGEST = 120.0
"""Seconds after which a measurement is broken off."""

Durations = list[list[float]]
Cost = list[float] | str
"""CPU seconds and MiB; or in words why they are not known."""


def main() -> None:
    """Print the table, or measure one thing in this process."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--seed", type=int, default=1, help="of the moves")
    parser.add_argument("--part", default="", help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.part:
        measure(*json.loads(given.part))
        return
    load = os.getloadavg()[0]
    print(f"the engine, {date.today()}, seed {given.seed}, {os.cpu_count()} cores, load {load:.1f}")
    print(f"{calibration():.2f} s of CPU for ten million turns of an empty loop\n")
    print(f"{'robots x moves':<16}{'':<28}{'CPU s':>9}{'us a move':>11}{'MiB':>8}{'/ SimPy':>9}{'/ bare':>8}")
    for robots, moves in SIZES:
        found = {name: part(name, robots, moves, given.seed) for name in PARTS}
        for name in PARTS:
            print(f"{f'{robots} x {moves}':<16}{PARTS[name][0]:<28}{figures(name, found, robots * moves)}")
        if (robots, moves) == GOAL[:2]:
            tell_goal(found["engine"])


def figures(name: str, found: dict[str, Cost], moves: int) -> str:
    """Return what one thing costs, beside its peers; or why nobody knows."""
    cost = found[name]
    if isinstance(cost, str):
        return f"   {cost}"
    peers = (found["simpy"], found["bare"])
    ratios = ["" if isinstance(peer, str) else f"{cost[0] / peer[0]:.1f}" for peer in peers]
    return f"{cost[0]:>9.3f}{1e6 * cost[0] / moves:>11.1f}{cost[1]:>8.1f}{ratios[0]:>9}{ratios[1]:>8}"


def tell_goal(cost: Cost) -> None:
    """Print whether the goal is met."""
    robots, moves, seconds = GOAL
    took = cost if isinstance(cost, str) else f"{cost[0]:.1f} s"
    met = not isinstance(cost, str) and cost[0] < seconds
    goal = f"{robots} robots x {moves} moves under {seconds:g} s of CPU, logs included"
    print(f"\n{goal}: {'met' if met else 'missed'} ({took})")


def calibration() -> float:
    """Return the CPU seconds that an empty loop takes on this machine."""
    begun = time.process_time()
    for _ in range(10_000_000):
        pass
    return time.process_time() - begun


def part(name: str, robots: int, moves: int, seed: int) -> Cost:
    """Return CPU seconds and MiB that one thing takes in a process of its own; or in words why not."""
    call = [sys.executable, __file__, "--part", json.dumps([name, robots, moves, seed])]
    try:
        done = subprocess.run(call, capture_output=True, text=True, timeout=LONGEST)
    except subprocess.TimeoutExpired:
        return f"not done within {LONGEST:g} s"
    if done.returncode:
        return done.stderr.strip().splitlines()[-1]
    found: list[float] = json.loads(done.stdout)
    return found


def measure(name: str, robots: int, moves: int, seed: int) -> None:
    """Print CPU seconds and MiB that one thing takes, without what it is prepared from."""
    drawn = random.Random(seed)
    durations = [[drawn.randint(1, 9) / 2.0 for _ in range(moves)] for _ in range(robots)]
    with tempfile.TemporaryDirectory() as folder:
        run = PARTS[name][1](durations, Path(folder))
        before, begun = getrusage(RUSAGE_SELF).ru_maxrss, time.process_time()
        ended = run()
        seconds, after = time.process_time() - begun, getrusage(RUSAGE_SELF).ru_maxrss
    if ended != "success":
        sys.exit(f"ended with {ended}")
    print(json.dumps([seconds, (after - before) / 1024]))


def engine(durations: Durations, folder: Path) -> Callable[[], str]:
    """Return what simulates a behaviour and writes its logs."""

    def moves_of(number: int) -> Iterator[Move]:
        following, east = f"r{(number + 1) % len(durations)}", 0.0
        for index, seconds in enumerate(durations[number]):
            after = (notify(f"{following}.{slot_of(index)}"),) if index % EACH == EACH - 1 else ()
            east += SPEED * seconds if index % 4 else -SPEED * seconds
            if index % 2:
                yield hold(f"m{index}", seconds, after=after)
                continue
            yield go(f"m{index}", (east, 0.0, 0.0), speed=SPEED, after=after)

    def robot_of(number: int) -> RobotProgram:
        waits = {f"m{index}": [slot_of(index)] for index in waiting(len(durations[number]))}
        policy = (Policy("WAIT_TOO_LONG", "HOLD", PATIENCE),)
        return robot(f"r{number}", list(moves_of(number)), waits=waits, policies=policy)

    fleet = program(*map(robot_of, range(len(durations))))

    def run() -> str:
        with LogWriter(folder, synced=False) as log:
            types = {ROBOT_TYPE: robot_type(lifetime=1e6)}
            kinds = {kind.metaclass: kind for kind in MOVE_KINDS}
            given = TargetInput(fleet, types, {PLAIN_ROBOT.metaclass: PLAIN_ROBOT}, kinds)
            terms = Terms(observe=log.write, steps=sys.maxsize)
            return simulate(given, SIMULATION, terms=terms).ending.outcome.value

    return run


def slot_of(index: int) -> str:
    """Return the slot that is waited for after a move."""
    return f"s{index // EACH}"


def waiting(moves: int) -> range:
    """Return the moves that are followed by a notify and a wait."""
    return range(EACH - 1, moves, EACH)


def with_simpy(durations: Durations, folder: Path) -> Callable[[], str]:
    """Return what goes through the same timeouts and events with SimPy."""
    try:
        import simpy
    except ImportError:
        sys.exit("not measured: pip install simpy==4.1.2")
    env, count = simpy.Environment(), len(durations)
    slots = [{index: env.event() for index in waiting(len(each))} for each in durations]
    late: list[int] = []

    def life(number: int) -> Generator[simpy.Event, object, None]:
        for index, seconds in enumerate(durations[number]):
            yield env.timeout(seconds)
            if index in slots[number]:
                slots[(number + 1) % count][index].succeed()
                slot = slots[number][index]
                yield slot | env.timeout(PATIENCE)
                if not slot.triggered:
                    late.append(number)

    def run() -> str:
        lives = [env.process(life(number)) for number in range(count)]
        env.run(until=simpy.AllOf(env, lives))
        return "late" if late else "success"

    return run


def bare(durations: Durations, folder: Path) -> Callable[[], str]:
    """Return what goes through the same timeouts and events with nothing but generators and a heap."""
    count = len(durations)
    active: list[set[int]] = [set() for _ in durations]
    wakes: list[tuple[float, int, int]] = []
    tickets = [0] * count
    late: list[int] = []
    now = 0.0

    def wake(number: int, time: float) -> None:
        tickets[number] += 1
        heappush(wakes, (time, number, tickets[number]))

    def life(number: int) -> Generator[float, None, None]:
        following = (number + 1) % count
        for index, seconds in enumerate(durations[number]):
            yield now + seconds
            if index % EACH == EACH - 1:
                active[following].add(index)
                if awaited[following] == index:
                    wake(following, now)
                deadline = now + PATIENCE
                while index not in active[number] and now < deadline:
                    awaited[number] = index
                    yield deadline
                awaited[number] = -1
                if index not in active[number]:
                    late.append(number)

    awaited = [-1] * count

    def run() -> str:
        nonlocal now
        lives = [life(number) for number in range(count)]
        for number, each in enumerate(lives):
            wake(number, next(each))
        while wakes:
            now, number, ticket = heappop(wakes)
            if ticket == tickets[number]:
                until = next(lives[number], None)
                if until is not None:
                    wake(number, until)
        return "late" if late else "success"

    return run


def lines(durations: Durations, folder: Path) -> Callable[[], str]:
    """Return what writes as many lines to as many logs as the run has steps."""

    def steps(number: int) -> Iterator[StepRecord]:
        made = 0
        for index, seconds in enumerate(durations[number]):
            for label in ("begin", "end", *(("ntf",) if index % EACH == EACH - 1 else ()), "take"):
                slot = f"+r{number}.{slot_of(index)}" if label == "ntf" else ""
                yield StepRecord("run-0", f"r{number}", made, made, seconds, label, f"m{index}", "", slot)
                made += 1

    def run() -> str:
        with LogWriter(folder, synced=False) as log:
            for number in range(len(durations)):
                for record in steps(number):
                    log.write(record)
        return "success"

    return run


PARTS = {
    "engine": ("this engine, with logs", engine),
    "simpy": ("SimPy, nothing else", with_simpy),
    "bare": ("bare loop, nothing else", bare),
    "lines": ("only as many lines to logs", lines),
}


if __name__ == "__main__":
    main()
