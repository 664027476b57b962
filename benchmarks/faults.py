"""The fault table: everything that can go wrong, what was declared, what then happened, in how many seconds.

    python benchmarks/faults.py > benchmarks/results/faults.txt

Every row is flown by generated controllers, as processes, on simulated vehicles of ours. What happened is
the vehicle's own record: its modes, and where it came to rest; the log line is the robot's. Seconds are those
of the run, which goes faster than real time; orders are confirmed in real ones. Those to
single robots are flown in real time, one flight after the other with nothing beside: how soon they are
confirmed depends on what else the machine does. Then several flights go on at once: ``--jobs``.
"""

from __future__ import annotations

import argparse
import json
import multiprocessing
import re
import sys
import tempfile
import time
from collections import defaultdict
from concurrent.futures import ProcessPoolExecutor, as_completed
from datetime import UTC, datetime
from itertools import zip_longest
from pathlib import Path
from statistics import quantiles

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "support"))

from fault_table.blows import DRILLS
from fault_table.journeys import JOURNEYS
from fault_table.orders import ORDERS
from fault_table.row import Outcome
from fault_table.rows import ROWS
from fault_table.trial import batches, fly

HEAD = ("fault", "declared", "what the vehicle did", "answered", "at rest", "log", "as declared")
JOBS = 2
"""Flights at once: ten robots and their vehicles take up to three quarters of a core at a speed-up of ten,
those of all orders more, and two cores then answer up to a second late."""

ALONE = "orders in real time"
"""The flight with nothing beside: one process, whose robots must confirm within a real second."""

SHOWN = ("seq", "time", "label", "move", "detail")


def flights(pattern, speedup):
    """Return all flights in the table's order: by name, what flies it, given a folder."""
    found = {}
    for number, batch in enumerate(batches([row for row in ROWS if re.search(pattern, row.title)])):
        found[f"faults {number}"] = lambda f, batch=batch: fly(batch, f, speedup=speedup)
    if orders := [row for row in ORDERS if re.search(pattern, row.title)]:
        found[ALONE] = lambda f: fly(orders, f, speedup=1.0)
    for number, drill in enumerate(DRILLS):
        if any(re.search(pattern, name) for name in (drill.name, *(row.title for row in drill.rows))):
            found[f"drill {number}: {drill.name}"] = drill.fly
    for number, stages in enumerate(JOURNEYS):
        if re.search(pattern, stages.name):
            found[f"stages {number}: {stages.name}"] = lambda f, j=stages: [j.fly(f)]
    return found


def flown(pattern, speedup, name, folder):
    """Return what became of one flight, and the real seconds that it took."""
    begun = time.monotonic()
    try:
        outcomes = flights(pattern, speedup)[name](folder)
    except Exception as error:
        outcomes = [Outcome(name, "", problems=[f"cannot be flown: {error!r}", ""])]
    return outcomes, time.monotonic() - begun


def fly_all(given, folder):
    """Return what became of every row, in the table's order; tell on standard error how far it is."""
    jobs = list(flights(given.only, given.speedup))
    found = {}
    alone = [job for job in jobs if job == ALONE]
    beside = _in_turns([job for job in jobs if job != ALONE])
    for some, at_once, place in ((alone, 1, "alone"), (beside, given.jobs, "beside")):
        for job, outcomes, seconds in fly_some(given, some, at_once, folder / place):
            found[job] = outcomes
            wrong = sum(bool(outcome.problems) for outcome in outcomes)
            words = f"{len(found)}/{len(jobs)} {job}: {seconds:.0f} s, {wrong} wrong"
            print(words, file=sys.stderr, flush=True)
    return [outcome for job in jobs for outcome in found[job]]


def _in_turns(jobs):
    """Return flights so that those of many robots are far apart, and those that take longest come first."""
    many = [job for job in jobs if job.startswith("faults")]
    few = sorted((job for job in jobs if job not in many), key=lambda job: "to all" not in job)
    return [job for pair in zip_longest(few, many) for job in pair if job is not None]


def fly_some(given, jobs, at_once, folder):
    """Yield each flight of these as it ends: name, what became of its rows, real seconds."""
    with ProcessPoolExecutor(at_once, multiprocessing.get_context("spawn")) as pool:
        futures = {}
        for name in jobs:
            place = folder / f"{len(futures)}"
            future = pool.submit(flown, given.only, given.speedup, name, place)
            futures[future] = name
        for future in as_completed(futures):
            yield futures[future], *future.result()


def cells(outcome):
    """Return the cells of a row."""
    fault = outcome.title.removesuffix(f", {outcome.declared}")
    confirmed = ", ".join(f"{order} {value:.3f} s real" for order, value in outcome.confirmed.items())
    return (
        fault,
        outcome.declared,
        outcome.happened,
        confirmed or in_words(outcome.answered),
        in_words(outcome.rested),
        log_of(outcome),
        "yes" if not outcome.problems else "NO: " + "; ".join(outcome.problems[:-1])[:400],
    )


def log_of(outcome):
    """Return the line of the step log, without what the table says anyway, and why it was decided so."""
    line = outcome.line
    if line.startswith("{"):
        step = json.loads(line)
        line = json.dumps({name: step[name] for name in SHOWN if step[name] != ""}, ensure_ascii=False)
    parts = [f"`{line}`"] if line else []
    if outcome.decision.startswith("{"):
        decision = json.loads(outcome.decision)
        parts += [decision["why"]] if decision.get("why") else []
    return "; ".join(parts)


def in_words(value):
    """Return seconds in words."""
    return "" if value is None else f"{value:.1f} s"


def line(values):
    """Return one line of the table."""
    return "| " + " | ".join(value.replace("|", "\\|").replace("\n", " ") for value in values) + " |"


def summary(outcomes):
    """Yield the lines that tell what all rows have in common."""
    wrong = [outcome for outcome in outcomes if outcome.problems]
    yield f"{len(outcomes)} rows, {len(outcomes) - len(wrong)} as declared, {len(wrong)} not."
    yield from (f"- NOT as declared: {outcome.title}" for outcome in wrong)
    yield from ("", "Orders, in real seconds until the vehicle was seen to obey:", "")
    yield from (line(("order", "robots", "median", "99 %", "slowest")), line(["---"] * 5))
    confirmed = defaultdict(list)
    for outcome in outcomes:
        for order, value in outcome.confirmed.items():
            confirmed[order].append(value)
            confirmed["all"].append(value)
    for order, values in sorted(confirmed.items()):
        spread = quantiles(values, n=100, method="inclusive") if len(values) > 1 else values * 99
        figures = (f"{value:.3f} s" for value in (spread[49], spread[98], max(values)))
        yield line((order, str(len(values)), *figures))
    yield from ("", "Slowest answers, in seconds of the run:", "")
    yield from (line(("fault", "seconds")), line(["---"] * 2))
    kinds = defaultdict(list)
    for outcome in outcomes:
        if outcome.answered is not None and not outcome.confirmed:
            kinds[outcome.title.split(", ")[0]].append(outcome.answered)
    for kind, answers in kinds.items():
        yield line((kind, in_words(max(answers))))


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--speedup", type=float, default=10.0)
    parser.add_argument("--jobs", type=int, default=JOBS, help="flights at once")
    parser.add_argument("--only", default="", metavar="PATTERN", help="rows or stories whose title matches")
    given = parser.parse_args()
    begun = time.monotonic()
    with tempfile.TemporaryDirectory() as folder:
        outcomes = fly_all(given, Path(folder))
        table = [line(cells(outcome)).replace(f"{folder}/", "") for outcome in outcomes]
    minutes = (time.monotonic() - begun) / 60.0
    print(f"# Faults: what was declared, and what happened ({datetime.now(UTC):%Y-%m-%d})\n")
    print(
        f"Speed-up {given.speedup:g}, orders in real time, those to all at 4; losses on purpose"
        f" by seed 7; vehicles of ours (mmrs_mavlink.sitl); orders in real time one flight after the other"
        f" with nothing beside, of all else {given.jobs} flights at once; {minutes:.1f} min.\n"
    )
    print(*summary(outcomes), "", line(HEAD), line(["---"] * len(HEAD)), *table, sep="\n")
    return 1 if any(outcome.problems for outcome in outcomes) else 0


if __name__ == "__main__":
    raise SystemExit(main())
