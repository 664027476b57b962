"""The fault table: everything that can go wrong, what was declared, what then happened, in how many seconds.

    python benchmarks/faults.py > benchmarks/results/faults.txt

Every row is flown by generated controllers and by ``mmrs run``, each as processes, on simulated vehicles
of ours. What happened is the vehicle's own record: its modes, and where it came to rest; the log line is the
robot's. Seconds are those of the run, which goes faster than real time; orders are confirmed in real ones.
"""

from __future__ import annotations

import argparse
import re
import sys
import tempfile
from datetime import UTC, datetime
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "support"))

from fault_table.blows import DRILLS
from fault_table.fleet import EXECUTIONS
from fault_table.journeys import JOURNEYS
from fault_table.orders import ORDERS
from fault_table.rows import ROWS
from fault_table.trial import batches, fly

HEAD = ("fault", "declared", "execution", "what the vehicle did", "answered", "at rest", "log", "as declared")


def outcomes(executions, speedup, pattern, folder):
    """Yield what became of every row."""
    chosen = [row for row in (*ROWS, *ORDERS) if re.search(pattern, row.title)]
    for execution in executions:
        for number, batch in enumerate(batches(chosen)):
            yield from fly(batch, execution, folder / f"{execution}-{number}", speedup=speedup)
        for number, drill in enumerate(each for each in DRILLS if re.search(pattern, each.name)):
            yield from drill.fly(execution, folder / f"{execution}-drill-{number}")
        for number, journey in enumerate(each for each in JOURNEYS if re.search(pattern, each.name)):
            yield journey.fly(execution, folder / f"{execution}-journey-{number}")


def cells(outcome):
    """Return the cells of a row."""
    fault = outcome.title.removesuffix(f", {outcome.declared}")
    confirmed = f"{outcome.confirmed:.3f} s (real, confirmed)" if outcome.confirmed is not None else ""
    log = "; ".join(part for part in (outcome.line, outcome.decision.strip('"')) if part)
    return (
        fault,
        outcome.declared,
        outcome.execution,
        outcome.happened,
        confirmed or seconds(outcome.answered),
        seconds(outcome.rested),
        f"`{log}`",
        "yes" if not outcome.problems else "NO: " + "; ".join(outcome.problems[:-1])[:400],
    )


def seconds(value):
    """Return seconds in words."""
    return "" if value is None else f"{value:.1f} s"


def line(values):
    """Return one line of the table."""
    return "| " + " | ".join(value.replace("|", "\\|").replace("\n", " ") for value in values) + " |"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--speedup", type=float, default=10.0)
    parser.add_argument("--execution", choices=EXECUTIONS, action="append")
    parser.add_argument("--only", default="", metavar="PATTERN", help="rows whose title matches")
    given = parser.parse_args()
    print(f"# Faults: what was declared, and what happened ({datetime.now(UTC):%Y-%m-%d})\n")
    print(f"Speed-up {given.speedup:g}; losses on purpose by seed 7; vehicles of ours (mmrs_core.sitl).\n")
    print(line(HEAD), line(["---"] * len(HEAD)), sep="\n")
    wrong = total = 0
    with tempfile.TemporaryDirectory() as folder:
        for outcome in outcomes(given.execution or EXECUTIONS, given.speedup, given.only, Path(folder)):
            total += 1
            wrong += bool(outcome.problems)
            print(line(cells(outcome)).replace(f"{folder}/", ""), flush=True)
    print(f"\n{total} rows, {total - wrong} as declared, {wrong} not.")
    return 1 if wrong else 0


if __name__ == "__main__":
    raise SystemExit(main())
