"""Vehicles to fly on: ours, MAVSDK's servers, ArduCopter, PX4; the latter two where they are installed.

Each is a context manager; inside, `links` gives the arguments that reach its vehicles, and after it
`tracks` holds what each did: seconds, metres north, east and up of home.
"""

from __future__ import annotations

import json
import os
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from math import cos, radians, sin
from pathlib import Path

from peer_lines import said_in
from ports import free_port
from pymavlink.dialects.v20 import ardupilotmega as mavlink
from pyproj import Geod

from example_flight.mission import Home
from mmrs_mavlink.sitl import Host, Settings, SimulatedVehicle

PEERS = Path(__file__).parents[2] / "peers"
ENERGY = 20_000.0
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

    def __init__(self, homes: Sequence[Home], folder: Path, *, gusts: float = 0.0) -> None:
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
                    gusts=(gusts, 5.0),
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


class Recorder:
    """Hears a vehicle at a second port, and keeps where it was while it was armed."""

    def __init__(self, home: Home) -> None:
        self._home = home
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.bind(("127.0.0.1", 0))
        self._socket.settimeout(0.2)
        self.port = self._socket.getsockname()[1]
        self.track: list[tuple[float, float, float, float]] = []
        self._stopping = threading.Event()
        self._thread = threading.Thread(target=self._listen, daemon=True)
        self._thread.start()

    def stop(self) -> None:
        self._stopping.set()
        self._thread.join()
        self._socket.close()

    def _listen(self) -> None:
        codec, armed, asked = mavlink.MAVLink(None, 254, 190), False, 0.0
        codec.robust_parsing = True
        while not self._stopping.is_set():
            try:
                data, peer = self._socket.recvfrom(65_535)
            except TimeoutError:
                continue
            if time.monotonic() - asked > 5.0:
                asked = time.monotonic()
                self._socket.sendto(_wish().pack(codec), peer)
            for message in codec.parse_buffer(data) or ():
                if message.get_type() == "HEARTBEAT" and message.autopilot != mavlink.MAV_AUTOPILOT_INVALID:
                    armed = bool(message.base_mode & mavlink.MAV_MODE_FLAG_SAFETY_ARMED)
                elif message.get_type() == "GLOBAL_POSITION_INT" and armed:
                    self.track.append(self._place(message))

    def _place(self, message) -> tuple[float, float, float, float]:
        here = [(message.lon * 1e-7, message.lat * 1e-7)]
        azimuths, _, lengths = WGS84.inv(
            [self._home.longitude], [self._home.latitude], *zip(*here, strict=True)
        )
        north = lengths[0] * cos(radians(azimuths[0]))
        east = lengths[0] * sin(radians(azimuths[0]))
        return (message.time_boot_ms * 1e-3, north, east, message.relative_alt * 1e-3)


def _wish():
    """Return the wish for ten positions a second, to whichever autopilot hears it."""
    number = float(mavlink.MAVLINK_MSG_ID_GLOBAL_POSITION_INT)
    interval = mavlink.MAV_CMD_SET_MESSAGE_INTERVAL
    return mavlink.MAVLink_command_long_message(0, 0, interval, 0, number, 1e5, 0, 0, 0, 0, 0)


class Installed:
    """Autopilots' own simulations, one process a vehicle, each with a recorder beside it."""

    variable = ""
    speedup = 1.0
    ready_seconds = 90.0

    def __init__(self, homes: Sequence[Home], folder: Path) -> None:
        self._homes, self._folder = homes, folder
        self._binary = Path(os.environ[self.variable])
        self._recorders = [Recorder(home) for home in homes]
        self.ports = [free_port() for _ in homes]
        self.links = links_of(homes, self.ports)
        self.tracks: dict[str, list] = {}
        self._processes: list[subprocess.Popen] = []

    def __enter__(self):
        for number in range(len(self._homes)):
            command, environment, where = self.command(number)
            with (where / "output.txt").open("wb") as output:
                self._processes.append(
                    subprocess.Popen(
                        command,
                        cwd=where,
                        env={**os.environ, **environment},
                        stdin=subprocess.DEVNULL,
                        stdout=output,
                        stderr=subprocess.STDOUT,
                    )
                )
        return self

    def __exit__(self, *_):
        for process in self._processes:
            process.terminate()
        for process in self._processes:
            process.wait(30.0)
        for home, recorder in zip(self._homes, self._recorders, strict=True):
            recorder.stop()
            self.tracks[home.robot] = recorder.track

    def command(self, number: int) -> tuple[list[str], dict[str, str], Path]:
        """Return the command line of a vehicle, its environment, and the folder to start it in."""
        raise NotImplementedError

    def _own_folder(self, number: int) -> Path:
        where = self._folder / f"{self.variable.lower()}-{number}"
        where.mkdir(parents=True)
        return where


class ArduCopter(Installed):
    """ArduCopter's simulation; MMRS_ARDUCOPTER_PARAMETERS may name more parameter files, comma between."""

    variable = "MMRS_ARDUCOPTER"
    speedup = 5.0
    parameters = (
        "FRAME_CLASS 1",
        "FS_THR_ENABLE 0",
        "SIM_SPEEDUP 5",
        "INS_ACCOFFS_X 0.001",
        "INS_ACCOFFS_Y 0.001",
        "INS_ACCOFFS_Z 0.001",
        "INS_ACCSCAL_X 1.001",
        "INS_ACCSCAL_Y 1.001",
        "INS_ACCSCAL_Z 1.001",
        "BATT_MONITOR 4",
        "BATT_CAPACITY 100000",
        "SIM_BATT_CAP_AH 100",
    )
    """What its simulation needs to be armed, and a battery for the whole mission."""

    def command(self, number: int) -> tuple[list[str], dict[str, str], Path]:
        home, where = self._homes[number], self._own_folder(number)
        (where / "parameters.parm").write_text("".join(f"{line}\n" for line in self.parameters), "ascii")
        more = os.environ.get("MMRS_ARDUCOPTER_PARAMETERS", "")
        files = [*filter(None, more.split(",")), str(where / "parameters.parm")]
        command = [
            *(str(self._binary), "--model", "quad", "--wipe", "-I", str(number)),
            *("--home", f"{home.latitude:.7f},{home.longitude:.7f},{ALTITUDE},0"),
            *("--speedup", f"{self.speedup:g}", "--defaults", ",".join(files)),
            *("--sysid", str(number + 1)),
            *("--serial0", f"udpclient:127.0.0.1:{self.ports[number]}"),
            *("--serial1", f"udpclient:127.0.0.1:{self._recorders[number].port}"),
        ]
        return command, {}, where


class Px4(Installed):
    """PX4's simulation, with its own simulator in it; the binary stands in its build folder's ``bin``."""

    variable = "MMRS_PX4"
    speedup = 1.0

    def __init__(self, homes: Sequence[Home], folder: Path) -> None:
        super().__init__(homes, folder)
        self.ports = [14_540 + number for number in range(len(homes))]
        self.links = links_of(homes, self.ports)

    def command(self, number: int) -> tuple[list[str], dict[str, str], Path]:
        home, where = self._homes[number], self._own_folder(number)
        environment = {
            "PX4_SIM_MODEL": "sihsim_quadx",
            "PX4_HOME_LAT": str(round(home.latitude * 1e7)),
            "PX4_HOME_LON": str(round(home.longitude * 1e7)),
            "PX4_HOME_ALT": str(ALTITUDE),
            "PX4_SIM_SPEED_FACTOR": f"{self.speedup:g}",
        }
        etc = self._binary.parents[1] / "etc"
        return [str(self._binary), "-i", str(number), "-d", str(etc)], environment, where


FLEETS: Mapping[str, Callable] = {"ours": Ours, "mavsdk": OfMavsdk, "arducopter": ArduCopter, "px4": Px4}
