"""The drives in C against those of the simulated vehicle: the same frames, damaged ones too, byte for byte.

    python benchmarks/drives.py > benchmarks/results/drives.txt

Needs gcc and make. Built with -fsanitize=undefined,address.
"""

import argparse
import sys
import tempfile
from collections import Counter
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from random import Random

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "support"))

from c_drives import compiled, happenings, told
from vessel_sheets import sheet, thruster

SANITIZERS = "-fsanitize=undefined,address"


def vehicle(seed):
    """Return a vehicle with up to 32 thrusters of any strength, watchdog and dead man's time."""
    random = Random(seed)
    count = random.choice([1, 2, 4, 6, 8, 32])
    thrusters = []
    for number in range(count):
        most = 10.0 ** random.uniform(-2.0, 4.5)
        operating = max(0.01, most * random.uniform(0.1, 1.0))
        made = thruster(number, operating_thrust=operating, max_thrust=most)
        thrusters.append(replace(made, max_power=random.uniform(0.0, 6553.5)))
    dead_man = random.choice([0.0, 0.1, 0.3, 5.0])
    return sheet(
        0,
        thrusters=tuple(thrusters),
        watchdog=random.choice([0.1, 0.5, 2.0]),
        extra={"deadman.time": dead_man},
    )


def compared(made, program, seed, seconds, counts):
    """Count what drives of a vehicle said after a stream of happenings, and where it differs."""
    stream = happenings(made, seed, seconds)
    said = told(program, stream.script)
    counts["streams"] += 1
    counts["frames heard"] += sum(line.startswith("h") for line in stream.script.lines)
    counts["statuses"] += sum(line.startswith("s") for block in said for line in block)
    counts["outputs"] += sum(line.startswith("o") for block in said for line in block)
    counts["drop weights let go"] += any("r" in block for block in said)
    counts["differ"] += said != stream.expected


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--streams", type=int, default=60, help="of one vehicle")
    parser.add_argument("--vehicles", type=int, default=25, help="of other vehicles, a stream each")
    parser.add_argument("--seed", type=int, default=0)
    given = parser.parse_args()
    counts = Counter()
    with tempfile.TemporaryDirectory() as folder:
        one = sheet(3, extra={"deadman.time": 0.25})
        program = compiled(one, Path(folder), SANITIZERS)
        for seed in range(given.seed, given.seed + given.streams):
            compared(one, program, seed, 8.0, counts)
        for seed in range(given.seed, given.seed + given.vehicles):
            made = vehicle(seed)
            place = Path(folder) / str(seed)
            place.mkdir()
            compared(made, compiled(made, place, SANITIZERS), seed, 2.0, counts)
    print(
        f"{given.streams} streams of 8 s; {given.vehicles} vehicles of 1 to 32 thrusters, 2 s each;"
        f" seeds from {given.seed}, {datetime.now(UTC):%Y-%m-%d}"
    )
    for what in ("streams", "frames heard", "statuses", "outputs", "drop weights let go", "differ"):
        print(f"{what:20} {counts[what]}")
    return 1 if counts["differ"] else 0


if __name__ == "__main__":
    raise SystemExit(main())
