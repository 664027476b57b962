"""Logs of a run that was broken off: whether they may be gone on with, and where they end."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import typer

from mmrs_core.behaviour.log import read_log, read_logs, recover_log
from mmrs_core.behaviour.program import Program
from mmrs_core.behaviour.replay import replay
from mmrs_core.cli.output import counted, tell
from mmrs_core.cli.run_options import RunOptions
from mmrs_core.errors import InvalidModelError
from mmrs_core.pictures.figures import clock
from mmrs_runtime.bus.program_bus import slots_path
from mmrs_runtime.engine.resuming import over_by
from mmrs_runtime.records.blackbox import black_box_path, last_time, plan_of
from mmrs_runtime.records.steps import SUFFIX, StepRecord, log_name


def resumed_steps(program: Program, wanted: RunOptions, here: tuple[str, ...]) -> tuple[StepRecord, ...]:
    """Return the steps that the robots of this process made before; none where nothing began then.

    Raises:
        typer.BadParameter: if there are logs without --resume, or none with it.
        InvalidModelError: if they are not logs of this behaviour.
    """
    found = [path for robot in here if (path := wanted.folder / log_name(robot)).exists()]
    _refuse_others(program, wanted)
    if not wanted.resume:
        if found:
            raise typer.BadParameter(
                f"--log {wanted.folder}: already contains logs; choose another folder,"
                " or resume that run with --resume"
            )
        return ()
    if not found:
        _refuse_unknown(wanted.folder, here)
        return ()
    for path in found:
        if plan_of(black_box_path(path)) not in ("", program.fingerprint):
            raise InvalidModelError(f"{path}: was flown by another plan of the mission")
    records = read_logs(found, partial=True)
    for damage in (each for path in found for each in recover_log(path)[1]):
        tell(f"{damage}: left out")
    result = replay(program, records, partial=True)
    if not result.accepted and len(here) == len(program.robots):
        raise InvalidModelError(f"{wanted.folder}: not logs of this behaviour: {result.complaints[0]}")
    try:
        over = over_by(program.executable, records)
    except ValueError as error:
        raise InvalidModelError(f"{wanted.folder}: {error}") from error
    for robot, why in over.items():
        tell(f"'{robot}': {f'its program has ended by {why}' if why else 'has come to its end'}")
    if all(record.label == "fault" and record.seq == 0 for record in records):
        raise typer.BadParameter("--resume: nothing had begun; begin again, with another --log")
    if set(over) >= set(here):
        raise typer.BadParameter(f"--resume: nothing is left to do for {', '.join(here)}")
    tell(f"continues after {counted(len(records), 'step')} and {clock(result.duration)}")
    return records


def _refuse_unknown(folder: Path, robots: Sequence[str]) -> None:
    """Refuse a folder in which nothing says that these robots were to begin; logs begin with a step."""
    logs = [folder / log_name(robot) for robot in robots]
    if not any(path.exists() for log in logs for path in (black_box_path(log), slots_path(log))):
        raise typer.BadParameter(f"--resume: no logs in {folder}")


def end_of(records: Sequence[StepRecord], folder: Path) -> float:
    """Return how many seconds of the run have passed, as logs and black boxes tell."""
    boxes = {black_box_path(folder / log_name(record.robot)) for record in records}
    return max((*(record.time for record in records), *map(last_time, boxes)), default=0.0)


def _refuse_others(program: Program, wanted: RunOptions) -> None:
    """Refuse a folder with logs of another run, or of another behaviour."""
    known = {log_name(robot.id) for robot in program.robots}
    for path in sorted(wanted.folder.glob(f"*{SUFFIX}")) if wanted.folder.is_dir() else ():
        records = read_log(path, partial=True)
        strange = path.name not in known or any(each.run != wanted.run for each in records[:1])
        if strange and not (wanted.resume and path.name in known):
            raise typer.BadParameter(f"--log {path}: is of another run; choose another folder")
