"""The simulated vehicle on the network: MAVLink over UDP, at any multiple of real time."""

from __future__ import annotations

import random
import socket
import threading
import time
from collections.abc import Callable
from math import degrees, isnan
from types import TracebackType
from typing import Any

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_core.sitl.autopilot import TYPES, Autopilot, Settings
from mmrs_core.sitl.faults import Faults
from mmrs_core.sitl.missions import MissionProtocol

Message = Any

TICK_SECONDS = 0.01
LARGEST = 65_535
POSITION_SECONDS, STATUS_SECONDS, HEARTBEAT_SECONDS = 0.1, 0.5, 1.0
YAW_IGNORED = mavlink.POSITION_TARGET_TYPEMASK_YAW_IGNORE
PREARM = 0x1000_0000
UNFIT_SECONDS = 30.0
EKF_LOCATED, EKF_LOST = 0x33F, 0xA7
SECTOR_FREE = 6_001
SIGNATURE_EPOCH = 1_420_070_400


class SimulatedVehicle:
    """A vehicle that sends to one UDP address, and listens for the answers, in a thread of its own.

    Attributes:
        autopilot: what it does; read it freely, its numbers may be a tick old.
        faults: makes things go wrong with it.
        received: (seconds, name) of every message that has come for it, but heartbeats.
    """

    def __init__(
        self,
        port: int,
        settings: Settings | None = None,
        *,
        host: str = "127.0.0.1",
        speedup: float = 1.0,
        loss: float = 0.0,
        seed: int = 0,
    ) -> None:
        """Prepare a vehicle; it speaks from `start` on.

        Args:
            port: UDP port of the ground station.
            settings: how it is.
            host: of the ground station.
            speedup: seconds of simulation in a second.
            loss: part of all datagrams that are lost, either way.
            seed: of the losses.
        """
        self.autopilot = Autopilot(settings or Settings())
        self._address = (host, port)
        self._speedup = speedup
        self._loss = loss
        self._random = random.Random(seed)
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.bind(("127.0.0.1" if host == "127.0.0.1" else "0.0.0.0", 0))
        self._socket.settimeout(TICK_SECONDS)
        self._mav = mavlink.MAVLink(None, srcSystem=self.autopilot.settings.system, srcComponent=1)
        self._mav.robust_parsing = True
        if self.autopilot.settings.key:
            self._sign(self.autopilot.settings.key)
        self.received: list[tuple[float, str]] = []
        self._missions = MissionProtocol(self.autopilot.stores, self._answer)
        self._late: list[tuple[float, Message]] = []
        self._due: dict[str, float] = {}
        self._lock = threading.RLock()
        self.faults = Faults(self.autopilot, self._lock)
        self._stopping = threading.Event()
        self._thread = threading.Thread(target=self._run, name="simulated vehicle", daemon=True)

    def start(self) -> None:
        """Switch the vehicle on."""
        self._thread.start()

    def stop(self) -> None:
        """Switch it off."""
        self._stopping.set()
        self._thread.join()
        self._socket.close()

    def mute(self) -> None:
        """Cut the link both ways; the vehicle goes on."""
        self.faults.cut_link()

    def unmute(self) -> None:
        """Mend the link."""
        self.faults.mend_link()

    def __enter__(self) -> SimulatedVehicle:
        """Switch the vehicle on."""
        self.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Switch it off."""
        self.stop()

    def _sign(self, key: bytes) -> None:
        signing = self._mav.signing
        signing.secret_key, signing.sign_outgoing = key, True
        signing.timestamp = int((time.time() - SIGNATURE_EPOCH) * 100_000)

    def _run(self) -> None:
        last = time.monotonic()
        while not self._stopping.is_set():
            data = self._receive()
            with self._lock:
                self._hear(data)
                now = time.monotonic()
                self._go_on((now - last) * self._speedup)
                last = now

    def _go_on(self, seconds: float) -> None:
        self.autopilot.advance(seconds)
        self._missions.busy = self.autopilot.uptime < self.autopilot.settings.boot
        while self._late and self._late[0][0] <= self.autopilot.time:
            self._send(self._late.pop(0)[1])
        for tell, period in _TELLS:
            self._tell(tell, period)

    def _receive(self) -> bytes:
        try:
            return self._socket.recv(LARGEST)
        except (TimeoutError, ConnectionRefusedError):
            return b""

    def _hear(self, data: bytes) -> None:
        if not data or self._deaf or self._random.random() < self._loss:
            return
        for message in self._mav.parse_buffer(data) or ():
            self._take(message)

    @property
    def _deaf(self) -> bool:
        return self.faults.link_down or self.autopilot.booting

    def _answer(self, message: Message) -> None:
        if self.faults.answer_delay:
            self._late.append((self.autopilot.time + self.faults.answer_delay, message))
        else:
            self._send(message)

    def _take(self, message: Message) -> None:
        if message.get_type() != "HEARTBEAT":
            self.received.append((self.autopilot.time, message.get_type()))
        if message.get_type() == "COMMAND_LONG":
            self._command(message)
        elif message.get_type() == "SET_POSITION_TARGET_GLOBAL_INT":
            place = self.autopilot.local(message.lat_int * 1e-7, message.lon_int * 1e-7, message.alt)
            self.autopilot.steer(place, _heading(message))
        elif message.get_type() == "SET_POSITION_TARGET_LOCAL_NED":
            self.autopilot.steer((message.x, message.y, -message.z), _heading(message))
        elif message.get_type() == "PARAM_SET":
            self._parameter(message)
        else:
            self._missions.take(message)

    def _command(self, message: Message) -> None:
        if message.command in self.autopilot.silent:
            return
        params = tuple(getattr(message, f"param{number}") for number in range(1, 8))
        result = self.autopilot.command(message.command, params)
        self._send(
            mavlink.MAVLink_command_ack_message(
                message.command,
                result,
                target_system=message.get_srcSystem(),
                target_component=message.get_srcComponent(),
            )
        )

    def _parameter(self, message: Message) -> None:
        name = message.param_id
        if name not in self.autopilot.parameters:
            return
        self.autopilot.parameters[name] = message.param_value
        self._send(
            mavlink.MAVLink_param_value_message(
                name.encode(), message.param_value, mavlink.MAV_PARAM_TYPE_REAL32, 1, 0
            )
        )

    def _tell(self, tell: Callable[[SimulatedVehicle], None], period: float) -> None:
        key = tell.__name__
        if self.autopilot.time >= self._due.get(key, 0.0):
            self._due[key] = self.autopilot.time + period
            tell(self)

    def _send(self, message: Message) -> None:
        data = message.pack(self._mav)
        self._mav.seq = (self._mav.seq + 1) % 256
        if self._deaf or self._random.random() < self._loss:
            return
        try:
            self._socket.sendto(data, self._address)
        except ConnectionRefusedError:
            return

    def _tell_heartbeat(self) -> None:
        pilot = self.autopilot
        armed = mavlink.MAV_MODE_FLAG_SAFETY_ARMED if pilot.armed else 0
        self._send(
            mavlink.MAVLink_heartbeat_message(
                TYPES[pilot.settings.kind],
                mavlink.MAV_AUTOPILOT_ARDUPILOTMEGA,
                mavlink.MAV_MODE_FLAG_CUSTOM_MODE_ENABLED | armed,
                pilot.mode,
                mavlink.MAV_STATE_ACTIVE if pilot.armed else mavlink.MAV_STATE_STANDBY,
                3,
            )
        )

    def _tell_position(self) -> None:
        pilot = self.autopilot
        if pilot.uptime < pilot.settings.ready:
            return
        latitude, longitude = pilot.degrees()
        north, east, up = pilot.body.position
        v_north, v_east, v_up = pilot.body.velocity
        now = self._boot_milliseconds()
        self._send(
            mavlink.MAVLink_global_position_int_message(
                now,
                round(latitude * 1e7),
                round(longitude * 1e7),
                round((720.0 + up) * 1000),
                round(up * 1000),
                round(v_north * 100),
                round(v_east * 100),
                round(-v_up * 100),
                round(pilot.body.heading * 100) % 36_000,
            )
        )
        self._send(mavlink.MAVLink_local_position_ned_message(now, north, east, -up, v_north, v_east, -v_up))
        self._send(mavlink.MAVLink_mission_current_message(pilot.item))

    def _tell_status(self) -> None:
        pilot = self.autopilot
        health = PREARM if pilot.ready else 0
        landed = mavlink.MAV_LANDED_STATE_IN_AIR if pilot.airborne else mavlink.MAV_LANDED_STATE_ON_GROUND
        self._send(
            mavlink.MAVLink_sys_status_message(
                health, health, health, 0, 15_000, -1, round(pilot.energy * 100), 0, 0, 0, 0, 0, 0
            )
        )
        self._send(mavlink.MAVLink_extended_sys_state_message(0, landed))
        located = pilot.located and pilot.uptime >= pilot.settings.ready
        flags = EKF_LOCATED if located else EKF_LOST
        self._send(mavlink.MAVLink_ekf_status_report_message(flags, 0, 0, 0, 0, 0))
        latitude, longitude = pilot.degrees()
        self._send(
            mavlink.MAVLink_gps_raw_int_message(
                self._boot_milliseconds() * 1000,
                mavlink.GPS_FIX_TYPE_3D_FIX if located else mavlink.GPS_FIX_TYPE_NO_FIX,
                round(latitude * 1e7),
                round(longitude * 1e7),
                round((720.0 + pilot.body.position[2]) * 1000),
                80 if located else 9999,
                65_535,
                0,
                65_535,
                14 if located else 0,
            )
        )
        self._send(
            mavlink.MAVLink_system_time_message(
                round((time.time() + pilot.clock_error) * 1e6), self._boot_milliseconds()
            )
        )
        self._send(
            mavlink.MAVLink_fence_status_message(
                pilot.breached, pilot.breaches, mavlink.FENCE_BREACH_BOUNDARY if pilot.breached else 0, 0
            )
        )
        for name, value in pilot.settings.values.items():
            self._send(
                mavlink.MAVLink_named_value_float_message(
                    self._boot_milliseconds(), name.encode(), value(pilot.time)
                )
            )

    def _tell_events(self) -> None:
        pilot = self.autopilot
        while pilot.texts:
            severity, text = pilot.texts.pop(0)
            self._send(mavlink.MAVLink_statustext_message(severity, text.encode()[:50]))
        while pilot.photos:
            self._tell_photo(pilot.photos.pop(0))
        if pilot.obstacle is not None:
            self._tell_obstacle(*pilot.obstacle)

    def _tell_photo(self, place: tuple[float, float, float]) -> None:
        pilot = self.autopilot
        latitude, longitude = pilot.degrees()
        pilot.taken += 1
        self._send(
            mavlink.MAVLink_camera_feedback_message(
                self._boot_milliseconds() * 1000,
                pilot.settings.system,
                0,
                pilot.taken,
                round(latitude * 1e7),
                round(longitude * 1e7),
                720.0 + place[2],
                place[2],
                0.0,
                0.0,
                pilot.body.heading,
                0.0,
                mavlink.CAMERA_FEEDBACK_PHOTO,
            )
        )

    def _tell_obstacle(self, distance: float, bearing: float) -> None:
        sectors = [SECTOR_FREE] * 72
        sectors[round(bearing / 5.0) % 72] = round(distance * 100)
        self._send(
            mavlink.MAVLink_obstacle_distance_message(
                self._boot_milliseconds() * 1000,
                mavlink.MAV_DISTANCE_SENSOR_LASER,
                sectors,
                5,
                20,
                SECTOR_FREE - 1,
                5.0,
                0.0,
                mavlink.MAV_FRAME_BODY_FRD,
            )
        )

    def _tell_unfit(self) -> None:
        if self.autopilot.unfit and not self.autopilot.armed:
            self.autopilot.say(mavlink.MAV_SEVERITY_CRITICAL, f"PreArm: {self.autopilot.unfit}")

    def _boot_milliseconds(self) -> int:
        return max(0, round((self.autopilot.uptime + self.autopilot.clock_error) * 1000)) % 2**32


_TELLS: tuple[tuple[Callable[[SimulatedVehicle], None], float], ...] = (
    (SimulatedVehicle._tell_heartbeat, HEARTBEAT_SECONDS),
    (SimulatedVehicle._tell_position, POSITION_SECONDS),
    (SimulatedVehicle._tell_status, STATUS_SECONDS),
    (SimulatedVehicle._tell_unfit, UNFIT_SECONDS),
    (SimulatedVehicle._tell_events, POSITION_SECONDS),
)


def _heading(message: Message) -> float | None:
    if message.type_mask & YAW_IGNORED or isnan(message.yaw):
        return None
    return degrees(message.yaw) % 360.0
