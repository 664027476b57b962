"""Vehicles to fly on: ours, MAVSDK's servers, ArduCopter, PX4; the latter two where they are installed.

Each is a context manager; inside, `links` gives the arguments that reach its vehicles, and after it
`tracks` holds what each did: seconds, metres north, east and up of home.
"""

import json
import subprocess
import sys
import threading
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from math import cos, radians, sin
from pathlib import Path
from typing import ClassVar

from firmware import ARDUCOPTER, PX4, Fix, InstalledVehicle, Stand
from peer_lines import said_in
from ports import free_port
from pyproj import Geod

from example_flight.mission import Home
from mmrs_mavlink.sitl import Host, Settings, SimulatedVehicle

PEERS = Path(__file__).parents[2] / "peers"
ENERGY = 20_000.0
CAPACITY, CELLS = 22_000.0, 6
"""Of the batteries of the example's drones, milliampere-hours and in series."""

ALTITUDE = 720.0
WGS84 = Geod(ellps="WGS84")


def links_of(homes: Sequence[Home], ports: Sequence[int]) -> dict[str, str]:
    """Return how each robot is reached, systems being counted from 1."""
    return {
        home.robot: f"udpin:127.0.0.1:{port}@{number}"
        for number, (home, port) in enumerate(zip(homes, ports, strict=True), start=1)
    }


class Ours:
    """Our simulated vehicles, in a thread of this process.

    Attributes:
        armed: by robot, whether its motors still run at the end.
    """

    speedup = 20.0

    def __init__(self, homes: Sequence[Home], folder: Path) -> None:
        ports = [free_port() for _ in homes]
        self.links = links_of(homes, ports)
        self.armed: dict[str, bool] = {}
        self.tracks: dict[str, list] = {}
        self._vehicles = {
            home.robot: SimulatedVehicle(
                port,
                Settings(
                    "copter",
                    home.latitude,
                    home.longitude,
                    number,
                    energy=ENERGY,
                    recharge=60.0,
                    capacity=CAPACITY,
                    cells=CELLS,
                ),
                speedup=self.speedup,
            )
            for number, (home, port) in enumerate(zip(homes, ports, strict=True), start=1)
        }
        self._host = Host(list(self._vehicles.values()))

    def __enter__(self):
        self._host.start()
        return self

    def __exit__(self, *_):
        self._host.stop()
        for robot, vehicle in self._vehicles.items():
            self.tracks[robot] = vehicle.autopilot.track
            self.armed[robot] = vehicle.autopilot.armed
            vehicle.stop()


class OfMavsdk:
    """Vehicles whose services are MAVSDK's where it has them, as another process.

    Attributes:
        by_mavsdk: how many messages of each name MAVSDK itself has sent, by robot.
    """

    speedup = 20.0

    def __init__(self, homes: Sequence[Home], folder: Path) -> None:
        ports = [free_port() for _ in homes]
        self.links = links_of(homes, ports)
        self.tracks: dict[str, list] = {}
        self.by_mavsdk: dict[str, Mapping[str, int]] = {}
        self._given = [
            {"robot": home.robot, "latitude": home.latitude, "longitude": home.longitude, "port": port}
            for home, port in zip(homes, ports, strict=True)
        ]

    def __enter__(self):
        command = [sys.executable, str(PEERS / "mavsdk_vehicles.py"), json.dumps(self._given)]
        pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "stderr": subprocess.STDOUT}
        self._process = subprocess.Popen([*command, str(self.speedup)], text=True, **pipes)
        self._said: list[dict] = []
        self._ready = threading.Event()
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()
        assert self._ready.wait(30.0), "MAVSDK does not start"
        return self

    def _read(self) -> None:
        for line in self._process.stdout:
            if (said := said_in(line)) is not None:
                self._said.append(said)
                self._ready.set()

    def __exit__(self, *_):
        self._process.stdin.close()
        self._process.wait(30.0)
        self._reader.join(30.0)
        self._process.stdout.close()
        for each in self._said:
            if "robot" in each:
                self.tracks[each["robot"]] = each["track"]
                self.by_mavsdk[each["robot"]] = each["by_mavsdk"]


class Installed:
    """Autopilots' own simulations, one process a vehicle, each observed beside it."""

    firmware = ARDUCOPTER
    speedup = 1.0
    parameters: ClassVar[Mapping[str, float]] = {}
    properties: ClassVar[Mapping[str, str] | None] = None

    def __init__(self, homes: Sequence[Home], folder: Path) -> None:
        self._vehicles = {
            home.robot: InstalledVehicle(
                self.firmware,
                Stand(home.latitude, home.longitude, ALTITUDE),
                folder,
                number=number,
                speedup=self.speedup,
                parameters=self.parameters,
            )
            for number, home in enumerate(homes)
        }
        self.links = {robot: vehicle.link for robot, vehicle in self._vehicles.items()}
        self.tracks: dict[str, list] = {}
        self._homes = {home.robot: home for home in homes}

    def __enter__(self):
        with ExitStack() as started:
            for vehicle in self._vehicles.values():
                started.enter_context(vehicle)
            self._started = started.pop_all()
        return self

    def __exit__(self, *error):
        self._started.close()
        for robot, vehicle in self._vehicles.items():
            self.tracks[robot] = _metres(self._homes[robot], vehicle.observer.track)


def _metres(home: Home, track: Sequence[Fix]) -> list[tuple[float, float, float, float]]:
    """Return where a vehicle was while it was armed: seconds, metres north, east and up of home."""
    flown = [fix for fix in track if fix.armed]
    begin = ([home.longitude] * len(flown), [home.latitude] * len(flown))
    azimuths, _, lengths = WGS84.inv(*begin, [fix.lon for fix in flown], [fix.lat for fix in flown])
    return [
        (fix.t, length * cos(radians(azimuth)), length * sin(radians(azimuth)), fix.rel)
        for fix, azimuth, length in zip(flown, azimuths, lengths, strict=True)
    ]


class ArduCopter(Installed):
    """ArduCopter's simulation."""

    speedup = 5.0


class Px4(Installed):
    """PX4's simulation, with its own simulator in it; the binary stands in its build folder's ``bin``.

    A PX4 switches no relays: its gas sensor is where a gripper would be.
    """

    firmware = PX4
    parameters: ClassVar[Mapping[str, float]] = {"PD_GRIPPER_EN": 1}
    properties: ClassVar[Mapping[str, str] | None] = {
        "mavlink.gripper": "1",
        "mavlink.gripper.SampleGas": "grab",
    }


FLEETS: Mapping[str, Callable] = {"ours": Ours, "mavsdk": OfMavsdk, "arducopter": ArduCopter, "px4": Px4}
