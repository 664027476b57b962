"""Logs of recorded flights, and their models with figures that `mmrs calibrate` finds in some of these."""

import csv
import gzip
import json
from bisect import bisect_right
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from shutil import copyfile, copytree

from flight_logs import ARDUPILOT, QUADROTOR, Sample, telemetry

from flown_times.clock import Clock
from flown_times.models import Modelled, opened
from flown_times.tracks import track_in
from mmrs_core.cli.session import Session
from mmrs_core.cli.settings import Settings
from mmrs_mavlink.calibration.figures import Figure, figures_of
from mmrs_mavlink.calibration.flight import Flight
from mmrs_mavlink.calibration.judging import judged
from mmrs_mavlink.calibration.reading import flight_in
from mmrs_mavlink.calibration.type_file import type_in

MAV_TYPES = {"rover": 10, "sub": 12}
"""By the first word of a flight's name; the others are copters'."""

TRACK = ".track.csv.gz"


def class_of(folder: Path) -> str:
    """Return the class of the vehicles that flew: the first word of the folder's name, or else a copter."""
    first = folder.name.partition("-")[0]
    return first if first in {*MAV_TYPES, "px4"} else "copter"


def flights_of(folder: Path, scratch: Path) -> list[Flight]:
    """Return the flights that were recorded in a folder, as `mmrs calibrate` reads them from logs.

    Args:
        folder: of the flights.
        scratch: file for the log of each of them, one after the other.
    """
    found = []
    for track in sorted(folder.glob(f"*{TRACK}")):
        scratch.write_bytes(log_of(folder, track.name.removesuffix(TRACK)))
        found.append(flight_in(scratch))
    return found


def copied(folder: Path, into: Path) -> Path:
    """Return a copy of a recorded flight, in another folder, whose robot types can be written."""
    found = copytree(folder, into / folder.name, copy_function=copyfile)
    (found / "robots").chmod(0o755)
    return found


def calibrate(folders: Iterable[Path], flights: Sequence[Flight]) -> None:
    """Write what flights tell into the robot types of the models in folders, as `mmrs calibrate` does."""
    languages, found = Session(Settings()).contributions.languages, dict[bytes, tuple[Figure, ...]]()
    for folder in folders:
        (file,) = (folder / "robots").iterdir()
        loaded = opened(folder)[1]
        robot = loaded.program.robots[0]
        payloads = (each.payload for each in loaded.place.types[robot.type_name].capabilities)
        known = type_in(file, languages, next(each for each in payloads if each >= robot.payload))
        if known.data not in found:
            figures = figures_of(flights, known.capacity, known.current)
            found[known.data] = judged(flights, figures, known.current)
        known.write(found[known.data])
    opened.cache_clear()


def log_of(folder: Path, robot: str, autopilot: int = ARDUPILOT) -> bytes:
    """Return the log of a recorded flight, which tells when each target was commanded."""
    kind = MAV_TYPES.get(class_of(folder), QUADROTOR)
    return telemetry(_samples(folder, robot), mav_type=kind, autopilot=autopilot)


def _samples(folder: Path, robot: str) -> Iterator[Sample]:
    """Yield the samples of a track, east and north of its first position; each target is another item."""
    with gzip.open(folder / f"{robot}{TRACK}", "rt", encoding="utf-8") as file:
        rows = [{name: float(value) for name, value in row.items()} for row in csv.DictReader(file)]
    rows = [row for row in rows if row["lat"]]
    latitude, longitude = rows[0]["lat"], rows[0]["lon"]
    begun, target, number = _begun(folder, robot), (0, 0), 0
    for row in rows:
        place = ((row["lon"] - longitude) * 82_379.0, (row["lat"] - latitude) * 111_081.0, row["rel"])
        velocity, mode = (row["vy"], row["vx"], -row["vz"]), int(row["mode"])
        if (now := (bisect_right(begun, row["t"]), int(row["seq"]))) != target:
            target, number = now, number + 1
        yield Sample(row["t"], place, velocity, row["hdg"], mode, bool(row["armed"]), number)


def _begun(folder: Path, robot: str) -> list[float]:
    """Return when the moves of a robot that was commanded step by step began, by the vehicle's clock."""
    log = folder / "logs" / f"{robot}.jsonl"
    if not log.is_file():
        return []
    session, loaded = opened(folder)
    program = next(each for each in loaded.program.robots if each.id == robot)
    records = map(json.loads, log.read_text().splitlines())
    steps = [(each["label"], each["move"], float(each["time"])) for each in records]
    clock = Clock(steps, track_in(folder / f"{robot}{TRACK}"), Modelled(session, loaded, program))
    return sorted(clock.at(time) for label, _, time in steps if label == "begin")
