"""Measures how evenly robots share one area: seconds that the last one takes over the mean, and patches.

Drones of one type photograph areas of about a square kilometre in a grid of 20 m, from homes 12 m apart, and
begin at the corner that is nearest to these. Each mission is planned and checked from files to file; one
that is not safe ends the run. A share is one patch where the strips about its strokes touch.

    python benchmarks/shares.py --seed 1 > benchmarks/results/shares.txt
"""

from __future__ import annotations

import argparse
import json
import re
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from datetime import date
from pathlib import Path

import numpy as np
import shapely
from whole_plans import model, point

TYPE = Path(__file__).parents[1] / "examples" / "barn" / "robots" / "yard-drone.xmi"
ROBOTS = (2, 5, 10)
PLACES = ((250.0, 250.0), (700.0, 300.0), (500.0, 600.0), (250.0, 750.0), (780.0, 760.0))
"""Middles of holes."""
GRID, ALTITUDE = 20.0, 40.0
MMRS = (sys.executable, "-m", "mmrs_core")
TOUCHING = 0.3
"""Metres by which the strip about a stroke is wider than half the grid."""


def main() -> None:
    """Print a line for each area and number of robots."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--seed", type=int, default=1)
    seed = parser.parse_args().seed
    print(f"shares of one area, {date.today().isoformat()}, seed {seed}")
    print("bound: mission time / least possible; even: the longest time of a robot / the mean of all;")
    print("parted: robots whose share is more than one patch, and the smaller patches' part of it\n")
    print(f"{'area':24}{'km²':>6}{'robots':>8}{'mission s':>11}{'bound':>8}{'even':>8}{'parted':>14}")
    for name, outline in areas(seed):
        for robots in ROBOTS:
            with tempfile.TemporaryDirectory() as folder:
                write(Path(folder), robots, outline)
                plan = json.loads(mmrs("plan", folder, "--stop-after", "plan"))["value"]
                mmrs("plan", folder, "--force", "--json")
                mmrs("check", folder)
            busy = np.array([each["busy"] for each in plan["robots"]])
            parted = [part for each in plan["robots"] if (part := apart(each["steps"])) > 0.0]
            shown = f"{len(parted)} ({max(parted):.1%})" if parted else "0"
            figures = f"{plan['makespan']:11.1f}{plan['makespan'] / plan['lower_bound']:8.3f}"
            even = busy.max() / busy.mean()
            print(f"{name:24}{outline.area / 1e6:6.2f}{robots:8}{figures}{even:8.4f}{shown:>14}", flush=True)


def mmrs(*arguments: str) -> str:
    """Return what a command prints.

    Raises:
        SystemExit: if it fails.
    """
    done = subprocess.run([*MMRS, *arguments], capture_output=True, text=True)
    if done.returncode:
        raise SystemExit(f"mmrs {arguments[0]}: {done.stderr}")
    return done.stdout


def apart(steps: list[dict]) -> float:
    """Return the part of a share that is not in its largest patch."""
    strokes = [np.array(each["stroke"]["points"])[:, :2] for each in steps if each.get("stroke")]
    strips = [
        (shapely.LineString(each) if len(each) > 1 else shapely.Point(each[0])).buffer(GRID / 2.0 + TOUCHING)
        for each in strokes
    ]
    patches = [each.area for each in shapely.get_parts(shapely.union_all(strips))]
    return 1.0 - max(patches) / sum(patches) if patches else 0.0


def areas(seed: int) -> Iterator[tuple[str, shapely.Polygon]]:
    """Yield plain, bent, holed and rough areas."""
    rng = np.random.default_rng(seed)
    yield "square", shapely.box(0.0, 0.0, 1000.0, 1000.0)
    yield "strip", shapely.box(0.0, 0.0, 2500.0, 400.0)
    yield "L", shapely.box(0.0, 0.0, 1300.0, 1300.0) - shapely.box(500.0, 500.0, 1300.0, 1300.0)
    yield "U", shapely.box(0.0, 0.0, 1300.0, 1200.0) - shapely.box(400.0, 300.0, 900.0, 1200.0)
    holes = [shapely.Point(*place).buffer(rng.uniform(40.0, 90.0), quad_segs=2) for place in PLACES]
    yield "square, 5 holes", shapely.box(0.0, 0.0, 1000.0, 1000.0) - shapely.union_all(holes)
    for corners, least in ((9, 0.5), (100, 0.8)):
        angles = 2.0 * np.pi * np.arange(corners) / corners
        radii = rng.uniform(least, 1.0, corners) * 700.0
        ring = np.stack([500.0 + radii * np.cos(angles), 700.0 + radii * np.sin(angles)], axis=1)
        yield f"star, {corners} corners", shapely.Polygon(ring)


def write(folder: Path, robots: int, area: shapely.Polygon) -> None:
    (folder / "robots").mkdir()
    kind = re.sub(
        r'(lifetime|capacity)="([\d.]+)"', lambda m: f'{m[1]}="{20.0 * float(m[2])}"', TYPE.read_text()
    )
    (folder / "robots" / TYPE.name).write_text(kind)
    homes = [np.array((12.0 * k, -40.0)) for k in range(robots)]
    team = [
        f'<robots name="r{k}" type="Yard drone">{point("home", each)}</robots>'
        for k, each in enumerate(homes)
    ]
    shell = shapely.get_coordinates(area.exterior)[:-1]
    holes = [shapely.get_coordinates(each)[:-1] for each in area.interiors]
    rings = [f"<holes>{''.join(point('points', each) for each in ring)}</holes>" for ring in holes]
    nearest = min(shell, key=lambda each: float(np.hypot(*(each - homes[0]))))
    first, outer = point("initialPosition", nearest), "".join(point("shell", each) for each in shell)
    head = (
        f'<tasks xsi:type="survey:PhotoGridTask" name="grid" altitude="{ALTITUDE}" gridResolution="{GRID}">'
    )
    task = f"{head}{first}{outer}{''.join(rings)}</tasks>"
    (folder / "mission.xmi").write_text(model("mission:Mission", ["<team>", *team, "</team>", task]))
    (folder / "context.xmi").write_text(model("context:Context", []))


if __name__ == "__main__":
    main()
