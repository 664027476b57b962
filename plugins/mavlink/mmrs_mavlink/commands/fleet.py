"""The simulated fleet of a rehearsal: one vehicle at the home of each robot, as its type defines it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import isfinite, nan
from pathlib import Path
from typing import Any

import typer

from mmrs_core.behaviour.earth import degrees_of
from mmrs_core.cli.crews import CrewMember, crew_in
from mmrs_core.cli.output import tell
from mmrs_core.cli.session import Session
from mmrs_core.cli.settings import Settings as CliSettings
from mmrs_core.contributions.rules import RobotKind, robot_kind_of
from mmrs_core.errors import InfeasibleError, UnsupportedError
from mmrs_core.scene import Name, Scene
from mmrs_mavlink.plugin.vehicles import autopilot_of, profile_of, uncarried
from mmrs_mavlink.sitl.parameters import defaults
from mmrs_mavlink.sitl.settings import IMITATED, Settings
from mmrs_mavlink.sitl.vehicle import SimulatedVehicle
from mmrs_runtime.sights import Sight

PLACE = (42.37, 13.35)
"""Degrees of the home of each robot of a local mission, which has no place on the Earth."""

LAST_PORT = 65_535
MILLIAMPERE_HOUR = 3.6
CELL_VOLTS = 3.7

Members = Mapping[str, Settings]
"""Settings of vehicles, by robot."""


def members_of(settings: CliSettings, path: Path, sights: Sequence[Sight] = ()) -> Members:
    """Return the robots of a behaviour or of a mission, with objects at metres from its origin.

    Raises:
        UnsupportedError: a robot has no home, or no simulated vehicle carries it.
        InvalidModelError: the models are invalid.
    """
    session = Session(settings)
    crew, contributed = crew_in(session, path), session.contributions
    kinds, moves, extensions = contributed.robot_kinds, contributed.move_kinds, contributed.extensions
    profiles = [profile_of(each.program, each.type, kinds, moves, extensions) for each in crew.members]
    unfit = [
        uncarried(each.name, each.type, kinds, extensions) or f"robot '{each.name}': its profile has none"
        for each, profile in zip(crew.members, profiles, strict=True)
        if profile is None or not profile.rehearsed_as
    ]
    if unfit:
        raise UnsupportedError(f"{path}: no simulated vehicle for all of its robots", unfit)
    if homeless := [each.name for each in crew.members if each.home is None]:
        raise UnsupportedError(f"{path}: no home for {', '.join(homeless)}")
    homes = [each.home[:2] for each in crew.members if each.home is not None]
    places = [PLACE] * len(homes) if crew.scene.frame.is_local else degrees_of(homes, crew.scene.frame)
    made = {}
    for each, profile, place, (east, north) in zip(crew.members, profiles, places, homes, strict=True):
        near = tuple(replace(sight, north=sight.north - north, east=sight.east - east) for sight in sights)
        assert profile is not None
        named = autopilot_of(each.type, extensions)
        firmware = named if (profile.rehearsed_as, named) in IMITATED else profile.rehearsed_with
        vehicle = Settings(profile.rehearsed_as, *place, firmware=firmware, sights=near)
        vehicle = replace(vehicle, spins=profile.drives and _spins(each.name, crew.scene, kinds))
        made[each.name] = _with_battery(vehicle, each)
    return made


def _spins(name: str, scene: Scene, kinds: Mapping[Name, RobotKind]) -> bool:
    """Return whether a robot is known to turn on the spot."""
    robot = next((each for each in scene.robots if each.name == name), None)
    kind = robot_kind_of(robot.type, kinds) if robot is not None else None
    try:
        return robot is not None and kind is not None and kind.kinematics(robot, scene).turning_radius == 0.0
    except InfeasibleError:
        return False


def _with_battery(settings: Settings, robot: CrewMember) -> Settings:
    """Return settings with the battery of a robot's type, which lasts its lifetime."""
    type = robot.type
    if type is None:
        return settings
    able = [each for each in type.capabilities if each.payload >= robot.payload]
    if able and able[0].lifetime is not None:
        settings = replace(settings, energy=able[0].lifetime)
    recharge = max((each.recharge_time or 0.0 for each in type.batteries), default=0.0)
    voltage = type.batteries[0].voltage if type.batteries else None
    if voltage is None:
        return replace(settings, recharge=recharge)
    capacity = sum(each.energy for each in type.batteries) / (MILLIAMPERE_HOUR * voltage)
    return replace(settings, recharge=recharge, capacity=capacity, cells=max(1, round(voltage / CELL_VOLTS)))


def equipped(members: Members, options: Mapping[str, Any]) -> Members:
    """Return settings with a system number each, and with options of all vehicles, where these are not None.

    Raises:
        typer.BadParameter: a vehicle cannot have one of them.
    """
    found, given = {}, {name: value for name, value in options.items() if value is not None}
    for number, (robot, each) in enumerate(members.items(), start=1):
        try:
            found[robot] = replace(each, system=number, **given)
        except ValueError as error:
            raise typer.BadParameter(str(error)) from error
        known = defaults(replace(found[robot], parameters={}))
        if unknown := sorted(found[robot].parameters.keys() - known.keys()):
            raise typer.BadParameter(f"parameter {unknown[0]}: unknown to the simulated vehicle")
    return found


def connected(
    members: Members, port: int, step: int, host: str, speedup: float
) -> tuple[dict[str, SimulatedVehicle], list[str]]:
    """Return a vehicle for each robot, at ascending ports, and the arguments that connect to them.

    Raises:
        typer.BadParameter: an option is invalid.
    """
    last = port + step * (len(members) - 1)
    if last > LAST_PORT:
        raise typer.BadParameter(f"--port {port}: the last vehicle would need port {last}")
    vehicles, arguments = {}, list[str]()
    for robot, each in members.items():
        try:
            vehicles[robot] = SimulatedVehicle(port, each, host=host, speedup=speedup)
        except ValueError as error:
            raise typer.BadParameter(str(error)) from error
        arguments += ["--connect", f"{robot}=udpin:{host}:{port}@{each.system}"]
        port += step
        tell(f"'{robot}': {each.kind}, system {each.system}, at {each.latitude:.7f}, {each.longitude:.7f}")
    return vehicles, arguments + (["--speedup", f"{speedup:g}"] if speedup != 1.0 else [])


def parameter(text: str) -> tuple[str, float]:
    """Return a name and its value.

    Raises:
        typer.BadParameter: they are not.
    """
    name, _, value = text.partition("=")
    try:
        number = float(value)
    except ValueError:
        number = nan
    if not isfinite(number):
        raise typer.BadParameter(f"--parameter {text}: not NAME=NUMBER")
    return name, number


def station(text: str) -> tuple[str, int]:
    """Return the host and the port of a ground station.

    Raises:
        typer.BadParameter: they are not.
    """
    host, _, port = text.rpartition(":")
    if not port.isdecimal() or len(port) > 9 or not 1 <= int(port) <= LAST_PORT:
        raise typer.BadParameter(f"--ground {text}: not [HOST:]PORT")
    return host or "127.0.0.1", int(port)
