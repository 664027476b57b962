"""Runs a behaviour in simulation and keeps its logs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from itertools import pairwise
from math import dist
from pathlib import Path
from tempfile import TemporaryDirectory

import typer

from mmrs_core.behaviour.log import read_log
from mmrs_core.behaviour.program import Program
from mmrs_core.cli.output import progress
from mmrs_core.cli.session import Session
from mmrs_core.cli.simulated_boxes import remove_boxes, write_boxes
from mmrs_core.contributions.rules import RobotKind
from mmrs_core.errors import MmrsError
from mmrs_core.pictures.figures import clock, length
from mmrs_core.pipeline import BehaviourContext, simulate
from mmrs_core.resources import new_folders
from mmrs_core.scene import Name, RobotType
from mmrs_core.simulation.run import SimulatedRun
from mmrs_runtime.records.log import LogWriter
from mmrs_runtime.records.steps import SUFFIX, StepRecord, log_name
from mmrs_runtime.semantics import Outcome

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
        UnsupportedError: if it does not know what the behaviour holds.
    """

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
    kinds: Mapping[Name, RobotKind] | None = None,
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
            write_boxes(run, program, types or {}, Path(staged), kinds or {})
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
