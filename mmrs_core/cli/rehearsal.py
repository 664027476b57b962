"""Keeps simulated vehicles going: who they are, what befalls them, what is told of them."""

from __future__ import annotations

import queue
import signal
import sys
import threading
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from types import FrameType
from typing import TYPE_CHECKING

import typer

from mmrs_core.cli.interruption import INTERRUPTED
from mmrs_core.cli.output import say, tell
from mmrs_core.cli.settings import Settings as CliSettings
from mmrs_core.errors import UnsupportedError
from mmrs_core.sitl.battery import load_at
from mmrs_core.sitl.faults import ENDS, FAULTS
from mmrs_core.sitl.hosting import Host
from mmrs_core.sitl.schedule import Planned, Schedule, order, planned
from mmrs_core.sitl.settings import Settings
from mmrs_core.sitl.vehicle import SimulatedVehicle
from mmrs_core.sitl.words import Deeds, deeds_of, state_of, summary

if TYPE_CHECKING:
    from mmrs_core.scene import RobotType

LOOK_SECONDS = 0.1
TELL_SECONDS = 10.0
SPACING = 0.0001
"""Degrees between vehicles without a model: eleven metres."""

USUAL_ENERGY = 1200.0
"""Seconds of hovering where nobody says how long a battery lasts."""

QUIT = frozenset({"quit", "exit"})


@dataclass(frozen=True, slots=True)
class Berth:
    """A robot that needs a vehicle.

    Attributes:
        kind: ``copter``, ``sub`` or ``rover``.
        home: latitude and longitude, degrees.
        energy: seconds of hovering in a full battery; recharge: seconds until it is full; 0: never.
    """

    robot: str
    kind: str
    home: tuple[float, float]
    energy: float = USUAL_ENERGY
    recharge: float = 0.0


@dataclass(frozen=True, slots=True)
class Berths:
    """What all vehicles have in common.

    Attributes:
        energy, recharge: for all of them; None: as each berth says.
    """

    port: int
    step: int
    host: str
    speedup: float
    loss: float
    delay: float
    seed: int
    firmware: str
    wind: str
    energy: float | None
    recharge: float | None
    parameters: tuple[str, ...]

    def vehicles(self, berths: Sequence[Berth]) -> tuple[tuple[str, SimulatedVehicle], ...]:
        """Return a vehicle for each robot, and say how it is reached.

        Raises:
            typer.BadParameter: if an option makes no sense.
        """
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
                energy=berth.energy if self.energy is None else self.energy,
                recharge=berth.recharge if self.recharge is None else self.recharge,
                parameters=dict(map(_parameter, self.parameters)),
            )
        except ValueError as error:
            raise typer.BadParameter(str(error)) from error
        return SimulatedVehicle(
            self.port + self.step * number,
            settings,
            host=self.host,
            speedup=self.speedup,
            loss=self.loss,
            delay=self.delay,
            seed=self.seed,
        )


def plain_berths(count: int, home: str, kind: str) -> list[Berth]:
    """Return vehicles without a model, side by side from west to east.

    Raises:
        typer.BadParameter: the home is no place.
    """
    latitude, longitude = pair(home, "--home")
    return [Berth(f"Vehicle{n + 1}", kind, (latitude, longitude + SPACING * n)) for n in range(count)]


def berths_of(settings: CliSettings, path: Path) -> list[Berth]:
    """Return the robots of a behaviour, or of a mission, with their homes.

    Raises:
        UnsupportedError: they have no place on Earth.
        InvalidModelError: the models are not valid.
    """
    from mmrs_core.cli.behaviours import is_behaviour, load_behaviour
    from mmrs_core.cli.journey import Journey, Workshop
    from mmrs_core.languages.modelset import model_in
    from mmrs_core.mavlink.earth import degrees_of
    from mmrs_core.mavlink.vehicles import class_of_type, vehicle_class

    workshop = Workshop(settings)
    found = model_in(path, "behaviour") if path.is_dir() else path
    if found is not None and found.is_file() and is_behaviour(workshop, found):
        loaded = load_behaviour(workshop, found)
        frame = loaded.program.frame
        robots = loaded.program.robots
        types = [loaded.place.types.get(each.type_name) for each in robots]
        crew = [
            (each.id, vehicle_class(each, type).name, each.home, _battery(each.payload, type))
            for each, type in zip(robots, types, strict=True)
        ]
    else:
        scene = Journey(workshop, path).grounded
        frame = scene.frame
        crew = [
            (each.name, class_of_type(each.type).name, each.home, _battery(each.payload, each.type))
            for each in scene.robots
        ]
    lost = [name for name, _, home, _ in crew if home is None]
    if lost:
        raise UnsupportedError(f"{path}: no home for {', '.join(lost)}")
    places = degrees_of([home[:2] for _, _, home, _ in crew if home is not None], frame)
    return [
        Berth(name, kind, place, *battery)
        for (name, kind, _, battery), place in zip(crew, places, strict=True)
    ]


def _battery(payload: float, type: RobotType | None) -> tuple[float, float]:
    """Return seconds of hovering and of recharging, so that it lasts its lifetime at its fastest."""
    able = [each for each in type.capabilities if each.payload >= payload] if type is not None else []
    charging = max((each.recharge_time or 0.0 for each in type.batteries), default=0.0) if type else 0.0
    if not able or able[0].lifetime is None:
        return USUAL_ENERGY, charging
    return able[0].lifetime * load_at(able[0].speed[1]), charging


def fault_list() -> None:
    """Print the names of all faults."""
    for name in FAULTS:
        say(f"{name}{'' if name in ENDS else '  (happens once)'}")


class Rehearsal:
    """Vehicles under way, until they are no longer wanted."""

    def __init__(self, vehicles: Sequence[tuple[str, SimulatedVehicle]], faults: Sequence[str]) -> None:
        """Be ready with these vehicles, to which these faults will happen.

        Raises:
            typer.BadParameter: a fault is none, or befalls nobody.
        """
        self._vehicles = vehicles
        plan = [_planned(text, [name for name, _ in vehicles]) for text in faults]
        self._schedules = {
            name: Schedule(vehicle, [fault for fault in plan if fault.robot in ("", name)])
            for name, vehicle in vehicles
        }
        self._modes = dict.fromkeys((name for name, _ in vehicles), "")
        self._stopped = False

    def run(self, seconds: float, *, quiet: bool = False) -> int:
        """Keep them going; return the exit code.

        Args:
            seconds: real ones until the end; 0: until somebody ends it.
            quiet: whether to leave the summary away.
        """
        host = Host([vehicle for _, vehicle in self._vehicles])
        lines = _typed_lines()
        before = {number: signal.signal(number, self._stop) for number in (signal.SIGINT, signal.SIGTERM)}
        host.start()
        try:
            ended = self._watch(time.monotonic() + seconds if seconds else float("inf"), lines)
        finally:
            host.stop()
            for number, handler in before.items():
                signal.signal(number, handler)
            for _, vehicle in self._vehicles:
                vehicle.radio.close()
        for name, vehicle in self._vehicles if not quiet else ():
            say(f"'{name}': {summary(deeds_of(vehicle))}")
        return 0 if ended else INTERRUPTED

    def deeds(self) -> dict[str, Deeds]:
        """Return what each vehicle did."""
        return {name: deeds_of(vehicle) for name, vehicle in self._vehicles}

    def _stop(self, number: int, frame: FrameType | None) -> None:
        self._stopped = True

    def _watch(self, until: float, lines: queue.SimpleQueue[str]) -> bool:
        """Return whether it ended by itself, or by a line; False: it was interrupted."""
        due = time.monotonic() + TELL_SECONDS
        while not self._stopped:
            now = time.monotonic()
            if now >= until or self._obey(lines):
                return True
            for name, schedule in self._schedules.items():
                for event in schedule.go_on():
                    tell(f"'{name}': {event}")
            if sys.stderr.isatty():
                self._tell_modes()
                if now >= due:
                    due = now + TELL_SECONDS
                    self._tell_states()
            time.sleep(LOOK_SECONDS)
        return False

    def _obey(self, lines: queue.SimpleQueue[str]) -> bool:
        while not lines.empty():
            line = lines.get().strip()
            if line in QUIT:
                return True
            if line in ("", "status"):
                self._tell_states()
                continue
            try:
                tell(f"{', '.join(order(line, self._vehicles))}: {line.partition(' ')[2]}")
            except ValueError as error:
                tell(str(error))
        return False

    def _tell_modes(self) -> None:
        for name, vehicle in self._vehicles:
            pilot = vehicle.autopilot
            now = f"{pilot.mode_name.upper()} {'armed' if pilot.armed else 'disarmed'}"
            if now != self._modes[name]:
                self._modes[name] = now
                tell(f"{pilot.time:7.1f} s '{name}': {now}")

    def _tell_states(self) -> None:
        for name, vehicle in self._vehicles:
            tell(f"{vehicle.autopilot.time:7.1f} s '{name}': {state_of(vehicle.autopilot)}")


def pair(text: str, option: str) -> tuple[float, float]:
    """Return two numbers that a comma parts.

    Raises:
        typer.BadParameter: they are not.
    """
    first, _, second = text.partition(",")
    try:
        return float(first), float(second)
    except ValueError:
        raise typer.BadParameter(f"{option} {text}: is not two numbers with a comma") from None


def _parameter(text: str) -> tuple[str, float]:
    name, _, value = text.partition("=")
    try:
        return name, float(value)
    except ValueError:
        raise typer.BadParameter(f"--parameter {text}: is not NAME=NUMBER") from None


def _planned(text: str, robots: Sequence[str]) -> Planned:
    try:
        fault = planned(text)
    except ValueError as error:
        raise typer.BadParameter(f"--fault {error}") from error
    if fault.robot and fault.robot not in robots:
        raise typer.BadParameter(f"--fault {text}: no robot '{fault.robot}'; there are {', '.join(robots)}")
    return fault


def _typed_lines() -> queue.SimpleQueue[str]:
    """Return what is typed, line by line, as it comes; nothing where nobody can type."""
    lines: queue.SimpleQueue[str] = queue.SimpleQueue()

    def read() -> None:
        for line in sys.stdin:
            lines.put(line)

    if sys.stdin is not None and not sys.stdin.closed:
        threading.Thread(target=read, name="typed lines", daemon=True).start()
    return lines
