"""Measures how robots are kept apart: moving pieces against shapely's STRtree, and a whole plan.

The peer builds an STRtree of (east, time) rectangles, filters by the other coordinates, and computes the
closest approach of the pairs that are left; both must find the same pairs. Seconds are of CPU, the least of
five runs of each in turn; what numba compiles is compiled before. `check` is the search of the independent
check, which shares no code with the planner's: compiled loops find boxes that overlap where there are as many
pieces as in the last line, an STRtree of slices of time where there are fewer.

    python benchmarks/separation.py --seed 1 > benchmarks/results/separation.txt
"""

from __future__ import annotations

import argparse
import sys
from datetime import date
from pathlib import Path
from time import process_time

import numpy as np
import shapely

# This folder's coverage.py must not stand for the package of that name, which numba looks for.
sys.path.pop(0)
sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "support"))

from plain_scenes import robot, scene, visit

from mmrs_core.analysis.nearness import Legs, near_pairs
from mmrs_core.planning import sweep
from mmrs_core.planning.planner import plan
from mmrs_core.planning.proximity import Pieces, Proximity

APART = 10.0


def main() -> None:
    """Print a line for each fleet, then the plans."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--seed", type=int, default=1)
    seed = parser.parse_args().seed
    print(f"separation, {date.today().isoformat()}, seed {seed}, {APART:g} m apart")
    print(
        f"{'robots':>7}{'pieces':>8}{'meetings':>9}{'STRtree s':>11}{'numpy':>18}{'numba':>18}{'check':>18}"
    )
    for robots, side in ((10, 1000.0), (100, 2000.0), (1000, 5000.0)):
        pieces = fleet(np.random.default_rng(seed), robots, 100, side)
        ours, theirs, seconds = None, None, np.full(3, np.inf)
        for _ in range(6):
            for row, many in enumerate((None, 10**9, 0)):
                sweep._MANY = many
                begun = process_time()
                found = peer(pieces) if many is None else mine(pieces)
                seconds[row] = min(seconds[row], process_time() - begun)
                ours, theirs = (ours, found) if many is None else (found, theirs)
                assert ours is None or theirs is None or np.array_equal(ours, theirs)
        ratios = "".join(f"{each:9.4f} ({seconds[0] / each:5.1f}x)" for each in seconds[1:])
        known, checked = legs(pieces), np.inf
        for _ in range(6):
            begun = process_time()
            near = near_pairs(known, APART)
            checked = min(checked, process_time() - begun)
        assert np.array_equal(ours, near[:, 0] * len(pieces) + near[:, 1])
        ratios += f"{checked:9.4f} ({seconds[0] / checked:5.1f}x)"
        print(f"{robots:7}{len(pieces):8}{len(ours):9}{seconds[0]:11.4f}{ratios}")
    print("\n20 robots, 100 tasks within a square kilometre, one plan each")
    for apart in (None, 5.0):
        begun = process_time()
        made = plan(mission(np.random.default_rng(seed), apart))
        print(
            f"apart {apart or 0:g} m: {process_time() - begun:.2f} s of CPU, makespan {made.makespan:.1f} s"
        )


def fleet(rng: np.random.Generator, robots: int, legs: int, side: float) -> Pieces:
    """Return random walks of robots at 5 to 12 m/s, in a square and between 20 and 60 m high."""
    length, angle = rng.uniform(20.0, 200.0, (robots, legs)), rng.uniform(-np.pi, np.pi, (robots, legs))
    steps = [length * np.cos(angle), length * np.sin(angle), rng.uniform(-2.0, 2.0, (robots, legs))]
    first = rng.uniform((0.0, 0.0, 20.0), (side, side, 60.0), (robots, 1, 3))
    points = np.concatenate([first, np.stack(steps, axis=2)], axis=1).cumsum(axis=1)
    points[..., :2] = side - abs(points[..., :2] % (2 * side) - side)
    points[..., 2] = 60.0 - abs((points[..., 2] - 20.0) % 80.0 - 40.0)
    seconds = np.linalg.norm(np.diff(points, axis=1), axis=2) / rng.uniform(5.0, 12.0, (robots, legs))
    times = np.concatenate([np.zeros((robots, 1)), seconds.cumsum(axis=1)], axis=1)
    spans = np.stack([times[:, :-1].ravel(), times[:, 1:].ravel()], axis=1)
    places = np.stack([points[:, :-1].reshape(-1, 3), points[:, 1:].reshape(-1, 3)], axis=1)
    none = np.zeros(robots * legs, np.intp)
    owners = np.repeat(np.arange(robots), legs)
    return Pieces(owners, none, none, spans, places, spans[:, 1] - spans[:, 0], none * 0.0, none)


def legs(pieces: Pieces) -> Legs:
    """Return the same pieces as the check has them, in the order of time, each an occupation of its own."""
    order = np.argsort(pieces.times[:, 0], kind="stable")
    named = pieces.owners, pieces.places, pieces.times, pieces.least, pieces.radii
    return Legs(order, *(each[order] for each in named))


def mine(pieces: Pieces) -> np.ndarray:
    homes = [(1e6 * k, 0.0, 0.0) for k in range(int(pieces.owners.max()) + 1)]
    i, j = Proximity(pieces, homes, APART).meetings(0.0)
    return i * len(pieces) + j


def peer(pieces: Pieces) -> np.ndarray:
    times, begin, end = pieces.times, pieces.places[:, 0], pieces.places[:, 1]
    low, high = np.minimum(begin, end) - APART / 2, np.maximum(begin, end) + APART / 2
    boxes = shapely.box(low[:, 0], times[:, 0], high[:, 0], times[:, 1])
    i, j = shapely.STRtree(boxes).query(boxes)
    chosen = (i < j) & (pieces.owners[i] != pieces.owners[j])
    i, j = i[chosen], j[chosen]
    chosen = (low[i, 1:] < high[j, 1:]).all(axis=1) & (low[j, 1:] < high[i, 1:]).all(axis=1)
    i, j = i[chosen], j[chosen]
    speed = (end - begin) / (times[:, 1] - times[:, 0])[:, None]
    since, until = np.maximum(times[i, 0], times[j, 0]), np.minimum(times[i, 1], times[j, 1])
    gap = begin[i] + speed[i] * (since - times[i, 0])[:, None]
    gap -= begin[j] + speed[j] * (since - times[j, 0])[:, None]
    pace = speed[i] - speed[j]
    square = (pace**2).sum(axis=1)
    nearest = np.clip(-(gap * pace).sum(axis=1) / np.where(square > 0.0, square, 1.0), 0.0, until - since)
    near = np.linalg.norm(gap + nearest[:, None] * pace, axis=1) < APART
    return np.sort(i[near] * len(pieces) + j[near])


def mission(rng: np.random.Generator, apart: float | None):
    team = tuple(robot(f"r{k:02}", (10.0 * (k % 5), 10.0 * (k // 5), 0.0)) for k in range(20))
    places = rng.uniform(0.0, 1000.0, (100, 2)).tolist()
    works = {f"t{k:03}": visit((*place, 20.0)) for k, place in enumerate(places)}
    return scene(team, works, minimum_separation=apart)


if __name__ == "__main__":
    main()
