"""The simulated fleet of a rehearsal: one vehicle at the home of each robot, as its type defines it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from math import isfinite
from pathlib import Path
from typing import Any

import typer

from mmrs_core.behaviour.earth import degrees_of
from mmrs_core.cli.crews import CrewMember, crew_in
from mmrs_core.cli.output import tell
from mmrs_core.cli.session import Session
from mmrs_core.cli.settings import Settings as CliSettings
from mmrs_core.errors import UnsupportedError
from mmrs_mavlink.plugin.vehicles import profile_of, uncarried
from mmrs_mavlink.profiles import VehicleProfile
from mmrs_mavlink.sitl.parameters import defaults
from mmrs_mavlink.sitl.settings import Settings
from mmrs_mavlink.sitl.vehicle import SimulatedVehicle
from mmrs_runtime.sights import Sight

PLACE = (42.37, 13.35)
"""Degrees of the home of each robot of a local mission, which has no place on the Earth."""

LAST_PORT = 65_535
MILLIAMPERE_HOUR = 3.6
CELL_VOLTS = 3.7

Members = Mapping[str, Settings]
"""Settings of vehicles, by robot."""


@dataclass(frozen=True, slots=True)
class SimulatedFleet:
    """Options of all vehicles of a fleet, as on the command line.

    Attributes:
        settings: those that replace the settings of all robots.
    """

    port: int = 14_550
    step: int = 10
    host: str = "127.0.0.1"
    speedup: float = 1.0
    settings: Mapping[str, Any] = field(default_factory=dict)

    def vehicles(self, members: Members) -> tuple[tuple[str, SimulatedVehicle], ...]:
        """Return a vehicle for each robot, and print where it is.

        Raises:
            typer.BadParameter: an option is invalid.
        """
        last = self.port + self.step * (len(members) - 1)
        if last > LAST_PORT:
            raise typer.BadParameter(f"--port {self.port}: the last vehicle would need port {last}")
        try:
            made = tuple(
                (robot, self._vehicle(number, settings))
                for number, (robot, settings) in enumerate(members.items())
            )
        except ValueError as error:
            raise typer.BadParameter(str(error)) from error
        for number, (robot, each) in enumerate(members.items(), start=1):
            tell(f"'{robot}': {each.kind}, system {number}, at {each.latitude:.7f}, {each.longitude:.7f}")
        return made

    def arguments(self, members: Members) -> list[str]:
        """Return the arguments with which controllers and ``mmrs run`` connect to the vehicles."""
        found = []
        for number, robot in enumerate(members):
            port = self.port + self.step * number
            found += ["--connect", f"{robot}=udpin:{self.host}:{port}@{number + 1}"]
        return found + (["--speedup", f"{self.speedup:g}"] if self.speedup != 1.0 else [])

    def _vehicle(self, number: int, member: Settings) -> SimulatedVehicle:
        settings = replace(member, system=number + 1, **self.settings)
        if unknown := sorted(settings.parameters.keys() - defaults(replace(settings, parameters={})).keys()):
            raise ValueError(f"parameter {unknown[0]}: unknown to the simulated vehicle")
        return SimulatedVehicle(
            self.port + self.step * number, settings, host=self.host, speedup=self.speedup
        )


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
        why
        for each, profile in zip(crew.members, profiles, strict=True)
        if (why := uncarried(each.name, each.type, kinds, extensions) or _unsimulated(each.name, profile))
    ]
    if unfit:
        raise UnsupportedError(f"{path}: no simulated vehicle for all of its robots", unfit)
    if homeless := [each.name for each in crew.members if each.home is None]:
        raise UnsupportedError(f"{path}: no home for {', '.join(homeless)}")
    homes = [each.home[:2] for each in crew.members if each.home is not None]
    places = [PLACE] * len(homes) if crew.frame.is_local else degrees_of(homes, crew.frame)
    made = {}
    for each, profile, place, (east, north) in zip(crew.members, profiles, places, homes, strict=True):
        near = tuple(replace(sight, north=sight.north - north, east=sight.east - east) for sight in sights)
        assert profile is not None
        made[each.name] = _with_battery(Settings(profile.rehearsed_as, *place, sights=near), each)
    return made


def _unsimulated(robot: str, profile: VehicleProfile | None) -> str:
    """Return why no vehicle is simulated for a robot; empty where one is."""
    if profile is not None and profile.rehearsed_as:
        return ""
    name = f" '{profile.name}'" if profile is not None else ""
    return f"robot '{robot}': no vehicle is simulated for its profile{name}"


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


def pair(text: str, option: str) -> tuple[float, float]:
    """Return two numbers separated by a comma.

    Raises:
        typer.BadParameter: they are not.
    """
    first, _, second = text.partition(",")
    try:
        return _finite(first), _finite(second)
    except ValueError:
        raise typer.BadParameter(f"{option} {text}: not two numbers with a comma") from None


def parameter(text: str) -> tuple[str, float]:
    """Return a name and its value.

    Raises:
        typer.BadParameter: they are not.
    """
    name, _, value = text.partition("=")
    try:
        return name, _finite(value)
    except ValueError:
        raise typer.BadParameter(f"--parameter {text}: not NAME=NUMBER") from None


def _finite(text: str) -> float:
    if not isfinite(number := float(text)):
        raise ValueError(f"{text}: not a finite number")
    return number


def station(text: str) -> tuple[str, int]:
    """Return the host and the port of a ground station.

    Raises:
        typer.BadParameter: they are not.
    """
    host, _, port = text.rpartition(":")
    if not port.isdecimal() or len(port) > 9 or not 1 <= int(port) <= LAST_PORT:
        raise typer.BadParameter(f"--ground {text}: not [HOST:]PORT")
    return host or "127.0.0.1", int(port)
