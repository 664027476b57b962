"""Measures `mmrs plan` from files to file: start-up, reading, planning, check and writing included.

Quadcopters of one type pass places at 30 m. Three of them do so among obstacles on a square of two
kilometres, once with heights of 10 to 60 m and once without; a thousand do so on a free square of twelve
kilometres. Twenty and five set out from homes 10 m apart to places on a square kilometre, once with 5 m to
keep between any two of them, and once without. Places are seeded. Each case is planned twice on one core:
numba (extra `fast`) compiles in the first call if its cache is empty, so that the second one counts.

    python benchmarks/whole_plans.py > benchmarks/results/whole_plans.txt
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import subprocess
import sys
import tempfile
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from datetime import date
from pathlib import Path
from time import perf_counter

import numpy as np
from paths import outline

TYPE = Path(__file__).parents[1] / "examples" / "carbon-dioxide" / "robots" / "quad-650.xmi"
HEIGHT = 30.0
CLEAR = 25.0
"""Metres that homes and places are from the middles of obstacles, whose corners are within 20 m of these."""


@dataclass(frozen=True, slots=True)
class Case:
    """What is planned; `side` and `apart` in metres.

    `apart` is what robots keep between each other: then homes are beside each other, and not seeded.
    """

    robots: int
    tasks: int
    obstacles: int
    side: float
    heights: bool = False
    apart: float | None = None


CASES = {
    "heights": Case(3, 10, 1000, 2000.0, heights=True),
    "no-heights": Case(3, 10, 1000, 2000.0),
    "thousand": Case(1000, 10_000, 0, 12_000.0),
    "twenty": Case(20, 100, 0, 1000.0, apart=0.0),
    "twenty-apart": Case(20, 100, 0, 1000.0, apart=5.0),
    "five": Case(5, 25, 0, 1000.0, apart=0.0),
    "five-apart": Case(5, 25, 0, 1000.0, apart=5.0),
}


def main() -> None:
    """Print a table, or write the projects."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--seed", type=int, default=7)
    parser.add_argument("--cases", nargs="+", choices=CASES, default=list(CASES))
    parser.add_argument("--write", type=Path, help="folder for the projects; nothing is planned")
    given = parser.parse_args()
    if given.write:
        for name in given.cases:
            write(given.write / name, CASES[name], given.seed)
        return
    print(f"whole plans, {date.today().isoformat()}, seed {given.seed}, {platform.machine()}, one core")
    print(
        "`mmrs plan`: seconds of CPU of the first and the second call, seconds and gigabytes of the second,"
        "\nand the seconds of the mission\n"
    )
    print(
        f"{'case':<12}{'robots':>7}{'tasks':>7}{'obstacles':>10}{'first':>8}{'second':>8}{'wall':>7}{'GB':>6}"
        f"{'mission':>9}"
    )
    for name in given.cases:
        case = CASES[name]
        with tempfile.TemporaryDirectory() as folder:
            write(Path(folder), case, given.seed)
            (first, _, _, _), (second, wall, memory, mission) = planned(folder), planned(folder)
        figures = f"{first:8.1f}{second:8.1f}{wall:7.1f}{memory:6.2f}{mission:9.1f}"
        print(f"{name:<12}{case.robots:7}{case.tasks:7}{case.obstacles:10}{figures}", flush=True)


def planned(folder: str) -> tuple[float, float, float, float]:
    """Return the seconds of CPU and of wall, and the gigabytes, that planning a project takes on one core.

    And the seconds of the mission.
    """
    begun = perf_counter()
    command = [sys.executable, "-m", "mmrs_core", "plan", folder, "--force", "--json"]
    compiled = {name: each for name, each in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    with tempfile.TemporaryFile() as printed:
        made = subprocess.Popen(command, stdout=printed, env=compiled)
        os.sched_setaffinity(made.pid, {min(os.sched_getaffinity(0))})
        _, status, spent = os.wait4(made.pid, 0)
        printed.seek(0)
        text = printed.read()
    if status:
        raise SystemExit(f"mmrs plan: exit {os.waitstatus_to_exitcode(status)}")
    wall = perf_counter() - begun
    return spent.ru_utime + spent.ru_stime, wall, spent.ru_maxrss / 2**20, json.loads(text)["makespan"]


def write(folder: Path, case: Case, seed: int) -> None:
    rng = np.random.default_rng((seed, case.robots, case.tasks, case.obstacles))
    (folder / "robots").mkdir(parents=True, exist_ok=True)
    kind = TYPE.read_text().replace('communicationRange="2000.0"', 'communicationRange="20000.0"')
    (folder / "robots" / TYPE.name).write_text(kind)
    middles = rng.uniform(0.0, case.side, (case.obstacles, 2))
    clear = places_clear_of(middles, case.side, rng)
    beside = ((10.0 * (i % 5), 10.0 * (i // 5)) for i in range(case.robots))
    homes = clear if case.apart is None else beside
    robots = [
        f'<robots name="r{i}" type="Quad 650">{point("home", next(homes))}</robots>'
        for i in range(case.robots)
    ]
    tasks = [
        f'<tasks xsi:type="survey:GoToTask" name="t{i}">{point("point", next(clear), HEIGHT)}</tasks>'
        for i in range(case.tasks)
    ]
    (folder / "mission.xmi").write_text(
        model("mission:Mission", ["<team>", *robots, "</team>", *tasks], case.apart)
    )
    obstacles = []
    for i, middle in enumerate(middles):
        top = f' maxHeight="{rng.uniform(10.0, 60.0):.1f}"' if case.heights else ""
        shell = "".join(point("shell", place) for place in outline(rng) + middle)
        obstacles.append(f'<obstacles name="o{i}" safetyDistance="2.0"{top}>{shell}</obstacles>')
    (folder / "context.xmi").write_text(model("context:Context", obstacles))


def places_clear_of(middles: np.ndarray, side: float, rng: np.random.Generator) -> Iterator[np.ndarray]:
    while True:
        place = rng.uniform(0.0, side, 2)
        if not len(middles) or np.linalg.norm(middles - place, axis=1).min() > CLEAR:
            yield place


def model(root: str, parts: Iterable[str], apart: float | None = None) -> str:
    namespaces = " ".join(f'xmlns:{name}="urn:mmrs:{name}:1.0"' for name in ("mission", "context", "survey"))
    xsi = 'xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"'
    xmi = 'xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI"'
    more = f' minimumSeparation="{apart}"' if apart else ""
    return "\n".join([f'<{root} {xmi} {xsi} {namespaces} name="seeded"{more}>', *parts, f"</{root}>"])


def point(name: str, place: Sequence[float], height: float | None = None) -> str:
    z = "" if height is None else f' z="{height}"'
    return f'<{name} xsi:type="mission:RelativeCoordinate" x="{place[0]:.2f}" y="{place[1]:.2f}"{z}/>'


if __name__ == "__main__":
    main()
