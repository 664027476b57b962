"""Measures the control loop of an underwater vehicle in real time, each part a process, joined by our hub.

A simulated vehicle goes to and fro in a current. How late each tick of each process comes; the time from
one command of a thruster to the next as it is heard on the bus, which is what the loop does after all; how
long after a measurement of pressure the next command is heard; and what each process needs of a core.
Beside it stands how late a bare process is that sleeps for the same period, for that is the computer's part.

    python benchmarks/auv_loop.py > benchmarks/results/auv_loop.txt
"""

from __future__ import annotations

import argparse
import os
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from datetime import date
from itertools import pairwise
from pathlib import Path

from sample_vessels import pool_sheet

from auv_vessel.api import Connection
from auv_vessel.body import surroundings
from auv_vessel.sheet import to_json
from auv_vessel.wire.catalogue import COMMAND_BASE, COMMAND_PERIOD
from auv_vessel.wire.ports import Port, open_port

PARTS = ("sensors", "actuators", "movement", "vehicle")
PRESSURE = 0x200
BARE = """import sys, time
for _ in range(int(sys.argv[1])):
    time.sleep(float(sys.argv[2]))
    print(time.monotonic())
"""


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=60.0)
    given = parser.parse_args()
    print(f"the loop of an underwater vehicle, {date.today()}, {os.cpu_count()} cores, "
          f"load {os.getloadavg()[0]:.1f}, {given.seconds:g} s\n")  # fmt: skip
    with tempfile.TemporaryDirectory() as folder:
        measure(Path(folder), given.seconds)


def measure(folder: Path, seconds: float) -> None:
    """Run the vehicle, and print what was measured."""
    sheet = pool_sheet()
    (folder / "sheet.json").write_text(to_json(sheet), encoding="utf-8")
    around = surroundings.Surroundings(current=(0.15, -0.1), bottom=20.0)
    (folder / "around.json").write_text(surroundings.to_json(around), encoding="utf-8")
    hub = subprocess.Popen([sys.executable, "-m", "mmrs_core", "can", "hub", "--port", "0"],
                           stdout=subprocess.PIPE, stdin=subprocess.PIPE, text=True)  # fmt: skip
    assert hub.stdout is not None
    channel = f"can0@{hub.stdout.readline().split(';')[0].removeprefix('hub at ').strip()}"
    processes = [part_process(part, folder, channel) for part in PARTS]
    count = str(int(seconds / COMMAND_PERIOD))
    words = [sys.executable, "-c", BARE, count, str(COMMAND_PERIOD)]
    bare = subprocess.Popen(words, stdout=subprocess.PIPE, text=True)
    try:
        with open_port("socketcand", channel) as listener, open_port("socketcand", channel) as own:
            connection = Connection(sheet, own)
            heard = drive(connection, listener, seconds)
            connection.close()
    finally:
        for process in processes:
            process.send_signal(signal.SIGTERM)
        for process in processes:
            process.wait(20.0)
        hub.terminate()
        hub.wait(20.0)
    bare_times = [float(line) for line in bare.communicate(timeout=60.0)[0].split()]
    report(folder, heard, bare_times, seconds)


def part_process(part: str, folder: Path, channel: str) -> subprocess.Popen[str]:
    """Start a part of the vehicle."""
    words = [sys.executable, "-m", "auv_vessel", part, "--sheet", str(folder / "sheet.json"),
             "--channel", channel, "--figures", str(folder / part)]  # fmt: skip
    if part == "vehicle":
        words += ["--surroundings", str(folder / "around.json")]
    return subprocess.Popen(words, text=True)


def drive(connection: Connection, listener: Port, seconds: float) -> list[tuple[float, int]]:
    """Send the vehicle to and fro; return when frames of pressure and of the first thruster were heard."""
    craft, heard = connection.craft, list[tuple[float, int]]()
    begin = time.monotonic()
    while not craft.state().trusted and time.monotonic() - begin < 30.0:
        listener.receive(0.1)
    legs, begin = 0, time.monotonic()
    while time.monotonic() - begin < seconds:
        if legs == 0 or craft.state().progress in ("REACHED", "FAILED"):
            legs += 1
            craft.go_to(4.0 * (legs % 2), 0.0, 2.0)
        frame = listener.receive(0.05)
        if frame is not None and frame.id in (PRESSURE, COMMAND_BASE):
            heard.append((time.monotonic(), frame.id))
    state = craft.state()
    print(f"goals begun {legs}, at last {state.north:.2f} m north, {state.depth:.2f} m deep, "
          f"emergency {state.emergency or 'none'}\n")  # fmt: skip
    return heard


def report(folder: Path, heard: Sequence[tuple[float, int]], bare: Sequence[float], seconds: float) -> None:
    """Print the table of what was measured."""
    print(f"{'milliseconds':34}{'p50':>8}{'p99':>8}{'most':>8}")
    for part in PARTS:
        late = [float(line) for line in (folder / part).read_text(encoding="utf-8").split()[1:]]
        row(f"{part}: tick late by", late)
    commands = [when for when, number in heard if number == COMMAND_BASE]
    periods = [later - earlier for earlier, later in pairwise(commands)]
    row("command to command, of 50", periods)
    row("  off its period by", [abs(each - COMMAND_PERIOD) for each in periods])
    answers, pressure = list[float](), 0.0
    for when, number in heard:
        if number == PRESSURE:
            pressure = when
        elif pressure:
            answers.append(when - pressure)
    row("pressure to next command", answers)
    row("a bare sleep of 50 off by", [abs(b - a - COMMAND_PERIOD) for a, b in pairwise(bare)])
    print(f"\n{'part of a core':34}")
    for part in PARTS:
        used = float((folder / part).read_text(encoding="utf-8").split()[0])
        print(f"{part:34}{used / seconds:8.3f}")
    total = sum(float((folder / part).read_text(encoding="utf-8").split()[0]) for part in PARTS)
    print(f"{'all four':34}{total / seconds:8.3f}")


def row(name: str, values: Sequence[float]) -> None:
    """Print a line of the table, from seconds."""
    ordered = sorted(values) or [float("nan")]
    at = [ordered[min(len(ordered) - 1, int(part * len(ordered)))] for part in (0.5, 0.99, 1.0)]
    print(f"{name:34}" + "".join(f"{1000.0 * each:8.2f}" for each in at))


if __name__ == "__main__":
    main()
