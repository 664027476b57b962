"""One robot of a recorded flight: what it was planned, and checked, to take, and what it took."""

import json
from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path

from flown_times.clock import Clock, Step
from flown_times.models import ACCEPTANCE, SPEEDS, Estimate, Modelled, opened
from flown_times.tracks import AUTO, Sample, track_in
from mmrs_mavlink.plugin.plans.items import TAKE_OFF, WAYPOINT

WITHIN, LEGS_WITHIN, MOST_LEGS = 0.05, 0.15, 0.95
"""Share of the planned time within which a flight and a leg count, and share of the legs that must."""

RECORDED = 0.1
"""Seconds to which recordings tell when a step was done."""

ARMED = 5.0
"""Seconds before its mission from which a vehicle is armed for it."""


class NotComparableError(Exception):
    """What was recorded shows no flight of the models."""


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

    def line(self) -> str:
        end = "" if self.whole else "  not completed"
        return (
            f"{self.flight:26} {self.robot:8} {self.way:8}"
            f" {self.planned:8.1f} {self.low:8.1f} {self.high:8.1f} {self.flown:8.1f} {self.ratio:6.3f}"
            f"  {self.good_legs:3} of {len(self.legs):3}"
            f"  {'deviates' if any(self.faults()) else ''}{end}"
        ).rstrip()

    def faults(self) -> Iterator[str]:
        """Yield what is not as planned and checked, in words."""
        if self.whole and abs(self.ratio - 1.0) > WITHIN:
            yield f"'{self.robot}': {self.flown:.0f} s, planned {self.planned:.0f} s"
        if not self.low <= self.flown <= self.high:
            yield f"'{self.robot}': {self.flown:.0f} s, checked {self.low:.0f} to {self.high:.0f} s"
        yield from (f"'{self.robot}': {words}" for words in self.outside)

    def add(self, moved: Mapping[str, tuple[float, float]], modelled: Modelled, *, uploaded: bool) -> None:
        """Compare what was flown, as seconds of movement, and with actions, by move."""
        estimates = modelled.estimates(uploaded=uploaded)
        for move, (seconds, whole) in moved.items():
            known = estimates.get(move)
            if known is None:
                continue
            self._sum(known, whole)
            if not known.least - RECORDED <= seconds <= known.most + RECORDED:
                self.outside.append(f"{move}: {seconds:.2f} of {known.least:.2f} to {known.most:.2f}")
            if move in modelled.legs and seconds > RECORDED:
                self.legs[move] = (known.moving, seconds)

    def _sum(self, known: Estimate, whole: float) -> None:
        self.planned, self.flown = self.planned + known.whole, self.flown + whole
        self.low, self.high = self.low + known.bounds.whole.low, self.high + known.bounds.whole.high

    def set_whole(self, seconds: float, modelled: Modelled) -> None:
        """Compare the whole flight of a mission: nothing tells when each action of it ended."""
        known = modelled.estimates(uploaded=True).values()
        self.planned, self.flown = sum(each.whole for each in known), seconds
        self.low = sum(each.bounds.whole.low for each in known)
        self.high = sum(each.bounds.whole.high for each in known)


def compared(
    folder: Path, *, px4: bool = False, without: Container[tuple[str, str]] = ()
) -> list[Comparison]:
    """Return the comparisons of the robots that were recorded in a folder.

    Args:
        folder: of the flight.
        px4: whether a PX4 flew that the types do not state.
        without: robots and moves that are left out, since something happened to them.

    Raises:
        NotComparableError: nothing that was flown is there.
    """
    session, loaded = opened(folder, px4=px4)
    found = []
    for robot in loaded.program.robots:
        modelled = Modelled(session, loaded, robot, ACCEPTANCE.get(folder.name), SPEEDS.get(folder.name))
        track = track_in(folder / f"{robot.id}.track.csv.gz")
        log = folder / "logs" / f"{robot.id}.jsonl"
        if log.is_file():
            found.append(_steps(folder.name, modelled, log, track, without))
        elif track:
            found.append(_mission(folder.name, modelled, track))
    if not found:
        raise NotComparableError("there is neither a log nor a track of any robot")
    return found


def _steps(
    flight: str, modelled: Modelled, log: Path, track: Sequence[Sample], without: Container[tuple[str, str]]
) -> Comparison:
    """Return the comparison of a robot that was commanded step by step, runs as missions."""
    robot = modelled.robot
    records = [json.loads(line) for line in log.read_text().splitlines()]
    steps = [(each["label"], each["move"], float(each["time"])) for each in records]
    found = Comparison(flight, robot.id, "steps")
    spans = _spans(steps, Clock(steps, track, modelled), modelled)
    moved = {move: span for move, span in spans.items() if (robot.id, move) not in without}
    found.add(moved, modelled, uploaded=False)
    found.whole = bool(steps) and steps[-1][:2] == ("end", robot.moves[robot.stop].id)
    return found


def _mission(flight: str, modelled: Modelled, track: Sequence[Sample]) -> Comparison:
    """Return the comparison of a robot that flew all of its moves as a mission."""
    items = modelled.items()
    last = len(
        items
    )  # since the first is 1; beyond it, the mission is complete, and some vehicles stay armed
    begun = next((each.time for each in track if each.armed and each.mode in AUTO), 0.0)
    flying = [
        each
        for each in track
        if each.armed and each.item <= last and (each.mode in AUTO or 0.0 < begun - each.time < ARMED)
    ]
    if not flying:
        raise NotComparableError(f"{modelled.robot.id} has no log, and its track shows no mission")
    moves: dict[str, float] = {}
    for one, two in pairwise(flying):
        item = items[max(one.item, 1) - 1]
        if item.command in (WAYPOINT, TAKE_OFF):
            moves[item.move.id] = moves.get(item.move.id, 0.0) + two.time - one.time
    ended = not track[-1].armed or track[-1].item > last
    if not ended and flying[-1].item > 0:
        moves.pop(items[flying[-1].item - 1].move.id, None)
    found = Comparison(flight, modelled.robot.id, "mission", whole=ended)
    found.add({move: (seconds, seconds) for move, seconds in moves.items()}, modelled, uploaded=True)
    if ended:
        found.set_whole(flying[-1].time - flying[0].time, modelled)
    return found


def _spans(steps: Iterable[Step], clock: Clock, modelled: Modelled) -> dict[str, tuple[float, float]]:
    """Return for each completed move how long it moved, and how long with its actions.

    Stays end by the program's clock, whatever the vehicle's shows.
    """
    begun: dict[str, float] = {}
    moved: dict[str, float] = {}
    acted: dict[str, float] = {}
    before = 0.0
    for label, move, time in steps:
        if label == "begin":
            begun[move] = time
        elif label == "end" and move in begun:
            moved[move] = time - begun[move] if move in modelled.stays else clock.passed(begun[move], time)
        elif label in ("act", "ntf"):
            acted[move] = acted.get(move, 0.0) + clock.passed(before, time)
        before = time
    return {move: (seconds, seconds + acted.get(move, 0.0)) for move, seconds in moved.items()}
