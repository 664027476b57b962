"""Random missions through the whole chain: how many are refused, how well covered, how long it takes.

    python benchmarks/random_missions.py --count 1000 --workers 2

Every mission is judged by code that shares nothing with the chain. Missions of the solvable sort have a
witness: a simple plan that the generator knows to exist.
"""

import argparse
import sys
import tempfile
from concurrent.futures import ProcessPoolExecutor
from datetime import UTC, datetime
from functools import cache
from pathlib import Path
from statistics import median

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "support"))

from mission_generator.outcome import outcome_of

from mmrs_core.plugins import load_plugins


@cache
def contributions():
    return load_plugins().contributions


def judged(seed):
    with tempfile.TemporaryDirectory() as folder:
        return outcome_of(seed, contributions(), Path(folder))


def report(outcomes):
    """Yield the lines that tell what became of the missions."""
    for name, chosen in (
        ("solvable by construction", [o for o in outcomes if o.solvable]),
        ("without a witness", [o for o in outcomes if not o.solvable]),
        ("all", outcomes),
    ):
        refused = [o for o in chosen if o.refused]
        share = 100 * len(refused) / len(chosen) if chosen else 0.0
        yield f"{name}: {len(chosen)} missions, {len(refused)} refused ({share:.1f} %)"
    shares = [share for o in outcomes for share in o.coverage.values()]
    if shares:
        yield f"polygon tasks: {len(shares)}, smallest coverage {100 * min(shares):.4f} %"
    seconds = sorted(o.seconds for o in outcomes)
    yield f"seconds of CPU a mission: median {median(seconds):.2f}, largest {seconds[-1]:.1f}"
    complaints = [f"seed {o.seed}: {each}" for o in outcomes for each in o.complaints]
    yield f"complaints: {len(complaints)}"
    yield from complaints
    for outcome in outcomes:
        if outcome.solvable and outcome.refused:
            yield f"seed {outcome.seed}, solvable, refused: {outcome.refused}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--count", type=int, default=100, help="missions")
    parser.add_argument("--first", type=int, default=0, help="first seed")
    parser.add_argument("--workers", type=int, default=1, help="processes")
    arguments = parser.parse_args()
    seeds = range(arguments.first, arguments.first + arguments.count)
    with ProcessPoolExecutor(arguments.workers) as pool:
        outcomes = list(pool.map(judged, seeds, chunksize=5))
    print(f"{datetime.now(UTC):%Y-%m-%d}, seeds {seeds[0]} to {seeds[-1]}")
    print("\n".join(report(outcomes)))


if __name__ == "__main__":
    main()
