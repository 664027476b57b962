"""State of a simulated autopilot, its modes and its home; it has no link and no clock of its own."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from math import hypot, inf

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.profiles import VehicleProfile
from mmrs_mavlink.sitl import parameters
from mmrs_mavlink.sitl.battery import Battery
from mmrs_mavlink.sitl.body import Body, Vector, course
from mmrs_mavlink.sitl.car import Car
from mmrs_mavlink.sitl.items import ABOVE_SEA, FENCE, MISSION, MOVING, RALLY, StoredItem
from mmrs_mavlink.sitl.settings import PX4, Settings
from mmrs_runtime.controllers.geodesy import metres_per_degree, wrapped

NEAR_GROUND = 0.05
NOT_TO_BE_ARMED_IN = frozenset({"land", "return"})
"""Modes that a PX4 refuses to be armed in (``mode_requirements.cpp``)."""

SPEEDS: Mapping[str, float] = {"WPNAV_SPEED": 100.0, "WP_SPEED": 1.0, "MPC_XY_CRUISE": 1.0}
"""Parameters of the default speed, with their units in a metre per second."""

LARGEST: Mapping[str, float] = {"MPC_XY_VEL_MAX": 1.0}
"""Parameter of the only limit that a PX4 keeps in OFFBOARD, in metres per second (``_lim_vel_horizontal``,
``PositionControl.cpp``)."""

DIGICAM, TRIGGER_DISTANCE, IMAGE = 203, 206, 2000
SHUTTER = {DIGICAM: 4, TRIGGER_DISTANCE: 2}
"""Index of the parameter that is 1 where a command takes a photo at once; IMAGE_START_CAPTURE always does."""

CHANGE_SPEED = int(mavlink.MAV_CMD_DO_CHANGE_SPEED)
STREAM_SECONDS, STREAM_GAP = 1.0, 0.5
"""PX4 accepts set-points that have come for a second, with gaps of at most half a second."""

MANUAL = frozenset({"stabilize", "acro", "altitude_hold", "depth_hold", "altitude", "manual", "steering"})
"""Modes in which a pilot steers."""

CURVED = frozenset({"auto", "return", "smart_return"})
"""Modes in which a copter takes legs as S-curves; other vehicles always do."""

BLIND = MANUAL | {"land", "surface"}
"""Modes that need no position."""


class SimulatedAutopilot:
    """The state of a vehicle; `simulation` moves it, `commands` executes its commands.

    Attributes:
        px4: whether its firmware is PX4. flies: whether its kind takes off and lands.
        first_item: number of a mission's first item: item 0 is home on ArduPilot.
        time: seconds since the simulation began. booted: time of the last boot.
        history: (seconds, command, parameters) of every executed command and mission item.
        visited: (seconds, item) of every completed mission item.
        track: (seconds, north, east, up) while armed, ten times a second.
        modes: (seconds, number) of every mode change. numbers: of its modes, by name.
        armable_mode: the last mode that a PX4 may be armed in.
        said: (seconds, severity, text) of every STATUSTEXT.
        photos: position at each photo. takes_photos: whether its camera works.
        trigger_distance: metres after which it takes the next; 0: none. triggered_at: where it took the last.
        stores: items by mission type.
        item: current mission item. held: seconds at its position. finished: whether the mission is over.
        climbs_at: time at which its motors have spun up for a take-off. driven_at: time of the last sticks.
        return_path: positions to pass on a return. breadcrumbs: positions for SmartRTL.
        located: whether it has a position. shift: metres north and east by which it is wrong.
        motor_failed: whether a motor has failed, with which it cannot fly.
        wind: metres per second, and degrees that it comes from.
        obstacle: metres to something ahead; None: there is nothing.
        breached: whether it is outside its fence. forced_breach: whether an injected fault says so.
        silent: commands that it does not answer. cut: numbers of the links that are cut.
        link_timeout: shortest timeout of its link, seconds, whatever its parameters say.
        failing: time since which each failure is present. answered: failures that it has answered.
        interest: what it looks at on missions; None: the next place.
        home: latitude, longitude, metres above mean sea level. home_set: whether a command has set it.
        last_heartbeat: time of the last heartbeat of its ground station; None: none received.
        setpoints: times of the last set-points, oldest first. aimed: whether it has followed one in its mode.
    """

    def __init__(self, settings: Settings) -> None:
        """Stand at home after boot."""
        self.settings, self.px4, self.flies = settings, settings.firmware == PX4, settings.profile.flies
        self.first_item = int(settings.profile.autopilot.missions.begins_with_home)
        kind = Car if settings.profile.drives and not settings.spins else Body
        self.body = kind(settings.profile.pacing.step)
        self.battery = Battery(settings.energy, settings.capacity, settings.cells)
        self.photos: list[Vector] = []
        self.takes_photos = True
        self.trigger_distance, self.triggered_at = 0.0, (0.0, 0.0, 0.0)
        self.parameters = parameters.defaults(settings)
        self.stores: dict[int, list[StoredItem]] = {MISSION: [], FENCE: [], RALLY: []}
        self.time = self.booted = self.clock_error = self.link_timeout = 0.0
        self.numbers = _numbers(settings.profile)
        self.mode, self.mode_name = 0, ""
        self.history: list[tuple[float, int, tuple[float, ...]]] = []
        self.visited: list[tuple[float, int]] = []
        self.track: list[tuple[float, float, float, float]] = []
        self.modes: list[tuple[float, int]] = []
        self.said: list[tuple[float, int, str]] = []
        self.located, self.shift = True, (0.0, 0.0)
        self.wind = settings.wind
        self.motor_failed = False
        self.interest: Vector | None = None
        self.obstacle: float | None = None
        self.silent, self.cut = set(settings.silent), set[int]()
        self._clear_memory()

    def _clear_memory(self) -> None:
        self.armed = self.breached = self.forced_breach = False
        self.start_mode()
        self.item, self.held, self.finished = 0, 0.0, False
        self.climbs_at = self.driven_at = 0.0
        self.return_path: list[Vector] = []
        self.breadcrumbs: list[Vector] = [(0.0, 0.0, 0.0)]
        self.last_heartbeat: float | None = None
        self.setpoints: list[float] = []
        self.grounded_since = self.time
        self.home = self._here()
        self.home_set = self.heartbeat_due = self.aimed = False
        self.failing: dict[str, float] = {}
        self.answered: set[str] = set()
        self.body.target = self.body.onward = self.body.wanted_heading = self.body.driven = None
        self._set_up_body(self.mode_name)

    @property
    def uptime(self) -> float:
        """Return the seconds since boot."""
        return self.time - self.booted

    @property
    def booting(self) -> bool:
        """Return whether it is still silent after a reboot."""
        return self.booted > 0.0 and self.uptime < self.settings.boot

    @property
    def ready(self) -> bool:
        """Return whether it has had the time since boot that its position estimate needs."""
        return self.uptime >= self.settings.ready

    @property
    def current_item(self) -> int:
        """Return the item that it reports: ArduPilot that which it flies to, not one executed on the way."""
        items = self.stores[MISSION]
        if self.px4 or not self.first_item <= self.item < len(items):
            return self.item
        ahead = (seq for seq in range(self.item, len(items)) if items[seq].is_flown)
        behind = (seq for seq in range(self.item, 0, -1) if items[seq].is_flown)
        return next(ahead, next(behind, 0))

    @property
    def airborne(self) -> bool:
        """Return whether it flies above the ground."""
        return self.flies and self.body.position[2] > NEAR_GROUND

    @property
    def has_mission(self) -> bool:
        """Return whether it has a mission; a PX4's must begin within MIS_DIST_1WP."""
        items, limit = self.stores[MISSION], self.parameters.get("MIS_DIST_1WP", 0.0)
        first = next((item for item in items if item.command in MOVING and (item.x or item.y)), None)
        if first is not None and limit > 0.0:
            home, place = self.local(*self.home[:2], 0.0), self.place_of(first)
            return hypot(place[0] - home[0], place[1] - home[1]) < limit
        return len(items) > self.first_item

    @property
    def is_steered(self) -> bool:
        """Return whether set-points come as often and as long as a PX4 requires."""
        first, last = self.setpoints[:1], self.setpoints[-1:]
        lasting = bool(first) and self.time - first[0] >= STREAM_SECONDS and len(self.setpoints) > 2
        return lasting and self.time - last[0] <= max(STREAM_GAP, self.link_timeout)

    def degrees(self) -> tuple[float, float]:
        """Return its latitude and longitude."""
        return self.degrees_at(self.body.position)

    def degrees_at(self, place: Vector) -> tuple[float, float]:
        """Return the latitude and longitude of a position."""
        of_latitude, of_longitude = metres_per_degree(self.settings.latitude)
        longitude = wrapped(self.settings.longitude + (place[1] + self.shift[1]) / of_longitude)
        return self.settings.latitude + (place[0] + self.shift[0]) / of_latitude, longitude

    def local(self, latitude: float, longitude: float, up: float) -> Vector:
        """Return metres north, east and up of home."""
        of_latitude, of_longitude = metres_per_degree(self.settings.latitude)
        north = (latitude - self.settings.latitude) * of_latitude - self.shift[0]
        return (north, wrapped(longitude - self.settings.longitude) * of_longitude - self.shift[1], up)

    def above_ground(self, height: float, *, above_sea: bool) -> float:
        """Return an altitude above sea level, or else above home, in metres above the ground; of rovers 0."""
        if self.settings.kind == "rover":
            return 0.0
        return height + (0.0 if above_sea else self.home[2]) - self.settings.altitude

    def place_of(self, item: StoredItem) -> Vector:
        """Return the position of an item; without coordinates, that of the vehicle at the item's altitude."""
        up = self.above_ground(item.z, above_sea=item.frame in ABOVE_SEA)
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
            self.heartbeat_due = True
            if name == "auto" and (self.finished or self.parameters.get("MIS_RESTART") == 1):
                self.item, self.finished = self.first_item, False
        self.mode, self.mode_name = number, name
        if name not in NOT_TO_BE_ARMED_IN:
            self.armable_mode = name
        self.body.onward = self.interest = None
        if name != "land":
            self.body.target = None
        self._set_up_body(name)
        self.aimed, self.held, self.return_path = False, 0.0, []
        return int(mavlink.MAV_RESULT_ACCEPTED)

    def _set_up_body(self, mode: str) -> None:
        """Set the vehicle up to move as in a mode; a PX4 keeps the speed that its mission has set."""
        body, pacing = self.body, self.settings.profile.pacing
        body.curved = mode in CURVED or not (self.flies or mode in MANUAL)
        one_by_one = mode == "guided" or (self.flies and not body.curved)
        legs = pacing.step if one_by_one else pacing.mission
        if mode == "take_off":
            legs = pacing.upright
        body.figures = legs or pacing.step
        body.radius = self._value(self.settings.profile.radii)
        body.pivots = self._value(self.settings.profile.pivots) if self.settings.spins else inf
        keeps = mode == "auto" and self.settings.profile.autopilot.missions.keeps_speed
        passed = self.stores[MISSION][: self.item] if keeps else []
        speeds = [item.params[1] for item in passed if item.command == CHANGE_SPEED]
        guided = self.px4 and mode == "guided"
        body.speed = self._value(LARGEST) if guided else (speeds or [self.usual_speed()])[-1]
        body.climb, body.descent = self._value(self.settings.profile.climbs), self.usual_descent()
        body.turn_rate = min(self._value(self.settings.profile.yaw_rates), pacing.turn_rate)

    def usual_speed(self) -> float:
        """Return the default speed, metres per second."""
        return self._value(SPEEDS)

    def usual_descent(self) -> float:
        """Return the default speed of its descents, metres per second."""
        return self._value(self.settings.profile.descents)

    def _value(self, units: Mapping[str, float]) -> float:
        """Return the first parameter that it has of these, in metres; inf where it has none."""
        known = (self.parameters[name] / unit for name, unit in units.items() if name in self.parameters)
        return next(known, inf)

    def face(self, place: Vector) -> None:
        """Turn to its region of interest, or to a place that is not right here."""
        place = self.interest or place
        north, east = place[0] - self.body.position[0], place[1] - self.body.position[1]
        if abs(north) + abs(east) > 1.0:
            self.body.wanted_heading = course(self.body.position, place)

    def enter(self, *names: str) -> None:
        """Enter the first of these modes that it has and may enter."""
        for name in names:
            if name in self.numbers and self.set_mode(self.numbers[name]) == mavlink.MAV_RESULT_ACCEPTED:
                return

    def say(self, severity: int, text: str) -> None:
        """Send a STATUSTEXT."""
        self.said.append((self.time, int(severity), text))

    def record(self, number: int, params: Iterable[float]) -> None:
        """Record an executed command, and take a photo if it says so."""
        values = tuple(params)
        self.history.append((self.time, number, values))
        if number == TRIGGER_DISTANCE:
            self.trigger_distance = values[0]
            self.triggered_at = self.body.position
        if number == IMAGE or (number in SHUTTER and values[SHUTTER[number] :][:1] == (1.0,)):
            self.take_photo()

    def take_photo(self) -> None:
        """Take a photo, if its camera works."""
        self.triggered_at = self.body.position
        if self.takes_photos:
            self.photos.append(self.body.position)

    def arm(self) -> None:
        """Arm; home becomes the present position unless a command has set it."""
        self.armed = True
        self.grounded_since = self.time
        self.breadcrumbs = [self.body.position]
        if not (self.airborne or self.home_set):
            self.home = self._here()
        self.say(mavlink.MAV_SEVERITY_INFO, "Arming motors")

    def spin_up(self) -> None:
        """Begin a take-off: it climbs once its motors have spun up."""
        pacing = self.settings.profile.pacing
        self.climbs_at = self.time + max(0.0, (pacing.launch or 0.0) - pacing.noticing)

    def _here(self) -> tuple[float, float, float]:
        """Return the present position as a home; that of a submarine is at the surface above it."""
        height = 0.0 if self.settings.profile.dives else self.body.position[2]
        return (*self.degrees(), self.settings.altitude + height)

    def disarm(self) -> None:
        """Disarm; the mission restarts at its first item, and a PX4 leaves modes that it is not armed in."""
        if self.armed:
            self.say(mavlink.MAV_SEVERITY_INFO, "Disarming motors")
            if self.settings.profile.autopilot.restores_mode and self.mode_name != self.armable_mode:
                self.mode_name, self.mode = self.armable_mode, self.numbers[self.armable_mode]
                self.modes.append((self.time, self.mode))
                self.heartbeat_due = True
        self.armed, self.item, self.finished = False, 0, False
        self.body.rest_at(self.body.position[2])

    def restart(self) -> None:
        """Reboot, and keep uploads and parameters only."""
        self.booted = self.time
        self._clear_memory()
        self.modes.append((self.time, self.mode))

    def start_mode(self) -> None:
        """Enter the mode of a vehicle after boot."""
        self.mode = self.numbers["hold"] if self.px4 else self.settings.profile.starts_in
        self.mode_name = next(name for name, its in self.numbers.items() if its == self.mode)
        self.armable_mode = self.mode_name

    def _may_enter(self, name: str) -> bool:
        blind = name in BLIND or (self.settings.profile.drives and name == "hold")
        if not blind and self.armed and not self.located:
            self.say(mavlink.MAV_SEVERITY_WARNING, f"Mode change to {name.upper()} failed: requires position")
            return False
        if name == "auto":
            return self.has_mission
        return self.is_steered if self.px4 and name == "guided" else True


def _numbers(profile: VehicleProfile) -> dict[str, int]:
    """Return the numbers of a vehicle's modes by the names that its profile gives them."""
    others = {
        name.replace(" ", "_").replace("-", "_"): number for number, name in profile.other_modes.items()
    }
    return {name: mode.number for name, mode in profile.modes.items()} | others
