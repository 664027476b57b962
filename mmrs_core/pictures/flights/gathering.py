"""Reads logs and black boxes of one flight, whatever state they are in."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from types import MappingProxyType

from mmrs_core.behaviour.box_files import SIMULATION, BlackBox, black_boxes, is_part
from mmrs_core.behaviour.log import logs_in, recover_log
from mmrs_core.behaviour.program import Program, RobotProgram
from mmrs_core.contributions.rules import RobotKind
from mmrs_core.errors import InvalidModelError, UnreadableError
from mmrs_core.pictures.flights.clocks import Readings, Shift, shifts_of, zero_of
from mmrs_core.pictures.flights.fixes import Datum, Fixes, datum_of
from mmrs_core.pictures.flights.flight import Flight, Flown
from mmrs_core.scene import Name, RobotType
from mmrs_runtime.records.entries import Damage, Entry, number_of
from mmrs_runtime.records.steps import StepRecord

MOST_ENTRIES = 100_000
"""Entries of one robot that are kept, without fixes and messages."""
_MOST_DAMAGES = 20


@dataclass(slots=True)
class _Contents:
    """What the box of one robot contains, so far."""

    fixes: Fixes = field(default_factory=Fixes)
    entries: list[Entry] = field(default_factory=list)
    messages: int = 0
    counts: list[Counter[str]] = field(default_factory=list)
    runs: dict[str, None] = field(default_factory=dict)
    dropped: int = 0
    wall: str = ""
    clock: Readings = field(default_factory=Readings)

    def add(self, entry: Entry) -> None:
        """Take an entry."""
        self.runs[entry.run] = None
        self.wall = self.wall or entry.wall
        self.clock.add(entry)
        if entry.kind == "start" or not self.counts:
            self.counts.append(Counter())
        if entry.kind == "fix":
            self.fixes.add(entry)
        elif entry.kind == "message":
            self.messages += 1
        elif entry.kind == "counted":
            self._count(entry)
        elif len(self.entries) < MOST_ENTRIES:
            self.entries.append(entry)
        else:
            self.dropped += 1

    def _count(self, entry: Entry) -> None:
        """Keep the newest counts of each process that the robot had: they only grow."""
        frames = entry.content.get("frames")
        for name, count in _flat(frames) if isinstance(frames, Mapping) else ():
            self.counts[-1][name] = max(self.counts[-1][name], count)

    @property
    def vehicle(self) -> str:
        """Return the class of vehicle; empty where the box does not name it."""
        starts = (each.content.get("vehicle") for each in self.entries if each.kind == "start")
        return next((each for each in starts if isinstance(each, str)), "")

    @property
    def simulated(self) -> bool:
        """Return whether there was no vehicle: in a simulation, and in a dry run."""
        starts = (each.content for each in self.entries if each.kind == "start")
        return any(each.get("link") == SIMULATION or each.get("dry_run") is True for each in starts)


def _flat(frames: Mapping[object, object]) -> Iterator[tuple[str, int]]:
    """Yield names and numbers; of numbers by a further name, ``name: further``."""
    for name, count in frames.items():
        number = number_of(count)
        if number is not None:
            yield str(name), int(number)
        elif isinstance(count, Mapping):
            yield from ((f"{name}: {further}", inner) for further, inner in _flat(count))


def read_flight(
    paths: Sequence[Path],
    program: Program,
    types: Mapping[str, RobotType],
    kinds: Mapping[Name, RobotKind] = MappingProxyType({}),
) -> Flight:
    """Return what logs and black boxes tell; damages are in the flight, in words.

    Args:
        paths: logs, parts of black boxes, or folders of them.
        program: the behaviour whose run it was.
        types: of its robots, by name, as far as they are known.
        kinds: of robots, by metaclass.

    Raises:
        UnreadableError: if a file cannot be opened, or there is neither log nor black box.
        InvalidModelError: if none of them is of a robot of the behaviour.
    """
    absent = next((path for path in paths if not path.exists() and not is_part(path)), None)
    if absent is not None:
        raise UnreadableError(f"{absent}: no such file or folder")
    damages: list[str] = []
    steps = _steps(paths, damages)
    readable = not damages
    boxes = black_boxes(paths)
    if not steps and not boxes:
        raise UnreadableError(f"{', '.join(map(str, paths))}: contains no log and no black box")
    contents = _contents(boxes, damages)
    known = {robot.id for robot in program.robots}
    reported = {*steps, *contents}
    if reported and not reported & known:
        strangers, robots_here = ", ".join(sorted(reported)), ", ".join(sorted(known))
        raise InvalidModelError(f"these are of {strangers}: the behaviour has only {robots_here}")
    for stranger in sorted(reported - known):
        damages.append(f"{stranger}: no such robot in the behaviour; left out")
    damages += _runs(steps, contents)
    for robot in program.robots:
        given = steps.get(robot.id, [])
        steps[robot.id] = [record for record in given if _is_of(robot, record)]
        if strange := len(given) - len(steps[robot.id]):
            damages.append(
                f"{robot.id}: {strange} steps are of moves or actions that the behaviour does not have"
            )
    shifts, notes = shifts_of({id: contents[id].clock for id in known & contents.keys()})
    damages += notes
    robots = {
        robot.id: _moved(
            _flown(
                robot.id,
                steps.get(robot.id, ()),
                contents.get(robot.id, _Contents()),
                datum_of(
                    robot,
                    program,
                    types.get(robot.type_name),
                    contents.get(robot.id, _Contents()).vehicle,
                    kinds,
                ),
                damages,
            ),
            shifts.get(robot.id),
        )
        for robot in program.robots
    }
    begun = min((each.wall for each in contents.values() if each.wall), default="")
    run = next((each for each in (*_of_steps(steps), *_of_boxes(contents)) if each), "")
    whole = readable and all(flown.records for flown in robots.values())
    zero = zero_of(contents[id].clock for id in known & contents.keys())
    return Flight(run, robots, tuple(damages), len(boxes), whole, begun, zero)


def _is_of(robot: RobotProgram, record: StepRecord) -> bool:
    """Return whether a step names a move of the robot, and an action that this move has."""
    move = next((move for move in robot.moves if move.id == record.move), None)
    if move is None or record.label not in ("act", "ntf"):
        return move is not None
    side, _, index = record.detail.partition(":")
    actions = {"pre": move.before, "post": move.after}.get(side, ())
    return index.isdecimal() and len(index) < 6 and int(index) < len(actions)


def _steps(paths: Sequence[Path], damages: list[str]) -> dict[str, list[StepRecord]]:
    steps: dict[str, list[StepRecord]] = {}
    for path in logs_in(paths):
        records, unread = recover_log(path)
        damages += _listed(unread, len(unread))
        for record in records:
            steps.setdefault(record.robot, []).append(record)
    return steps


def _contents(boxes: Iterable[BlackBox], damages: list[str]) -> dict[str, _Contents]:
    contents: dict[str, _Contents] = {}
    for box in boxes:
        unread: list[Damage] = []
        count = 0

        def tell(damage: Damage, unread: list[Damage] = unread) -> None:
            nonlocal count
            count += 1
            if len(unread) < _MOST_DAMAGES:
                unread.append(damage)

        for entry in box.entries(tell):
            contents.setdefault(entry.robot, _Contents()).add(entry)
        damages += [*box.missing, *_listed(unread, count)]
    return contents


def _listed(unread: Sequence[Damage], count: int) -> Iterator[str]:
    yield from map(str, unread[:_MOST_DAMAGES])
    if count > _MOST_DAMAGES:
        yield f"{unread[0].file}: {count - _MOST_DAMAGES} more lines cannot be read"


def _flown(
    robot: str, records: Sequence[StepRecord], contents: _Contents, datum: Datum, damages: list[str]
) -> Flown:
    fixes = contents.fixes
    track = fixes.track(datum, exact=contents.simulated)
    if fixes.unplaced:
        damages.append(f"{robot}: {fixes.unplaced} fixes have no place in the frame of the behaviour")
    if fixes.astray:
        damages.append(f"{robot}: {fixes.astray} fixes have times that make no sense; they are left out")
    if fixes.turned:
        damages.append(
            f"{robot}: the time of {fixes.turned} fixes goes back; they count as of the one before"
        )
    if contents.dropped:
        damages.append(f"{robot}: {contents.dropped} entries beyond {MOST_ENTRIES} are left out")
    counted: Counter[str] = sum(contents.counts, Counter())
    entries = tuple(contents.entries)
    return Flown(
        robot,
        tuple(records),
        track,
        entries,
        contents.messages,
        counted,
        contents.simulated,
        contents.vehicle,
    )


def _moved(flown: Flown, shift: Shift | None) -> Flown:
    """Return what a robot did, by the clock of the others."""
    if shift is None:
        return flown
    return replace(
        flown,
        records=tuple(each._replace(time=shift.time(each.time)) for each in flown.records),
        track=replace(flown.track, times=shift.times(flown.track.times)),
        entries=tuple(replace(each, time=shift.time(each.time)) for each in flown.entries),
    )


def _runs(steps: Mapping[str, Sequence[StepRecord]], contents: Mapping[str, _Contents]) -> Iterator[str]:
    runs = {*_of_steps(steps), *_of_boxes(contents)}
    if len(runs) > 1:
        yield f"these are of different runs: {', '.join(map(repr, sorted(runs)))}"


def _of_steps(steps: Mapping[str, Sequence[StepRecord]]) -> dict[str, None]:
    return dict.fromkeys(record.run for records in steps.values() for record in records)


def _of_boxes(contents: Mapping[str, _Contents]) -> dict[str, None]:
    return dict.fromkeys(run for each in contents.values() for run in each.runs)
