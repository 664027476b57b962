"""Measures how models are read and written, against EMF, stock pyecore and bare lxml, all in one run.

Behaviour models of several sizes are made with a seed. "cold" is a whole process that starts, reads,
writes and exits; "warm" is one reading or one writing in a process that has done the same before. Wall
time depends on what else the machine does, CPU time less so: ratios are of CPU times, medians of several
runs. EMF's CPU time is that of its working thread when it is warm, without the compiler and the collector
that run beside it ("all" is with them), and of the whole process when it is cold.

    python benchmarks/models.py --seed 1 > benchmarks/results/models.txt
"""

from __future__ import annotations

import argparse
import os
import platform
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable
from dataclasses import dataclass, field
from datetime import date
from importlib.metadata import version
from pathlib import Path
from statistics import median
from time import perf_counter

from model_samples import write_sample

HERE = Path(__file__).resolve().parent
ECORES = [HERE.parent / "metamodels" / f"{name}.ecore" for name in ("robot", "behaviour")]
JARS = [Path("/usr/share/java") / f"eclipse-emf-{name}.jar" for name in ("common", "ecore", "ecore-xmi")]
PYECORE_LIMIT = 100_000
"""pyecore takes minutes and gigabytes beyond."""
SIZES = "1000,10000,100000,1000000"


@dataclass
class Figures:
    """Seconds and bytes of one library at one size; what was not measured is missing.

    Attributes:
        wall, cpu, all: by what was done: "cold", "read" and "write".
        memory: bytes of the model.
    """

    wall: dict[str, float] = field(default_factory=dict)
    cpu: dict[str, float] = field(default_factory=dict)
    all: dict[str, float] = field(default_factory=dict)
    memory: float | None = None


def main() -> None:
    """Measure every size, and print a table and whether the goals hold."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--sizes", default=SIZES, help=f"numbers of elements (default: {SIZES})")
    parser.add_argument("--runs", type=int, default=5, help="of which the medians are taken")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        commands = subjects(Path(folder))
        print_versions(options.seed, commands)
        table = {}
        for size in map(int, options.sizes.split(",")):
            model = Path(folder) / f"{size}.xmi"
            elements = write_sample(model, size, options.seed)
            print(f"\n{elements} elements, {model.stat().st_size / 1e6:.1f} MB", flush=True)
            table[size] = measured(commands, model, size, options.runs)
            print_table(table[size], elements)
        print_goals(table)


def subjects(folder: Path) -> dict[str, Callable[[int, Path, Path], list[str]]]:
    """Return how each library that is here is called, by its name; say which are not."""
    script = str(HERE / "model_subjects.py")

    def python(name: str) -> Callable[[int, Path, Path], list[str]]:
        return lambda runs, model, out: [
            *(sys.executable, script, name, str(runs), str(model), str(out)),
            *map(str, ECORES),
        ]

    found = {"ours": python("ours")}
    java, javac = shutil.which("java"), shutil.which("javac")
    if java is None or javac is None or not all(jar.is_file() for jar in JARS):
        print("EMF is missing (Debian: libeclipse-emf-ecore-xmi-java and a JDK)", file=sys.stderr)
    else:
        path = os.pathsep.join(map(str, [folder, *JARS]))
        subprocess.run([javac, "-cp", path, "-d", folder, HERE / "EmfModels.java"], check=True)
        found["EMF"] = lambda runs, model, out: [
            *(java, "-cp", path, "EmfModels", str(runs), str(model), str(out)),
            *map(str, ECORES),
        ]
    return found | {"pyecore": python("pyecore"), "lxml": python("lxml"), "our JSON": our_json}


def our_json(runs: int, model: Path, out: Path) -> list[str]:
    """Return how we are called to read and write the same model as JSON, which is made for the first call."""
    command = [sys.executable, str(HERE / "model_subjects.py"), "ours"]
    source = model.with_suffix(".json")
    if not source.exists():
        subprocess.run([*command, "1", model, source], stdout=subprocess.DEVNULL, check=True)
    return [*command, str(runs), str(source), str(out.with_suffix(".out.json"))]


def measured(
    commands: dict[str, Callable[[int, Path, Path], list[str]]], model: Path, size: int, runs: int
) -> dict[str, Figures]:
    """Return the figures of all libraries for a model."""
    out = model.with_suffix(".out")
    figures = {name: Figures() for name in commands}
    for name, command in commands.items():
        if name == "pyecore" and size > PYECORE_LIMIT:
            continue
        cold = [
            whole_process(command(1, model, out)) for _ in range(min(runs, 2) if size > 100_000 else runs)
        ]
        figures[name].wall["cold"], figures[name].cpu["cold"] = map(median, zip(*cold, strict=True))
        warm(figures[name], command(warm_runs(name, size, runs), model, out))
    return figures


def warm_runs(name: str, size: int, runs: int) -> int:
    """Return how often a process reads and writes: a virtual machine needs many runs to be at its best."""
    if name == "pyecore":
        return 2 if size >= PYECORE_LIMIT else runs
    if size > 100_000:
        return min(2 * runs, 4)
    return max(4 * runs, 200_000 // size) if name == "EMF" else 2 * runs


def whole_process(command: list[str]) -> tuple[float, float]:
    """Run a process; return its seconds of wall and CPU time."""
    begun = perf_counter()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise SystemExit(f"{' '.join(command)}: failed")
    return perf_counter() - begun, usage.ru_utime + usage.ru_stime


def warm(figures: Figures, command: list[str]) -> None:
    """Run a process that works again and again; keep the medians of the later half."""
    text = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    rows: dict[str, list[list[float]]] = {}
    for line in text.splitlines():
        what, *numbers = line.split()
        rows.setdefault(what, []).append([float(number) for number in numbers])
    figures.memory = rows.pop("memory", [[0.0]])[0][0] or None
    for what, times in rows.items():
        later = times[len(times) // 2 :]
        columns = [median(column) for column in zip(*later, strict=True)]
        figures.wall[what], figures.cpu[what], figures.all[what] = columns[0], columns[1], columns[-1]


def print_versions(seed: int, commands: dict[str, Callable[[int, Path, Path], list[str]]]) -> None:
    """Print what is compared, and on what."""
    packages = ", ".join(f"{name} {version(name)}" for name in ("mmrs-core", "pyecore", "lxml"))
    print(f"reading and writing models, {date.today().isoformat()}, seed {seed}")
    print(f"Python {platform.python_version()}, {packages}")
    if "EMF" in commands:
        jars = ", ".join(jar.resolve().stem.removeprefix("eclipse-emf-") for jar in JARS)
        told = subprocess.run(["java", "-version"], capture_output=True, text=True, check=True).stderr
        print(f"EMF {jars}; {told.splitlines()[0]}")
    load = ", ".join(f"{number:.1f}" for number in os.getloadavg())
    print(f"{os.cpu_count()} cores, load {load}")


def print_table(figures: dict[str, Figures], elements: int) -> None:
    """Print the figures of one size; times in milliseconds, wall / CPU."""
    print(f"{'':10}{'cold':>18}{'warm read':>18}{'all':>8}{'warm write':>18}{'all':>8}{'bytes/element':>15}")
    for name, row in figures.items():
        if not row.cpu:
            print(f"{name:10}  not measured: it takes minutes")
            continue
        cells = [
            f"{row.wall[what] * 1e3:.0f} / {row.cpu[what] * 1e3:.0f}" for what in ("cold", "read", "write")
        ]
        beside = [f"{row.all[what] * 1e3:.0f}" for what in ("read", "write")]
        memory = f"{row.memory / elements:.0f}" if row.memory and elements > 5_000 else ""  # else it is noise
        print(
            f"{name:10}{cells[0]:>18}{cells[1]:>18}{beside[0]:>8}{cells[2]:>18}{beside[1]:>8}{memory:>15}",
            flush=True,
        )


def print_goals(table: dict[int, dict[str, Figures]]) -> None:
    """Print whether each goal holds that the measured sizes allow to judge."""
    print("\ngoals")
    for size, row in table.items():
        ours = row["ours"]
        if "EMF" in row:
            most = 1.0 if size <= 100_000 else 1.5
            goal(f"cold process, {size}", ours.cpu["cold"] / row["EMF"].cpu["cold"], "EMF", most)
        if size == 100_000:
            if "EMF" in row:
                goal("warm read", ours.cpu["read"] / row["EMF"].cpu["read"], "EMF", 1.5)
                goal("warm read", ours.cpu["read"] / row["EMF"].all["read"], "EMF with all its threads", 1.5)
            goal("warm read", ours.cpu["read"] / row["pyecore"].cpu["read"], "pyecore", 1 / 12)
            goal("warm write", ours.cpu["write"] / row["pyecore"].cpu["write"], "pyecore", 1 / 15)
        if size >= 100_000 and ours.memory:
            per_element = ours.memory / size
            holds = "holds" if per_element <= 512 else "MISSED"
            print(f"  {holds:7} memory, {size}: {per_element:.0f} bytes an element <= 512")


def goal(what: str, ratio: float, peer: str, most: float) -> None:
    """Print a ratio, and whether it is small enough; where it has to be tiny, how many times faster it is."""
    holds = "holds" if ratio <= most else "MISSED"
    if most < 0.5:
        print(f"  {holds:7} {what}: {1 / ratio:.1f} times faster than {peer} >= {1 / most:.0f}")
    else:
        print(f"  {holds:7} {what}: {ratio:.2f} times {peer} <= {most:g}")


if __name__ == "__main__":
    main()
