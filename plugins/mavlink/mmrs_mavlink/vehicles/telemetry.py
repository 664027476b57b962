"""What a vehicle tells about itself, read from the latest messages of its link."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from math import atan2, degrees, hypot, inf

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_runtime.controllers.state import State
from mmrs_runtime.faults import FENCE_BREACHED, POSITION_LOST

from ..links.link import Link, Message
from ..links.messages import tells_place
from ..profiles import modes
from ..program import Geographic, Local, Place
from .detections import Detections
from .motor_failures import MotorFailures
from .position_jumps import PositionJumps
from .readiness import lacks, unlocated
from .texts import Announcements, Texts
from .trail import Trail, item_of, place_in

HEARING_SECONDS = 2.5
"""Vehicles tell their heartbeats once a second; one of them may get lost."""


class Batteries:
    """Keeps the last report of each battery except the payload's; an observer of the vehicle's link."""

    def __init__(self, component: Callable[[], int]) -> None:
        """Create without reports; `component` gives that of the autopilot, which reports its batteries."""
        self._component = component
        self._reported: dict[int, tuple[int, int]] = {}

    def __call__(self, message: Message, outgoing: bool) -> None:
        """Keep the report of a battery that propels the vehicle."""
        if outgoing or message.get_type() != "BATTERY_STATUS":
            return
        payload = message.battery_function == mavlink.MAV_BATTERY_FUNCTION_PAYLOAD
        if message.get_srcComponent() == self._component() and not payload:
            reported = (int(message.battery_remaining), int(message.charge_state))
            self._reported = {**self._reported, int(message.id): reported}

    @property
    def left(self) -> float | None:
        """Return the part that is left in the battery that has least; None where none tells it."""
        known = [left for left, _ in self._reported.values() if left >= 0]
        return min(known) / 100.0 if known else None

    @property
    def state(self) -> int:
        """Return the gravest MAV_BATTERY_CHARGE_STATE of those that do not charge; 0: none tells one."""
        charging = mavlink.MAV_BATTERY_CHARGE_STATE_CHARGING
        return max((state for _, state in self._reported.values() if state < charging), default=0)


NO_HEADING = 65_535
NO_DISTANCE = 65_535
NO_VOLTAGE = 65_535
STALE_SECONDS = 3.0
"""Seconds after which a position without an update counts as lost, while the vehicle is received."""

RECENT_SECONDS = 5.0
"""Seconds for which a reported obstacle or breach counts."""

IN_AIR = frozenset(
    {mavlink.MAV_LANDED_STATE_IN_AIR, mavlink.MAV_LANDED_STATE_TAKEOFF, mavlink.MAV_LANDED_STATE_LANDING}
)
OBSTACLE_METRES = 5.0
CHARGE = {2: "low", 3: "critical", 4: "an emergency", 5: "failed", 6: "unhealthy"}
BREACHES = {1: "too low", 2: "too high", 3: "at its boundary"}


class Telemetry:
    """Reads the latest messages of a link; nothing here waits.

    Attributes:
        texts: of the vehicle.
        announcements: its texts about its failsafes.
        jumps: jumps of its position estimate.
        motor_failures: signs that a motor has failed.
    """

    def __init__(self, link: Link, home: Place) -> None:
        """Read a link; the frame of `home` decides which positions count."""
        self._link = link
        self._place = home
        self._geographic = isinstance(home, Geographic)
        self._position = "GLOBAL_POSITION_INT" if self._geographic else "LOCAL_POSITION_NED"
        self.texts = Texts(link.clock)
        link.observe(self.texts)
        self.announcements = Announcements(link, self.texts)
        link.observe(self.announcements)
        self._batteries = Batteries(lambda: link.component)
        link.observe(self._batteries)
        self.jumps = PositionJumps(self._position, lambda: link.component, self.armed)
        link.observe(self.jumps)
        self.motor_failures = MotorFailures(
            self._position, lambda: link.component, self.armed, self._is_to_land
        )
        link.observe(self.motor_failures)
        self._detections = Detections(lambda: self.here() if self.placed() else None)
        link.observe(self._detections)

    def state(self) -> State:
        """Return all that conditions are asked with."""
        wind = self.wind()
        return State(
            self._link.clock.now(),
            self.here(),
            self.speed(),
            self.heading() or 0.0,
            self.energy(),
            wind=None if wind is None else wind[0],
            wind_from=None if wind is None else wind[1],
            detected=self._detections.names,
            places=self._detections.places,
        )

    def lacks(self) -> tuple[str, ...]:
        """Return in words what keeps the vehicle from being ready to move; empty when nothing does."""
        return lacks(self._link, self.texts, self._position, geographic=self._geographic)

    def placed(self) -> bool:
        """Return whether the vehicle has told where it is."""
        found = self._link.latest(self._position)
        return found is not None and tells_place(found)

    def ready(self) -> bool:
        """Return whether the vehicle knows where it is and its own checks pass."""
        return not self.lacks()

    def position_trouble(self) -> str:
        """Return why the vehicle no longer knows where it is; empty if it does, or never did."""
        if self._link.latest(self._position) is None:
            return ""
        trouble = unlocated(self._link, geographic=self._geographic)
        silent = self._link.since(self._position) - self._link.silent_for()
        if not trouble and silent > self._link.clock.patience(STALE_SECONDS, 1.0):
            return f"it has not reported its position for {silent:.0f} s ({self._position})"
        return trouble

    def starts(self) -> int:
        """Return how often the vehicle was seen to restart."""
        return self._link.starts

    def obstacle(self) -> str:
        """Return the obstacle that the vehicle reports; empty if there is none."""
        collision, scan = self._recent("COLLISION"), self._recent("OBSTACLE_DISTANCE")
        if collision is not None and collision.threat_level == mavlink.MAV_COLLISION_THREAT_LEVEL_HIGH:
            return f"a collision threatens in {collision.time_to_minimum_delta:.0f} s"
        if scan is not None:
            known = [cm for cm in scan.distances if cm != NO_DISTANCE and cm <= scan.max_distance]
            if known and min(known) <= OBSTACLE_METRES * 100.0:
                return f"something is {min(known) / 100.0:.1f} m away"
        return ""

    def breach(self) -> str:
        """Return how the vehicle says that it has broken its fence; empty if it does not."""
        fence = self._recent("FENCE_STATUS")
        if fence is None or not fence.breach_status:
            return ""
        return f"it is outside its fence: {BREACHES.get(fence.breach_type, 'somehow')}"

    def breached_at(self) -> float:
        """Return the second of the run at which its present breach began, as it reports; -inf without one."""
        fence = self._recent("FENCE_STATUS")
        if fence is None or not fence.breach_status:
            return -inf
        return self._link.clock.now() - max(0.0, self.time() - float(fence.breach_time) * 1e-3)

    def wind(self) -> tuple[float, float] | None:
        """Return metres per second, and from where, degrees; None where the vehicle does not say."""
        reported, estimated = self._link.latest("WIND"), self._link.latest("WIND_COV")
        if reported is not None:
            return float(reported.speed), float(reported.direction) % 360.0
        if estimated is not None:
            speed = hypot(estimated.wind_x, estimated.wind_y)
            return speed, (degrees(atan2(estimated.wind_y, estimated.wind_x)) + 180.0) % 360.0
        return None

    def failsafe(self) -> str | None:
        """Return the event that a failsafe has just answered, as reported; None if none has."""
        if self.position_trouble():
            return POSITION_LOST
        if self.breach():
            return FENCE_BREACHED
        said = {event for event, _ in self.announcements.recent()}
        return next((event for event in self._link.profile.autopilot.announcements if event in said), None)

    def crash(self) -> str:
        """Return how the vehicle says that it has just crashed, and disarmed; empty if it does not."""
        beginnings = self._link.profile.autopilot.crashed
        seconds = self._link.clock.patience(RECENT_SECONDS)
        said = self.texts.starting_with(beginnings, seconds) if beginnings else ()
        return said[-1] if said else ""

    def here(self) -> Place:
        """Return the last reported position, as the vehicle is judged by it; home before there is one."""
        found = self._link.latest(self._position)
        if found is not None and tells_place(found):
            self._place = self._link.profile.level(place_in(found))
        return self._place

    @contextmanager
    def trail(self) -> Iterator[Trail]:
        """Collect all positions that are reported from now on, also between two looks."""
        with self._link.trail(self._position) as reported:
            yield Trail(self._link, self._position, self.here(), reported)

    def still_since(self, begun: float, pace: float) -> bool:
        """Return whether a position that has come since shows no more than a speed, metres per second."""
        reported = self._link.clock.now() - self._link.since(self._position)
        return reported > begun and self.speed() <= pace

    def time(self) -> float:
        """Return the second since its start at which the vehicle was at its last reported position."""
        found = self._link.latest(self._position)
        return 0.0 if found is None else float(found.time_boot_ms) * 1e-3

    def aim(self) -> Place | None:
        """Return the vehicle's last reported target position; None where it has reported none.

        The height of a geographic one means nothing: firmwares count it from different levels.
        """
        found = self._link.latest(
            "POSITION_TARGET_GLOBAL_INT" if self._geographic else "POSITION_TARGET_LOCAL_NED"
        )
        if found is None:
            return None
        if self._geographic:
            return Geographic(found.lat_int * 1e-7, found.lon_int * 1e-7, found.alt)
        return Local(found.x, found.y, -found.z)

    def sea_level(self) -> float | None:
        """Return the metres of the vehicle's own home above mean sea level; None before it says."""
        found = self._link.latest("GLOBAL_POSITION_INT")
        return None if found is None else (found.alt - found.relative_alt) * 1e-3

    def velocity(self) -> tuple[float, float, float]:
        """Return the speed north, east and up in metres per second."""
        found = self._link.latest(self._position)
        if found is None:
            return (0.0, 0.0, 0.0)
        unit = 0.01 if self._geographic else 1.0
        return (found.vx * unit, found.vy * unit, -found.vz * unit)

    def speed(self) -> float:
        """Return the speed in metres per second."""
        return float(hypot(*self.velocity()))

    def heading(self) -> float | None:
        """Return the heading in degrees clockwise from north; None where the vehicle does not say."""
        found = self._link.latest("GLOBAL_POSITION_INT")
        return found.hdg / 100.0 if found is not None and found.hdg != NO_HEADING else None

    def energy(self) -> float | None:
        """Return the part of the battery that is left; None where the vehicle does not say."""
        reported = self._link.latest("SYS_STATUS")
        if reported is not None and reported.battery_remaining >= 0:
            return float(reported.battery_remaining) / 100.0
        return self._batteries.left

    def least_energy(self) -> float | None:
        """Return the part that is left in the battery that has least; None where the vehicle does not say."""
        reported = (self.energy(), self._batteries.left)
        return min((each for each in reported if each is not None), default=None)

    def voltage(self) -> float | None:
        """Return the volts of the battery; None where the vehicle does not say."""
        reported = self._link.latest("SYS_STATUS")
        known = reported is not None and 0 < reported.voltage_battery < NO_VOLTAGE
        return reported.voltage_battery * 1e-3 if reported is not None and known else None

    def battery_trouble(self) -> str:
        """Return what the vehicle itself says against its battery; empty if nothing."""
        word = CHARGE.get(self._batteries.state)
        return "" if word is None else f"it says that its battery is {word}"

    def armed(self) -> bool:
        """Return whether the motors may run."""
        beat = self._link.latest("HEARTBEAT")
        return bool(beat is not None and beat.base_mode & mavlink.MAV_MODE_FLAG_SAFETY_ARMED)

    def mode(self) -> int:
        """Return the number of the mode; -1 before the first heartbeat."""
        beat = self._link.latest("HEARTBEAT")
        return int(beat.custom_mode) if beat is not None else -1

    def _is_to_land(self) -> bool:
        return self._link.profile.mode_name(self.mode()) == modes.LAND

    def grounded(self) -> bool:
        """Return whether the vehicle says that it stands on the ground."""
        state = self._link.latest("EXTENDED_SYS_STATE")
        return bool(state is not None and state.landed_state == mavlink.MAV_LANDED_STATE_ON_GROUND)

    def airborne(self) -> bool:
        """Return whether the vehicle says that it is in the air."""
        state = self._link.latest("EXTENDED_SYS_STATE")
        return state is not None and self.armed() and state.landed_state in IN_AIR

    def item(self) -> int:
        """Return the mission item that the vehicle is at; -1 where it does not say."""
        return item_of(self._link)[0]

    def _recent(self, kind: str) -> Message | None:
        return self._link.latest(kind) if self._link.since(kind) < RECENT_SECONDS else None
