"""Measures shortest paths among seeded obstacles: seconds of CPU to build and to ask, beside two peers.

Obstacles, convex and not, stand so densely that, grown by the clearance, they add up to a quarter of a
square; they touch and overlap. Robots cross it from side to side. extremitypathfinder gets the grown
outlines and finds the same paths; pyastar2d gets them drawn into a grid of 4096 by 4096 cells and finds
paths along eight directions. The peers run in an interpreter of their own, with packages that the project
does not need. Everything is warm: what numba compiles (extra `fast`) is compiled before.

    python -m venv peers
    peers/bin/pip install extremitypathfinder==2.7.2 pyastar2d==1.1.4 pillow scipy shapely
    python benchmarks/paths.py --seed 1 --peers peers/bin/python > benchmarks/results/paths.txt
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from dataclasses import dataclass
from datetime import date
from itertools import pairwise
from math import dist, inf, sqrt
from pathlib import Path
from statistics import mean, median
from time import process_time

import numpy as np
import shapely

COUNTS = (10, 40, 1000, 10_000)
CLEARANCE, SAFETY = 1.0, 2.0
DENSITY = 0.25
CELLS = 4096
LONGEST = 400.0
"""Seconds after which a peer is broken off."""


@dataclass(frozen=True, slots=True)
class Cost:
    """Seconds of CPU to build and for each query, and the metres of each path found."""

    build: float
    queries: tuple[float, ...]
    metres: tuple[float, ...]

    @property
    def whole(self) -> float:
        return self.build + sum(self.queries)


def main() -> None:
    """Print a table, or be a peer in an interpreter that has one."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--seed", type=int, default=1, help="of the obstacles")
    parser.add_argument("--counts", type=int, nargs="+", default=COUNTS, help="of obstacles")
    parser.add_argument("--queries", type=int, default=20, help="paths for each number of obstacles")
    parser.add_argument("--peers", type=Path, help="Python interpreter with the peers")
    parser.add_argument("--peer", choices=PEERS, help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.peer:
        print(json.dumps(measured(*PEERS[given.peer], json.load(sys.stdin))))
        return
    print(f"shortest paths, {date.today().isoformat()}, seed {given.seed}, {given.queries} queries each")
    print("ms of CPU; length: mean of metres / those of mmrs; / mmrs: whole time by that of mmrs\n")
    heads = "".join(f"{each:>9}" for each in ("build", "median", "largest", "whole"))
    print(f"{'obstacles':<10}{'':<22}{heads}{'length':>8}{'/ mmrs':>8}")
    for count in given.counts:
        scene = drawn(count, given.queries, given.seed)
        ours = Cost(*measured(build_space, ask_space, scene))
        print(f"{count:<10}{'mmrs':<22}{figures(ours)}")
        for name in PEERS:
            found = peer(name, scene, given.peers)
            told = f"   {found}" if isinstance(found, str) else figures(found) + ratios(found, ours)
            print(f"{count:<10}{name:<22}{told}", flush=True)


def figures(cost: Cost) -> str:
    times = (cost.build, median(cost.queries), max(cost.queries), cost.whole)
    return "".join(f"{1e3 * each:9.1f}" for each in times)


def ratios(cost: Cost, ours: Cost) -> str:
    longer = [one / two for one, two in zip(cost.metres, ours.metres, strict=True) if one > 0.0]
    queries = median(cost.queries) / median(ours.queries)
    length = f"{mean(longer):8.4f}" if longer else f"{'none':>8}"
    return f"{length}{cost.whole / ours.whole:8.1f}   a query: {queries:.1f}"


def drawn(count: int, queries: int, seed: int) -> dict:
    """Return obstacles as drawn, the same grown, and where queries begin and end, as JSON."""
    rng = np.random.default_rng((seed, count))
    shapes = [outline(rng) for _ in range(count)]
    grown = shapely.buffer([shapely.Polygon(ring) for ring in shapes], CLEARANCE + SAFETY)
    side = sqrt(shapely.area(grown).sum() / DENSITY)
    rings = [(ring + rng.uniform(0.0, side, 2)) for ring in shapes]
    outlines = grown_outlines(rings)
    whole = shapely.union_all(outlines)
    shapely.prepare(whole)
    ends = []
    while len(ends) < 2 * queries:
        left = len(ends) % 2 == 0
        place = np.array([rng.uniform(0.0, 0.05) if left else rng.uniform(0.95, 1.0), rng.uniform(0.0, 1.0)])
        if not shapely.intersects_xy(whole, *(side * place)):
            ends.append((side * place).tolist())
    return {
        "side": side,
        "rings": [ring.tolist() for ring in rings],
        "grown": [list(each.exterior.coords) for each in outlines],
        "pairs": [(ends[i], ends[i + 1]) for i in range(0, len(ends), 2)],
    }


def outline(rng: np.random.Generator) -> np.ndarray:
    """Return the corners of an obstacle about the origin: a star or its hull."""
    corners = int(rng.integers(4, 9))
    turns = 2 * np.pi * (np.arange(corners) + rng.uniform(-0.3, 0.3, corners)) / corners
    ring = rng.uniform(6.0, 20.0, (corners, 1)) * np.c_[np.cos(turns), np.sin(turns)]
    if rng.random() < 0.5:
        ring = shapely.get_coordinates(shapely.MultiPoint(ring).convex_hull)[:-1]
    return ring


def grown_outlines(rings: list[np.ndarray]) -> list[shapely.Polygon]:
    from mmrs_core.geometry.clearance import grow

    return [grow(ring.tolist(), CLEARANCE + SAFETY) for ring in rings]


def measured(build, ask, scene: dict) -> tuple[float, list[float], list[float]]:
    """Return the seconds of building and of each query, and the metres of each path."""
    warm = len(scene["rings"]) // 10 or 1
    ask(
        build(scene | {name: scene[name][:warm] for name in ("rings", "grown")}),
        *map(tuple, scene["pairs"][0]),
    )
    begun = process_time()
    built = build(scene)
    took = process_time() - begun
    seconds, metres = [], []
    for start, goal in scene["pairs"]:
        begun = process_time()
        path = ask(built, tuple(start), tuple(goal))
        seconds.append(process_time() - begun)
        metres.append(sum(dist(one[:2], two[:2]) for one, two in pairwise(path)))
    return took, seconds, metres


def peer(name: str, scene: dict, interpreter: Path | None) -> Cost | str:
    """Return what a peer takes; or in words why that is not known."""
    if interpreter is None:
        return "skipped: no --peers given"
    if name == "extremitypathfinder" and len(scene["rings"]) > 40:
        return "skipped: quadratic in corners, minutes from 100 obstacles on"
    call = [interpreter, __file__, "--peer", name]
    try:
        done = subprocess.run(call, input=json.dumps(scene), capture_output=True, text=True, timeout=LONGEST)
    except subprocess.TimeoutExpired:
        return f"not done within {LONGEST:g} s"
    if done.returncode:
        return f"skipped: {done.stderr.strip().splitlines()[-1]}"
    return Cost(*json.loads(done.stdout.splitlines()[-1]))


def build_space(scene: dict):
    from mmrs_core.planning.paths import Space
    from mmrs_core.scene import Area, AreaUse

    rings = ([tuple(place) for place in ring] for ring in scene["rings"])
    return Space(
        [Area(f"{i}", AreaUse.OBSTACLE, tuple(ring), -inf, inf, SAFETY) for i, ring in enumerate(rings)],
        CLEARANCE,
    )


def ask_space(space, start, goal):
    return space.route((*start, 10.0), (*goal, 10.0))


def build_extremity(scene: dict):
    from extremitypathfinder import PolygonEnvironment

    shapes = shapely.union_all([shapely.Polygon(ring) for ring in scene["grown"]])
    outer = [shapely.get_coordinates(each.exterior)[:-1] for each in shapely.get_parts(shapes)]
    clockwise = [ring if _twice_area(ring) < 0.0 else ring[::-1] for ring in outer]
    low, high = -100.0, scene["side"] + 100.0
    boundary = [(low, low), (high, low), (high, high), (low, high)]
    environment = PolygonEnvironment()
    environment.store(boundary, [ring.tolist() for ring in clockwise], validate=False)
    environment.prepare()
    return environment


def _twice_area(ring: np.ndarray) -> float:
    after = np.roll(ring, -1, axis=0)
    return float((ring[:, 0] * after[:, 1] - ring[:, 1] * after[:, 0]).sum())


def ask_extremity(environment, start, goal):
    return environment.find_shortest_path(start, goal)[0]


def build_grid(scene: dict):
    from PIL import Image, ImageDraw

    cell = (scene["side"] + 100.0) / CELLS
    image = Image.new("L", (CELLS, CELLS), 1)
    draw = ImageDraw.Draw(image)
    for ring in scene["grown"]:
        draw.polygon([((x + 50.0) / cell, (y + 50.0) / cell) for x, y in ring], fill=0)
    weights = np.where(np.asarray(image) > 0, np.float32(1.0), np.float32(np.inf))
    return weights, cell


def ask_grid(built, start, goal):
    import pyastar2d

    weights, cell = built
    ends = [(round((y + 50.0) / cell), round((x + 50.0) / cell)) for x, y in (start, goal)]
    path = pyastar2d.astar_path(weights, *ends, allow_diagonal=True)
    return [] if path is None else (path * cell).tolist()


PEERS = {
    "extremitypathfinder": (build_extremity, ask_extremity),
    "pyastar2d 4096 x 4096": (build_grid, ask_grid),
}

if __name__ == "__main__":
    main()
