"""Flies the models of a flight on simulated vehicles, and records that as flights of real ones are."""

import subprocess
from collections.abc import Callable
from pathlib import Path

from firmware import Fix
from ports import free_port
from pymavlink.dialects.v20 import ardupilotmega as mavlink
from real_flights.flying import write_track
from warm_python import python

from flown_times.models import Modelled, opened
from mmrs_core.cli.settings import Settings as CliSettings
from mmrs_mavlink.commands.fleet import connected, equipped, members_of
from mmrs_mavlink.plugin.plans.items import Row
from mmrs_mavlink.sitl.autopilot import SimulatedAutopilot
from mmrs_mavlink.sitl.commands import execute
from mmrs_mavlink.sitl.items import MISSION, StoredItem
from mmrs_mavlink.sitl.settings import Settings
from mmrs_mavlink.sitl.simulation import advance
from mmrs_mavlink.sitl.vehicle import Host

TICK, PERIOD = 0.05, 0.1
"""Seconds of the vehicle between two steps of a mission, and between two places of a track."""

READY, LONGEST, RESTING = 10.0, 10_000.0, 20.0
"""Seconds before a mission begins, that it takes at most, and that are recorded behind its end."""

ENDED = {"recharge": 20.0}
"""Seconds in which a battery is full: waits and charging are compared with nothing."""


def simulate_steps(folder: Path, *arguments: str, speedup: float = 10.0, patience: float = 1800.0) -> None:
    """Carry out the models in a folder with `mmrs run`, and keep its logs and the vehicles' tracks there."""
    members = equipped(members_of(CliSettings(), folder), ENDED)
    vehicles, links = connected(members, free_port(), 1, "127.0.0.1", speedup)
    tracks: dict[str, list[Fix]] = {name: [] for name in vehicles}
    for name, vehicle in vehicles.items():
        vehicle.on_tick = _recorder(vehicle.autopilot, tracks[name])
    host = Host(list(vehicles.values()))
    host.start()
    try:
        command = [python(), "-m", "mmrs_core", "run", str(folder), *links, *arguments]
        done = subprocess.run(
            [*command, "--log", str(folder / "logs")], capture_output=True, text=True, timeout=patience
        )
    finally:
        host.stop()
        for vehicle in vehicles.values():
            vehicle.close()
    if host.failure is not None:
        raise host.failure
    assert done.returncode == 0, done.stderr
    for name, track in tracks.items():
        write_track(folder / f"{name}.track.csv.gz", track)


def simulate_mission(folder: Path, robot: str) -> None:
    """Have a robot of the models in a folder fly all of its moves as a mission, and keep its track there."""
    session, loaded = opened(folder)
    program = next(each for each in loaded.program.robots if each.id == robot)
    modelled = Modelled(session, loaded, program)
    rows = modelled.rows()
    pilot = SimulatedAutopilot(members_of(CliSettings(), folder)[robot])
    for limit in modelled.limits():
        if limit.name in pilot.parameters and not limit.holds(pilot.parameters[limit.name]):
            pilot.parameters[limit.name] = limit.value
    track: list[Fix] = []
    record = _recorder(pilot, track)
    advance(pilot, READY)
    pilot.stores[MISSION] = [*_home(pilot.settings, pilot.first_item), *map(_stored, rows)]
    if not pilot.px4 and pilot.flies:
        pilot.enter("guided")
    assert execute(pilot, mavlink.MAV_CMD_COMPONENT_ARM_DISARM, (1.0,) + 6 * (0.0,)) == 0, pilot.said
    assert execute(pilot, mavlink.MAV_CMD_MISSION_START, 7 * (0.0,)) == 0, pilot.said
    until = pilot.time + LONGEST
    while pilot.armed and not pilot.finished and pilot.time < until:
        advance(pilot, TICK)
        record()
    assert pilot.time < until, "the mission does not end"
    for _ in range(int(RESTING / TICK)):
        advance(pilot, TICK)
        record()
    write_track(folder / f"{robot}.track.csv.gz", track)


def _recorder(pilot: SimulatedAutopilot, track: list[Fix]) -> Callable[[], None]:
    """Return what notes where a vehicle is."""

    def record() -> None:
        if track and pilot.time < track[-1].t + PERIOD - 1e-6:
            return
        (latitude, longitude), body = pilot.degrees(), pilot.body
        (north, east, up), height = body.velocity, body.position[2]
        item = len(pilot.stores[MISSION]) - pilot.first_item + 1 if pilot.finished else pilot.current_item
        state = (pilot.armed, pilot.mode, item)
        altitude = pilot.settings.altitude + height
        track.append(
            Fix(pilot.time, latitude, longitude, altitude, height, north, east, -up, body.heading, *state)
        )

    return record


def _home(settings: Settings, number: int) -> list[StoredItem]:
    place = (round(settings.latitude * 1e7), round(settings.longitude * 1e7), settings.altitude)
    return [StoredItem(0, 16, (0.0, 0.0, 0.0, 0.0), *place)] * number


def _stored(row: Row) -> StoredItem:
    x, y = (round(each * (1e7 if row.has_place else 1.0)) for each in row.params[4:6])
    return StoredItem(row.frame, row.command, row.params[:4], x, y, row.params[6])
