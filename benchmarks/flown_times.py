"""Compares the times of recorded flights with those that the same models are planned, and checked, to take.

    python benchmarks/flown_times.py FLIGHT... > benchmarks/results/flown_times.txt

A flight is a folder: ``behaviour.xmi``, ``robots/``, and ``context.xmi`` as flown; ``logs/*.jsonl``, the
steps of `mmrs run`; ``ROBOT.track.csv.gz``, the vehicle's own estimate (`t` s of its clock, `lat`, `lon`
degrees, `rel` m above home, `vx`, `vy`, `vz` m/s, `armed`, `mode`, `seq`). A robot without a log was given
all of its moves as a mission.

Flown times are those of the vehicle's clock: that of the log runs ahead where a simulation falls behind.
Waits for other robots are left out on both sides. Prints a line for each robot: planned, the bounds of the
check, flown, the ratio, and the legs that took what was planned within 15 %. Exit code 0 where each robot
that completed its moves took what was planned within 5 %, all are within their bounds, and 95 % of all legs
within 15 %; 1 where not; 2 where no folder is given.
"""

from __future__ import annotations

import argparse
import csv
import gzip
import json
import sys
from bisect import bisect_right
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from datetime import date
from functools import cache
from itertools import pairwise
from math import cos, dist, hypot, radians
from pathlib import Path
from statistics import median

from mmrs_core.analysis.durations import Duration, durations_of
from mmrs_core.analysis.figures import seconds_of
from mmrs_core.analysis.motion import motions
from mmrs_core.behaviour.program import RobotProgram
from mmrs_core.cli.behaviours import Loaded, load_behaviour
from mmrs_core.cli.session import Session
from mmrs_core.cli.settings import Settings
from mmrs_core.contributions.checks import CheckInput
from mmrs_core.contributions.runs import runs_of
from mmrs_core.contributions.targets import TargetInput
from mmrs_core.contributions.timing import as_uploaded
from mmrs_core.errors import MmrsError
from mmrs_core.generation.planned_moves import planned_moves
from mmrs_core.scene import Device, Position
from mmrs_mavlink.plugin.context import context_of
from mmrs_mavlink.plugin.plans.flight import sorties_of
from mmrs_mavlink.plugin.plans.items import TAKE_OFF, WAYPOINT

WITHIN, LEGS_WITHIN, MOST_LEGS = 0.05, 0.15, 0.95
"""Share of the planned time within which a flight and a leg count, and share of the legs that must."""

DEGREE = 111_319.49
"""Metres of a degree of latitude."""

NEAR, STILL = 0.5, 0.3
"""Metres and metres per second within which a vehicle is at a target, as its recording shows it."""

RECORDED = 0.1
"""Seconds to which recordings tell when a step was done."""

STALL = 1.0
"""Seconds from which the log's clock has run ahead."""

ARMED = 5.0
"""Seconds before its mission from which a vehicle is armed for it."""

ITEM = 0.9
"""Seconds that an item of a mission is shown at least which is a leg."""

AUTO = {3, 10}
"""Modes of ArduPilot's copters and subs, and of its rovers, in which missions are flown."""


class NotComparableError(Exception):
    """What was recorded shows no flight of the models."""


@dataclass(frozen=True, slots=True)
class Sample:
    """Where a vehicle was: east, north and up of the robot's home."""

    time: float
    place: Position
    speed: float
    armed: bool
    mode: int
    item: int


@dataclass(slots=True)
class Comparison:
    """One robot of a flight.

    Attributes:
        planned, low, high, flown: seconds of all moves that were completed, waits left out.
        legs: planned and flown seconds of each, by move.
        outside: moves that took less or more than the check's bounds, with these.
        whole: whether the robot did all of its moves.
    """

    flight: str
    robot: str
    way: str
    planned: float = 0.0
    low: float = 0.0
    high: float = 0.0
    flown: float = 0.0
    legs: dict[str, tuple[float, float]] = field(default_factory=dict)
    outside: list[str] = field(default_factory=list)
    whole: bool = True

    @property
    def ratio(self) -> float:
        return self.planned / self.flown if self.flown else float("nan")

    @property
    def good_legs(self) -> int:
        return sum(abs(planned / flown - 1.0) <= LEGS_WITHIN for planned, flown in self.legs.values())

    @property
    def is_true(self) -> bool:
        exact = abs(self.ratio - 1.0) <= WITHIN or not self.whole
        return exact and self.low <= self.flown <= self.high

    def line(self) -> str:
        end = "" if self.whole else "  not completed"
        return (
            f"{self.flight:26} {self.robot:8} {self.way:8}"
            f" {self.planned:8.1f} {self.low:8.1f} {self.high:8.1f} {self.flown:8.1f} {self.ratio:6.3f}"
            f"  {self.good_legs:3} of {len(self.legs):3}"
            f"  {'' if self.is_true else 'deviates'}{end}"
        ).rstrip()


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("flights", nargs="*", type=Path, metavar="FLIGHT")
    parser.add_argument("--px4", action="append", type=Path, default=[], help="a flight with a PX4")
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
            print(each.line())
            if given.legs:
                print(*details(each), sep="\n")
    legs, good = sum(len(each.legs) for each in found), sum(each.good_legs for each in found)
    print(f"\nlegs within 15 %: {good} of {legs}, {good / legs:.1%}" if legs else "\nno legs")
    return (
        0 if not missing and legs and good >= MOST_LEGS * legs and all(each.is_true for each in found) else 1
    )


def details(each: Comparison) -> list[str]:
    legs = [
        f"    {move}: planned {planned:.2f}, flown {flown:.2f}"
        for move, (planned, flown) in each.legs.items()
        if abs(planned / flown - 1.0) > LEGS_WITHIN
    ]
    return [*legs, *(f"    outside its bounds: {words}" for words in each.outside)]


def compared(folder: Path, *, px4: bool = False) -> list[Comparison]:
    """Return the comparisons of the robots that were recorded in a folder.

    Raises:
        NotComparableError: nothing that was flown is there.
    """
    session, loaded = opened(folder, px4=px4)
    found = []
    for robot in loaded.program.robots:
        track, log = track_of(folder, robot), folder / "logs" / f"{robot.id}.jsonl"
        if log.is_file():
            found.append(_steps(folder.name, session, loaded, robot, log, track))
        elif track:
            found.append(_mission(folder.name, session, loaded, robot, track))
    if not found:
        raise NotComparableError("there is neither a log nor a track of any robot")
    return found


@cache
def opened(folder: Path, *, px4: bool = False) -> tuple[Session, Loaded]:
    """Return the models of a flight; `px4`: its types state that autopilot."""
    session = Session(Settings())
    loaded = load_behaviour(session, folder / "behaviour.xmi")
    if px4:
        pilot = Device("autopilot", {}, {"mavlink.autopilot": "px4"})
        types = {
            name: replace(each, devices={**each.devices, "autopilot": pilot})
            for name, each in loaded.place.types.items()
        }
        loaded = replace(loaded, place=replace(loaded.place, types=types))
    return session, loaded


def _steps(
    flight: str,
    session: Session,
    loaded: Loaded,
    robot: RobotProgram,
    log: Path,
    track: Sequence[Sample],
) -> Comparison:
    """Return the comparison of a robot that was commanded step by step, runs as missions."""
    records = [json.loads(line) for line in log.read_text().splitlines()]
    times = [(each["label"], each["move"], float(each["time"])) for each in records]
    clock = Clock(times, track, robot, session, loaded)
    flown = _spans(times, clock)
    found = Comparison(flight, robot.id, "steps")
    _fill(found, flown, session, loaded, robot, uploaded=False)
    found.whole = bool(times) and times[-1][0] == "end" and times[-1][1] == robot.moves[robot.stop].id
    return found


def _mission(
    flight: str, session: Session, loaded: Loaded, robot: RobotProgram, track: Sequence[Sample]
) -> Comparison:
    """Return the comparison of a robot that flew all of its moves as a mission."""
    contributions = session.contributions
    place = loaded.place
    input = TargetInput(
        loaded.program,
        place.types,
        contributions.robot_kinds,
        contributions.move_kinds,
        extensions=contributions.extensions,
    )
    (items, *_) = sorties_of(context_of(robot, input))
    begun = next((each.time for each in track if each.armed and each.mode in AUTO), 0.0)
    flying = [each for each in track if each.armed and (each.mode in AUTO or 0.0 < begun - each.time < ARMED)]
    if not flying:
        raise NotComparableError(f"{robot.id} has no log, and its track shows no mission")
    moves: dict[str, float] = {}
    for one, two in pairwise(flying):
        item = items[max(one.item, 1) - 1] if one.item <= len(items) else None
        if item is not None and item.command in (WAYPOINT, TAKE_OFF):
            moves[item.move.id] = moves.get(item.move.id, 0.0) + two.time - one.time
    last = items[flying[-1].item - 1].move.id if 0 < flying[-1].item <= len(items) else ""
    ended = not track[-1].armed
    if not ended:
        moves.pop(last, None)
    found = Comparison(flight, robot.id, "mission", whole=ended)
    _fill(
        found,
        {move: (seconds, seconds) for move, seconds in moves.items()},
        session,
        loaded,
        robot,
        uploaded=True,
    )
    if ended:
        _fill_whole(found, flying, session, loaded, robot)
    return found


def _fill(
    found: Comparison,
    flown: Mapping[str, tuple[float, float]],
    session: Session,
    loaded: Loaded,
    robot: RobotProgram,
    *,
    uploaded: bool,
) -> None:
    """Compare what was flown, as seconds of movement, and with actions, by move."""
    planned, bounds = planned_of(session, loaded, robot, uploaded=uploaded)
    legs = legs_of(robot, session, loaded)
    for move, (moved, whole) in flown.items():
        if move not in planned:
            continue
        found.planned += planned[move][1]
        found.flown += whole
        low, high = bounds[move].whole.low, bounds[move].whole.high
        found.low, found.high = found.low + low, found.high + high
        least = bounds[move].moved.low - bounds[move].before.low
        most = bounds[move].moved.high - bounds[move].before.high
        if not least - RECORDED <= moved <= most + RECORDED:
            found.outside.append(f"{move}: {moved:.2f} of {least:.2f} to {most:.2f}")
        if move in legs and moved > RECORDED:
            found.legs[move] = (planned[move][0], moved)


def _fill_whole(
    found: Comparison,
    flying: Sequence[Sample],
    session: Session,
    loaded: Loaded,
    robot: RobotProgram,
) -> None:
    """Compare the whole flight: of a mission nothing tells when each action ended."""
    planned, bounds = planned_of(session, loaded, robot, uploaded=True)
    found.planned = sum(whole for _, whole in planned.values())
    found.low = sum(bounds[move].whole.low for move in planned)
    found.high = sum(bounds[move].whole.high for move in planned)
    found.flown = flying[-1].time - flying[0].time


def _spans(steps: Iterable[tuple[str, str, float]], clock: Clock) -> dict[str, tuple[float, float]]:
    """Return for each completed move how long it moved, and how long with its actions."""
    begun: dict[str, float] = {}
    moved: dict[str, float] = {}
    acted: dict[str, float] = {}
    before = 0.0
    for label, move, time in steps:
        if label == "begin":
            begun[move] = time
        elif label == "end" and move in begun:
            moved[move] = clock.passed(begun[move], time)
        elif label in ("act", "ntf"):
            acted[move] = acted.get(move, 0.0) + clock.passed(before, time)
        before = time
    return {move: (seconds, seconds + acted.get(move, 0.0)) for move, seconds in moved.items()}


def planned_of(
    session: Session, loaded: Loaded, robot: RobotProgram, *, uploaded: bool
) -> tuple[dict[str, tuple[float, float]], dict[str, Duration]]:
    """Return for each move how long it is planned to move, and to take with its actions; and its bounds."""
    contributions, place = session.contributions, loaded.place
    kinds = as_uploaded(contributions.robot_kinds) if uploaded else contributions.robot_kinds
    input = TargetInput(
        loaded.program,
        place.types,
        kinds,
        contributions.move_kinds,
        environment=place.environment or {},
        areas=place.areas or (),
        elements=place.elements,
    )
    check = CheckInput(
        loaded.program,
        place.types,
        kinds,
        contributions.move_kinds,
        place.areas,
        place.environment or {},
        place.elements,
    )
    durations = durations_of(check, robot, motions(check)[robot.id]).of
    bounds = {robot.moves[index].id: each for index, each in durations.items()}
    planned: dict[str, tuple[float, float]] = {}
    for each in planned_moves(robot, input):
        move = robot.moves[each.index]
        if each.seconds is not None:
            actions = (*move.before, *move.after)
            acting = sum(seconds_of(action, place.types[robot.type_name]) or 0.0 for action in actions)
            planned[move.id] = (each.seconds.expected - acting, each.seconds.expected)
    return planned, bounds


def legs_of(robot: RobotProgram, session: Session, loaded: Loaded) -> dict[str, tuple[Position, ...]]:
    """Return the paths of the moves that lead somewhere, from the robot's home, by move."""
    contributions, home = session.contributions, robot.home or (0.0, 0.0, 0.0)
    input = CheckInput(
        loaded.program, loaded.place.types, contributions.robot_kinds, contributions.move_kinds
    )
    return {
        robot.moves[path.move].id: tuple(
            (p[0] - home[0], p[1] - home[1], p[2] - home[2]) for p in path.points
        )
        for path in motions(input)[robot.id].paths
        if dist(path.points[0], path.points[-1]) > 0.0
    }


class Clock:
    """The vehicle's clock by that of the log: both are known where it comes to a stop at a target."""

    def __init__(
        self,
        times: Sequence[tuple[str, str, float]],
        track: Sequence[Sample],
        robot: RobotProgram,
        session: Session,
        loaded: Loaded,
    ) -> None:
        legs, stepped, runs = legs_of(robot, session, loaded), _stepped(robot, session), _runs(robot, session)
        known: list[tuple[float, float]] = []
        periods = iter(_missions(track))
        passed: dict[str, float] = {}
        for label, move, time in times if track else ():
            about = time - (known[-1][1] if known else 0.0)
            run = next((each for each in runs if each[0] == move), None)
            seen = None
            if label == "begin" and run is not None and (period := next(periods, None)) is not None:
                seen, *ends = period
                passed |= dict(zip(run, ends, strict=False))
            elif label == "end" and move in passed:
                seen = passed[move]
            elif label == "end" and move in stepped and move in legs:
                seen = _stop_at(legs[move][-1], track, about, 15.0 if known else 60.0)
            if seen is not None:
                known.append((time, time - seen))
        landed = [(time, move) for label, move, time in times if label == "end" and move in legs]
        if landed and known and legs[landed[-1][1]][-1][2] < NEAR < legs[landed[-1][1]][0][2]:
            known.append((landed[-1][0], landed[-1][0] - max(each.time for each in track if each.armed)))
        ahead = [each for _, each in known]
        self._at = [time for time, _ in known]
        self._ahead = [median(ahead[max(0, i - 1) : i + 2]) for i in range(len(ahead))]

    def passed(self, begin: float, end: float) -> float:
        """Return the vehicle's seconds between two times of the log.

        Where a stop shows on a track to a few tenths of a second only, the log counts, but for stalls.
        """
        seconds = self.at(end) - self.at(begin)
        return seconds if end - begin - seconds > STALL else end - begin

    def at(self, time: float) -> float:
        """Return the vehicle's time at a time of the log."""
        if not self._at:
            return time
        after = bisect_right(self._at, time)
        if after == 0 or after == len(self._at):
            return time - self._ahead[0 if after == 0 else -1]
        one, two = self._at[after - 1], self._at[after]
        part = (time - one) / (two - one) if two > one else 0.0
        return time - (self._ahead[after - 1] + part * (self._ahead[after] - self._ahead[after - 1]))


def _runs(robot: RobotProgram, session: Session) -> list[list[str]]:
    """Return the runs of a robot, as moves."""
    found = runs_of(robot, session.contributions.move_kinds)
    return [[robot.moves[index].id for index in run] for run in found]


def _stepped(robot: RobotProgram, session: Session) -> set[str]:
    """Return the moves whose ends show on a track: those that lead to places and are no part of a run."""
    flown = {move for run in _runs(robot, session) for move in run}
    return {
        move.id
        for move in robot.moves
        if move.id not in flown and move.target is not None and move.target.position is not None
    }


def _missions(track: Sequence[Sample]) -> list[list[float]]:
    """Return for each mission that was flown when it began, and when each leg of it ended."""
    found: list[list[float]] = []
    item, since = 0, 0.0
    for one, two in pairwise(track):
        if two.mode in AUTO and one.mode not in AUTO:
            found.append([two.time])
            item, since = two.item, two.time
        elif one.mode in AUTO and (two.mode not in AUTO or two.item != item):
            if two.time - since > ITEM or two.mode not in AUTO:
                found[-1].append(two.time)
            item, since = two.item, two.time
    return found


def _stop_at(place: Position, track: Sequence[Sample], about: float, within: float) -> float | None:
    """Return when the vehicle came to a stop at a place, nearest to a time; None: it is not seen to."""
    near = [
        each.speed <= STILL
        and hypot(each.place[0] - place[0], each.place[1] - place[1]) <= NEAR
        and abs(each.place[2] - place[2]) <= NEAR
        for each in track
    ]
    begins = [track[i].time for i in range(1, len(track)) if near[i] and not near[i - 1]]
    close = [time for time in begins if abs(time - about) <= within]
    return min(close, key=lambda time: abs(time - about)) if close else None


def track_of(folder: Path, robot: RobotProgram) -> list[Sample]:
    """Return a robot's track, from where it was armed; empty where none was recorded."""
    file = folder / f"{robot.id}.track.csv.gz"
    if not file.is_file():
        return []
    with gzip.open(file, "rt") as rows:
        found = [{name: float(value) for name, value in row.items()} for row in csv.DictReader(rows)]
    if not found:
        return []
    home = next((each for each in found if each["armed"]), found[0])
    east = DEGREE * cos(radians(home["lat"]))
    return [
        Sample(
            each["t"],
            ((each["lon"] - home["lon"]) * east, (each["lat"] - home["lat"]) * DEGREE, each["rel"]),
            hypot(each["vx"], each["vy"], each["vz"]),
            bool(each["armed"]),
            int(each["mode"]),
            int(each["seq"]),
        )
        for each in found
    ]


if __name__ == "__main__":
    sys.exit(main())
