"""Random missions through the whole chain: how many are refused, how well covered, how long it takes.

    python benchmarks/random_missions.py --count 1000 --record outcomes.jsonl

Every mission is judged by code that shares nothing with the chain. Missions of the solvable sort have a
witness: a simple plan that the generator knows to exist. What is in the record is not done again, so that a
run that was ended goes on where it was.
"""

import argparse
import json
import sys
import tempfile
import traceback
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict
from datetime import UTC, datetime
from functools import cache, partial
from itertools import pairwise
from pathlib import Path
from statistics import mean, median

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "support"))

from mission_generator.missions import LARGEST
from mission_generator.outcome import Outcome, outcome_of

from mmrs_core.plugins import load_plugins


@cache
def contributions():
    return load_plugins().contributions


def judged(seed, largest):
    """Return what becomes of a mission; a crash is a complaint that says where."""
    with tempfile.TemporaryDirectory() as folder:
        try:
            return outcome_of(seed, contributions(), Path(folder), largest)
        except Exception as error:
            last = traceback.extract_tb(error.__traceback__)[-1]
            words = f"crash: {error!r} in {Path(last.filename).name}:{last.lineno}"
            return Outcome(seed, solvable=False, complaints=[words], largest=largest)


def recorded(file, largest):
    """Return the outcomes in a record, by seed; none if there is no such file.

    Raises:
        SystemExit: the record is of missions of another size.
    """
    if file is None or not file.exists():
        return {}
    outcomes = [Outcome(**json.loads(line)) for line in file.read_text().splitlines()]
    if any(tuple(each.largest) != largest for each in outcomes):
        raise SystemExit(f"{file} is of missions of another size; give another file")
    return {each.seed: each for each in outcomes}


def faults(outcome) -> Iterator[str]:
    """Yield, in one line each, what should not have become of a mission."""
    yield from (f"seed {outcome.seed}: {each}" for each in outcome.complaints)
    if outcome.solvable and outcome.refused:
        yield f"seed {outcome.seed}, solvable, refused: {outcome.refused}"


def seeds_in_words(seeds):
    """Return seeds as runs.

    >>> seeds_in_words([0, 1, 2, 5])
    '0 to 2, 5'
    """
    first, *rest = ordered = sorted(seeds)
    begins = [first, *(two for one, two in pairwise(ordered) if two > one + 1)]
    ends = [*(one for one, two in pairwise(ordered) if two > one + 1), (rest or [first])[-1]]
    runs = zip(begins, ends, strict=True)
    return ", ".join(f"{begin} to {end}" if end > begin else str(begin) for begin, end in runs)


def report(outcomes):
    """Yield the lines that tell what became of the missions."""
    yield f"{datetime.now(UTC):%Y-%m-%d}, seeds {seeds_in_words(each.seed for each in outcomes)}"
    for name, chosen in (
        ("solvable by construction", [o for o in outcomes if o.solvable]),
        ("without a witness", [o for o in outcomes if not o.solvable]),
        ("all", outcomes),
        ("with a minimum separation", [o for o in outcomes if o.separation]),
    ):
        refused = [o for o in chosen if o.refused]
        share = 100 * len(refused) / len(chosen) if chosen else 0.0
        yield f"{name}: {len(chosen)} missions, {len(refused)} refused ({share:.1f} %)"
    shares = [share for o in outcomes for share in o.coverage.values()]
    if shares:
        yield f"polygon tasks: {len(shares)}, smallest coverage {100 * min(shares):.4f} %"
    seconds = sorted(o.seconds for o in outcomes)
    yield (
        f"seconds of CPU a mission: median {median(seconds):.2f}, mean {mean(seconds):.2f},"
        f" largest {seconds[-1]:.1f}"
    )
    yield f"complaints: {sum(len(o.complaints) for o in outcomes)}"
    for outcome in outcomes:
        yield from faults(outcome)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--count", type=int, default=100, help="missions")
    parser.add_argument("--first", type=int, default=0, help="first seed")
    parser.add_argument("--robots", type=int, default=LARGEST[0], help="robots of a mission, at most")
    parser.add_argument("--tasks", type=int, default=LARGEST[1], help="tasks of a mission, at most")
    parser.add_argument("--workers", type=int, default=1, help="processes")
    parser.add_argument("--record", type=Path, help="file of outcomes, a JSON object a line")
    arguments = parser.parse_args()
    largest = (arguments.robots, arguments.tasks)
    known = recorded(arguments.record, largest)
    seeds = range(arguments.first, arguments.first + arguments.count)
    left = [seed for seed in seeds if seed not in known]
    with ProcessPoolExecutor(arguments.workers) as pool:
        for outcome in pool.map(partial(judged, largest=largest), left):
            known[outcome.seed] = outcome
            if arguments.record is not None:
                with arguments.record.open("a") as file:
                    file.write(json.dumps(asdict(outcome)) + "\n")
            for fault in faults(outcome):
                print(fault, file=sys.stderr, flush=True)
    print(f"missions of at most {largest[0]} robots and {largest[1]} tasks")
    print("\n".join(report([known[seed] for seed in sorted(known)])))


if __name__ == "__main__":
    main()
