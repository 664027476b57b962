"""Vehicles whose mission, command, parameter and telemetry services are MAVSDK's.

Usage: python mavsdk_vehicles.py VEHICLES SPEEDUP, with VEHICLES a JSON list of objects with robot, latitude,
longitude, port. It says when they are on, and, when its standard input ends, what each did.

MAVSDK's are: transfers of missions and all that is told of their progress; the answers to arming,
take-off, message intervals and requests; parameters; positions, landed state, home, texts, time, satellites.
Ours are, because MAVSDK has no server for them or one for PX4's numbers only: fences, rally points,
set-points, changes of the mode and of the speed, cameras, heartbeats, the health of sensors with the
pre-arm check, and how the vehicle moves.
"""

import json
import sys
from collections import deque

from mavsdk import ComponentType, Configuration, ConnectionResult, Mavsdk
from mavsdk.plugins import telemetry_server as telemetry
from mavsdk.plugins.action_server import ActionServer
from mavsdk.plugins.mission_raw_server import MissionRawServer
from mavsdk.plugins.param_server import ParamServer
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.commands.rehearsal import summary_of
from mmrs_mavlink.sitl.commands import arming_refusal, execute
from mmrs_mavlink.sitl.items import StoredItem
from mmrs_mavlink.sitl.settings import Settings
from mmrs_mavlink.sitl.telemetry import Streams
from mmrs_mavlink.sitl.vehicle import Host, SimulatedVehicle

ARM, TAKE_OFF, JUMP, INTERVAL, REQUEST = 400, 22, 224, 511, 512
COMMANDS = {ARM, TAKE_OFF, INTERVAL, REQUEST}
PARAMETERS = {"PARAM_SET", "PARAM_REQUEST_READ", "PARAM_REQUEST_LIST"}
GROUND = (255, 191)


class MavsdkVehicle(SimulatedVehicle):
    """One of our vehicles that leaves to MAVSDK's servers what they can do."""

    def __init__(self, port: int, settings: Settings, speedup: float) -> None:
        super().__init__(port, settings, speedup=speedup)
        self.by_mavsdk: dict[str, int] = {}
        self._events: deque = deque()
        self._outgoing: deque = deque()
        self._height, self._passed, self._told_item = 0.0, 0, 0
        self._armable: bool | None = None
        self.streams.send = self._tell
        self._ground = mavlink.MAVLink(None, *GROUND)
        self._spoken = mavlink.MAVLink(None)
        self._spoken.robust_parsing = True
        self.mavsdk = Mavsdk(Configuration.create_manual(settings.system, 1, True))
        added = self.mavsdk.add_any_connection("raw://")
        assert added == ConnectionResult.SUCCESS, added
        self.mavsdk.subscribe_raw_bytes_to_be_sent(self._pass_on)
        component = self.mavsdk.server_component_by_type(ComponentType.AUTOPILOT)
        self._values = ParamServer(component)
        self._telemetry = telemetry.TelemetryServer(component)
        self._flown = MissionRawServer(component)
        self._actions = ActionServer(component)
        self._subscribe()

    def _subscribe(self) -> None:
        later = self._events.append
        for name, value in self.autopilot.parameters.items():
            self._values.provide_param_float(name, float(value))
        self._values.subscribe_changed_param_float(lambda found, _: later(("set", found.name, found.value)))
        self._flown.subscribe_incoming_mission(lambda _, plan, __: later(("load", plan.mission_items)))
        self._flown.subscribe_clear_all(lambda *_: later(("load", ())))
        self._actions.set_disarmable(True, True)
        self._actions.set_allow_takeoff(True)
        self._actions.subscribe_arm_disarm(lambda _, found, __: later(("arm", found.arm, found.force)))
        self._actions.subscribe_takeoff(lambda *_: later(("rise",)))

    def _pass_on(self, data: bytes) -> None:
        """Take what MAVSDK says, but its heartbeats, which name no kind of vehicle, and lists of ours."""
        for message in self._spoken.parse_buffer(data) or ():
            kind = message.get_type()
            if kind in ("HEARTBEAT", "BAD_DATA", "PING") or getattr(message, "mission_type", 0):
                continue
            self.by_mavsdk[kind] = self.by_mavsdk.get(kind, 0) + 1
            self._outgoing.append(message)

    def receive(self) -> None:
        super().receive()
        self._send_on()

    def _send_on(self) -> None:
        """Send what MAVSDK said, numbered among what we say: a vehicle counts its frames only once."""
        with self.lock:
            while self._outgoing:
                self.radio.send(self._outgoing.popleft())

    def _take(self, message) -> None:
        kind = message.get_type()
        mission = kind.startswith("MISSION_") and not getattr(message, "mission_type", 0)
        command = kind == "COMMAND_LONG" and message.command in COMMANDS
        if kind == "HEARTBEAT" or mission or command or kind in PARAMETERS:
            self.mavsdk.pass_received_raw_bytes(bytes(message.get_msgbuf()))
        if kind == "COMMAND_LONG" and message.command == TAKE_OFF:
            self._height = message.param7
        if kind == "COMMAND_LONG" and message.command == INTERVAL:
            self.streams.set_interval(message.param1, message.param2)
        if not (mission or command or kind in PARAMETERS):
            super()._take(message)
        else:
            self.received.append((self.autopilot.time, kind))
        if kind == "COMMAND_LONG" and message.command == JUMP:
            self._choose(int(message.param1))

    def _choose(self, item: int) -> None:
        """Have MAVSDK know the item that the mission is at; it knows the message only, not the command."""
        system = self.autopilot.settings.system
        message = mavlink.MAVLink_mission_set_current_message(system, 1, item)
        self.mavsdk.pass_received_raw_bytes(message.pack(self._ground))
        self._ground.seq = (self._ground.seq + 1) % 256

    def advance(self, real_seconds: float) -> None:
        pilot = self.autopilot
        with self.lock:
            while self._events:
                what, *values = self._events.popleft()
                getattr(self, f"_on_{what}")(*values)
            fit = not arming_refusal(pilot)
            if fit != self._armable:
                self._armable = fit
                self._actions.set_armable(fit, fit)
        self._send_on()
        super().advance(real_seconds)
        for _ in pilot.visited[self._passed :]:
            self._flown.set_current_item_complete()
        self._passed = len(pilot.visited)
        if pilot.item == 0 != self._told_item:
            self._choose(0)
        self._told_item = pilot.item

    def _on_set(self, name: str, value: float) -> None:
        self.autopilot.parameters[name] = value

    def _on_load(self, items) -> None:
        self.autopilot.stores[0] = [
            StoredItem(
                each.frame,
                each.command,
                (each.param1, each.param2, each.param3, each.param4),
                each.x,
                each.y,
                each.z,
            )
            for each in items
        ]

    def _on_arm(self, arm: bool, force: bool) -> None:
        execute(self.autopilot, ARM, (float(arm), 21_196.0 if force else 0.0, 0.0, 0.0, 0.0, 0.0, 0.0))

    def _on_rise(self) -> None:
        execute(self.autopilot, TAKE_OFF, (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, self._height))

    def _tell(self, name: str) -> None:
        tell = _TELLS.get(name)
        if tell is None:
            Streams.send(self.streams, name)
        elif self.autopilot.uptime >= self.autopilot.settings.ready:
            tell(self, self._telemetry)

    def _position(self, server) -> None:
        pilot = self.autopilot
        north, east, up = pilot.body.velocity
        above = pilot.settings.altitude + pilot.body.position[2]
        server.publish_position(
            telemetry.Position(*pilot.degrees(), above, above - pilot.home[2]),
            telemetry.VelocityNed(north, east, -up),
            telemetry.Heading(pilot.body.heading),
        )

    def _local(self, server) -> None:
        (north, east, up), (v_north, v_east, v_up) = (
            self.autopilot.body.position,
            self.autopilot.body.velocity,
        )
        server.publish_position_velocity_ned(
            telemetry.PositionVelocityNed(
                telemetry.PositionNed(north, east, -up), telemetry.VelocityNed(v_north, v_east, -v_up)
            )
        )

    def _landed(self, server) -> None:
        state = telemetry.LandedState.IN_AIR if self.autopilot.airborne else telemetry.LandedState.ON_GROUND
        server.publish_extended_sys_state(telemetry.VtolState.UNDEFINED, state)

    def _home_told(self, server) -> None:
        server.publish_home(telemetry.Position(*self.autopilot.home, 0.0))

    def _satellites(self, server) -> None:
        latitude, longitude = self.autopilot.degrees()
        above = self.autopilot.settings.altitude + self.autopilot.body.position[2]
        fix = telemetry.FixType.FIX_3D if self.autopilot.located else telemetry.FixType.NO_FIX
        raw = telemetry.RawGps(
            0, latitude, longitude, above, 0.8, 1.2, 0.0, 0.0, above, 1.0, 1.0, 0.5, 1.0, 0.0
        )
        server.publish_raw_gps(raw, telemetry.GpsInfo(14, fix))

    def _nothing(self, server) -> None:
        """Tell nothing: MAVSDK tells missions by itself, and has another time since the start than ours."""


_TELLS = {
    "GLOBAL_POSITION_INT": MavsdkVehicle._position,
    "LOCAL_POSITION_NED": MavsdkVehicle._local,
    "EXTENDED_SYS_STATE": MavsdkVehicle._landed,
    "HOME_POSITION": MavsdkVehicle._home_told,
    "GPS_RAW_INT": MavsdkVehicle._satellites,
    "MISSION_CURRENT": MavsdkVehicle._nothing,
    "ATTITUDE": MavsdkVehicle._nothing,
    "SYSTEM_TIME": MavsdkVehicle._nothing,
}


def tell(**fields: object) -> None:
    print("peer " + json.dumps(fields), flush=True)


def main(vehicles: str, speedup: str) -> None:
    made = {}
    for number, given in enumerate(json.loads(vehicles), start=1):
        settings = Settings(
            "copter",
            given["latitude"],
            given["longitude"],
            number,
            recharge=60.0,
            energy=20_000.0,
            capacity=22_000.0,
            cells=6,
        )
        made[given["robot"]] = MavsdkVehicle(given["port"], settings, float(speedup))
    host = Host(list(made.values()))
    host.start()
    tell(what="ready")
    sys.stdin.read()
    host.stop()
    for robot, vehicle in made.items():
        deeds = summary_of(vehicle)
        tell(robot=robot, deeds=deeds, track=vehicle.autopilot.track, by_mavsdk=vehicle.by_mavsdk)


if __name__ == "__main__":
    main(*sys.argv[1:])
