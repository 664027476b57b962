"""A simulated vehicle: an autopilot that answers MAVLink by its radio."""

from __future__ import annotations

import threading
from collections.abc import Callable, Mapping, Sequence
from math import degrees, isnan
from types import TracebackType
from typing import Any

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.sitl import telemetry
from mmrs_mavlink.sitl.autopilot import Autopilot
from mmrs_mavlink.sitl.commands import obey, steer
from mmrs_mavlink.sitl.faults import Faults
from mmrs_mavlink.sitl.hosting import Host
from mmrs_mavlink.sitl.items import MISSION, RALLY, Item
from mmrs_mavlink.sitl.parameter_service import ParameterService
from mmrs_mavlink.sitl.px4_transfers import Px4MissionProtocol
from mmrs_mavlink.sitl.radio import COMPONENT, Radio
from mmrs_mavlink.sitl.routing import Router
from mmrs_mavlink.sitl.settings import PX4, Settings
from mmrs_mavlink.sitl.simulation import advance
from mmrs_mavlink.sitl.sticks import sticks_of
from mmrs_mavlink.sitl.stored import Transfers
from mmrs_mavlink.sitl.streams import Streams
from mmrs_mavlink.sitl.transfers import MissionProtocol

Message = Any

YAW_IGNORED = mavlink.POSITION_TARGET_TYPEMASK_YAW_IGNORE
ABOVE_SEA = frozenset({0, 5})
REAL_PATIENCE = 2.0
"""Real seconds that it waits at least for what comes by its link, however fast its time goes."""


class SimulatedVehicle:
    """A vehicle that sends to a UDP address, or to two, and listens for the answers.

    Attributes:
        autopilot: what it does; read it freely, its numbers may be a tick old.
        faults: makes things go wrong with it.
        radio: how it speaks to who steers it.
        streams: what it tells by itself. values: its parameters, for the ground.
        received: (seconds, name) of every message that has come for it, but heartbeats.
        on_tick: called whenever its time has gone on, in its own thread: what must happen at an instant
            of it, happens there.
        speedup: seconds of simulation in a second.
    """

    def __init__(
        self,
        port: int,
        settings: Settings | None = None,
        *,
        host: str = "127.0.0.1",
        speedup: float = 1.0,
        loss: float = 0.0,
        delay: float = 0.0,
        seed: int = 0,
        ground: tuple[str, int] | None = None,
    ) -> None:
        """Prepare a vehicle; it speaks from `start` on.

        Args:
            port: UDP port of who steers it: a controller, or a ground station.
            settings: how it is.
            host: of that.
            speedup: seconds of simulation in a second.
            loss: part of all datagrams that are lost, either way.
            delay: real seconds that a datagram takes, either way.
            seed: of the losses.
            ground: host and UDP port of a ground station that looks on by a radio of its own.
        """
        given = settings or Settings()
        self.autopilot = Autopilot(given)
        self.speedup = speedup
        self.autopilot.patience = REAL_PATIENCE * speedup
        self.radio = Radio(
            (host, port),
            given.system,
            key=given.key,
            loss=loss,
            delay=delay,
            seed=seed,
            old=given.mavlink == 1,
        )
        self.received: list[tuple[float, str]] = []
        self.on_tick: Callable[[], None] = lambda: None
        self.lock = threading.RLock()
        self.faults = Faults(self.autopilot, self.lock, watched=ground is not None)
        self.radio.dumb = lambda: self.faults.dumb
        self.radio.down = lambda: self.faults.link_down or self.autopilot.booting
        self._router = Router(given.system, self.radio, *self._second(ground, given))
        self._missions = self._protocol(given)
        self._missions.finished = self._count_items
        self._missions.home = None if given.firmware == PX4 else self._home
        self._late: list[tuple[float, Message]] = []
        self.values = ParameterService(self.autopilot, self._router.send)
        self.streams = Streams(self.autopilot, self._router.send)
        self._host: Host | None = None
        self._begin()

    def start(self) -> None:
        """Switch the vehicle on, in a thread of its own."""
        self._host = Host([self])
        self._host.start()

    def stop(self) -> None:
        """Switch it off."""
        if self._host is not None:
            self._host.stop()
        self.close()

    def close(self) -> None:
        """Fall silent."""
        self._router.close()

    @property
    def radios(self) -> Sequence[Radio]:
        """Return all by which something may come."""
        return self._router.radios

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

    def hear(self) -> None:
        """Answer what has come."""
        with self.lock:
            for message in self._router.receive():
                if self._is_for_it(message):
                    self._take(message)

    def go_on(self, real_seconds: float) -> None:
        """Let real time pass, and tell what is due."""
        with self.lock:
            advance(self.autopilot, real_seconds * self.speedup)
            self.on_tick()
            if self.autopilot.booted != self._booted:
                self._begin()
            if self.autopilot.reboots:
                self.autopilot.restart()
            self._missions.busy = self.autopilot.uptime < self.autopilot.settings.boot
            self._missions.go_on(self.autopilot.time, self.autopilot.patience / 4.0)
            self._tell_late()
            self.streams.go_on()
            self.values.go_on()
            self._router.flush()
            if self._router.late:
                self.hear()

    def _protocol(self, given: Settings) -> Transfers:
        stores, say = self.autopilot.stores, self.autopilot.say
        if given.firmware == PX4:
            return Px4MissionProtocol(stores, self._answer, say)
        return MissionProtocol(stores, self._answer, say, old=given.mavlink == 1)

    def _second(self, ground: tuple[str, int] | None, given: Settings) -> list[Radio]:
        if ground is None:
            return []
        radio = Radio(ground, given.system, key=given.key)
        radio.down = lambda: self.faults.ground_down or self.autopilot.booting
        return [radio]

    def _tell_late(self) -> None:
        while self._late and self._late[0][0] <= self.autopilot.time:
            self._router.send(self._late.pop(0)[1])

    def _begin(self) -> None:
        """Begin anew after a boot: what was asked for is forgotten."""
        self._booted = self.autopilot.booted
        self.streams.begin()
        self.values.begin()

    def _is_for_it(self, message: Message) -> bool:
        system = getattr(message, "target_system", 0)
        component = getattr(message, "target_component", 0)
        return system in (0, self.autopilot.settings.system) and component in (0, COMPONENT)

    def _take(self, message: Message) -> None:
        kind = message.get_type()
        if kind == "HEARTBEAT":
            self._hear_ground(message)
            return
        self.received.append((self.autopilot.time, kind))
        handler = _HANDLERS.get(kind)
        if handler is not None:
            handler(self, message)
        else:
            self.values.take(message)
            self._missions.take(message)

    def _hear_ground(self, message: Message) -> None:
        pilot = self.autopilot
        wanted = pilot.parameters.get("SYSID_MYGCS")
        ground = message.type == mavlink.MAV_TYPE_GCS if wanted is None else message.get_srcSystem() == wanted
        if ground:
            pilot.heard = pilot.time

    def _long(self, message: Message) -> None:
        self._command(message, tuple(getattr(message, f"param{number}") for number in range(1, 8)))

    def _int(self, message: Message) -> None:
        params = tuple(getattr(message, f"param{number}") for number in range(1, 5))
        self._command(message, (*params, message.x * 1e-7, message.y * 1e-7, message.z))

    def _command(self, message: Message, params: tuple[float, ...]) -> None:
        number = message.command
        if number in self.autopilot.silent:
            return
        if number in _ASKING and number not in self.autopilot.settings.refuse:
            result = _ASKING[number](self, params)
        else:
            result = obey(self.autopilot, number, params)
        self._router.send(
            mavlink.MAVLink_command_ack_message(
                number,
                result,
                target_system=message.get_srcSystem(),
                target_component=message.get_srcComponent(),
            )
        )

    def _interval(self, params: tuple[float, ...]) -> int:
        return self.streams.ask(params[0], params[1])

    def _request(self, params: tuple[float, ...]) -> int:
        return self.streams.tell_now(params[0])

    def _capabilities(self, params: tuple[float, ...]) -> int:
        return self._request((float(mavlink.MAVLINK_MSG_ID_AUTOPILOT_VERSION),))

    def _where_home(self, params: tuple[float, ...]) -> int:
        return self._request((float(mavlink.MAVLINK_MSG_ID_HOME_POSITION),))

    def _mode(self, message: Message) -> None:
        self.autopilot.set_mode(message.custom_mode)

    def _current(self, message: Message) -> None:
        obey(self.autopilot, int(mavlink.MAV_CMD_DO_SET_MISSION_CURRENT), (message.seq, *[0.0] * 6))

    def _steer_globally(self, message: Message) -> None:
        up = self.autopilot.above_ground(message.alt, above_sea=message.coordinate_frame in ABOVE_SEA)
        place = self.autopilot.local(message.lat_int * 1e-7, message.lon_int * 1e-7, up)
        steer(self.autopilot, place, _heading(message))

    def _steer_locally(self, message: Message) -> None:
        steer(self.autopilot, (message.x, message.y, -message.z), _heading(message))

    def _take_sticks(self, message: Message) -> None:
        if message.target in (0, self.autopilot.settings.system):
            self.autopilot.sticks = sticks_of(message, self.autopilot.time)

    def _synchronise(self, message: Message) -> None:
        if message.tc1 == 0:
            now = telemetry.milliseconds(self.autopilot) * 1_000_000
            self._router.send(mavlink.MAVLink_timesync_message(now, message.ts1))

    def _answer(self, message: Message) -> None:
        if self.faults.answer_delay:
            self._late.append((self.autopilot.time + self.faults.answer_delay, message))
        else:
            self._router.send(message)

    def _home(self) -> Item:
        latitude, longitude, above = self.autopilot.home
        return Item(0, 16, (0.0, 0.0, 0.0, 0.0), round(latitude * 1e7), round(longitude * 1e7), above)

    def _count_items(self, kind: int) -> None:
        name = {MISSION: "MIS_TOTAL", RALLY: "RALLY_TOTAL"}.get(kind)
        if name in self.autopilot.parameters:
            self.autopilot.parameters[name] = len(self.autopilot.stores[kind])


def _heading(message: Message) -> float | None:
    if message.type_mask & YAW_IGNORED or isnan(message.yaw):
        return None
    return degrees(message.yaw) % 360.0


_ASKING: Mapping[int, Callable[[SimulatedVehicle, tuple[float, ...]], int]] = {
    int(mavlink.MAV_CMD_SET_MESSAGE_INTERVAL): SimulatedVehicle._interval,
    int(mavlink.MAV_CMD_REQUEST_MESSAGE): SimulatedVehicle._request,
    int(mavlink.MAV_CMD_REQUEST_AUTOPILOT_CAPABILITIES): SimulatedVehicle._capabilities,
    int(mavlink.MAV_CMD_GET_HOME_POSITION): SimulatedVehicle._where_home,
}
_HANDLERS: Mapping[str, Callable[[SimulatedVehicle, Message], None]] = {
    "COMMAND_LONG": SimulatedVehicle._long,
    "COMMAND_INT": SimulatedVehicle._int,
    "SET_MODE": SimulatedVehicle._mode,
    "MISSION_SET_CURRENT": SimulatedVehicle._current,
    "SET_POSITION_TARGET_GLOBAL_INT": SimulatedVehicle._steer_globally,
    "SET_POSITION_TARGET_LOCAL_NED": SimulatedVehicle._steer_locally,
    "MANUAL_CONTROL": SimulatedVehicle._take_sticks,
    "TIMESYNC": SimulatedVehicle._synchronise,
}
