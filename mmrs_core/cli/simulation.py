"""Runs a behaviour in simulation and keeps its logs."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from heapq import merge
from itertools import pairwise
from math import dist, inf
from operator import itemgetter
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

import typer

from mmrs_core.behaviour.box_files import SIMULATION, black_boxes
from mmrs_core.behaviour.log import read_log
from mmrs_core.behaviour.program import Program, RobotProgram
from mmrs_core.cli.output import progress
from mmrs_core.cli.protection import ProtectedError
from mmrs_core.cli.session import Session
from mmrs_core.contributions.execution import Sample
from mmrs_core.contributions.registry import Contributions
from mmrs_core.contributions.rules import robot_kind_of
from mmrs_core.contributions.vehicles import VehicleFactory
from mmrs_core.errors import MmrsError, UnsupportedError
from mmrs_core.pictures.figures import clock, length
from mmrs_core.pipeline import BehaviourContext, simulate
from mmrs_core.resources import named, new_folders
from mmrs_core.scene import Position, RobotType
from mmrs_core.simulation.run import SimulatedRun
from mmrs_runtime.records.blackbox import black_box_path
from mmrs_runtime.records.log import LogWriter
from mmrs_runtime.records.steps import SUFFIX, StepRecord, log_name
from mmrs_runtime.semantics import Outcome

if TYPE_CHECKING:
    from mmrs_core.pictures.flights.fixes import Datum
    from mmrs_core.pictures.flights.photos import Shot

_HOLDS = {"yes": True, "true": True, "no": False, "false": False}


def answers(given: Sequence[str] | None) -> Mapping[str, bool]:
    """Return what conditions are to answer, from ``IDENTIFIER=yes`` or ``=no``.

    Raises:
        typer.BadParameter: if it is written otherwise.
    """
    found: dict[str, bool] = {}
    for each in given or ():
        identifier, _, answer = each.rpartition("=")
        if not identifier or answer.lower() not in _HOLDS:
            raise typer.BadParameter(f"--assume {each}: expected CONDITION=yes or CONDITION=no")
        found[identifier] = _HOLDS[answer.lower()]
    return found


@dataclass(frozen=True, slots=True)
class Chosen:
    """The backends of a run.

    Attributes:
        backend: name of the usual one. own: by robot, those of others.
        options: by key; ``ROBOT:KEY`` is for the backend of one robot.
    """

    backend: str = "simulation"
    options: Mapping[str, str] = field(default_factory=dict)
    own: Mapping[str, str] = field(default_factory=dict)


def backends_of(given: Sequence[str] | None, usual: str) -> tuple[str, Mapping[str, str]]:
    """Return the usual backend, and those that robots have for themselves, from ``[ROBOT=]NAME``.

    Raises:
        typer.BadParameter: if two are usual, or a robot has two.
    """
    own: dict[str, str] = {}
    for robot, sign, name in (each.rpartition("=") for each in given or ()):
        if robot in own:
            whose = f"'{robot}' has" if sign else "all other robots have"
            raise typer.BadParameter(f"--backend {name}: {whose} {own[robot]} already")
        own[robot] = name
    return own.pop("", usual), own


def options_of(given: Sequence[str] | None) -> Mapping[str, str]:
    """Return the options of a backend, from ``KEY=VALUE``.

    Raises:
        typer.BadParameter: if it is written otherwise.
    """
    pairs = [each.partition("=") for each in given or ()]
    for key, sign, _ in pairs:
        if not key or not sign:
            raise typer.BadParameter(f"--backend-option {key}{sign}: expected KEY=VALUE")
    return {key: value for key, _, value in pairs}


def fly(
    session: Session,
    program: Program,
    place: BehaviourContext,
    conditions: Mapping[str, bool],
    chosen: Chosen = Chosen(),
) -> SimulatedRun:
    """Return the simulated run of a behaviour.

    Raises:
        UsageError: if there is no such backend, or it does not simulate or know its options, or no Choice
            asks for one of the conditions.
        UnsupportedError: if robot types are missing, or it does not know what the behaviour holds.
    """
    used = dict.fromkeys(robot.type_name for robot in program.robots)
    if missing := [name for name in used if name not in place.types]:
        words = (
            f"{program.name}: cannot be simulated without its robot types: {', '.join(map(repr, missing))}"
        )
        raise UnsupportedError(f"{words}; --robots gives their files, or put these into robots/ beside it")

    def make() -> SimulatedRun:
        with progress("simulating") as show:

            def observe(record: StepRecord) -> None:
                show(clock(record.time))
                session.observers.see_step(record)

            return simulate(
                program,
                place,
                session.contributions,
                backend=chosen.backend,
                own_backends=chosen.own,
                options=chosen.options,
                assume=conditions,
                observe=observe,
            )

    return session.stage("simulate", "simulating", make)


def write_logs(
    run: SimulatedRun,
    program: Program,
    folder: Path,
    types: Mapping[str, RobotType] | None = None,
    contributions: Contributions | None = None,
) -> tuple[Path, ...]:
    """Write the log and the black box of every robot, all or none; return the logs.

    What an earlier simulation left there of other robots goes away.

    Raises:
        ProtectedError: if the black box of a flight lies there.
        OSError: if the folder cannot be written to.
    """
    names = [log_name(robot.id) for robot in program.robots]
    with new_folders() as make:
        make(folder)
        with TemporaryDirectory(prefix=".mmrs-", dir=folder) as staged, _named_in(folder):
            with LogWriter(Path(staged), synced=False) as writer:
                for record in run.records:
                    writer.write(record)
            write_boxes(run, program, types or {}, Path(staged), contributions)
            remove_boxes(folder)
            _remove_older(folder, set(names))
            for file in sorted(Path(staged).iterdir()):
                file.replace(folder / file.name)
    return tuple(folder / name for name in names if (folder / name).exists())


@contextmanager
def _named_in(folder: Path) -> Iterator[None]:
    """Let errors about a file name it as it is called in a folder."""
    try:
        yield
    except OSError as error:
        if error.filename is not None:
            error.filename = str(folder / Path(error.filename).name)
        raise


def _remove_older(folder: Path, kept: set[str]) -> None:
    for path in folder.glob(f"*{SUFFIX}"):
        if path.name not in kept and _is_log(path):
            path.unlink()


def _is_log(path: Path) -> bool:
    try:
        return bool(read_log(path, partial=True))
    except MmrsError:
        return False


def run_lines(run: SimulatedRun) -> Iterator[str]:
    """Yield how a run went: the outcome, each robot's way, faults and waits."""
    ending = run.ending
    yield f"{ending.outcome.value} after {clock(ending.time)}, {ending.steps} steps"
    for robot, track in run.tracks.items():
        points = [(sample.east, sample.north, sample.up) for sample in track]
        flown = sum(dist(a, b) for a, b in pairwise(points))
        left = _energy_left(track[0].energy, track[-1].energy) if track else ""
        yield f"  {robot}: {length(flown)}{left}"
    for robot, fault in ending.faults.items():
        yield f"  fault of '{robot}': {fault}"
    for waiting in ending.waiting:
        yield f"  {waiting}"
    for note in run.notes:
        yield f"  note: {note}"


def _energy_left(full: float | None, left: float | None) -> str:
    if full is None or left is None or full in (0.0, float("inf")):
        return ""
    return f", {100 * left / full:.0f} % energy remaining"


def succeeded(run: SimulatedRun) -> bool:
    """Return whether every robot came to its end."""
    return run.ending.outcome is Outcome.SUCCESS


def box_name(robot: str) -> str:
    """Return the name of a robot's black box, which lies beside its log."""
    return black_box_path(Path(log_name(robot))).name


def refuse_flights(folder: Path) -> None:
    """Refuse a folder with black boxes of flights; those of simulations may be replaced.

    Raises:
        ProtectedError: if one does.
    """
    for box in black_boxes([folder] if folder.is_dir() else []):
        first = next(box.entries(lambda damage: None), None)
        if first is None or first.content.get("link") != SIMULATION:
            raise ProtectedError(f"{box.parts[0]}: is the black box of a flight, and is not replaced")


def remove_boxes(folder: Path) -> None:
    """Remove the black boxes of earlier simulations."""
    refuse_flights(folder)
    for box in black_boxes([folder]):
        for part in box.parts:
            part.unlink()


def write_boxes(
    run: SimulatedRun,
    program: Program,
    types: Mapping[str, RobotType],
    folder: Path,
    contributions: Contributions | None = None,
) -> tuple[Path, ...]:
    """Write a black box for every robot whose way the simulation tells; return the paths.

    Places are metres from home; between two of them a robot went straight. There is no time of day. Photos
    that a camera takes by distance are there one by one.
    """
    from mmrs_core.pictures.flights.fixes import datum_of

    name = run.records[0].run if run.records else ""
    kinds = contributions.robot_kinds if contributions is not None else {}
    vehicles = tuple(contributions.vehicles.values()) if contributions is not None else ()
    written = []
    for robot in program.robots:
        if track := run.tracks.get(robot.id):
            path = folder / box_name(robot.id)
            robot_type = types.get(robot.type_name)
            kind = robot_kind_of(robot_type, kinds) if robot_type is not None else None
            datum = datum_of(robot, program, robot_type, kinds=kinds)
            photos = _photos(run, robot, track, datum, robot_type, vehicles)
            lines = _lines(name, robot.id, track, datum, kind.vehicle if kind is not None else "", photos)
            with named(path):
                path.write_text("".join(f"{line}\n" for line in lines), encoding="utf-8")
            written.append(path)
    return tuple(written)


def _photos(
    run: SimulatedRun,
    robot: RobotProgram,
    track: Sequence[Sample],
    datum: Datum,
    robot_type: RobotType | None,
    vehicles: Iterable[VehicleFactory],
) -> tuple[Shot, ...]:
    """Return all photos of a robot, those by distance where it was when they were due."""
    import numpy as np

    from mmrs_core.pictures.flights.flight import Flown
    from mmrs_core.pictures.flights.photos import shots_of
    from mmrs_core.pictures.flights.tracks import Track

    times, positions = (np.array([getattr(each, what) for each in track]) for what in ("time", "position"))
    whole = Track(times, positions, np.full(len(track), np.nan), np.zeros(len(track), np.bool_))
    records = tuple(each for each in run.records if each.robot == robot.id)
    return shots_of(robot, Flown(robot.id, records, whole, simulated=True), datum, robot_type, vehicles)


def _lines(
    run: str, robot: str, track: Sequence[Sample], datum: Datum, vehicle: str, photos: Sequence[Shot]
) -> Iterator[str]:
    full = track[0].energy
    common = {"run": run, "robot": robot}

    def line(time: float, kind: str, **content: object) -> tuple[float, str]:
        whole = {**common, "time": round(time, 6), "wall": "", "kind": kind, **content}
        return time, json.dumps(whole, ensure_ascii=False, separators=(",", ":"), allow_nan=False)

    def place(position: Position) -> dict[str, float]:
        east, north, up = position
        found = {"north": north - datum.home[1], "east": east - datum.home[0], "height": up - datum.up}
        return {name: round(value, 3) for name, value in found.items()}

    def fix(sample: Sample) -> tuple[float, str]:
        left = None if not full or sample.energy is None or full == inf else round(sample.energy / full, 4)
        more = {"speed": None, "heading": None, "energy": left, "mode": "", "armed": None}
        return line(sample.time, "fix", place=place(sample.position), **more)

    taken = (
        line(shot.time, "photo", index=index, place=place(shot.at))
        for index, shot in enumerate(photos)
        if shot.at is not None
    )
    yield line(0.0, "start", link=SIMULATION, vehicle=vehicle, firmware="", home=None, versions={})[1]
    yield from (each for _, each in merge(map(fix, track), taken, key=itemgetter(0)))
