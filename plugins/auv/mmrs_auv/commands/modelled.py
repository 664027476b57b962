"""The vehicles that a command works on: from a file of its data, or from models."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated

import typer

from auv_vessel.refusals import SheetError, refuse
from auv_vessel.sheet import Sheet, from_json
from mmrs_auv.sheets import is_vehicle, sheet_of
from mmrs_core.cli.crews import crew_in
from mmrs_core.cli.session import Session
from mmrs_core.cli.settings import Settings
from mmrs_core.errors import UnreadableError, UnsupportedError


def sheets_in(path: Path) -> Mapping[str, Sheet]:
    """Return the data of the underwater vehicles of a project or a behaviour, by robot.

    Raises:
        UnreadableError, InvalidModelError: the models cannot be read, or are not valid.
        UnsupportedError: there is not an underwater vehicle, or data of one are missing; lists which.
    """
    crew = crew_in(Session(Settings()), path)
    found = {}
    for each in crew.members:
        if each.type is not None and is_vehicle(each.type):
            found[each.name] = sheet_of(
                each.type,
                each.name,
                home=each.home or (0.0, 0.0, crew.scene.frame.surface),
                surface=crew.scene.frame.surface,
                payload=each.payload,
                density=crew.scene.environment.get("waterDensity"),
            )
    if not found:
        raise UnsupportedError(f"{path}: no underwater vehicle")
    return found


Vehicle = Annotated[
    Path,
    typer.Argument(
        metavar="VEHICLE",
        help="Vehicle configuration (*.json) of 'mmrs auv sheet', or a project or behaviour with a vehicle.",
    ),
]
RobotName = Annotated[
    str, typer.Option("--robot", metavar="ROBOT", help="Vehicle to use, if there are several.")
]


def sheet_in(path: Path, robot: str) -> Sheet:
    """Return the data of a vehicle that a bus can be made of.

    Raises:
        UnreadableError: the file cannot be read, or is not a vehicle's data.
        UnsupportedError: no bus can be made of it; lists why.
    """
    sheet = _read(path) if path.suffix == ".json" and path.is_file() else _modelled(path, robot)
    try:
        refuse(sheet)
    except SheetError as error:
        raise UnsupportedError(f"{path}: no bus can be made of this vehicle", error.faults) from error
    return sheet


def _read(path: Path) -> Sheet:
    try:
        return from_json(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise UnreadableError(f"{path}: {error.strerror}") from error
    except ValueError as error:
        raise UnreadableError(f"{path}: {error}") from error


def _modelled(path: Path, robot: str) -> Sheet:
    """Return the data of a vehicle of a project or a behaviour."""
    sheets = sheets_in(path)
    there = ", ".join(sorted(sheets))
    if robot:
        if robot not in sheets:
            raise typer.BadParameter(f"--robot {robot}: no such vehicle in {path}; there are {there}")
        return sheets[robot]
    if len(sheets) > 1:
        raise typer.BadParameter(f"which of its vehicles is meant? --robot, one of {there}")
    return next(iter(sheets.values()))
