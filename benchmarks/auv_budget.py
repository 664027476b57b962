"""Measures what whole underwater vehicles need of a computer, each part a process, in real time.

One vehicle dives the course `examples/pool-course` by what it sees: hub, four processes of the vehicle,
three of its eyes at 5 Hz, which draw the pictures themselves, and `mmrs run`. Then two vehicles dive
`examples/two-auv-survey`: without eyes, and with eyes at 2 Hz. Counted is what each process used of a core,
by the system's own count, from when the first robot begins until the run ends; starting Python is left out.

    python benchmarks/auv_budget.py > benchmarks/results/auv_budget.txt
"""

from __future__ import annotations

import argparse
import os
import shutil
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from datetime import date
from pathlib import Path

from mmrs_auv.commands.modelled import sheets_in
from mmrs_auv.rehearsal import VehicleProcesses

from auv_vessel.body.surroundings import BUOY, Surroundings, Thing, from_json, to_json

ROOT = Path(__file__).resolve().parents[1]
MMRS = (sys.executable, "-m", "mmrs_core")
TICK = os.sysconf("SC_CLK_TCK")
EYES = ("frames", "front", "bottom")
LONGEST = 1200.0
BUDGET = 1.5
"""Cores that one vehicle with eyes may need."""


@dataclass(frozen=True)
class Setting:
    """What is dived. Attributes: the example; eyes at so many hertz, 0: none; what is around."""

    name: str
    example: str
    rate: float
    around: Surroundings


def main() -> None:
    """Print a table for each setting."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", default="", help="those settings whose name contains this")
    parser.add_argument("--seconds", type=float, default=LONGEST, help="after which a dive is broken off")
    given = parser.parse_args()
    print(f"whole underwater vehicles, {date.today()}, {os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}")
    for setting in settings():
        if given.only in setting.name:
            with tempfile.TemporaryDirectory() as folder:
                measure(setting, Path(folder), given.seconds)


def settings() -> tuple[Setting, ...]:
    """Return what is dived."""
    course = from_json((ROOT / "examples/pool-course/surroundings.json").read_text(encoding="utf-8"))
    buoys = tuple(
        Thing(BUOY, f"buoy {n}", 14.0, 6.0 * n - 9.0, 4.0, colour="red", size=0.4) for n in range(4)
    )
    bay = Surroundings(current=(0.05, 0.05), bottom=12.0, things=buoys)
    return (
        Setting("one vehicle, eyes at 5 Hz", "pool-course", 5.0, course),
        Setting("two vehicles, no eyes", "two-auv-survey", 0.0, bay),
        Setting("two vehicles, eyes at 2 Hz", "two-auv-survey", 2.0, bay),
    )


def measure(setting: Setting, folder: Path, seconds: float) -> None:
    """Dive, and print what each process needed."""
    project = folder / "project"
    shutil.copytree(ROOT / "examples" / setting.example, project)
    subprocess.run((*MMRS, "plan", str(project)), check=True, stdout=subprocess.DEVNULL)
    with ExitStack() as stack:
        ids: dict[str, int] = {}
        words = [
            *MMRS,
            "run",
            str(project / "behaviour.xmi"),
            "--backend",
            "can",
            "--log",
            str(folder / "logs"),
        ]
        words += ["--backend-option", "clock=bus"]
        for number, (robot, sheet) in enumerate(sheets_in(project).items()):
            berth = stack.enter_context(
                VehicleProcesses(sheet, folder / robot, surroundings=setting.around, seed=number)
            )
            ids |= {f"{robot}: {part}": id for part, id in berth.ids.items()}
            words += ["--connect", f"{robot}={berth.channel}"]
            if setting.rate:
                port = free_port()
                ids |= stack.enter_context(eyes(robot, folder, berth.channel, port, setting))
                words += ["--backend-option", f"{robot}:detections={port}"]
        said = folder / "said.txt"
        run = subprocess.Popen(words, stdout=stack.enter_context(said.open("w")), stderr=subprocess.STDOUT)
        stack.callback(ended, run)
        until_it_moves(run, said)
        ids["mmrs run"] = run.pid
        used, elapsed = usage(ids, run, seconds)
        code = run.poll()
    report(setting, used, elapsed, code, said.read_text(encoding="utf-8"))


@contextmanager
def eyes(robot: str, folder: Path, channel: str, port: int, setting: Setting) -> Iterator[Mapping[str, int]]:
    """Run the three processes of a vehicle's eyes."""
    file = folder / f"{robot}.json"
    file.write_text(to_json(setting.around), encoding="utf-8")
    words = [sys.executable, "-m", "auv_vision"]
    given = ["--sheet", str(folder / robot / "sheet.json"), "--surroundings", str(file)]
    given += ["--memory", f"budget-{os.getpid()}-{robot}", "--channel", channel]
    given += ["--rate", str(setting.rate), "--to", f"127.0.0.1:{port}"]
    started = {part: subprocess.Popen([*words, part, *given]) for part in EYES}
    try:
        yield {f"{robot}: eyes, {part}": process.pid for part, process in started.items()}
    finally:
        for process in started.values():
            ended(process)


def until_it_moves(run: subprocess.Popen[bytes], said: Path) -> None:
    """Wait until a robot begins, or the run has ended."""
    begin = time.monotonic()
    while "'start" not in said.read_text(encoding="utf-8") and time.monotonic() - begin < 60.0:
        if run.poll() is not None:
            return
        time.sleep(0.2)


def usage(
    ids: Mapping[str, int], run: subprocess.Popen[bytes], seconds: float
) -> tuple[Mapping[str, float], float]:
    """Return processor seconds of each process while the run goes on, and how long that was."""
    begin, elapsed = time.monotonic(), 0.0
    before = {name: processor_seconds(id) for name, id in ids.items()}
    latest = before
    while run.poll() is None and time.monotonic() - begin < seconds:
        time.sleep(0.5)
        now = {name: processor_seconds(id) for name, id in ids.items()}
        elapsed = time.monotonic() - begin
        latest = {name: max(now[name], latest[name]) for name in ids}
    return {name: latest[name] - before[name] for name in ids}, elapsed


def processor_seconds(id: int) -> float:
    """Return what a process has used by now; 0 once it has ended."""
    try:
        fields = Path(f"/proc/{id}/stat").read_text(encoding="utf-8").rpartition(")")[2].split()
    except OSError:
        return 0.0
    return (int(fields[11]) + int(fields[12])) / TICK


def report(setting: Setting, used: Mapping[str, float], elapsed: float, code: int | None, said: str) -> None:
    """Print the table."""
    ending = "completed" if code == 0 else f"broken off after {elapsed:.0f} s" if code is None else said
    print(f"\n{setting.name}: {setting.example}, {elapsed:.0f} s, {ending}\n")
    for name, seconds in used.items():
        print(f"  {name:28}{seconds / elapsed:8.3f}")
    total = sum(used.values()) / elapsed
    print(f"  {'together, of a core':28}{total:8.3f}")
    if setting.rate:
        kept = "kept" if total <= BUDGET * vehicles(used) else "exceeded"
        print(f"  budget of {BUDGET:g} cores for each vehicle: {kept}")


def vehicles(names: Sequence[str] | Mapping[str, float]) -> int:
    """Return of how many vehicles these processes are."""
    return len({name.partition(":")[0] for name in names if ":" in name})


def free_port() -> int:
    """Return a UDP port that nobody uses now."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        port: int = probe.getsockname()[1]
        return port


def ended(process: subprocess.Popen[bytes]) -> None:
    """End a process, if it has not ended."""
    if process.poll() is None:
        process.terminate()
    try:
        process.wait(30.0)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()


if __name__ == "__main__":
    main()
