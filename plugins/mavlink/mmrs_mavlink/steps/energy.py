"""The point of no return: whether the energy left still suffices for the return path."""

from __future__ import annotations

from dataclasses import replace
from math import atan2, cos, degrees, exp, hypot, inf, radians, sin, sqrt

from mmrs_runtime.controllers.geodesy import bearing, distance, offset
from mmrs_runtime.controllers.return_paths import Track, way_back
from mmrs_runtime.controllers.state import State
from mmrs_runtime.policies import COMES_DOWN

from ..program import Place, Robot

MEAN_SECONDS = 60.0
"""Over how long winds are averaged, at most."""


class MeanWind:
    """Averages the wind that a vehicle tells: evenly at first, later the more the newer it is."""

    def __init__(self) -> None:
        """Create without wind."""
        self._mean: tuple[float, ...] | None = None
        self._begun = self._last = 0.0

    def with_mean(self, state: State) -> State:
        """Return a state with the mean wind instead of that of the moment, which is taken into account."""
        if state.wind is None:
            return state
        now = (state.wind,) if state.wind_from is None else _components(state.wind, state.wind_from)
        if self._mean is None or len(self._mean) != len(now):
            self._mean, self._begun = now, state.time
        else:
            share = self._share(state.time)
            self._mean = tuple(old + share * (new - old) for old, new in zip(self._mean, now, strict=True))
        self._last = state.time
        if len(self._mean) == 1:
            return replace(state, wind=self._mean[0])
        north, east = self._mean
        return replace(state, wind=hypot(north, east), wind_from=degrees(atan2(east, north)) % 360.0)

    def _share(self, time: float) -> float:
        """Return how much the newest wind counts: as long as it lasts, of all that is remembered."""
        lasted, seen = time - self._last, time - self._begun
        if lasted <= 0.0:
            return 0.0
        return max(lasted / seen, 1.0 - exp(-lasted / MEAN_SECONDS))


def _components(speed: float, comes_from: float) -> tuple[float, float]:
    angle = radians(comes_from)
    return speed * cos(angle), speed * sin(angle)


MARGIN = 0.05
"""Part of the whole battery that must be left when the robot has come down."""

SLOWEST = 0.5
"""Metres per second; a robot that the wind keeps from being faster than that does not come back."""

TURNING_SECONDS = 6.0
"""Allowance for braking, turning round, accelerating, and stopping at the end."""

ACCELERATION = 2.0
"""Metres per second squared with which vehicles speed up, and slow down at every place of the way."""

USUAL_CRUISE = 3.0
USUAL_DESCENT = 1.0
LEAST_USED = 0.05
"""Part of the battery that must be used before its use is taken for the rate of a sortie."""

RECOUNT_SECONDS = 1.0

CHARGING_FACTOR = 1.2
"""How many times as long as declared charging may take, as checks count it."""

RECHARGE_FACTOR = 3.0
"""How many times as long as declared a robot waits for its batteries at most."""


class Reserve:
    """Watches the battery of a sortie.

    It is low when less than the robot's reserve is left, or when what is left no longer suffices for
    the response to a low battery from the robot's position: whichever comes first. Power is the type's
    mean power, or what the sortie has used so far where that is more. If the vehicle stops reporting,
    the last report in the air is extrapolated.

    Attributes:
        untold: warning about a battery that is no longer reported; empty while it is.
    """

    def __init__(self, robot: Robot) -> None:
        """Create without a sortie."""
        self.untold = ""
        self._robot = robot
        self._begun: tuple[float, float] | None = None
        self._reported: tuple[float, float] | None = None
        self._counted = -inf
        self._seconds = 0.0
        self._wind = MeanWind()

    def begin(self) -> None:
        """Begin a new sortie, or a new battery."""
        self._begun, self._counted = None, -inf

    def low(self, state: State, response: str, track: Track) -> str:
        """Return why the battery is low; empty while it is not, or unknown.

        Args:
            state: of the robot, now.
            response: to a low battery.
            track: the positions that it has passed in this sortie.
        """
        state = self._wind.with_mean(state)
        if not state.armed:
            self._reported = None
        left = self._left(state)
        if left is None or not state.armed:
            return ""
        if self._begun is None:
            self._begun = (state.time, left)
        if state.energy is not None:
            self._reported = (state.time, state.energy)
        if left < self._robot.reserve:
            return f"less than {self._robot.reserve:.0%} of the energy is left"
        endurance = self._endurance(state.time, left)
        if response not in COMES_DOWN or endurance is None:
            return ""
        needed = self._way_back(state, response, track) / endurance
        if left >= needed + MARGIN:
            return ""
        way = f"the return path takes {needed:.0%}" if needed < inf else "the wind is stronger than the robot"
        return f"point of no return: {left:.0%} of the energy is left, and {way}"

    def short(self, state: State, response: str, track: Track) -> str:
        """Return why what is left does not suffice for a response, margin or not; empty where it may."""
        left = self._left(state)
        endurance = None if left is None or self._begun is None else self._endurance(state.time, left)
        if left is None or endurance is None or response not in COMES_DOWN:
            return ""
        needed = seconds_back(self._robot, self._wind.with_mean(state), response, track) / endurance
        if left >= needed:
            return ""
        return f"{left:.0%} of the energy is left, and {response} takes {needed:.0%}"

    def _left(self, state: State) -> float | None:
        """Return the energy left as reported, or as extrapolated; None where unknown."""
        self.untold = ""
        if state.energy is not None or self._reported is None:
            return state.energy
        time, left = self._reported
        endurance = self._endurance(time, left)
        known = "a low battery will go unnoticed" if endurance is None else f"reckoned from {left:.0%}"
        self.untold = f"does not tell its battery any more: {known}"
        return None if endurance is None else max(0.0, left - (state.time - time) / endurance)

    def _endurance(self, time: float, left: float) -> float | None:
        """Return for how many seconds a full battery lasts; None where unknown."""
        begun, full = self._begun or (time, left)
        used = full - left
        found = (time - begun) / used if used >= LEAST_USED else None
        known = [each for each in (self._robot.endurance, found) if each]
        return min(known, default=None)

    def _way_back(self, state: State, response: str, track: Track) -> float:
        if state.time - self._counted >= RECOUNT_SECONDS:
            self._counted = state.time
            self._seconds = seconds_back(self._robot, state, response, track)
        return self._seconds


def seconds_back(robot: Robot, state: State, response: str, track: Track) -> float:
    """Return how long a robot needs to be back on the ground; inf where the wind is too strong."""
    here, seconds = state.place, 0.0
    for place in way_back(robot, response, track, here):
        seconds += _seconds(robot, state, here, place)
        here = place
    if seconds > 0.0:
        seconds += TURNING_SECONDS
    if not robot.profile.flies:
        return seconds
    return seconds + _landing_seconds(robot, max(0.0, here.height))


def _landing_seconds(robot: Robot, height: float) -> float:
    """Return how long a robot takes to land from a height: vehicles come down slowly near the ground."""
    pacing = robot.profile.pacing
    descent = min(robot.travel.descent or USUAL_DESCENT, pacing.step.descent)
    low = min(height, pacing.landing_height)
    slowly = low / min(descent, pacing.landing_rate) if low else 0.0
    return (height - low) / descent + slowly + (pacing.recovery or 0.0)


def _seconds(robot: Robot, state: State, a: Place, b: Place) -> float:
    """Return how long a leg takes from one stop to the next."""
    way, cruise = distance(a, b), robot.cruise or USUAL_CRUISE
    pace = min(cruise, max(cruise, robot.fastest or 0.0) - _headwind(state, a, b))
    if way == 0.0:
        return 0.0
    if pace < SLOWEST:
        return inf
    if robot.profile.flies:
        rise = abs(offset(a, b)[2]) / way
        pace = min(pace, (robot.travel.descent or USUAL_DESCENT) / rise) if rise else pace
    if way < pace**2 / ACCELERATION:
        return 2.0 * sqrt(way / ACCELERATION)
    return way / pace + pace / ACCELERATION


def _headwind(state: State, a: Place, b: Place) -> float:
    """Return the wind against the way, metres per second; a tail wind counts as none."""
    north, east, _ = offset(a, b)
    if state.wind is None or hypot(north, east) == 0.0:
        return 0.0
    if state.wind_from is None:
        return state.wind
    return max(0.0, state.wind * cos(radians(bearing(a, b) - state.wind_from)))
