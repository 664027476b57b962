"""What the simulated vehicle does: modes, arming, missions, commands; no wires and no clock of its own.

Its habits are those measured on ArduPilot, the unpleasant ones included: it is not ready at first,
refuses uploads in its first second, takes a mission without a take-off and then never leaves the
ground, and disarms when it stands about.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from math import atan2, cos, degrees, radians

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_core.sitl.body import Body, Vector
from mmrs_core.sitl.missions import Item

METRES_PER_DEGREE = 111_319.49
HORIZONTAL_RADIUS = 2.0
CLOSE = 0.2
RETURN_HEIGHT = 15.0
TRACK_SECONDS = 0.5
EKF_SECONDS = 1.0
FALL_SPEED = 10.0

ACCEPTED = mavlink.MAV_RESULT_ACCEPTED
DENIED = mavlink.MAV_RESULT_DENIED
FAILED = mavlink.MAV_RESULT_FAILED
UNSUPPORTED = mavlink.MAV_RESULT_UNSUPPORTED

MODES: Mapping[str, Mapping[str, int]] = {
    "copter": {
        "stabilize": 0,
        "alt_hold": 2,
        "auto": 3,
        "guided": 4,
        "loiter": 5,
        "return": 6,
        "land": 9,
        "brake": 17,
        "smart_return": 21,
    },
    "sub": {"stabilize": 0, "alt_hold": 2, "auto": 3, "guided": 4, "surface": 9, "loiter": 16, "brake": 16},
    "rover": {
        "stabilize": 0,
        "loiter": 5,
        "auto": 10,
        "return": 11,
        "smart_return": 12,
        "guided": 15,
        "brake": 4,
    },
}
TYPES = {"copter": mavlink.MAV_TYPE_QUADROTOR, "sub": mavlink.MAV_TYPE_SUBMARINE, "rover": 10}
_DEVICES = {2000, 2001, 203, 183, 181, 182, 211, 195, 197, 115, 1000, 2500, 2501}


@dataclass(frozen=True, slots=True)
class Settings:
    """How a vehicle is.

    Attributes:
        kind: ``copter``, ``sub`` or ``rover``.
        latitude, longitude: of its home, degrees.
        boot: seconds in which uploads are refused and modes forgotten.
        ready: seconds after which it has a position and may be armed.
        disarm_delay: seconds after which it disarms by itself on the ground.
        energy: seconds of motors running until the battery is empty.
        recharge: seconds without motors running until it is full again.
        values: by name, what it publishes as NAMED_VALUE_FLOAT, given seconds.
        refuse: commands that it does not know.
        silent: commands that it never answers.
        key: 32 bytes to sign with and to expect signatures of; empty: no signatures.
    """

    kind: str = "copter"
    latitude: float = 42.37
    longitude: float = 13.35
    system: int = 1
    boot: float = 1.0
    ready: float = 2.0
    disarm_delay: float = 10.0
    energy: float = 1200.0
    recharge: float = 60.0
    values: Mapping[str, Callable[[float], float]] = field(default_factory=dict)
    refuse: frozenset[int] = frozenset()
    silent: frozenset[int] = frozenset()
    key: bytes = b""


class Autopilot:
    """The vehicle's behaviour.

    Attributes:
        history: (seconds, command, parameters) of every command that it carried out, and of every
            mission item that it executed.
        visited: (seconds, item) of every mission item that it has left behind.
        track: (seconds, north, east, up) of where it was while armed, every half a second.
        parameters: by name.
        modes: (seconds, number) of every change of the mode, whoever changed it.
        texts: (severity, text) of what it has to say, oldest first; who sends them takes them off.
        photos: of photos taken that are still to be told; who tells them takes them off.
        booted: seconds at which it was last switched on.
        located: whether it has a position. unfit: why it does not let itself be armed.
        obstacle: metres and degrees clockwise from its nose. breached: whether it is out of its fence.
        silent: commands that it does not answer. clock_error: seconds by which its clocks are wrong.
    """

    def __init__(self, settings: Settings) -> None:
        """Stand at home, switched on."""
        self.settings = settings
        self.body = Body()
        self.time = 0.0
        self.mode = MODES[settings.kind]["stabilize"]
        self.armed = False
        self.energy = 1.0
        self.item = 0
        self.history: list[tuple[float, int, tuple[float, ...]]] = []
        self.visited: list[tuple[float, int]] = []
        self.track: list[tuple[float, float, float, float]] = []
        self.parameters: dict[str, float] = {
            "FS_GCS_ENABLE": 0.0,
            "FS_ACTION": 0.0,
            "FS_EKF_ACTION": 1.0,
            "FENCE_ENABLE": 0.0,
            "FENCE_ACTION": 1.0,
        }
        self.stores: dict[int, list[Item]] = {0: [], 1: [], 2: []}
        self.modes: list[tuple[float, int]] = []
        self.texts: list[tuple[int, str]] = []
        self.photos: list[tuple[float, float, float]] = []
        self.booted = 0.0
        self.located = True
        self.unfit = ""
        self.obstacle: tuple[float, float] | None = None
        self.breached = False
        self.breaches = 0
        self.silent = settings.silent
        self.clock_error = 0.0
        self.camera_works = True
        self.taken = 0
        self._held = 0.0
        self._grounded_since = 0.0
        self._lost_for = 0.0

    def advance(self, seconds: float) -> None:
        """Let time pass."""
        self.time += seconds
        self._heed_position(seconds)
        if self.armed:
            self.energy = max(0.0, self.energy - seconds / self.settings.energy)
            _PILOTS.get(self._mode_name(), Autopilot._brake)(self, seconds)
            self.body.advance(seconds)
            self._touch_ground()
            if not self.track or self.time - self.track[-1][0] >= TRACK_SECONDS:
                self.track.append((self.time, *self.body.position))
            return
        self.energy = min(1.0, self.energy + seconds / self.settings.recharge)
        self._fall(seconds)
        if self.uptime < self.settings.boot:
            self.mode = MODES[self.settings.kind]["stabilize"]

    @property
    def ready(self) -> bool:
        """Return whether it knows where it is and may be armed."""
        return self.uptime >= self.settings.ready and self.located and not self.unfit

    @property
    def uptime(self) -> float:
        """Return the seconds since it was switched on."""
        return self.time - self.booted

    @property
    def booting(self) -> bool:
        """Return whether it is still silent after a reboot."""
        return self.booted > 0.0 and self.uptime < self.settings.boot

    @property
    def airborne(self) -> bool:
        """Return whether it is off the ground; what does not fly never is."""
        return self.settings.kind == "copter" and self.body.position[2] > 0.05

    def degrees(self) -> tuple[float, float]:
        """Return latitude and longitude."""
        north, east, _ = self.body.position
        scale = METRES_PER_DEGREE * cos(radians(self.settings.latitude))
        return self.settings.latitude + north / METRES_PER_DEGREE, self.settings.longitude + east / scale

    def local(self, latitude: float, longitude: float, up: float) -> Vector:
        """Return metres north, east and up of home."""
        scale = METRES_PER_DEGREE * cos(radians(self.settings.latitude))
        north = (latitude - self.settings.latitude) * METRES_PER_DEGREE
        return (north, (longitude - self.settings.longitude) * scale, up)

    def steer(self, target: Vector, heading: float | None) -> None:
        """Go to a position, if in GUIDED and, for what flies, in the air."""
        if self._mode_name() == "guided" and self.armed and (self.airborne or self._stays_down()):
            self.body.target, self.body.wanted_heading = target, heading

    def command(self, number: int, params: tuple[float, ...]) -> int:
        """Carry out a command; return its MAV_RESULT."""
        handler = _COMMANDS.get(number)
        if number in self.settings.refuse or (handler is None and number not in _DEVICES):
            return int(UNSUPPORTED)
        result = int(ACCEPTED) if handler is None else handler(self, params)
        if result == ACCEPTED:
            self._note(number, params)
        return result

    def _note(self, number: int, params: tuple[float, ...]) -> None:
        self.history.append((self.time, number, params))
        takes = number == mavlink.MAV_CMD_IMAGE_START_CAPTURE or (
            number == mavlink.MAV_CMD_DO_DIGICAM_CONTROL and params[4:5] in ((1.0,), ())
        )
        if takes and self.camera_works:
            self.photos.append(self.body.position)

    def set_mode(self, number: int) -> int:
        """Change the mode; return a MAV_RESULT."""
        if number not in MODES[self.settings.kind].values():
            return int(FAILED)
        self._change_mode(number)
        self.body.target = None
        self.body.speed = 5.0
        self._held = 0.0
        return int(ACCEPTED)

    def take_stick(self, mode: str) -> None:
        """Have the pilot change the mode.

        Raises:
            ValueError: there is no such mode.
        """
        numbers = MODES[self.settings.kind]
        if mode not in numbers:
            raise ValueError(f"{mode}: no such mode; a {self.settings.kind} has {', '.join(numbers)}")
        self.set_mode(numbers[mode])

    def restart(self, armed: bool = False) -> None:
        """Lose what is in memory and begin anew; what was uploaded and set is on disk."""
        self.booted = self.time
        self.armed = self.armed and armed
        self.item, self._held = 0, 0.0
        self.body.target = None
        self.breached, self._lost_for = False, 0.0
        self.texts.clear()
        self._change_mode(MODES[self.settings.kind]["stabilize"])

    def breach(self) -> None:
        """Be out of the fence, and do what FENCE_ACTION says."""
        self.breached = True
        self.breaches += 1
        self.say(mavlink.MAV_SEVERITY_NOTICE, "Polygon fence breached")
        action = self.parameters["FENCE_ACTION"]
        if self.armed and action and self.parameters["FENCE_ENABLE"]:
            answers = {
                1: ("return", "land"),
                2: ("land",),
                3: ("smart_return", "return", "land"),
                4: ("brake",),
            }
            self._answer(answers.get(int(action), ("return", "land")))

    def say(self, severity: int, text: str) -> None:
        """Have something to say to the ground."""
        self.texts.append((int(severity), text))

    def _change_mode(self, number: int) -> None:
        if number != self.mode:
            self.modes.append((self.time, number))
        self.mode = number

    def _answer(self, names: tuple[str, ...]) -> None:
        numbers = MODES[self.settings.kind]
        self.set_mode(next((numbers[name] for name in names if name in numbers), numbers["brake"]))

    def _heed_position(self, seconds: float) -> None:
        self._lost_for = 0.0 if self.located else self._lost_for + seconds
        needs = self._mode_name() not in ("stabilize", "alt_hold", "land", "surface")
        if self.armed and needs and self._lost_for > EKF_SECONDS and self.parameters["FS_EKF_ACTION"]:
            self.say(mavlink.MAV_SEVERITY_CRITICAL, "EKF Failsafe: changed to LAND Mode")
            self._answer(("land", "surface"))

    def _fall(self, seconds: float) -> None:
        if self.airborne:
            north, east, up = self.body.position
            self.body.position = (north, east, max(0.0, up - FALL_SPEED * seconds))
            self.body.velocity = (0.0, 0.0, -FALL_SPEED)
        else:
            self.body.velocity = (0.0, 0.0, 0.0)

    def _mode_name(self) -> str:
        return next(name for name, number in MODES[self.settings.kind].items() if number == self.mode)

    def _stays_down(self) -> bool:
        return self.settings.kind != "copter"

    def _touch_ground(self) -> None:
        if self._stays_down():
            return
        if self.body.position[2] < 0.0:
            self.body.rest_at(0.0)
        if self.airborne or self.body.target is not None:
            self._grounded_since = self.time
        elif self.time - self._grounded_since > self.settings.disarm_delay:
            self._disarm()

    def _disarm(self) -> None:
        self.armed = False
        self.item = 0
        self.body.rest_at(self.body.position[2] if self._stays_down() else 0.0)

    def _brake(self, seconds: float) -> None:
        self.body.target = None

    def _guided(self, seconds: float) -> None:
        """Go where commands say."""

    def _land(self, seconds: float) -> None:
        north, east, up = self.body.position
        self.body.target = (north, east, -1.0)
        self.body.speed = 5.0 if up > 10.0 else 1.0
        if up <= 0.05:
            self.body.rest_at(0.0)
            self._disarm()

    def _surface(self, seconds: float) -> None:
        self.body.target = (self.body.position[0], self.body.position[1], 0.0)

    def _return(self, seconds: float) -> None:
        north, east, up = self.body.position
        if abs(north) + abs(east) < 1.0:
            self._land(seconds)
        elif up < RETURN_HEIGHT - 0.5 and not self._stays_down():
            self.body.target = (north, east, RETURN_HEIGHT)
        else:
            self.body.target = (0.0, 0.0, max(up, RETURN_HEIGHT))

    def _auto(self, seconds: float) -> None:
        items = self.stores[0]
        self.item = max(1, self.item)
        while self.item < len(items) and self._perform(items[self.item], seconds):
            self.visited.append((self.time, self.item))
            if self.item + 1 == len(items):
                return
            self.item += 1
            self._held = 0.0

    def _perform(self, item: Item, seconds: float) -> bool:
        """Work on a mission item for a while; return whether it is done."""
        if item.command == mavlink.MAV_CMD_DO_CHANGE_SPEED:
            self.body.speed = item.params[1]
            return True
        if item.command in _DEVICES:
            self._note(item.command, (*item.params, item.x, item.y, item.z))
            return True
        if item.command == mavlink.MAV_CMD_NAV_LAND:
            self._land(seconds)
            return False
        if item.command == mavlink.MAV_CMD_NAV_RETURN_TO_LAUNCH:
            self._return(seconds)
            return False
        return self._go(item, seconds)

    def _go(self, item: Item, seconds: float) -> bool:
        takes_off = item.command == mavlink.MAV_CMD_NAV_TAKEOFF
        if not (self.airborne or self._stays_down() or takes_off):
            return False
        place = self.local(item.x * 1e-7, item.y * 1e-7, item.z)
        if takes_off or not (item.x or item.y):
            place = (*self.body.position[:2], item.z)
        self.body.target = place
        self._face(place)
        if item.command == mavlink.MAV_CMD_NAV_LOITER_UNLIM:
            return False
        held = item.params[0]
        passes = item.command == mavlink.MAV_CMD_NAV_WAYPOINT and held == 0.0
        if self.body.distance_to(place) > (HORIZONTAL_RADIUS if passes else CLOSE) and not self._held:
            return False
        self._held += seconds
        return passes or takes_off or self._held >= held

    def _face(self, place: Vector) -> None:
        north, east = place[0] - self.body.position[0], place[1] - self.body.position[1]
        if abs(north) + abs(east) > 1.0:
            self.body.wanted_heading = degrees(atan2(east, north)) % 360.0

    def _on_arm(self, params: tuple[float, ...]) -> int:
        if params[0] == 0.0:
            if self.airborne and params[1] != 21_196:
                return int(FAILED)
            self._disarm()
            return int(ACCEPTED)
        if self.unfit:
            self.say(mavlink.MAV_SEVERITY_CRITICAL, f"Arm: {self.unfit}")
        if not self.ready or self._mode_name() == "auto":
            return int(FAILED)
        self.armed = True
        self._grounded_since = self.time
        return int(ACCEPTED)

    def _on_take_off(self, params: tuple[float, ...]) -> int:
        if not self.armed or self._mode_name() != "guided" or self._stays_down():
            return int(FAILED)
        north, east, _ = self.body.position
        self.body.target = (north, east, params[6])
        return int(ACCEPTED)

    def _on_speed(self, params: tuple[float, ...]) -> int:
        self.body.speed = params[1]
        return int(ACCEPTED)

    def _on_item(self, params: tuple[float, ...]) -> int:
        if not 0 <= params[0] < len(self.stores[0]):
            return int(DENIED)
        self.item, self._held = int(params[0]), 0.0
        return int(ACCEPTED)

    def _on_start(self, params: tuple[float, ...]) -> int:
        if params[0] or params[1] or not self.armed:
            return int(DENIED)
        return self.set_mode(MODES[self.settings.kind]["auto"])

    def _on_mode(self, params: tuple[float, ...]) -> int:
        return self.set_mode(int(params[1]))

    def _on_fence(self, params: tuple[float, ...]) -> int:
        self.parameters["FENCE_ENABLE"] = params[0]
        return int(ACCEPTED)

    def _on_interval(self, params: tuple[float, ...]) -> int:
        return int(ACCEPTED)


_PILOTS: Mapping[str, Callable[[Autopilot, float], None]] = {
    "auto": Autopilot._auto,
    "guided": Autopilot._guided,
    "land": Autopilot._land,
    "return": Autopilot._return,
    "surface": Autopilot._surface,
    "brake": Autopilot._brake,
}
_COMMANDS: Mapping[int, Callable[[Autopilot, tuple[float, ...]], int]] = {
    mavlink.MAV_CMD_COMPONENT_ARM_DISARM: Autopilot._on_arm,
    mavlink.MAV_CMD_NAV_TAKEOFF: Autopilot._on_take_off,
    mavlink.MAV_CMD_DO_CHANGE_SPEED: Autopilot._on_speed,
    mavlink.MAV_CMD_DO_SET_MISSION_CURRENT: Autopilot._on_item,
    mavlink.MAV_CMD_MISSION_START: Autopilot._on_start,
    mavlink.MAV_CMD_DO_SET_MODE: Autopilot._on_mode,
    mavlink.MAV_CMD_DO_FENCE_ENABLE: Autopilot._on_fence,
    mavlink.MAV_CMD_SET_MESSAGE_INTERVAL: Autopilot._on_interval,
}
