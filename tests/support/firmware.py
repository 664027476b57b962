"""Autopilots' own simulations: started one process a vehicle, with an observer at a link of its own.

`FIRMWARES` are those that can be started, as values. `InstalledVehicle` starts one and keeps its track.
Environment variables name binaries and files with the default parameters of the class of vehicle: nothing of
a firmware is part of this project.
"""

from __future__ import annotations

import json
import os
import socket
import struct
import subprocess
import threading
import time
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import NamedTuple

from ports import free_port, is_free
from pymavlink.dialects.v20 import ardupilotmega as mavlink

FIRST_INSTANCE, INSTANCES, VEHICLES = 80, 160, 8
"""Of ArduPilot's simulations: rarely those of one that was started by hand; of a process, at most eight."""

PX4_INSTANCES, PX4_KEPT = 10, 14_650
"""Instances with ports of their own, and the first of the ports by which each is kept for a vehicle."""

RATE = 10.0
ASK_SECONDS = 2.0
LARGEST = 65_535
FLOAT, WHOLE = struct.Struct("<f"), struct.Struct("<i")
SIGNED_SINCE = 1
"""Time stamp with which a key is given: any later frame is accepted."""


@dataclass(frozen=True, slots=True)
class Firmware:
    """What is known of an autopilot's simulation.

    Attributes:
        name: as printed.
        variable: environment variable that names the binary; with ``_PARAMETERS`` behind it, files with
            parameters, comma between, that the class of vehicle needs before it can be armed.
        vehicle: class of vehicle, as `RobotKind.vehicle` names it.
        model: what is simulated, as its command line names it.
        parameters: beyond those files: what every flight needs.
    """

    name: str
    variable: str
    vehicle: str
    model: str
    parameters: Mapping[str, float] = field(default_factory=dict)

    @property
    def binary(self) -> str:
        """Return the path of the binary; empty where none is given."""
        return os.environ.get(self.variable, "")


LARGE_BATTERY = {"BATT_MONITOR": 4, "BATT_CAPACITY": 100_000, "SIM_BATT_CAP_AH": 100}
"""Lasts for every flight: the stock one of 3.3 Ah is at a quarter after five minutes."""

POLYGONS_ONLY = {"FENCE_TYPE": 4}
"""An enabled fence is otherwise also a circle, of 150 m in the copter's default parameters."""

CAMERA = {"CAM1_TYPE": 1, "SERVO9_FUNCTION": 10}
"""Without them, the vehicle has no camera."""

GIMBAL = {"MNT1_TYPE": 1, "SERVO10_FUNCTION": 7, "SERVO11_FUNCTION": 6}
RELAYS = {"RELAY1_FUNCTION": 1, "RELAY1_PIN": 13, "RELAY2_FUNCTION": 1, "RELAY2_PIN": 14}

ARDUCOPTER = Firmware(
    "ArduCopter",
    "MMRS_ARDUCOPTER",
    "copter",
    "quad",
    {**LARGE_BATTERY, **POLYGONS_ONLY, **CAMERA, **GIMBAL, **RELAYS, "FRAME_CLASS": 1, "FS_THR_ENABLE": 0}
    | {f"INS_ACCOFFS_{axis}": 0.001 for axis in "XYZ"}
    | {f"INS_ACCSCAL_{axis}": 1.001 for axis in "XYZ"},
)
ARDUROVER = Firmware(
    "ArduRover", "MMRS_ARDUROVER", "rover", "rover", {**LARGE_BATTERY, **POLYGONS_ONLY, **RELAYS}
)
ARDUROVER_SKID = replace(
    ARDUROVER,
    model="rover-skid",
    parameters={
        **ARDUROVER.parameters,
        **{"SERVO1_FUNCTION": 73, "SERVO3_FUNCTION": 74, "ATC_STR_RAT_FF": 0.2},
        **{"CRUISE_SPEED": 3, "CRUISE_THROTTLE": 75, "WP_SPEED": 3},
    },
)
"""Steers by the difference of its tracks, so that it turns on the spot."""

ARDUSUB = Firmware("ArduSub", "MMRS_ARDUSUB", "sub", "vectored", {**LARGE_BATTERY, **CAMERA, **RELAYS})
PX4 = Firmware(
    "PX4",
    "MMRS_PX4",
    "copter",
    "sihsim_quadx",
    {"SIM_BAT_DRAIN": 3600, "MPC_LAND_CRWL": 0.6, "LNDMC_Z_VEL_MAX": 0.5},
)
"""Its simulated battery is otherwise at half of its charge after a minute. Its land detector otherwise wants
a climb within 0.25 m/s, while that which it estimates wanders by 0.3 to 0.5 m/s on the ground; the limit is
kept below MPC_LAND_CRWL.
"""

FIRMWARES = (ARDUCOPTER, ARDUROVER, ARDUSUB, PX4)


class Fix(NamedTuple):
    """What a vehicle reported of itself: seconds since its start, degrees, metres, metres per second.

    `seq` is `Observer.item`.
    """

    t: float
    lat: float
    lon: float
    amsl: float
    rel: float
    vx: float
    vy: float
    vz: float
    hdg: float
    armed: bool
    mode: int
    seq: int


class Observer:
    """Receives from a vehicle at a link of its own, keeps its track, and changes it as a test or pilot does.

    It sends no heartbeats, so that it is no ground station.

    Attributes:
        port: where it listens. track: every fix, about ten a second. texts: with the seconds of the vehicle.
        version: of the firmware, as it reports it. has_been_armed: whether it ever was.
        parameters: that it has reported. requests, mission_acks: of transfers: type, and number or result.
        acks: of commands: number, result. system: of the vehicle. photos: numbers of those that it has
            reported; of two at once, it may report the second only.
    """

    def __init__(self, peer: tuple[str, int] | None = None, system: int = 0) -> None:
        """Begin to listen; `peer` is where a vehicle listens that must be addressed first."""
        self.track: list[Fix] = []
        self.texts: list[tuple[float, str]] = []
        self.version = ""
        self.has_been_armed = False
        self.parameters: dict[str, float] = {}
        self.photos: set[int] = set()
        self.requests: list[tuple[int, int]] = []
        self._sorts: dict[str, struct.Struct] = {}
        self._is_px4: bool | None = None  # before its first heartbeat
        self.acks: list[tuple[int, int]] = []
        self.mission_acks: list[tuple[int, int]] = []
        self.system, self._peer = system, peer
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.bind(("127.0.0.1", 0))
        self._socket.settimeout(0.2)
        self.port: int = self._socket.getsockname()[1]
        self._armed, self._mode, self._item, self._now = False, -1, 0, 0.0
        self._codec = mavlink.MAVLink(None, 254, 190)
        self._sending = threading.Lock()
        self._began: tuple[float, float] | None = None
        self._stopping = threading.Event()
        self._thread = threading.Thread(target=self._listen, name="observer", daemon=True)
        self._thread.start()

    @property
    def armed(self) -> bool:
        """Return whether the motors may run."""
        return self._armed

    @property
    def mode(self) -> int:
        """Return the number of the mode; -1 before the first heartbeat."""
        return self._mode

    @property
    def item(self) -> int:
        """Return the number of the mission's item that it is at; once it is complete, one beyond the last."""
        return self._item

    @property
    def now(self) -> float:
        """Return the seconds of the vehicle."""
        return self._now

    @property
    def pace(self) -> float:
        """Return the vehicle's seconds in a real one since it was first received."""
        if self._began is None:
            return 0.0
        real, own = self._began
        return (self._now - own) / max(time.monotonic() - real, 1e-9)

    def send(self, message: mavlink.MAVLink_message) -> None:
        """Send a message to the vehicle; before it has been received, nothing is sent."""
        with self._sending:
            if self._peer is not None:
                self._socket.sendto(message.pack(self._codec), self._peer)

    def command(self, number: int, *params: float) -> None:
        """Send a command."""
        values = (*params, *[0.0] * 7)[:7]
        self.send(mavlink.MAVLink_command_long_message(self.system, 1, number, 0, *values))

    def change(self, parameters: Mapping[str, float], patience: float = 20.0) -> None:
        """Set parameters until the vehicle reports their values.

        Raises:
            TimeoutError: it does not within so many real seconds.
        """
        until = time.monotonic() + patience
        for name, value in parameters.items():
            self.parameters.pop(name, None)
            while abs(self.parameters.get(name, value + 1.0) - value) > 1e-4 * max(1.0, abs(value)):
                if time.monotonic() > until:
                    raise TimeoutError(f"parameter {name}: the vehicle does not take {value:g}")
                code, sort = name.encode("ascii"), self._sorts.get(name)
                if sort is None:  # parameters received before the first heartbeat are read again
                    self.send(mavlink.MAVLink_param_request_read_message(self.system, 1, code, -1))
                else:
                    written = value if sort is FLOAT else FLOAT.unpack(sort.pack(round(value)))[0]
                    number = mavlink.MAV_PARAM_TYPE_REAL32 if sort is FLOAT else mavlink.MAV_PARAM_TYPE_INT32
                    self.send(mavlink.MAVLink_param_set_message(self.system, 1, code, written, number))
                time.sleep(0.2)

    def read(self, name: str, patience: float = 4.0) -> float | None:
        """Return the value of a parameter; None: it does not tell it within so many real seconds."""
        until = time.monotonic() + patience
        while name not in self.parameters and time.monotonic() < until:
            self.send(mavlink.MAVLink_param_request_read_message(self.system, 1, name.encode("ascii"), -1))
            time.sleep(0.2)
        return self.parameters.get(name)

    def store(self, patience: float = 20.0) -> None:
        """Wait until the vehicle has stored its parameters.

        Raises:
            TimeoutError: it does not within so many real seconds.
        """
        until, stored = time.monotonic() + patience, (mavlink.MAV_CMD_PREFLIGHT_STORAGE, 0)
        while stored not in self.acks:
            if time.monotonic() > until:
                raise TimeoutError("the vehicle does not store its parameters")
            self.command(stored[0], 1)
            time.sleep(0.5)

    def stop(self) -> None:
        """Stop listening."""
        self._stopping.set()
        self._thread.join()
        self._socket.close()

    def _listen(self) -> None:
        self._codec.robust_parsing = True
        asked = 0.0
        while not self._stopping.is_set():
            if time.monotonic() - asked > ASK_SECONDS:
                asked = time.monotonic()
                self._ask()
            try:
                data, sender = self._socket.recvfrom(LARGEST)
            except TimeoutError:
                continue
            except OSError:
                continue  # nothing listens at its address yet
            self._peer = sender
            for message in self._codec.parse_buffer(data) or ():
                self._keep(message)

    def _ask(self) -> None:
        """Request what is kept: a vehicle that restarts forgets it."""
        intervals = (mavlink.MAVLINK_MSG_ID_GLOBAL_POSITION_INT, mavlink.MAVLINK_MSG_ID_MISSION_CURRENT)
        for number in intervals:
            self.command(mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, number, 1e6 / RATE)
        if not self.version:
            self.command(mavlink.MAV_CMD_REQUEST_MESSAGE, mavlink.MAVLINK_MSG_ID_AUTOPILOT_VERSION)

    def _keep(self, message: mavlink.MAVLink_message) -> None:
        kind = message.get_type()
        if kind in (
            "GLOBAL_POSITION_INT",
            "ATTITUDE",
        ):  # some vehicles that lose their position tell no more of it
            self._keep_time(message.time_boot_ms * 1e-3)
        if kind == "HEARTBEAT" and message.autopilot != mavlink.MAV_AUTOPILOT_INVALID:
            self.system = message.get_srcSystem()
            self._is_px4 = message.autopilot == mavlink.MAV_AUTOPILOT_PX4
            self._armed = bool(message.base_mode & mavlink.MAV_MODE_FLAG_SAFETY_ARMED)
            self.has_been_armed |= self._armed
            self._mode = message.custom_mode
        elif kind == "GLOBAL_POSITION_INT":
            self._keep_fix(message)
        elif kind == "MISSION_CURRENT":
            complete = message.mission_state == mavlink.MISSION_STATE_COMPLETE
            self._item = message.total + 1 if complete else message.seq
        elif kind == "MISSION_ITEM_REACHED":  # MISSION_CURRENT may come a second later
            self._item = message.seq + 1 if message.seq == self._item else self._item
        elif kind in ("CAMERA_IMAGE_CAPTURED", "CAMERA_FEEDBACK"):
            self.photos.add(message.img_idx if kind == "CAMERA_FEEDBACK" else message.image_index)
        elif kind == "STATUSTEXT":
            self.texts.append((self._now, message.text))
        elif kind == "PARAM_VALUE" and self._is_px4 is not None:
            # PX4 copies the bytes of a whole number
            whole = self._is_px4 and message.param_type == mavlink.MAV_PARAM_TYPE_INT32
            sort = self._sorts[message.param_id] = WHOLE if whole else FLOAT
            self.parameters[message.param_id] = sort.unpack(FLOAT.pack(message.param_value))[0]
        elif kind == "AUTOPILOT_VERSION":
            self.version = _version(message.flight_sw_version)
        elif kind in ("MISSION_REQUEST", "MISSION_REQUEST_INT"):
            self.requests.append((message.mission_type, message.seq))
        elif kind == "MISSION_ACK":
            self.mission_acks.append((message.mission_type, message.type))
        elif kind == "COMMAND_ACK":
            self.acks.append((message.command, message.result))

    def _keep_time(self, now: float) -> None:
        self._now = now
        if self._began is None or now < self._began[1]:
            self._began = (time.monotonic(), now)

    def _keep_fix(self, message: mavlink.MAVLink_message) -> None:
        degrees = (message.lat * 1e-7, message.lon * 1e-7)
        heights = (message.alt * 1e-3, message.relative_alt * 1e-3)
        speeds = (message.vx * 0.01, message.vy * 0.01, message.vz * 0.01)
        heading = message.hdg * 0.01
        state = (self._armed, self._mode, self._item)
        self.track.append(Fix(self._now, *degrees, *heights, *speeds, heading, *state))


def _version(number: int) -> str:
    major, minor, patch, sort = struct.unpack(">BBBB", struct.pack(">I", number))
    sorts = ((0, "dev"), (64, "alpha"), (128, "beta"), (192, "rc"))
    known = next((name for least, name in reversed(sorts) if sort >= least), "")
    return f"{major}.{minor}.{patch}" + (f"-{known}" if sort < 255 else "")


@dataclass(frozen=True, slots=True)
class Stand:
    """Where a vehicle stands at first: degrees, metres above mean sea level, degrees clockwise from north."""

    latitude: float
    longitude: float
    altitude: float = 0.0
    heading: float = 0.0


class InstalledVehicle:
    """A simulation of an autopilot, as a process; a context.

    Attributes:
        observer: beside it. port: to which it sends by UDP; `listens` at which a program would listen.
    """

    def __init__(
        self,
        firmware: Firmware,
        stand: Stand,
        folder: Path,
        *,
        number: int = 0,
        port: int | None = None,
        speedup: float = 1.0,
        parameters: Mapping[str, float] | None = None,
        key: bytes = b"",
    ) -> None:
        """Prepare it.

        Args:
            firmware: that is simulated.
            stand: where.
            folder: for its files; its own one is made in it.
            number: of the vehicle, from 0; its system is one more, or that of a PX4's instance.
            port: to which it sends; None: any.
            speedup: seconds of the vehicle in a second.
            parameters: beyond those of the firmware.
            key: by which links are signed; empty: they are not. ArduPilot's first serial port accepts what
                is not signed, so that a program is connected to its second one then.
        """
        self._key = key
        self.firmware, self.speedup, self.number = firmware, speedup, number
        self._stand = stand
        self._parameters = {**firmware.parameters, **(parameters or {})}
        self._folder = folder / f"{firmware.name.lower()}-{number}"
        self._folder.mkdir(parents=True, exist_ok=True)
        self._process: subprocess.Popen[bytes] | None = None
        px4 = firmware is PX4
        instance, self._kept = _px4_instance() if px4 else (number, None)
        self._instance, self.system = instance, instance + 1
        self.port = 14_540 + instance if px4 else port or free_port()
        self.observer = Observer(("127.0.0.1", 18_570 + instance) if px4 else None, self.system)

    @property
    def link(self) -> str:
        """Return how a program reaches it."""
        return self.link_at(self.port)

    def link_at(self, port: int) -> str:
        """Return how a program reaches it that listens at another port."""
        return f"udpin:127.0.0.1:{port}@{self.system}"

    def __enter__(self) -> InstalledVehicle:
        try:
            self.start()
        except TimeoutError:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_: object) -> None:
        self.kill()
        self.observer.stop()
        if self._kept is not None:
            self._kept.close()

    def start(self, *, wipe: bool = True) -> None:
        """Start the process; without `wipe`, as after a loss of power: what it has stored is kept."""
        self._run(wipe=wipe)
        if self.firmware is PX4:
            self.observer.change(self._parameters)
            if wipe and self._parameters:  # some are read when it starts, such as PD_GRIPPER_EN
                self.observer.store()
                self.kill()
                self._run(wipe=False)
                self.observer.change(self._parameters)

    def _run(self, *, wipe: bool) -> None:
        command, environment = self._px4() if self.firmware is PX4 else self._ardupilot(wipe=wipe)
        with (self._folder / "output.txt").open("ab") as output:
            self._process = subprocess.Popen(
                command,
                cwd=self._folder,
                env={**os.environ, **environment},
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=subprocess.STDOUT,
            )

    def sign(self) -> None:
        """Give it its key, once it runs: from then on, it signs and accepts only what is signed."""
        self.observer.send(mavlink.MAVLink_setup_signing_message(self.system, 1, self._key, SIGNED_SINCE))

    def kill(self) -> None:
        """End the process."""
        if self._process is not None:
            self._process.kill()
            self._process.wait(30.0)

    def _ardupilot(self, *, wipe: bool) -> tuple[list[str], dict[str, str]]:
        lines = (f"{name} {value:g}\n" for name, value in self._parameters.items())
        (self._folder / "flight.parm").write_text("".join(lines), "ascii")
        given = os.environ.get(f"{self.firmware.variable}_PARAMETERS", "")
        files = [*filter(None, given.split(",")), str(self._folder / "flight.parm")]
        stand = self._stand
        command = [
            *(self.firmware.binary, "--model", self.firmware.model),
            *(["--wipe"] if wipe else []),
            *("-I", str(_instance(self.number)), "--sysid", str(self.number + 1)),
            *("--home", f"{stand.latitude:.7f},{stand.longitude:.7f},{stand.altitude:g},{stand.heading:g}"),
            *("--speedup", f"{self.speedup:g}", "--defaults", ",".join(files)),
            *("--serial1" if self._key else "--serial0", f"udpclient:127.0.0.1:{self.port}"),
            *("--serial0" if self._key else "--serial1", f"udpclient:127.0.0.1:{self.observer.port}"),
        ]
        return command, {}

    def _px4(self) -> tuple[list[str], dict[str, str]]:
        build = Path(self.firmware.binary).parents[1]
        latitude, longitude = _home_for_px4(build, self._stand.latitude, self._stand.longitude)
        environment = {
            "PX4_SIM_MODEL": self.firmware.model,
            "PX4_HOME_LAT": latitude,
            "PX4_HOME_LON": longitude,
            "PX4_HOME_ALT": f"{self._stand.altitude:g}",
            "PX4_SIM_SPEED_FACTOR": f"{self.speedup:g}",
        }
        return [self.firmware.binary, "-i", str(self._instance), "-d", str(build / "etc")], environment


def _home_for_px4(build: Path, *degrees: float) -> list[str]:
    """Return coordinates in the units of a PX4's parameters: degrees, or up to 1.15 degrees × 10⁷."""
    listed = json.loads((build / "parameters.json").read_text("utf-8"))["parameters"]
    types = {parameter["name"]: parameter["type"] for parameter in listed}
    whole = types["SIH_LOC_LAT0"] == "Int32"
    return [str(round(each * 1e7)) if whole else f"{each:.7f}" for each in degrees]


def _px4_instance() -> tuple[int, socket.socket]:
    """Return a number of PX4's instances, and what keeps others from it while the vehicle restarts.

    All beyond the tenth share the same ports.
    """
    for instance in reversed(range(PX4_INSTANCES)):
        kept = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        try:
            kept.bind(("127.0.0.1", PX4_KEPT + instance))
        except OSError:
            kept.close()
            continue
        if all(is_free(port + instance, socket.SOCK_DGRAM) for port in (14_540, 14_580, 18_570)):
            return instance, kept
        kept.close()
    raise RuntimeError("no instance of PX4's simulation is left")


def _instance(number: int) -> int:
    """Return a number of ArduPilot's instances whose ports are free; another process begins with another."""
    begin = os.getpid() * VEHICLES + number
    for instance in (FIRST_INSTANCE + (begin + more) % INSTANCES for more in range(0, INSTANCES, VEHICLES)):
        remote_control, serial2 = 5501 + 10 * instance, 5763 + 10 * instance
        if is_free(remote_control, socket.SOCK_DGRAM) and is_free(serial2, socket.SOCK_STREAM):
            return instance
    raise RuntimeError("no instance of ArduPilot's simulation is left")
