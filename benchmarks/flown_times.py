"""Compares the times of recorded flights with those that the same models are planned, and checked, to take.

    python benchmarks/flown_times.py FLIGHT... > benchmarks/results/flown_times.txt

A flight is a folder: ``behaviour.xmi``, ``robots/``, and ``context.xmi`` as flown; ``logs/*.jsonl``, the
steps of `mmrs run`; ``ROBOT.track.csv.gz``, the vehicle's own estimate (`t` s of its clock, `lat`, `lon`
degrees, `rel` m above home, `vx`, `vy`, `vz` m/s, `armed`, `mode`, `seq`). A robot without a log was given
all of its moves as a mission.

Flown times are those of the vehicle's clock: that of the log runs ahead where a simulation falls behind.
Waits for other robots, and charging, which operators end, are left out on both sides. Prints a line for each
robot: planned, the bounds of the check, flown, the ratio, and the legs that took what was planned within
15 %. Exit code 0 where each robot that completed its moves took what was planned within 5 %, all are within
their bounds, and 95 % of all legs within 15 %; 1 where not; 2 where no folder is given.
"""

from __future__ import annotations

import argparse
import sys
from datetime import date
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "support"))

from flown_times.comparison import LEGS_WITHIN, MOST_LEGS, Comparison, NotComparableError, compared

from mmrs_core.errors import MmrsError


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("flights", nargs="*", type=Path, metavar="FLIGHT")
    of_px4 = "a flight with a PX4 that its robot types do not state (mavlink.autopilot); repeatable"
    parser.add_argument("--px4", action="append", type=Path, default=[], metavar="FLIGHT", help=of_px4)
    parser.add_argument("--legs", action="store_true", help="print the legs that deviate as well")
    given = parser.parse_args()
    folders = [*given.flights, *given.px4]
    if not folders or not all((each / "behaviour.xmi").is_file() for each in folders):
        print("give the folders of flights, each with a behaviour.xmi", file=sys.stderr)
        return 2
    print(f"flown times, {date.today()}: seconds of all moves that were completed, waits left out\n")
    print(f"{'flight':26} {'robot':8} {'way':8}  planned      low     high    flown  ratio  legs within 15 %")
    found: list[Comparison] = []
    missing = False
    for folder in folders:
        try:
            robots = compared(folder, px4=folder in given.px4)
        except (MmrsError, NotComparableError, OSError) as error:
            robots = []
            print(f"{folder.name:26} not compared: {error}")
        missing = missing or not robots
        found += robots
        for each in robots:
            print("\n".join([each.line(), *(details(each) if given.legs else [])]))
    legs, good = sum(len(each.legs) for each in found), sum(each.good_legs for each in found)
    print(f"\nlegs within 15 %: {good} of {legs}, {good / legs:.1%}" if legs else "\nno legs")
    enough = not missing and legs and good >= MOST_LEGS * legs
    return 0 if enough and not any(fault for each in found for fault in each.faults()) else 1


def details(each: Comparison) -> list[str]:
    legs = [
        f"    {move}: planned {planned:.2f}, flown {flown:.2f}"
        for move, (planned, flown) in each.legs.items()
        if abs(planned / flown - 1.0) > LEGS_WITHIN
    ]
    return [*legs, *(f"    outside its bounds: {words}" for words in each.outside)]


if __name__ == "__main__":
    sys.exit(main())
