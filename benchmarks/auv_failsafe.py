"""Everything that may fail on an underwater vehicle, in real time, each part a process.

Each row is a dive of its own: two metres below the surface, with thrust on, something fails. The log of the
hub tells when a thruster was last commanded to push, and when a drive last told that it did; the simulated
body tells, also where nothing is heard on the bus, when its drives last put out thrust and when it is at the
surface. All in seconds after the failure.

    python benchmarks/auv_failsafe.py > benchmarks/results/auv_failsafe.txt
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from datetime import date
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "support"))

from patience import wait_for
from sample_vessels import heavy_sheet, pool_sheet
from vessel_processes import Boat

from auv_vessel.control import failsafe
from auv_vessel.sheet import Sheet
from auv_vessel.wire.codec import Codec
from auv_vessel.wire.frame import Frame

FLOATS = replace(pool_sheet(), weight_in_water=-1.7, home=(0.0, 0.0, 2.0))
SINKS = replace(heavy_sheet(), drop_weight=7.0, home=(0.0, 0.0, 2.0))
UNTRUSTED = failsafe.STALE + 0.3
"""Seconds until movement, which takes a state for trusted for 0.3 s, asks for no thrust."""

DRIVE = 0.1
"""Seconds between two statuses of a drive."""

LONGEST = 90.0
"""Seconds that a vehicle may take to surface."""


class Diver(Boat):
    """A vehicle that runs, to which happens what is typed.

    Attributes:
        pushed: when it last told that its drives put thrust out.
    """

    pushed = 0.0

    def start(self, part: str, *more: str) -> subprocess.Popen[str]:
        """Start a part; the vehicle's faults are typed."""
        if part != "vehicle":
            return super().start(part, *more)
        words = [sys.executable, "-m", "auv_vessel", part, "--sheet", str(self.file), "--faults"]
        return subprocess.Popen(
            [*words, "--channel", self.channel],
            stdin=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            bufsize=1,
        )

    def befall(self, line: str) -> None:
        """Have something befall the vehicle."""
        body = self.parts["vehicle"].stdin
        assert body is not None
        body.write(line + "\n")

    def is_up(self, sheet: Sheet) -> bool:
        """Return whether it is at the surface in truth; notes when it still has thrust."""
        self.befall("status")
        told = self.parts["vehicle"].stderr
        assert told is not None
        while " m down" not in (line := told.readline()):
            assert line, "the vehicle has ended"
        place, _, rest = line.partition(" m down, thrust ")
        if float(rest.split()[0]) > 0.0:
            self.pushed = time.time()
        return float(place.rpartition(" ")[2]) < sheet.height / 2.0 + 0.1


@dataclass(frozen=True)
class Cause:
    """What fails.

    Attributes:
        fail: makes it.
        within: seconds until thrust is to be zero, margins left out.
        heard: whether what the log of the hub holds after that can be believed. Where all frames are
            damaged it holds them as they arrived: one to three bits are wrong, and about one in 600 has a
            check that is right (one or two bits: none; three: one in 196 to 675, by length).
    """

    name: str
    fail: Callable[[Diver], object]
    within: float
    heard: bool = True


def killed(part: str) -> Callable[[Diver], object]:
    return lambda diver: diver.kill(part)


def typed(*lines: str) -> Callable[[Diver], object]:
    return lambda diver: [diver.befall(line) for line in lines]


def ordered(*lines: str) -> Callable[[Diver], object]:
    return lambda diver: [diver.order(line) for line in lines]


FROZEN = failsafe.FROZEN + UNTRUSTED
CAUSES = (
    Cause("movement killed", killed("movement"), failsafe.COMMANDS_SILENT),
    Cause("sensor controller killed", killed("sensors"), 0.3),
    Cause("actuator controller killed", killed("actuators"), FLOATS.watchdog),
    Cause("bus cut", ordered("cut"), FLOATS.watchdog, heard=False),
    Cause("all frames corrupted", ordered("corruption 1.0"), FLOATS.watchdog, heard=False),
    Cause("pressure frozen", typed("frozen Pressure"), FROZEN),
    Cause("compass frozen", typed("frozen Attitude"), FROZEN),
    Cause("pressure silent", typed("silent Pressure"), UNTRUSTED),
    Cause("all instruments silent", typed(*(f"silent {each}" for each in (
        "Pressure", "Attitude", "Rates", "GroundSpeed"))), UNTRUSTED),
    Cause("leak", typed("leak"), failsafe.LEAK_SAID * 0.2),
    Cause("leak detector silent", typed("silent Health"), failsafe.HEALTH_SILENT),
    Cause("given up by the decision centre", lambda diver: diver.craft.emergency(), 0.2),
)  # fmt: skip


def main() -> int:
    """Print a row for each cause and vehicle; return 1 where one is not as declared."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--only", default="", help="those causes whose name contains this")
    given = parser.parse_args()
    print(f"fail-safe at the bus, in real time, {date.today()}, {os.cpu_count()} cores, "
          f"load {os.getloadavg()[0]:.1f}; seconds")  # fmt: skip
    print(
        "dark: the log tells nothing that can be believed then; the simulated body tells when drives stop\n"
    )
    print(f"{'':42}{'declared':>10}{'commands':>10}{'statuses':>10}{'drives':>10}{'surfaced':>10}")
    wrong = 0
    for cause in CAUSES:
        for word, sheet in (("floats", FLOATS), ("sinks", SINKS)):
            if given.only in cause.name:
                wrong += not tried(cause, word, sheet)
    for word, sheet in (("floats", FLOATS), ("sinks", SINKS)):
        if given.only in "thruster dead":
            wrong += not dive_without_a_thruster(word, sheet)
    print(f"\n{wrong} rows not as declared")
    return 1 if wrong else 0


def tried(cause: Cause, word: str, sheet: Sheet) -> bool:
    """Print what became of a dive, and return whether thrust ended in time and the vehicle surfaced."""
    declared = cause.within + failsafe.MARGIN + DRIVE
    dive = dived(sheet, cause.fail)
    asked, told = dive.last("Command"), dive.last("Status") if cause.heard else 0.0
    kept = dive.surfaced < LONGEST and max(told, dive.pushed) <= declared
    heard = f"{asked:10.2f}{told:10.2f}" if cause.heard else f"{'dark':>10}{'dark':>10}"
    tell(f"{cause.name}, {word}", f"{declared:10.2f}{heard}{dive.pushed:10.2f}", dive, kept)
    return kept


def dive_without_a_thruster(word: str, sheet: Sheet) -> bool:
    """Print how a vehicle whose thruster died went on; return whether it did, and came up when told to."""

    def fail(diver: Diver) -> None:
        diver.befall("thruster-dead 0")
        time.sleep(3.0)
        diver.craft.surface()

    dive = dived(sheet, fail)
    kept = dive.surfaced < LONGEST and dive.last("Status") > 3.0
    heard = f"{'':10}{dive.last('Command', 0):10.2f}{dive.last('Status', 0):10.2f}{'':10}"
    tell(f"a thruster dead, others go on, {word}", heard, dive, kept)
    return kept


@dataclass(frozen=True)
class Dive:
    """What became of a dive.

    Attributes:
        surfaced: seconds from the failure until it was at the surface; `LONGEST`: it was not.
        pushed: seconds from the failure until drives last put thrust out, told every 0.05 s.
        thrusts: by message of commands and statuses, seconds from the failure until it last told of thrust.
    """

    surfaced: float
    pushed: float
    thrusts: Mapping[str, float]

    def last(self, kind: str, number: int | None = None) -> float:
        """Return when messages of a kind, of one thruster or all, last told of thrust; 0: not since then."""
        begin = "Thruster" if number is None else f"Thruster{number}{kind}"
        found = [at for name, at in self.thrusts.items() if name.startswith(begin) and name.endswith(kind)]
        return max(found, default=0.0)


def dived(sheet: Sheet, fail: Callable[[Diver], object]) -> Dive:
    """Have a vehicle dive with thrust on, let something fail, and wait until it is at the surface."""
    with tempfile.TemporaryDirectory() as folder:
        diver = Diver(sheet, Path(folder))
        try:
            assert wait_for(lambda: diver.craft.state().trusted, 30.0)
            diver.craft.go_to(60.0, 0.0, 2.0, heading=0.0)
            begun = time.monotonic()
            assert wait_for(lambda: diver.ear.last_thrust(begun) > begun + 2.0, 20.0)
            begin = time.time()
            fail(diver)
            up = wait_for(lambda: diver.is_up(sheet), LONGEST)
            surfaced = time.time() - begin if up else LONGEST
        finally:
            diver.close()
        return Dive(
            surfaced, max(0.0, diver.pushed - begin), thrusts_in(Path(folder) / "bus.log", sheet, begin)
        )


def thrusts_in(log: Path, sheet: Sheet, begin: float) -> dict[str, float]:
    """Return when each command and status of thrusters last told of thrust after a time, seconds from it."""
    codec, found = Codec(sheet), {}
    for line in log.read_text(encoding="ascii").splitlines():
        at, _, said = line.split()
        identifier, _, data = said.partition("#")
        after = float(at.strip("()")) - begin
        heard = codec.decode(Frame(int(identifier, 16), bytes.fromhex(data))) if after > 0.0 else None
        if heard is not None and heard.values.get("Thrust"):
            found[heard.name] = after
    return found


def tell(name: str, heard: str, dive: Dive, kept: bool) -> None:
    """Print a row."""
    print(f"{name:42}{heard}{dive.surfaced:10.1f}{'' if kept else '  NOT AS DECLARED'}", flush=True)


if __name__ == "__main__":
    sys.exit(main())
