"""Writes the black boxes of simulated runs: where robots were, as far as the simulation tells."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from mmrs_core.behaviour.box_files import black_boxes
from mmrs_core.behaviour.program import Program
from mmrs_core.cli.protection import ProtectedError
from mmrs_core.contributions.execution import Sample
from mmrs_core.contributions.rules import RobotKind, robot_kind_of
from mmrs_core.pictures.flights.fixes import Datum, datum_of
from mmrs_core.pictures.flights.gathering import SIMULATION
from mmrs_core.resources import named
from mmrs_core.scene import Name, RobotType
from mmrs_core.simulation.run import SimulatedRun
from mmrs_runtime.records.blackbox import black_box_path
from mmrs_runtime.records.steps import log_name


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
    kinds: Mapping[Name, RobotKind],
) -> tuple[Path, ...]:
    """Write a black box for every robot whose way the simulation tells; return the paths.

    Places are metres from home; between two of them a robot went straight. There is no time of day.
    """
    name = run.records[0].run if run.records else ""
    written = []
    for robot in program.robots:
        if track := run.tracks.get(robot.id):
            path = folder / box_name(robot.id)
            robot_type = types.get(robot.type_name)
            kind = robot_kind_of(robot_type, kinds) if robot_type is not None else None
            datum = datum_of(robot, program, robot_type, kinds=kinds)
            lines = _lines(name, robot.id, track, datum, kind.vehicle if kind is not None else "")
            with named(path):
                path.write_text("".join(f"{line}\n" for line in lines), encoding="utf-8")
            written.append(path)
    return tuple(written)


def _lines(run: str, robot: str, track: Sequence[Sample], datum: Datum, vehicle: str) -> Iterator[str]:
    full = track[0].energy
    common = {"run": run, "robot": robot}

    def line(time: float, kind: str, **content: object) -> str:
        whole = {**common, "time": round(time, 6), "wall": "", "kind": kind, **content}
        return json.dumps(whole, ensure_ascii=False, separators=(",", ":"), allow_nan=False)

    yield line(0.0, "start", link=SIMULATION, vehicle=vehicle, firmware="", home=None, versions={})
    for sample in track:
        east, north, up = sample.position
        place = {"north": north - datum.home[1], "east": east - datum.home[0], "height": up - datum.up}
        shown = {name: round(value, 3) for name, value in place.items()}
        left = None if not full or sample.energy is None or full == float("inf") else sample.energy / full
        rounded = None if left is None else round(left, 4)
        yield line(
            sample.time, "fix", place=shown, speed=None, heading=None, energy=rounded, mode="", armed=None
        )
