"""Reads a hundred thousand damaged models of every kind, and prints what came of them.

Run: ``python benchmarks/fuzz.py [CASES [SEED]]``; four processes take a quarter each.
"""

from __future__ import annotations

import resource
import sys
import tempfile
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from datetime import date
from functools import reduce
from pathlib import Path
from time import perf_counter

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "support"))

from fuzz_ways import large_ways, ways
from fuzzing import Tally, fuzz

from mmrs_core.plugins import load_plugins

PROCESSES = 4
SHARE_LARGE = 250
"""One text of so many more is about a megabyte long, and each of these is weighed: what a small one takes is
mostly what any text takes."""
RESULT = Path(__file__).parent / "results" / "fuzz.txt"


def line_of(name: str, tally: Tally) -> str:
    ends = ", ".join(f"{count} {end}" for end, count in sorted(tally.ends.items()))
    return (
        f"{name:<10} {sum(tally.ends.values()):>7} texts: {ends}; slowest {tally.slowest:.2f} s; "
        f"most memory {tally.most_memory / 1e6:.1f} MB, {tally.worst_factor:.1f} times the text"
    )


def part(cases: int, seed: int) -> tuple[dict[str, Tally], int]:
    """Return what came of some cases, and the most memory of the process, in kB."""
    with tempfile.TemporaryDirectory() as folder:
        contributions = load_plugins().contributions
        tallies = fuzz(ways(contributions, Path(folder)), cases, seed, weigh_every=50)
        tallies |= fuzz(large_ways(contributions), max(cases // SHARE_LARGE, 2), seed, weigh_every=1)
    return tallies, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss


def together(one: Tally, other: Tally) -> Tally:
    ends = Counter(one.ends) + Counter(other.ends)
    return Tally(
        dict(ends),
        max(one.worst_factor, other.worst_factor),
        max(one.most_memory, other.most_memory),
        max(one.slowest, other.slowest),
        one.defects + other.defects,
    )


def main(cases: int = 100_000, seed: int = 2015) -> int:
    begun = perf_counter()
    with ProcessPoolExecutor(PROCESSES) as pool:
        parts = list(pool.map(part, [cases // PROCESSES] * PROCESSES, range(seed, seed + PROCESSES)))
    names = parts[0][0]
    tallies = {name: reduce(together, (found[name] for found, _ in parts)) for name in names}
    defects = [f"{name}: {each}" for name, tally in tallies.items() for each in tally.defects]
    lines = [
        f"{cases} damaged models, seeds {seed} to {seed + PROCESSES - 1}, {date.today().isoformat()}",
        *(line_of(name, tally) for name, tally in tallies.items()),
        f"tracebacks and hangs: {len(defects)}",
        *defects[:20],
        f"most memory of a process: {max(memory for _, memory in parts) / 1024:.0f} MB; "
        f"{perf_counter() - begun:.0f} s",
    ]
    print("\n".join(lines))
    if cases >= 100_000:
        RESULT.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return 1 if defects else 0


if __name__ == "__main__":
    sys.exit(main(*map(int, sys.argv[1:3])))
