"""The simulated fleet of a rehearsal: one vehicle at the home of each robot, as its type defines it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import isfinite, remainder
from pathlib import Path

import typer

from mmrs_core.behaviour.earth import degrees_of
from mmrs_core.cli.behaviours import is_behaviour, load_behaviour
from mmrs_core.cli.output import tell
from mmrs_core.cli.session import Session, Stages
from mmrs_core.cli.settings import Settings as CliSettings
from mmrs_core.errors import UnsupportedError
from mmrs_core.languages.modelset import model_in
from mmrs_core.scene import RobotType
from mmrs_mavlink.plugin.vehicles import profile_of, profile_of_type, uncarried
from mmrs_mavlink.sitl.battery import load_at
from mmrs_mavlink.sitl.parameters import defaults
from mmrs_mavlink.sitl.settings import USUAL_CAPACITY, USUAL_CELLS, Settings
from mmrs_mavlink.sitl.vehicle import SimulatedVehicle
from mmrs_runtime.sights import Sight

SPACING = 0.0001
"""Degrees of longitude between vehicles without a model."""

LAST_PORT = 65_535
MILLIAMPERE_HOUR = 3.6
CELL_VOLTS = 3.7
USUAL_ENERGY = 1200.0
"""Default hover time of a battery, seconds."""


@dataclass(frozen=True, slots=True)
class Member:
    """A robot of the fleet.

    Attributes:
        kind: ``copter``, ``sub`` or ``rover``.
        home: latitude and longitude, degrees. offset: of it from the mission's origin, metres north and east.
        energy: hover time of a full battery, seconds; recharge: recharge time, seconds; 0: never.
        capacity: of the battery, mAh. cells: of it, in series.
    """

    robot: str
    kind: str
    home: tuple[float, float]
    energy: float = USUAL_ENERGY
    recharge: float = 0.0
    capacity: float = USUAL_CAPACITY
    cells: int = USUAL_CELLS
    offset: tuple[float, float] = (0.0, 0.0)


@dataclass(frozen=True, slots=True)
class SimulatedFleet:
    """Options of all vehicles of a fleet, as on the command line.

    Attributes:
        ground: address of a ground station; empty: none.
        energy, recharge: of every battery; None: by robot.
        sights: objects that photos can show, from the mission's origin.
    """

    port: int = 14_550
    step: int = 10
    host: str = "127.0.0.1"
    ground: str = ""
    speedup: float = 1.0
    loss: float = 0.0
    delay: float = 0.0
    seed: int = 0
    firmware: str = "ardupilot"
    wind: str = "0,0"
    energy: float | None = None
    recharge: float | None = None
    parameters: tuple[str, ...] = ()
    sights: tuple[Sight, ...] = ()

    def vehicles(self, members: Sequence[Member]) -> tuple[tuple[str, SimulatedVehicle], ...]:
        """Return a vehicle for each robot, and print where it is.

        Raises:
            typer.BadParameter: an option is invalid.
        """
        last = self.port + self.step * (len(members) - 1)
        if last > LAST_PORT:
            raise typer.BadParameter(f"--port {self.port}: the last vehicle would need port {last}")
        made = tuple((each.robot, self._vehicle(number, each)) for number, each in enumerate(members))
        for number, each in enumerate(members, start=1):
            latitude, longitude = each.home
            tell(f"'{each.robot}': {each.kind}, system {number}, at {latitude:.7f}, {longitude:.7f}")
        return made

    def arguments(self, members: Sequence[Member]) -> list[str]:
        """Return the arguments with which controllers and ``mmrs run`` connect to the vehicles."""
        found = []
        for number, each in enumerate(members):
            port = self.port + self.step * number
            found += ["--connect", f"{each.robot}=udpin:{self.host}:{port}@{number + 1}"]
        return found + (["--speedup", f"{self.speedup:g}"] if self.speedup != 1.0 else [])

    def _vehicle(self, number: int, member: Member) -> SimulatedVehicle:
        north, east = member.offset
        sights = tuple(replace(s, north=s.north - north, east=s.east - east) for s in self.sights)
        try:
            settings = Settings(
                member.kind,
                *member.home,
                system=number + 1,
                firmware=self.firmware,
                wind=pair(self.wind, "--wind"),
                energy=member.energy if self.energy is None else self.energy,
                recharge=member.recharge if self.recharge is None else self.recharge,
                capacity=member.capacity,
                cells=member.cells,
                parameters=dict(map(_parameter, self.parameters)),
                sights=sights,
            )
            _refuse_unknown(settings)
            return SimulatedVehicle(
                self.port + self.step * number,
                settings,
                host=self.host,
                speedup=self.speedup,
                loss=self.loss,
                delay=self.delay,
                seed=self.seed,
                ground=_address(self.ground) if self.ground else None,
            )
        except ValueError as error:
            raise typer.BadParameter(str(error)) from error


def plain_members(count: int, home: str, kind: str) -> list[Member]:
    """Return vehicles without a model, side by side from west to east.

    Raises:
        typer.BadParameter: the home is not a position.
    """
    latitude, longitude = pair(home, "--home")
    if not (-90.0 <= latitude <= 90.0 and -180.0 <= longitude <= 180.0):
        raise typer.BadParameter(
            f"--home {home}: not a position: LATITUDE is from -90 to 90, LONGITUDE from -180 to 180"
        )
    homes = [(latitude, remainder(longitude + SPACING * n, 360.0)) for n in range(count)]
    return [Member(f"Vehicle{n}", kind, each) for n, each in enumerate(homes, start=1)]


def members_of(settings: CliSettings, path: Path) -> list[Member]:
    """Return the robots of a behaviour or of a mission.

    Raises:
        UnsupportedError: a robot has no home, or no simulated vehicle carries it; the mission is local.
        InvalidModelError: the models are invalid.
    """
    session = Session(settings)
    found = model_in(path, "behaviour") if path.is_dir() else path
    contributed = session.contributions
    kinds, extensions = contributed.robot_kinds, contributed.extensions
    if found is not None and found.is_file() and is_behaviour(session, found):
        loaded = load_behaviour(session, found)
        frame, types = loaded.program.frame, loaded.place.types
        robots = [(each, each.id, types.get(each.type_name)) for each in loaded.program.robots]
        moves = contributed.move_kinds
        profiles = [profile_of(robot, type, kinds, moves, extensions) for robot, _, type in robots]
        crew = [(name, type, robot.home, robot.payload) for robot, name, type in robots]
    else:
        scene = Stages(session, path).grounded
        frame = scene.frame
        profiles = [profile_of_type(each.type, kinds, extensions) for each in scene.robots]
        crew = [(each.name, each.type, each.home, each.payload) for each in scene.robots]
    if unknown := [why for name, type, *_ in crew if (why := uncarried(name, type, kinds, extensions))]:
        raise UnsupportedError(f"{path}: no simulated vehicle for all of its robots", unknown)
    if unsimulated := [
        f"robot '{each[0]}': no vehicle is simulated for profile '{profile.name}'"
        for each, profile in zip(crew, profiles, strict=True)
        if profile is not None and not profile.rehearsed_as
    ]:
        raise UnsupportedError(f"{path}: no simulated vehicle for all of its robots", unsimulated)
    if homeless := [name for name, _, home, _ in crew if home is None]:
        raise UnsupportedError(f"{path}: no home for {', '.join(homeless)}")
    homes = [home[:2] for _, _, home, _ in crew if home is not None]
    return [
        Member(name, profile.rehearsed_as, place, *_battery(payload, type), *_capacity(type), (north, east))
        for (name, type, _, payload), profile, place, (east, north) in zip(
            crew, profiles, degrees_of(homes, frame), homes, strict=True
        )
        if profile is not None
    ]


def _battery(payload: float, type: RobotType | None) -> tuple[float, float]:
    """Return the hover time and the recharge time, so that the battery lasts its lifetime at full speed."""
    able = [each for each in type.capabilities if each.payload >= payload] if type is not None else []
    charging = max((each.recharge_time or 0.0 for each in type.batteries), default=0.0) if type else 0.0
    if not able or able[0].lifetime is None:
        return USUAL_ENERGY, charging
    return able[0].lifetime * load_at(able[0].speed[1]), charging


def _capacity(type: RobotType | None) -> tuple[float, int]:
    """Return the milliampere-hours of a type's batteries at the voltage of the first, and its cells."""
    batteries = type.batteries if type is not None else ()
    voltage = batteries[0].voltage if batteries else None
    if voltage is None:
        return USUAL_CAPACITY, USUAL_CELLS
    joules = sum(battery.energy for battery in batteries)
    return joules / (MILLIAMPERE_HOUR * voltage), max(1, round(voltage / CELL_VOLTS))


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


def _parameter(text: str) -> tuple[str, float]:
    name, _, value = text.partition("=")
    try:
        return name, _finite(value)
    except ValueError:
        raise typer.BadParameter(f"--parameter {text}: not NAME=NUMBER") from None


def _finite(text: str) -> float:
    if not isfinite(number := float(text)):
        raise ValueError(f"{text}: not a finite number")
    return number


def _address(text: str) -> tuple[str, int]:
    host, _, port = text.rpartition(":")
    if not port.isdecimal() or len(port) > 9 or not 1 <= int(port) <= LAST_PORT:
        raise ValueError(f"--ground {text}: not [HOST:]PORT")
    return host or "127.0.0.1", int(port)


def _refuse_unknown(settings: Settings) -> None:
    unknown = sorted(settings.parameters.keys() - defaults(replace(settings, parameters={})).keys())
    if unknown:
        raise ValueError(f"parameter {unknown[0]}: unknown to the simulated vehicle")
