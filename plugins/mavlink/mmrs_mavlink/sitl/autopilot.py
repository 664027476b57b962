"""What the simulated vehicle knows and is; no wires, and no clock of its own.

Its habits are those measured on ArduPilot, the unpleasant ones included: it is not ready at first,
refuses uploads in its first second, takes a mission without a take-off and then never leaves the
ground, and disarms when it stands about.
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import lru_cache
from math import atan2, cos, degrees, radians, remainder, sin, sqrt
from typing import TYPE_CHECKING

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.sitl import parameters
from mmrs_mavlink.sitl.battery import Battery
from mmrs_mavlink.sitl.body import Body, Vector, wind_of
from mmrs_mavlink.sitl.camera import Camera
from mmrs_mavlink.sitl.gusts import Gusts
from mmrs_mavlink.sitl.items import FENCE, MISSION, MOVING, RALLY, Item
from mmrs_mavlink.sitl.modes import BLIND, first_mode, numbers
from mmrs_mavlink.sitl.px4_missions import is_feasible
from mmrs_mavlink.sitl.settings import PX4, Settings

if TYPE_CHECKING:
    from mmrs_mavlink.sitl.px4_failsafes import Failsafe
    from mmrs_mavlink.sitl.sticks import Sticks

EQUATOR, SQUARED_ECCENTRICITY = 6_378_137.0, 6.694_379_990_14e-3
"""Of the ellipsoid of WGS 84: metres, and its flatness."""

NEAR_GROUND = 0.05

SPEEDS = (("WP_SPD", 1.0), ("WPNAV_SPEED", 0.01), ("WP_SPEED", 1.0), ("MPC_XY_CRUISE", 1.0))
"""Parameters for its usual speed, with their units: the first is that of copters from 4.7 on."""
CHANGE_SPEED = int(mavlink.MAV_CMD_DO_CHANGE_SPEED)

STREAM_SECONDS, STREAM_GAP, STREAM_LEAST = 1.0, 0.5, 2
"""PX4 takes set-points that have come for a second, with at most half a second in between."""


class Autopilot:
    """A vehicle; what it does in its modes is in `pilots`, what it obeys in `commands`.

    Attributes:
        body, battery, camera: what it is made of.
        time: seconds since the simulation began. booted: when it was last switched on.
        history: (seconds, command, parameters) of every command that it carried out, and of every
            mission item that it executed.
        visited: (seconds, item) of every mission item that it has left behind.
        track: (seconds, north, east, up) of where it was while armed, ten times a second.
        modes: (seconds, number) of every change of the mode, whoever changed it.
        texts: (severity, text) of what it has to say, oldest first; who sends them takes them off.
        said: (seconds, severity, text) of all that it ever said.
        parameters: by name. stores: items by mission type.
        item: number of the mission item that it is at; its first is 1. held: seconds at its place.
        finished: whether the mission is behind. loops: how often each jump was made.
        pending: number of the item that is still to be told as reached; None: there is none.
        returning: where it goes back to, and by which places.
        located: whether it has a position. unfit: why it does not let itself be armed.
        obstacle: metres and degrees clockwise from its nose. breached: whether it is out of its fence.
        silent: commands that it does not answer. clock_error: seconds by which its time of day is wrong.
        patience: seconds that it waits at least for what comes by its link, whatever parameters say.
        beats_now: whether a heartbeat is due because the mode has changed.
        failed: since when each thing is wrong that it watches, or that it has answered that.
        failsafe: what a PX4 does because of that; None: nothing.
        fence_due: when it looks at its fence again. told_out: whether somebody says that it is out of it.
        reboots: whether it is to be switched off and on.
        home: latitude, longitude and metres above the sea. settled: whether somebody has told it its home.
        heard: when the ground station that it knows was last heard; None: never.
        steered: when the last set-points came, oldest first.
        aimed: whether one was heeded since it went into its mode, or took off.
        sticks: of the pilot, where somebody has moved them.
    """

    def __init__(self, settings: Settings) -> None:
        """Stand at home, switched on."""
        self.settings = settings
        self.body = Body(wind=wind_of(*settings.wind))
        self.gusts = Gusts(*settings.gusts, seed=f"{settings.seed} {settings.system}")
        self.battery = Battery(settings.energy, settings.capacity)
        self.camera = Camera()
        self.parameters = parameters.defaults(settings)
        self.stores: dict[int, list[Item]] = {MISSION: [], FENCE: [], RALLY: []}
        self.time = self.booted = 0.0
        self.numbers = numbers(settings)
        self.mode = self.numbers[first_mode(settings)]
        self.mode_name = first_mode(settings)
        self.history: list[tuple[float, int, tuple[float, ...]]] = []
        self.visited: list[tuple[float, int]] = []
        self.track: list[tuple[float, float, float, float]] = []
        self.modes: list[tuple[float, int]] = []
        self.said: list[tuple[float, int, str]] = []
        self.located, self.unfit = True, ""
        self.obstacle: tuple[float, float] | None = None
        self.breached, self.breaches = False, 0
        self.told_out, self.reboots = False, False
        self.fence_due = 0.0
        self.silent = settings.silent
        self.clock_error = 0.0
        self.patience = 0.0
        self._forget()

    def _forget(self) -> None:
        """Begin with an empty memory; what is on disk is elsewhere."""
        self.armed = False
        self.texts: list[tuple[int, str]] = []
        self.item, self.held, self.finished = 0, 0.0, False
        self.loops: dict[int, int] = {}
        self.pending: int | None = None
        self.roi: Vector | None = None
        self.returning: list[Vector] = []
        self.crumbs: list[Vector] = [(0.0, 0.0, 0.0)]
        self.heard: float | None = None
        self.steered: list[float] = []
        self.aimed = False
        self.sticks: Sticks | None = None
        self.grounded_since = self.time
        self.home = self._here()
        self.settled = False
        self.beats_now = False
        self.failed: dict[str, float] = {}
        self.failsafe: Failsafe | None = None
        self.body.target = self.body.onward = self.body.origin = self.body.wanted_heading = None

    @property
    def energy(self) -> float:
        """Return the part of the battery that is left, 0 to 1."""
        return self.battery.level

    @energy.setter
    def energy(self, level: float) -> None:
        self.battery.change(level)

    @property
    def uptime(self) -> float:
        """Return the seconds since it was switched on."""
        return self.time - self.booted

    @property
    def booting(self) -> bool:
        """Return whether it is still silent after a reboot."""
        return self.booted > 0.0 and self.uptime < self.settings.boot

    @property
    def ready(self) -> bool:
        """Return whether it knows where it is and may be armed."""
        return self.uptime >= self.settings.ready and self.located and not self.unfit

    @property
    def first_item(self) -> int:
        """Return the number of the first item of missions: ArduPilot keeps home before it."""
        return 0 if self.settings.firmware == PX4 else 1

    @property
    def told_item(self) -> int:
        """Return the item that it tells: ArduPilot that which it flies to, not what it does on the way."""
        items = self.stores[MISSION]
        if self.settings.firmware == PX4 or not self.first_item <= self.item < len(items):
            return self.item
        ahead = (seq for seq in range(self.item, len(items)) if items[seq].is_flown)
        behind = (seq for seq in range(self.item, 0, -1) if items[seq].is_flown)
        return next(ahead, next(behind, 0))

    @property
    def flies(self) -> bool:
        """Return whether it is of a kind that takes off and lands."""
        return self.settings.kind == "copter"

    @property
    def airborne(self) -> bool:
        """Return whether it is off the ground; what does not fly never is."""
        return self.flies and self.body.position[2] > NEAR_GROUND

    def degrees(self) -> tuple[float, float]:
        """Return latitude and longitude."""
        return self.degrees_at(self.body.position)

    def degrees_at(self, place: Vector) -> tuple[float, float]:
        """Return latitude and longitude of a place."""
        north, east, _ = place
        of_latitude, of_longitude = metres_per_degree(self.settings.latitude)
        longitude = remainder(self.settings.longitude + east / of_longitude, 360.0)
        return self.settings.latitude + north / of_latitude, longitude

    def local(self, latitude: float, longitude: float, up: float) -> Vector:
        """Return metres north, east and up of home."""
        of_latitude, of_longitude = metres_per_degree(self.settings.latitude)
        north = (latitude - self.settings.latitude) * of_latitude
        return (north, remainder(longitude - self.settings.longitude, 360.0) * of_longitude, up)

    def above_ground(self, height: float, *, above_sea: bool) -> float:
        """Return a height that counts from the sea, or else from home, in metres above the ground."""
        return height + (0.0 if above_sea else self.home[2]) - self.settings.altitude

    def place_of(self, item: Item) -> Vector:
        """Return where an item is; one without a place, or without coordinates, is here or above here."""
        up = self.above_ground(item.z, above_sea=item.above_sea)
        if not (item.x or item.y):
            return (*self.body.position[:2], up)
        return self.local(item.x * 1e-7, item.y * 1e-7, up)

    def set_mode(self, number: int) -> int:
        """Change the mode; return a MAV_RESULT."""
        name = next((name for name, its in self.numbers.items() if its == number), None)
        if name is None or not self._may_enter(name):
            return int(mavlink.MAV_RESULT_FAILED)
        if number != self.mode:
            self.modes.append((self.time, number))
            self.beats_now = True
            self._take_up_mission(name)
        self.mode, self.mode_name = number, name
        self.body.target = self.body.onward = self.body.origin = None
        self.body.speed = self._entry_speed(name)
        self.body.adrift = self.aimed = False
        self.held, self.returning = 0.0, []
        return int(mavlink.MAV_RESULT_ACCEPTED)

    def enter(self, *names: str) -> None:
        """Go into the first of these modes that it has and may go into."""
        for name in names:
            if name in self.numbers and self.set_mode(self.numbers[name]) == mavlink.MAV_RESULT_ACCEPTED:
                return

    def say(self, severity: int, text: str) -> None:
        """Have something to say to the ground."""
        self.texts.append((int(severity), text))
        self.said.append((self.time, int(severity), text))

    def note(self, number: int, params: Iterable[float]) -> None:
        """Write into the history that something was carried out, and let the camera have it, too."""
        values = tuple(params)
        self.history.append((self.time, number, values))
        self.camera.obey(number, values, self.body)

    def arm(self) -> None:
        """Start the motors; home is here from now on, unless somebody has told it another."""
        self.armed = True
        self.grounded_since = self.time
        self.crumbs = [self.body.position]
        if not (self.airborne or self.settled):
            self.home = self._here()
        self.say(mavlink.MAV_SEVERITY_INFO, "Arming motors")

    def _here(self) -> tuple[float, float, float]:
        """Return where home is if it is here; that of a submarine is at the surface above it."""
        height = 0.0 if self.settings.kind == "sub" else self.body.position[2]
        return (*self.degrees(), self.settings.altitude + height)

    def disarm(self) -> None:
        """Stop the motors; the mission begins at its first item again."""
        if self.armed:
            self.say(mavlink.MAV_SEVERITY_INFO, "Disarming motors")
        self.armed, self.item, self.finished = False, 0, False
        self.body.rest_at(self.body.position[2])

    def restart(self, armed: bool = False) -> None:
        """Lose what is in memory and begin anew; what was uploaded and set is on disk."""
        was_armed, home = self.armed, self.home
        self.booted = self.time
        self._forget()
        self.armed = was_armed and armed
        self.home = home if self.armed else self.home
        self.breached = self.told_out = self.reboots = False
        self.mode_name = first_mode(self.settings)
        self.mode = self.numbers[self.mode_name]
        self.modes.append((self.time, self.mode))

    def take_stick(self, mode: str) -> None:
        """Have the pilot change the mode.

        Raises:
            ValueError: there is no such mode.
        """
        if mode not in self.numbers:
            raise ValueError(f"{mode}: no such mode; this vehicle has {', '.join(self.numbers)}")
        self.set_mode(self.numbers[mode])

    def _take_up_mission(self, mode: str) -> None:
        """Begin the mission anew where it is over, or where it shall not go on at the item it is at."""
        if mode == "auto" and (self.finished or self.parameters.get("MIS_RESTART") == 1):
            self.item, self.finished = self.first_item, False
            self.loops.clear()

    def _entry_speed(self, mode: str) -> float:
        """Return the speed at which it begins a mode: of missions a PX4 keeps what items have said before."""
        said = [item.params[1] for item in self.stores[MISSION][: self.item] if item.command == CHANGE_SPEED]
        keeps = said and mode == "auto" and self.settings.firmware == PX4
        return said[-1] if keeps else self.usual_speed()

    def usual_speed(self) -> float:
        """Return the metres per second at which it goes unless it is told another speed."""
        for name, part in SPEEDS:
            if name in self.parameters:
                return self.parameters[name] * part
        return self.body.speed

    def _may_enter(self, name: str) -> bool:
        blind = name in BLIND or (self.settings.kind == "rover" and name == "brake")
        if not blind and self.armed and not self.located:
            self.say(mavlink.MAV_SEVERITY_WARNING, f"Mode change to {name.upper()} failed: requires position")
            return False
        if name == "auto":
            return is_feasible(self) if self.settings.firmware == PX4 else self._has_a_mission()
        if self.settings.firmware == PX4 and name == "guided":
            return self.is_steered()
        return True

    def is_steered(self) -> bool:
        """Return whether set-points have come for a second, more than two a second, until now."""
        return (
            len(self.steered) > STREAM_LEAST
            and self.time - self.steered[0] >= STREAM_SECONDS
            and self.time - self.steered[-1] <= max(STREAM_GAP, self.patience)
        )

    def _has_a_mission(self) -> bool:
        items = self.stores[MISSION]
        moves = [item.command for item in items[1:] if item.command in MOVING]
        climbs = moves[:1] == [mavlink.MAV_CMD_NAV_TAKEOFF]
        if self.armed and self.flies and not self.airborne and not climbs:
            self.say(mavlink.MAV_SEVERITY_CRITICAL, "Auto: Missing Takeoff Cmd")
            return False
        return len(items) > self.first_item


@lru_cache(maxsize=1024)
def metres_per_degree(latitude: float) -> tuple[float, float]:
    """Return the length of a degree of latitude and of one of longitude, on the ellipsoid of WGS 84."""
    flat = 1.0 - SQUARED_ECCENTRICITY * sin(radians(latitude)) ** 2
    meridian = EQUATOR * (1.0 - SQUARED_ECCENTRICITY) / flat**1.5
    parallel = EQUATOR / sqrt(flat) * cos(radians(latitude))
    return radians(meridian), radians(parallel)


def bearing(here: Vector, there: Vector) -> float | None:
    """Return degrees clockwise from north; None where both are at one place."""
    north, east = there[0] - here[0], there[1] - here[1]
    return degrees(atan2(east, north)) % 360.0 if abs(north) + abs(east) > 1.0 else None
