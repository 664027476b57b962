"""Measures tours of many robots whose longest one counts, beside PyVRP and OR-tools at equal CPU.

Stops and homes are seeded, in a square of 2 km; what counts is the longest tour, from home through stops and
back, straight at 1 m/s. Each gets the same seconds of CPU, counted from its model on, and one thread.
OR-tools begins with parallel cheapest insertion and goes on with guided local search, once with each of three
weights of the longest tour. PyVRP has no such aim: the allowed length of a tour is bisected, between the
longest one without it and a lower bound. Of both, the best tours count, measured again. With a folder of
MTSPLib's min-max cases (tsp/*.tsp, reference_literature.csv), tours are compared with the published upper
bounds, too. Tasks at one place that wait for each other, as in stages of forks and joins or by dependencies
at random, are planned whole and compared with CP-SAT's optimum, or the best that it found in a minute. The
peers run in an interpreter of their own, with packages that the project does not need.

    python -m venv peers
    peers/bin/pip install ortools==9.15.6755 pyvrp==0.14.1 numpy
    python benchmarks/allocation.py --peers peers/bin/python [--mtsplib DIR]
"""

from __future__ import annotations

import argparse
import csv
import json
import os
import platform
import subprocess
import sys
import warnings
from datetime import date
from math import dist, inf
from pathlib import Path
from random import Random
from time import process_time

import numpy as np

SIZES = ((3, 20, 2.0, 5), (20, 200, 10.0, 5), (100, 2000, 30.0, 3))
"""Robots, stops, seconds of CPU for each, and how many seeds."""

WAITING = ((3, 20, 3), (4, 50, 3), (8, 200, 3))
"""Robots, tasks, and how many seeds of each sort."""

sys.path.insert(0, str(Path(__file__).parent.parent / "tests" / "support"))

SIDE, SCALE = 2000.0, 100
SPANS = (1, 100, 10_000)


def main() -> None:
    """Print a table, or be a peer in an interpreter that has one."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--peers", type=Path, help="Python interpreter with the peers")
    parser.add_argument("--mtsplib", type=Path, help="folder of MTSPLib's min-max cases")
    parser.add_argument("--seconds", type=float, default=5.0, help="for each of these")
    parser.add_argument("--sizes", type=int, nargs="*", default=[0, 1, 2], help="which sizes")
    parser.add_argument("--peer", choices=SOLVERS, help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.peer:
        print(json.dumps(SOLVERS[given.peer](json.load(sys.stdin))))
        return
    machine = f"{platform.machine()}, {os.cpu_count()} cores, one thread each"
    print(f"allocation, {date.today().isoformat()}, seed {given.seed}, {machine}")
    mmrs({**places(3, 150, 0), "seconds": 0.1})  # what numba compiles is compiled now
    print("longest tour in metres, and by how much it is shorter than the better peer's; inf: none found;")
    print("bound: of `planning.forests` or `planning.few_places`\n")
    heads = (*(f"{each:>10}" for each in ("bound", "mmrs", *PEERS)), "   shorter by")
    print(f"{'robots':>6}{'stops':>7}{'seed':>5}{'CPU s':>7}", *heads, sep="")
    for m, n, seconds, seeds in (SIZES[k] for k in given.sizes):
        for seed in range(given.seed, given.seed + seeds):
            case = {**places(m, n, seed), "seconds": seconds}
            ours = longest(case, mmrs(case))
            theirs = [longest(case, peer(name, case, given.peers)) for name in PEERS] if given.peers else []
            row = "".join(f"{each:10.1f}" for each in (bound(case), ours, *theirs))
            gain = f"{100.0 * (1.0 - ours / min(theirs)):8.1f} %" if theirs else ""
            print(f"{m:6}{n:7}{seed:5}{seconds:7.0f}{row}   {gain}", flush=True)
    if given.peers:
        against_optimum(given.peers, given.seed)
    if given.mtsplib:
        against_bounds(given.mtsplib, given.seconds, given.seed)


def places(m: int, n: int, seed: int) -> dict:
    rng = np.random.default_rng((seed, m, n))
    return {
        "homes": rng.uniform(0.0, SIDE, (m, 2)).tolist(),
        "stops": rng.uniform(0.0, SIDE, (n, 2)).tolist(),
    }


def bound(case: dict) -> float:
    from mmrs_core.planning.few_places import longest_to_few
    from mmrs_core.planning.forests import least_longest

    homes, stops = np.array(case["homes"]), np.array(case["stops"])
    go, out = (np.linalg.norm(each[:, None] - stops, axis=2) for each in (stops, homes))
    return max(least_longest(go, out, True, 0.0), longest_to_few(go, out, True))


def longest(case: dict, tours: list[list[int]]) -> float:
    """Return the metres of the longest tour; inf if they do not visit each stop once."""
    if sorted(stop for tour in tours for stop in tour) != list(range(len(case["stops"]))):
        return inf
    ways = (
        [home, *(case["stops"][k] for k in tour), home]
        for home, tour in zip(case["homes"], tours, strict=True)
    )
    return max(sum(map(dist, way, way[1:])) for way in ways)


def mmrs(case: dict) -> list[list[int]]:
    from mmrs_core.planning.ruin import Search, stops_of

    begun = process_time()
    search = Search(field(case), 1)
    shares = iter(lambda: min(1.0, (process_time() - begun) / case["seconds"]), 1.0)
    for _ in search.run(shares):
        pass
    return [list(stops_of(search.best, robot)) for robot in range(len(case["homes"]))]


def field(case: dict):
    from mmrs_core.planning.allocation import _nearest, _nearest_robots
    from mmrs_core.planning.ruin_loops import Field

    homes, stops = np.array(case["homes"]), np.array(case["stops"])
    (m, n), zeros = (len(homes), len(stops)), np.zeros
    go = np.linalg.norm(stops[:, None] - stops, axis=2)
    out = np.linalg.norm(homes[:, None] - stops, axis=2)
    near, robots = _nearest(go[None]), _nearest_robots(out)
    return Field(
        sizes=np.array([n, m, near.shape[1], robots.shape[1], 0, 0]),
        kinds=zeros(m, np.int64),
        out=out.ravel(),
        go=go.astype(np.float32).ravel(),
        back=out.ravel(),
        work=zeros(n),
        near=near.ravel(),
        near_robots=robots.ravel(),
        apart=zeros(0, np.int64),
        limits=np.full(m, inf),
        recharges=zeros(m),
        earliest=zeros(n),
        deadlines=np.full(n, inf),
        ranks=zeros(n, np.int64),
    )


def against_optimum(python: Path, seed: int) -> None:
    print("\ntasks that wait for each other: makespan in seconds, and by how much it is above CP-SAT's")
    print(
        f"{'robots':>6}{'tasks':>7}  {'waits':<8}{'seed':>5}{'mmrs':>9}{'CPU s':>8}{'CP-SAT':>9}{'above':>9}"
    )
    for m, n, seeds in WAITING:
        for sort in ("stages", "random"):
            for each in range(seed, seed + seeds):
                case = waiting(m, n, each, sort)
                begun = process_time()
                ours = planned(case)
                spent = process_time() - begun
                best, proved = peer("CP-SAT", case, python)
                row = f"{m:6}{n:7}  {sort:<8}{each:5}{ours:9.0f}{spent:8.2f}{best:9.0f}"
                print(
                    f"{row}{100.0 * (ours / best - 1.0):7.2f} %{'' if proved else '  not proved'}", flush=True
                )


def waiting(m: int, n: int, seed: int, sort: str) -> dict:
    """Return seconds of tasks and who waits for whom: all for a whole stage, or for some a little before."""
    random = Random(f"{m} {n} {seed} {sort}")
    seconds, pairs, last, k = [random.randint(10, 200) for _ in range(n)], [], [], 0
    while k < n:
        stage = list(range(k, min(n, k + (random.randint(1, 3 * m) if sort == "stages" else 1))))
        near = range(max(0, k - 3 * m), k)
        before = last if sort == "stages" else random.sample(near, min(k, random.randint(0, 2)))
        pairs += [(one, two) for one in before for two in stage]
        last, k = stage, stage[-1] + 1
    return {"robots": m, "tasks": seconds, "pairs": pairs}


def planned(case: dict) -> float:
    from plain_scenes import CRAWLER, robot, scene, visit

    from mmrs_core.planning.planner import plan

    robots = [robot(f"r{k}", kinematics=CRAWLER) for k in range(case["robots"])]
    works = {f"t{k}": visit((0.0, 0.0, 0.0), hold=float(each)) for k, each in enumerate(case["tasks"])}
    return plan(scene(robots, works, after=[(f"t{one}", f"t{two}") for one, two in case["pairs"]])).makespan


def cp_sat(case: dict) -> tuple[float, bool]:
    from ortools.sat.python import cp_model

    model, most = cp_model.CpModel(), sum(case["tasks"])
    begins = [model.new_int_var(0, most, "") for _ in case["tasks"]]
    spans = [
        model.new_fixed_size_interval_var(begin, each, "")
        for begin, each in zip(begins, case["tasks"], strict=True)
    ]
    model.add_cumulative(spans, [1] * len(spans), case["robots"])
    end = model.new_int_var(0, most, "")
    model.add_max_equality(end, [begin + each for begin, each in zip(begins, case["tasks"], strict=True)])
    for one, two in case["pairs"]:
        model.add(begins[two] >= begins[one] + case["tasks"][one])
    model.minimize(end)
    solver = cp_model.CpSolver()
    solver.parameters.max_time_in_seconds, solver.parameters.num_workers = 60.0, 2
    proved = solver.solve(model) == cp_model.OPTIMAL
    return solver.objective_value, proved


def against_bounds(folder: Path, seconds: float, seed: int) -> None:
    print(f"\nMTSPLib min-max: longest tour by the published upper bound, {seconds:g} s of CPU each")
    bounds: dict[tuple[str, int], float] = {}
    for row in csv.DictReader((folder / "reference_literature.csv").open()):
        key = (row["instance"], int(row["k"]))
        bounds[key] = min(bounds.get(key, inf), float(row["upper_bound"]))
    found = []
    for (name, m), upper in bounds.items():
        lines = (folder / "tsp" / f"{name}.tsp").read_text().split("NODE_COORD_SECTION")[1].split("EOF")[0]
        city, *stops = [[float(each) for each in line.split()[1:3]] for line in lines.strip().splitlines()]
        case = {"homes": [city] * m, "stops": stops, "seconds": seconds, "seed": seed}
        ours = longest(case, mmrs(case))
        found.append(ours / upper)
        print(f"{name:>10}{m:4}{ours:12.2f}{upper:12.2f}{ours / upper:9.4f}", flush=True)
    print(f"mean {np.mean(found):.4f}, largest {max(found):.4f}")


def peer(name: str, case: dict, python: Path):
    command = [python, __file__, "--peer", name]
    done = subprocess.run(command, input=json.dumps(case), stdout=subprocess.PIPE, text=True, check=True)
    return json.loads(done.stdout)


def whole_metres(case: dict) -> np.ndarray:
    """Return the distances of homes and stops among each other, hundredths of a metre."""
    points = np.array([*case["homes"], *case["stops"]])
    return (SCALE * np.linalg.norm(points[:, None] - points, axis=2)).round().astype(np.int64)


def pyvrp(case: dict) -> list[list[int]]:
    import pyvrp

    warnings.simplefilter("ignore")  # a limit that cannot be kept is one half of what bisection asks for
    metres, m, n = whole_metres(case), len(case["homes"]), len(case["stops"])
    runs, begun = 7, process_time()
    spots = [pyvrp.Location(*place) for place in (*case["homes"], *case["stops"])]
    depots, clients = [pyvrp.Depot(k) for k in range(m)], [pyvrp.Client(k) for k in range(m, m + n)]
    high, low = int(metres.max()) * n, 2 * int(metres[:m, m:].min(axis=0).max())
    best: list[list[int]] = []
    for run in range(runs):
        allowed = high if run == 0 else (low + high) // 2
        fleet = [pyvrp.VehicleType(1, start_depot=k, end_depot=k, max_distance=allowed) for k in range(m)]
        data = pyvrp.ProblemData(spots, clients, depots, fleet, [metres], [metres * 0])
        until = begun + case["seconds"] * (run + 1) / runs
        found = pyvrp.solve(
            data, lambda cost, until=until: process_time() >= until, seed=run, display=False
        ).best
        if found.is_feasible():
            tours: list[list[int]] = [[] for _ in range(m)]
            for route in found.routes():
                tours[route.start_depot()] = [each.idx for each in route if each.is_client()]
            high, best = min(high, max(route.distance() for route in found.routes())), tours
        else:
            low = allowed
    return best


def ortools(case: dict) -> list[list[int]]:
    begun = process_time()
    tries = []
    for k, span in enumerate(SPANS):
        tries.append(_ortools(case, span, begun + case["seconds"] * (k + 1) / len(SPANS)))
    return min(tries, key=lambda tours: longest(case, tours))


def _ortools(case: dict, span: int, until: float) -> list[list[int]]:
    from ortools.constraint_solver import pywrapcp, routing_enums_pb2

    metres, m = whole_metres(case), len(case["homes"])
    manager = pywrapcp.RoutingIndexManager(len(metres), m, list(range(m)), list(range(m)))
    model = pywrapcp.RoutingModel(manager)
    transit = model.RegisterTransitMatrix(metres.tolist())
    model.SetArcCostEvaluatorOfAllVehicles(transit)
    model.AddDimension(transit, 0, int(metres.max()) * len(metres), True, "metres")
    model.GetDimensionOrDie("metres").SetGlobalSpanCostCoefficient(span)
    parameters = pywrapcp.DefaultRoutingSearchParameters()
    parameters.first_solution_strategy = routing_enums_pb2.FirstSolutionStrategy.PARALLEL_CHEAPEST_INSERTION
    parameters.local_search_metaheuristic = routing_enums_pb2.LocalSearchMetaheuristic.GUIDED_LOCAL_SEARCH
    parameters.time_limit.seconds = 3600
    model.AddSearchMonitor(model.solver().CustomLimit(lambda: process_time() >= until))
    solution = model.SolveWithParameters(parameters)
    if solution is None:
        return []
    tours = []
    for robot in range(m):
        index, tour = solution.Value(model.NextVar(model.Start(robot))), []
        while not model.IsEnd(index):
            tour.append(manager.IndexToNode(index) - m)
            index = solution.Value(model.NextVar(index))
        tours.append(tour)
    return tours


PEERS = {"PyVRP": pyvrp, "OR-tools": ortools}
SOLVERS = {**PEERS, "CP-SAT": cp_sat}

if __name__ == "__main__":
    main()
