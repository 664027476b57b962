"""Measures the strokes over seeded fields against what no strokes can do without.

Strokes of width w over an area A are A/w metres long at least, and actions that cover w by l metres
come A/(w·l) times at least, both only if nothing is ever covered twice and no hop is needed.

The directions of edges are ranked by sums along the sorted edges; beside that, by a matrix of all directions
and all edges, and by strips that are laid at each of 180 directions and counted.

    python benchmarks/covering.py --seed 1 > benchmarks/results/covering.txt
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from datetime import date
from functools import partial
from itertools import pairwise
from math import dist, inf, pi
from time import process_time

import numpy as np
import shapely

from mmrs_core.planning.coverage import Sweep, work_over
from mmrs_core.planning.swaths import _across, _Reach, _sweep
from mmrs_core.scene import Area, AreaUse, Capability, Frame, Part, Ring, Robot, RobotType, Scene, Work

TYPE = RobotType("drone", (), (), 0.5, None, (Capability(0.0, None, (0.0, 10.0)),), (), {}, Part((), {}))
ROBOT = Robot("drone", TYPE, (0.0, 0.0, 0.0), True, 0.0, "NORMAL", 1.0)
ALTITUDE = 20.0


@dataclass(frozen=True, slots=True)
class Field:
    """A polygon to be covered, and the obstacles in it."""

    name: str
    shell: Ring
    width: float
    obstacles: tuple[Ring, ...] = ()


@dataclass(frozen=True, slots=True)
class Ratios:
    """What a work takes over what it cannot take less than, and the seconds to find it."""

    length: float
    actions: float
    seconds: float


def main() -> None:
    """Print a line for each field, and the means."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--seed", type=int, default=1)
    seed = parser.parse_args().seed
    print(f"coverage strokes, {date.today().isoformat()}, seed {seed}")
    print(
        "swept: metres of strokes and hops / (area / width); photos: the same, and photos / (area / cell)\n"
    )
    print(f"{'field':32}{'cells':>7}{'swept':>8}{'s':>7}{'photos: way':>13}{'count':>8}{'s':>7}")
    rows = []
    for field in fields(seed):
        swept, photos = ratios(field, 0.0), ratios(field, field.width)
        cells = shapely.Polygon(field.shell).area / field.width**2
        print(
            f"{field.name:32}{cells:7.0f}{swept.length:8.3f}{swept.seconds:7.2f}"
            f"{photos.length:13.3f}{photos.actions:8.3f}{photos.seconds:7.2f}"
        )
        rows.append((swept.length, swept.seconds, photos.length, photos.actions, photos.seconds))
    means = np.mean(rows, axis=0)
    print(f"{'mean':39}{means[0]:8.3f}{means[1]:7.2f}{means[2]:13.3f}{means[3]:8.3f}{means[4]:7.2f}")
    directions(seed)


def directions(seed: int) -> None:
    """Print what it takes to rank the directions of stars' edges, and what brute force takes."""
    rng = np.random.default_rng(seed)
    print(
        f"\n{'directions of edges: ms':32}{'sums':>8}{'matrix':>10}{'/ sums':>8}{'strips':>10}{'/ sums':>8}"
    )
    for corners in (10, 100, 1000, 10_000):
        field = shapely.Polygon(_star(rng, corners, 600.0, 0.6))
        edges = np.diff(shapely.get_coordinates(field.exterior), axis=0)
        angles = np.arctan2(edges[:, 1], edges[:, 0]) % pi
        assert np.allclose(_across(angles, edges), _by_matrix(angles, edges))
        sums = _least_ms(partial(_across, angles, edges))
        matrix = _least_ms(partial(_by_matrix, angles, edges))
        row = f"{sums:8.3f}{matrix:10.3f}{matrix / sums:8.1f}"
        if corners <= 100:
            strips = _least_ms(partial(_by_strips, field))
            row += f"{strips:10.0f}{strips / sums:8.0f}"
        print(f"{f'{corners} corners':32}{row}", flush=True)


def _by_matrix(angles: np.ndarray, edges: np.ndarray) -> np.ndarray:
    return np.abs(np.stack([-np.sin(angles), np.cos(angles)], axis=1) @ edges.T).sum(axis=1)


def _by_strips(field: shapely.Polygon) -> list[int]:
    reach = _Reach(20.0, 0.0, shapely.Polygon())
    return [len(_sweep([field], reach, each * pi / 180.0)) for each in range(180)]


def _least_ms(done: Callable[[], object]) -> float:
    """Return the milliseconds of CPU that something takes at least, of three tries."""
    found = []
    for _ in range(3):
        times, begun = 0, process_time()
        while process_time() - begun < 0.1:
            done()
            times += 1
        found.append(1e3 * (process_time() - begun) / times)
    return min(found)


def fields(seed: int) -> Iterator[Field]:
    """Yield smooth, ragged, many-cornered and obstructed fields."""
    rng = np.random.default_rng(seed)
    for radius in (30.0, 60.0, 150.0):
        yield Field(f"disc of {radius:g} m", _round(rng, 64, radius, 0.0), 12.0)
    for noise in (2.0, 5.0, 15.0):
        yield Field(f"disc of 150 m, +-{noise:g} m", _round(rng, 1000, 150.0, noise), 12.0)
    for gap in (6.0, 30.0):
        yield Field(f"comb, gaps of {gap:g} m", _comb(8, 6.0, gap, 72.0), 12.0)
    for corners in (3, 4, 6, 8, 10):
        yield Field(f"{corners} corners, small", _star(rng, corners, 150.0), 12.0)
    for corners in (4, 6, 8, 10, 100, 1000):
        yield Field(f"{corners} corners, large", _star(rng, corners, 700.0), 20.0)
    yield Field("rectangle, 1 by 1 km", _rectangle(1000.0, 1000.0, 0.0), 20.0)
    yield Field("rectangle, 2 by 0.5 km, turned", _rectangle(2000.0, 500.0, 0.7), 20.0)
    yield Field("convex, 10 corners, 1 km²", _convex(rng, 10), 20.0)
    yield Field("convex, 5 round obstacles", _convex(rng, 10), 20.0, _rounds(rng, 5))
    yield Field("wavy, 1000 corners, 1.1 km²", _wavy(rng, 1000), 20.0)
    yield Field("wavy, 20 round obstacles", _wavy(rng, 1000), 20.0, _rounds(rng, 20))
    for count in (5, 20):
        boxes = tuple(_box(rng, 400.0) for _ in range(count))
        yield Field(f"10 corners, {count} obstacles", _star(rng, 10, 700.0, 0.7), 20.0, boxes)


def ratios(field: Field, length: float) -> Ratios:
    """Measure the strokes over a field; a `length` asks for actions."""
    areas = tuple(Area("box", AreaUse.OBSTACLE, ring, -inf, inf, 2.0) for ring in field.obstacles)
    scene = Scene("field", Frame("wgs84", 42.0, 13.0), (), (), (ROBOT,), areas=areas)
    started = process_time()
    work = work_over(
        scene,
        ROBOT,
        field.shell,
        Sweep(
            altitude=ALTITUDE,
            width=field.width,
            rule="cover",
            length=length,
            action="TakePicture" if length else None,
        ),
    )
    seconds = process_time() - started
    least = _covered(work) / field.width
    photos = sum(len(stroke.actions) for stroke in work.strokes)
    return Ratios(_way(work) / least, photos * length / least, seconds)


def _covered(work: Work) -> float:
    return sum(shapely.Polygon(*piece).area for piece in work.coverage.target) if work.coverage else 0.0


def _way(work: Work) -> float:
    places = [point for stroke in work.strokes for point in stroke.points]
    return sum(dist(one, two) for one, two in pairwise(places))


def _round(rng: np.random.Generator, corners: int, radius: float, noise: float) -> Ring:
    angles = np.linspace(0.0, 2 * pi, corners, endpoint=False)
    return _ring(angles, radius + rng.uniform(-noise, noise, corners))


def _star(rng: np.random.Generator, corners: int, radius: float, smallest: float = 0.4) -> Ring:
    """Return a ring about the origin with corners at random angles and distances."""
    angles = 2 * pi * (np.arange(corners) + rng.uniform(-0.3, 0.3, corners)) / corners
    return _ring(angles, rng.uniform(smallest * radius, radius, corners))


def _ring(angles: np.ndarray, radii: np.ndarray) -> Ring:
    return tuple(zip((radii * np.cos(angles)).tolist(), (radii * np.sin(angles)).tolist(), strict=True))


def _rectangle(along: float, across: float, angle: float) -> Ring:
    turned = np.array([[0.0, 0.0], [along, 0.0], [along, across], [0.0, across]])
    c, s = np.cos(angle), np.sin(angle)
    return tuple(map(tuple, (turned @ np.array([[c, s], [-s, c]])).tolist()))


def _convex(rng: np.random.Generator, corners: int) -> Ring:
    return _ring(np.sort(rng.uniform(0.0, 2 * pi, corners)), np.full(corners, 620.0))


def _wavy(rng: np.random.Generator, corners: int) -> Ring:
    """Return a ring whose radius swings by some waves, and by up to 3 m from corner to corner."""
    angles = np.linspace(0.0, 2 * pi, corners, endpoint=False)
    waves = sum(rng.uniform(-0.12, 0.12) * np.cos(k * angles + rng.uniform(0.0, 6.0)) for k in range(2, 7))
    return _ring(angles, 600.0 * (1.0 + waves) + rng.uniform(-3.0, 3.0, corners))


def _rounds(rng: np.random.Generator, count: int) -> tuple[Ring, ...]:
    """Return round obstacles of 15 to 60 m about the middle, 30 m apart at least."""
    found: list[shapely.Polygon] = []
    while len(found) < count:
        other = shapely.Point(rng.uniform(-350.0, 350.0, 2)).buffer(rng.uniform(15.0, 60.0), quad_segs=3)
        if all(other.distance(each) > 30.0 for each in found):
            found.append(other)
    return tuple(tuple(map(tuple, shapely.get_coordinates(each)[:-1].tolist())) for each in found)


def _comb(teeth: int, tooth: float, gap: float, depth: float) -> Ring:
    """Return a comb with a back 12 m high."""
    edge = [(0.0, 0.0), (teeth * (tooth + gap) - gap, 0.0)]
    for i in reversed(range(teeth)):
        left = i * (tooth + gap)
        edge += [(left + tooth, depth), (left, depth)]
        edge += [(left, 12.0), (left - gap, 12.0)] if i else []
    return tuple(edge)


def _box(rng: np.random.Generator, reach: float) -> Ring:
    (x, y), (a, b) = rng.uniform(-reach, reach, 2).tolist(), rng.uniform(8.0, 40.0, 2).tolist()
    return ((x - a, y - b), (x + a, y - b), (x + a, y + b), (x - a, y + b))


if __name__ == "__main__":
    main()
