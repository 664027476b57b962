"""Simulated vehicles, each an autopilot with its radios, and the thread that advances them."""

from __future__ import annotations

import selectors
import threading
import time
from collections.abc import Callable, Sequence
from math import degrees, isnan
from typing import Any

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.sitl.autopilot import SimulatedAutopilot
from mmrs_mavlink.sitl.commands import drive, execute, steer, take_sticks
from mmrs_mavlink.sitl.faults import Faults
from mmrs_mavlink.sitl.items import ABOVE_SEA, StoredItem
from mmrs_mavlink.sitl.parameters import ParameterService
from mmrs_mavlink.sitl.radio import COMPONENT, SimulatedRadio
from mmrs_mavlink.sitl.settings import Settings
from mmrs_mavlink.sitl.simulation import advance
from mmrs_mavlink.sitl.telemetry import Streams
from mmrs_mavlink.sitl.transfers import Transfers

Message = Any

LINK_TIMEOUT = 2.0
"""Shortest timeout of its link in real seconds, whatever its speed-up."""

TICK_SECONDS, SHORTEST_TICK = 0.05, 0.01
LONGEST_STEP = 0.25
"""Longest step in real seconds, so that vehicles do not jump when their process was suspended."""


class SimulatedVehicle:
    """A vehicle that sends to one or two UDP addresses, and receives the answers.

    Attributes:
        autopilot: its state, which any thread may read.
        faults: injects faults.
        radio: to its controller, and to a ground station.
        streams: its telemetry.
        received: (seconds, name) of every message for it, except heartbeats.
        on_tick: called in its thread after each step of its time.
        speedup: simulated seconds per real second.
    """

    def __init__(
        self, port: int, settings: Settings | None = None, *, host: str = "127.0.0.1", speedup: float = 1.0
    ) -> None:
        """Create a vehicle, which sends nothing before `start`, for a controller at a UDP port.

        Raises:
            ValueError: a host cannot be resolved.
        """
        given = settings or Settings()
        self.autopilot = pilot = SimulatedAutopilot(given)
        self.speedup = speedup
        pilot.link_timeout = LINK_TIMEOUT * speedup
        self.received: list[tuple[float, str]] = []
        self.on_tick: Callable[[], None] = lambda: None
        self.lock = threading.RLock()
        self.faults = Faults(pilot, self.lock)
        addresses = [(host, port)] if given.ground is None else [(host, port), given.ground]
        self.radio = SimulatedRadio(addresses, given.system, given.key)
        self.radio.down = lambda number: number in pilot.cut or pilot.booting
        like = given.profile.autopilot
        self._transfers = Transfers(pilot.stores, self.radio.send, pilot.say, like)
        self._transfers.home = self._home if like.missions.begins_with_home else None
        self._parameters = ParameterService(pilot.parameters, like, self.radio.send)
        self.streams = Streams(pilot, self.radio.send)
        self._booted = pilot.booted
        self._host = Host([self])

    def start(self) -> None:
        """Start the vehicle in a thread of its own."""
        self._host.start()

    def stop(self) -> None:
        """Stop the vehicle."""
        self._host.stop()
        self.close()

    def close(self) -> None:
        """Close its radio."""
        self.radio.close()

    def __enter__(self) -> SimulatedVehicle:
        self.start()
        return self

    def __exit__(self, *error: object) -> None:
        self.stop()

    def receive(self) -> None:
        """Process the messages that have arrived."""
        own = self.autopilot.settings.system
        with self.lock:
            for message in self.radio.receive():
                system = getattr(message, "target_system", 0)
                if system in (0, own) and getattr(message, "target_component", 0) in (0, COMPONENT):
                    self._take(message)

    def advance(self, real_seconds: float) -> None:
        """Simulate the time of so much real time, and send what is due."""
        pilot = self.autopilot
        with self.lock:
            advance(pilot, real_seconds * self.speedup)
            self.on_tick()
            if pilot.booted != self._booted:
                self._booted = pilot.booted
                self.streams.reboot()
            self._transfers.busy = pilot.uptime < pilot.settings.boot
            self._transfers.advance(pilot.time, pilot.link_timeout / 4.0)
            self.streams.advance()

    def _take(self, message: Message) -> None:
        pilot, kind = self.autopilot, message.get_type()
        if kind == "HEARTBEAT":
            station = pilot.parameters.get("SYSID_MYGCS")
            is_gcs = message.type == mavlink.MAV_TYPE_GCS
            if is_gcs if station is None else message.get_srcSystem() == station:
                pilot.last_heartbeat = pilot.time
            return
        self.received.append((pilot.time, kind))
        match kind:
            case "COMMAND_LONG":
                self._command(message, tuple(getattr(message, f"param{n}") for n in range(1, 8)))
            case "COMMAND_INT":
                params = tuple(getattr(message, f"param{n}") for n in range(1, 5))
                self._command(message, (*params, message.x * 1e-7, message.y * 1e-7, message.z))
            case "MISSION_SET_CURRENT":
                execute(pilot, int(mavlink.MAV_CMD_DO_SET_MISSION_CURRENT), (message.seq, *[0.0] * 6))
            case "SET_POSITION_TARGET_GLOBAL_INT":
                up = pilot.above_ground(message.alt, above_sea=message.coordinate_frame in ABOVE_SEA)
                place = pilot.local(message.lat_int * 1e-7, message.lon_int * 1e-7, up)
                steer(pilot, place, None if pilot.settings.kind == "sub" else _heading(message))
            case "SET_POSITION_TARGET_LOCAL_NED":
                if message.type_mask & mavlink.POSITION_TARGET_TYPEMASK_X_IGNORE:
                    drive(pilot, message.vx, degrees(message.yaw_rate))
                else:
                    steer(pilot, (message.x, message.y, -message.z), _heading(message))
            case "MANUAL_CONTROL":
                if message.target in (0, pilot.settings.system):
                    take_sticks(pilot, message)
            case _:
                self._parameters.take(message)
                self._transfers.take(message)
                if kind == "PARAM_SET" and message.param_id == "SIM_GPS1_ENABLE":
                    pilot.located = bool(message.param_value)

    def _command(self, message: Message, params: tuple[float, ...]) -> None:
        number, pilot = message.command, self.autopilot
        if number in pilot.silent:
            return
        if number in pilot.settings.refuse:
            result = int(mavlink.MAV_RESULT_UNSUPPORTED)
        elif number == mavlink.MAV_CMD_SET_MESSAGE_INTERVAL:
            result = self.streams.set_interval(params[0], params[1])
        elif number == mavlink.MAV_CMD_REQUEST_MESSAGE:
            result = self.streams.send_once(params[0])
        else:
            result = execute(pilot, number, params)
        sender = {"target_system": message.get_srcSystem(), "target_component": message.get_srcComponent()}
        self.radio.send(mavlink.MAVLink_command_ack_message(number, result, **sender))

    def _home(self) -> StoredItem:
        latitude, longitude, above = self.autopilot.home
        return StoredItem(0, 16, (0.0, 0.0, 0.0, 0.0), round(latitude * 1e7), round(longitude * 1e7), above)


class Host:
    """Advances vehicles in ticks, and has them process messages as these arrive.

    Attributes:
        failure: the exception that has ended it; None: it has not failed.
    """

    def __init__(self, vehicles: Sequence[SimulatedVehicle]) -> None:
        self.failure: Exception | None = None
        self._vehicles = vehicles
        fastest = max((each.speedup for each in vehicles), default=1.0)
        self._tick = max(SHORTEST_TICK, TICK_SECONDS / fastest)
        self._stopping = threading.Event()
        self._thread = threading.Thread(target=self._run, name="simulated vehicles", daemon=True)

    def start(self) -> None:
        """Start the thread."""
        self._thread.start()

    def stop(self) -> None:
        """End the thread; the vehicles keep their state."""
        self._stopping.set()
        if self._thread.is_alive():
            self._thread.join()

    def _run(self) -> None:
        try:
            with selectors.DefaultSelector() as selector:
                for vehicle in self._vehicles:
                    selector.register(vehicle.radio, selectors.EVENT_READ, vehicle)
                self._simulate(selector)
        except Exception as error:
            self.failure = error

    def _simulate(self, selector: selectors.BaseSelector) -> None:
        last = time.monotonic()
        while not self._stopping.is_set():
            left = last + self._tick - time.monotonic()
            if left > 0.0:
                for key, _ in selector.select(left):
                    key.data.receive()
                continue
            now = time.monotonic()
            for vehicle in self._vehicles:
                vehicle.advance(min(now - last, LONGEST_STEP))
            last = now


def _heading(message: Message) -> float | None:
    if message.type_mask & mavlink.POSITION_TARGET_TYPEMASK_YAW_IGNORE or isnan(message.yaw):
        return None
    return degrees(message.yaw) % 360.0
