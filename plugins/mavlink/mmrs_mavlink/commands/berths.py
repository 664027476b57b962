"""Which simulated vehicles a rehearsal needs: one for each robot, at its home, as its type says."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import isfinite, remainder
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from mmrs_core.cli.output import tell
from mmrs_core.cli.settings import Settings as CliSettings
from mmrs_core.errors import UnsupportedError
from mmrs_mavlink.sitl.battery import load_at
from mmrs_mavlink.sitl.parameters import defaults
from mmrs_mavlink.sitl.settings import Settings
from mmrs_mavlink.sitl.vehicle import SimulatedVehicle
from mmrs_runtime.sights import Sight

if TYPE_CHECKING:
    from mmrs_core.scene import RobotType

SPACING = 0.0001
"""Degrees between vehicles without a model: eleven metres."""

LAST_PORT = 65_535
GUST_SECONDS = 5.0
"""How long gusts last where nobody says."""

USUAL_ENERGY = 1200.0
"""Seconds of hovering where nobody says how long a battery lasts."""


@dataclass(frozen=True, slots=True)
class Berth:
    """A robot that needs a vehicle.

    Attributes:
        kind: ``copter``, ``sub`` or ``rover``.
        home: latitude and longitude, degrees. offset: of it from the mission's origin, metres north and east.
        energy: seconds of hovering in a full battery; recharge: seconds until it is full; 0: never.
    """

    robot: str
    kind: str
    home: tuple[float, float]
    energy: float = USUAL_ENERGY
    recharge: float = 0.0
    offset: tuple[float, float] = (0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Berths:
    """What all vehicles have in common.

    Attributes:
        ground: where a ground station listens beside them; empty: there is none.
        energy, recharge: for all of them; None: as each berth says.
        sights: what there is to be seen, from the mission's origin.
    """

    port: int
    step: int
    host: str
    ground: str
    speedup: float
    loss: float
    delay: float
    seed: int
    firmware: str
    wind: str
    gusts: str
    energy: float | None
    recharge: float | None
    parameters: tuple[str, ...]
    sights: tuple[Sight, ...] = ()

    def vehicles(self, berths: Sequence[Berth]) -> tuple[tuple[str, SimulatedVehicle], ...]:
        """Return a vehicle for each robot, and say how it is reached.

        Raises:
            typer.BadParameter: if an option makes no sense.
        """
        last = self.port + self.step * (len(berths) - 1)
        if last > LAST_PORT:
            raise typer.BadParameter(f"--port {self.port}: the last vehicle would need port {last}")
        made = tuple((berth.robot, self._vehicle(number, berth)) for number, berth in enumerate(berths))
        for number, berth in enumerate(berths):
            latitude, longitude = berth.home
            tell(f"'{berth.robot}': {berth.kind}, system {number + 1}, at {latitude:.7f}, {longitude:.7f}")
        return made

    def arguments(self, berths: Sequence[Berth]) -> list[str]:
        """Return the arguments with which controllers and ``mmrs run`` reach the vehicles."""
        found = [
            part for number, berth in enumerate(berths) for part in ("--connect", self._url(number, berth))
        ]
        return found + (["--speedup", f"{self.speedup:g}"] if self.speedup != 1.0 else [])

    def _url(self, number: int, berth: Berth) -> str:
        return f"{berth.robot}=udpin:{self.host}:{self.port + self.step * number}@{number + 1}"

    def _vehicle(self, number: int, berth: Berth) -> SimulatedVehicle:
        try:
            settings = Settings(
                berth.kind,
                *berth.home,
                system=number + 1,
                firmware=self.firmware,
                wind=pair(self.wind, "--wind"),
                gusts=pair(self.gusts if "," in self.gusts else f"{self.gusts},{GUST_SECONDS}", "--gusts"),
                seed=self.seed,
                energy=berth.energy if self.energy is None else self.energy,
                recharge=berth.recharge if self.recharge is None else self.recharge,
                parameters=dict(map(_parameter, self.parameters)),
                sights=tuple(
                    replace(each, north=each.north - berth.offset[0], east=each.east - berth.offset[1])
                    for each in self.sights
                ),
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


def _address(text: str) -> tuple[str, int]:
    host, _, port = text.rpartition(":")
    if not port.isdecimal() or len(port) > 9 or not 1 <= int(port) <= LAST_PORT:
        raise ValueError(f"--ground {text}: is not [HOST:]PORT")
    return host or "127.0.0.1", int(port)


def _refuse_unknown(settings: Settings) -> None:
    unknown = sorted(settings.parameters.keys() - defaults(replace(settings, parameters={})).keys())
    if unknown:
        raise ValueError(f"parameter {unknown[0]}: the simulated vehicle has none of that name")


def plain_berths(count: int, home: str, kind: str) -> list[Berth]:
    """Return vehicles without a model, side by side from west to east.

    Raises:
        typer.BadParameter: the home is no place.
    """
    latitude, longitude = pair(home, "--home")
    if not (-90.0 <= latitude <= 90.0 and -180.0 <= longitude <= 180.0):
        raise typer.BadParameter(f"--home {home}: is no place: LATITUDE from -90 to 90, LONGITUDE to 180")
    places = [(latitude, remainder(longitude + SPACING * n, 360.0)) for n in range(count)]
    return [Berth(f"Vehicle{n + 1}", kind, place) for n, place in enumerate(places)]


def berths_of(settings: CliSettings, path: Path) -> list[Berth]:
    """Return the robots of a behaviour, or of a mission, with their homes.

    Raises:
        UnsupportedError: they have no place on Earth, or no vehicle carries one of them.
        InvalidModelError: the models are not valid.
    """
    from mmrs_core.behaviour.earth import degrees_of
    from mmrs_core.cli.behaviours import is_behaviour, load_behaviour
    from mmrs_core.cli.session import Session, Stages
    from mmrs_core.languages.modelset import model_in
    from mmrs_core.mavlink.vehicles import class_of_type, uncarried, vehicle_class

    session = Session(settings)
    found = model_in(path, "behaviour") if path.is_dir() else path
    kinds = session.contributions.robot_kinds
    if found is not None and found.is_file() and is_behaviour(session, found):
        loaded = load_behaviour(session, found)
        frame = loaded.program.frame
        robots = loaded.program.robots
        types = [loaded.place.types.get(each.type_name) for each in robots]
        crew = [
            (each.id, type, vehicle_class(each, type, kinds), each.home, _battery(each.payload, type))
            for each, type in zip(robots, types, strict=True)
        ]
    else:
        scene = Stages(session, path).grounded
        frame = scene.frame
        crew = [
            (
                each.name,
                each.type,
                class_of_type(each.type, kinds),
                each.home,
                _battery(each.payload, each.type),
            )
            for each in scene.robots
        ]
    if unknown := [why for name, type, *_ in crew if (why := uncarried(name, type, kinds))]:
        raise UnsupportedError(f"{path}: no simulated vehicle for all of its robots", unknown)
    lost = [name for name, _, _, home, _ in crew if home is None]
    if lost:
        raise UnsupportedError(f"{path}: no home for {', '.join(lost)}")
    homes = [home[:2] for _, _, _, home, _ in crew if home is not None]
    places = degrees_of(homes, frame)
    return [
        Berth(name, vehicle.name, place, *battery, (north, east))
        for (name, _, vehicle, _, battery), place, (east, north) in zip(crew, places, homes, strict=True)
        if vehicle is not None
    ]


def _battery(payload: float, type: RobotType | None) -> tuple[float, float]:
    """Return seconds of hovering and of recharging, so that it lasts its lifetime at its fastest."""
    able = [each for each in type.capabilities if each.payload >= payload] if type is not None else []
    charging = max((each.recharge_time or 0.0 for each in type.batteries), default=0.0) if type else 0.0
    if not able or able[0].lifetime is None:
        return USUAL_ENERGY, charging
    return able[0].lifetime * load_at(able[0].speed[1]), charging


def pair(text: str, option: str) -> tuple[float, float]:
    """Return two numbers that a comma parts.

    Raises:
        typer.BadParameter: they are not.
    """
    first, _, second = text.partition(",")
    try:
        return _finite(first), _finite(second)
    except ValueError:
        raise typer.BadParameter(f"{option} {text}: is not two numbers with a comma") from None


def _parameter(text: str) -> tuple[str, float]:
    name, _, value = text.partition("=")
    try:
        return name, _finite(value)
    except ValueError:
        raise typer.BadParameter(f"--parameter {text}: is not NAME=NUMBER") from None


def _finite(text: str) -> float:
    if not isfinite(number := float(text)):
        raise ValueError(f"{text}: is no finite number")
    return number
