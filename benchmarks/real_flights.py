"""Flies missions on autopilots' own simulations, and prints what came of each: one line a flight.

    MMRS_ARDUCOPTER=arducopter MMRS_ARDUCOPTER_PARAMETERS=copter.parm python benchmarks/real_flights.py

MMRS_ARDUCOPTER, MMRS_ARDUROVER, MMRS_ARDUSUB and MMRS_PX4 name binaries; the same with _PARAMETERS name the
default parameters of the class of vehicle (of ArduPilot's test suite). Flights whose binary is not given
are not flown, which is printed. Planned and flown are the seconds of all moves of the robot whose ratio
deviates most, waits and what was disturbed left out; each robot that completes must take what is planned
within 5 %, and each move what is checked. Legs are those that took what is planned within 15 %. Deviation
is the distance of the vehicle's own estimate from the planned line, maximum and 95 %; for rovers in the
plane. Margin is the closest approach to an area beyond the required clearance. Seconds are the vehicle's.
Flights on which less than 90 % of the speed-up was kept do not count.

Exit codes: 0 every flight that was flown went as declared, 1 one did not, 2 no binary is given for any of
them, or one that is no program.
"""

from __future__ import annotations

import argparse
import os
import re
import signal
import sys
import tempfile
import time
import traceback
from datetime import UTC, datetime
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "support"))

from firmware import FIRMWARES
from real_flights.flight import DONE, HOME, Flight
from real_flights.flying import Result, fly, missing
from real_flights.table import FLIGHTS

HEAD = (
    *("flight", "way", "planned", "flown", "ratio", "legs", "deviation", "landing", "margin"),
    *("end", "kept", "as declared"),
)


def cells(flight: Flight, result: Result) -> tuple[str, ...]:
    """Return the cells of a flight's line."""
    ends = sorted(set(result.end.values()))
    faults = sorted(set(result.faults.values()))
    judged = result.deviation is not None and flight.deviation is not None
    worst = max(result.times, key=lambda each: abs(each.ratio - 1.0), default=None)
    good = sum(each.good_legs for each in result.times)
    legs = sum(len(each.legs) for each in result.times)
    orders = [f"{order} after {seconds:.2f} s" for order, seconds in result.confirmed.items()]
    photos = [f"{result.photos} photos"] if flight.photos[0] else []
    return (
        flight.name,
        flight.way + (f" × {len(result.end)}" if len(result.end) > 1 else ""),
        f"{worst.planned:.0f} s" if worst else "",
        f"{worst.flown if worst else result.flown:.0f} s",
        f"{worst.ratio:.3f}" if worst else "",
        f"{good} of {legs}" if worst else "",
        "{:.2f} / {:.2f} m".format(*result.deviation) if judged else "",
        f"{result.landing:.2f} m" if result.landing is not None and flight.ends in (DONE, HOME) else "",
        f"{result.margin:+.2f} m" if result.margin is not None else "",
        "; ".join([*ends, *faults, *orders, *photos]),
        f"{int(100.0 * result.kept)} %",
        "yes" if not result.deviates else "NO: " + "; ".join(result.deviates),
    )


def line(values: tuple[str, ...]) -> str:
    """Return one line of the table."""
    return "| " + " | ".join(value.replace("|", "\\|").replace("\n", " ") for value in values) + " |"


def flown(flight: Flight, folder: Path, speedup: float | None) -> Result:
    """Return what came of a flight; what keeps it from being flown is reported as such."""
    try:
        return fly(flight, folder, speedup)
    except Exception as error:
        traceback.print_exc()
        return Result(deviates=[f"cannot be flown: {error!r}"[:300]])


def chosen(names: list[str]) -> list[Flight]:
    """Return the flights of these names, or whose names begin with them; all where none is given."""
    unknown = [name for name in names if not any(flight.name.startswith(name) for flight in FLIGHTS)]
    if unknown:
        print(f"real_flights: no flight '{unknown[0]}'; see --list", file=sys.stderr)
        raise SystemExit(2)
    return [flight for flight in FLIGHTS if not names or any(flight.name.startswith(name) for name in names)]


def main() -> int:
    """Fly what is asked for."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    add = parser.add_argument
    add("flights", nargs="*", metavar="FLIGHT", help="name of a flight, or how names begin; default: all")
    add("--list", action="store_true", help="print the names of all flights")
    add("--speedup", type=float, help="speed-up of all vehicles instead of the flights' own")
    add("--keep", type=Path, metavar="DIR", help="folder for models, logs and tracks; default: none are kept")
    given = parser.parse_args()
    flights = chosen(given.flights)
    if given.list:
        print(*(flight.name for flight in flights), sep="\n")
        return 0
    if not any(firmware.binary for firmware in FIRMWARES):
        print(
            f"real_flights: no binary is given: set {', '.join(each.variable for each in FIRMWARES)}",
            file=sys.stderr,
        )
        return 2
    for firmware in FIRMWARES:
        if firmware.binary and not os.access(firmware.binary, os.X_OK):
            print(f"real_flights: {firmware.variable}={firmware.binary}: no program", file=sys.stderr)
            return 2
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))  # vehicles and programs end with it
    print(f"# Flights on autopilots' own simulations ({datetime.now(UTC):%Y-%m-%d %H:%M} UTC)\n")
    print(line(HEAD), line(("---",) * len(HEAD)), sep="\n", flush=True)
    versions: set[str] = set()
    wrong, left_out = 0, {}
    begun = time.monotonic()
    with tempfile.TemporaryDirectory() as temporary:
        for flight in flights:
            folder = (given.keep or Path(temporary)) / re.sub(r"\W+", "-", flight.name)
            if folder.exists():
                parser.error(f"{folder}: exists already; choose another folder for --keep")
            if lacking := missing(flight, folder):
                left_out[flight.name] = lacking
                continue
            result = flown(flight, folder, given.speedup)
            versions |= result.versions
            wrong += bool(result.deviates)
            print(line(cells(flight, result)), flush=True)
    print(f"\n{len(flights) - len(left_out)} flights, {wrong} not as declared, in", end=" ")
    print(
        f"{(time.monotonic() - begun) / 60.0:.0f} min; {', '.join(sorted(versions))}; {os.cpu_count()} cores"
    )
    for name, lacking in left_out.items():
        print(f"not flown: {name}: set {', '.join(lacking)}")
    return 2 if len(left_out) == len(flights) else int(wrong > 0)


if __name__ == "__main__":
    raise SystemExit(main())
