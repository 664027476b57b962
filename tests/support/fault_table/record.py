"""What a vehicle did, by its own record: how it ended, how fast it answered, in words."""

from bisect import bisect_left
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import dist, hypot, sqrt

from shapely import Point, Polygon

from fault_table.project import MEADOW, OUT, TOUR
from mmrs_mavlink.sitl import SimulatedVehicle
from mmrs_mavlink.sitl.autopilot import SimulatedAutopilot
from mmrs_mavlink.sitl.body import Vector

NAMES = {
    0: "STABILIZE",
    2: "ALT_HOLD",
    3: "AUTO",
    4: "GUIDED",
    5: "LOITER",
    6: "RTL",
    9: "LAND",
    17: "BRAKE",
    21: "SMART_RTL",
}
STILL = 0.3
NEAR_HOME = 2.0
MARGIN = 1.0
"""Metres by which a vehicle may go farther than it must to brake: it takes a moment to lean back."""

GRAVITY = 9.81
GUIDED = 4
SPEED = 178
"""The command for a speed, which is told again behind the first targets of a leg."""

Moment = Callable[[SimulatedVehicle], bool]


def _near(place: tuple[float, float, float]) -> Moment:
    return _when(
        lambda pilot: pilot.armed and pilot.body.distance_to(place) < 1.0 and pilot.body.pace < STILL
    )


def _when(holds: Callable[[SimulatedAutopilot], bool]) -> Moment:
    return lambda vehicle: holds(vehicle.autopilot)


def _being_set_up(vehicle: SimulatedVehicle) -> bool:
    """Return whether somebody has told a vehicle on the ground something, as who has heard it does."""
    return bool(vehicle.received) and not (vehicle.autopilot.armed or vehicle.autopilot.track)


MOMENTS: Mapping[str, Moment] = {
    "on the ground": _being_set_up,
    "climbing": _when(lambda pilot: pilot.armed and 3.0 < pilot.body.position[2] < 8.0),
    "on a leg (GUIDED)": _when(
        lambda pilot: pilot.armed and pilot.mode == 4 and 8.0 < pilot.body.position[0] < 22.0
    ),
    "at its place": _near(OUT),
    "landing at home": _when(
        lambda pilot: (
            pilot.mode == 9
            and 3.0 < pilot.body.position[2] < 9.0
            and hypot(*pilot.body.position[:2]) < NEAR_HOME
        )
    ),
    "waiting": _near(OUT),
    "on a mission (AUTO)": _when(lambda pilot: pilot.mode == 3 and pilot.body.distance_to(TOUR[1]) < 6.0),
    "charging": _when(
        lambda pilot: (
            not pilot.armed
            and any(number == 22 for _, number, _ in pilot.history)
            and pilot.body.position[2] < 0.1
        )
    ),
}


@dataclass(frozen=True, slots=True)
class Struck:
    """When and where a vehicle was when something went wrong: seconds, metres from home.

    Attributes:
        modes, commands: how many changes of mode and commands it had had by then.
        falls: whether its motors no longer run.
    """

    time: float
    place: tuple[float, float, float]
    modes: int
    commands: int
    falls: bool = False


def struck(vehicle: SimulatedVehicle) -> Struck:
    """Return where a vehicle is now."""
    pilot = vehicle.autopilot
    body, falls = pilot.body, not pilot.armed and pilot.body.position[2] > MARGIN
    return Struck(pilot.time, body.position, len(pilot.modes), len(pilot.history), falls)


def answered(vehicle: SimulatedVehicle, since: Struck) -> float | None:
    """Return the seconds until the vehicle first did something else: a mode, a command that is no speed."""
    pilot = vehicle.autopilot
    times = [time for time, _ in pilot.modes[since.modes :]]
    times += [time for time, number, _ in pilot.history[since.commands :] if number != SPEED]
    return max(0.0, min(times) - since.time) if times else None


class Answer:
    """When a vehicle does something else than it did: by its record, or by where it goes in GUIDED."""

    def __init__(self, vehicle: SimulatedVehicle, since: Struck, target: Vector | None) -> None:
        """Begin to look at a vehicle that went for a target, or for none, until then."""
        self._vehicle, self._since, self._target = vehicle, since, target
        self._turned: float | None = None

    @property
    def seconds(self) -> float | None:
        """Return how many it took; None: it has not yet."""
        times = [self._turned, answered(self._vehicle, self._since)]
        return min((time for time in times if time is not None), default=None)

    def look(self) -> None:
        """Keep when it first goes for another place than before."""
        pilot = self._vehicle.autopilot
        new = pilot.body.target
        if self._turned is not None or pilot.mode != GUIDED or new is None:
            return
        if self._target is None or dist(new, self._target) > 1.0:
            self._turned = max(0.0, pilot.time - self._since.time)


def ending(vehicle: SimulatedVehicle, since: Struck) -> str:
    """Return where a vehicle has come to rest: home, meadow, here, elsewhere, holds; empty while it moves."""
    pilot = vehicle.autopilot
    north, east, up = pilot.body.position
    if pilot.armed:
        return "holds" if pilot.body.pace < STILL and up > 0.5 else ""
    if up > 0.1:
        return ""
    if hypot(north, east) < NEAR_HOME:
        return "home"
    if Polygon(MEADOW).contains(Point(north, east)):
        return "meadow"
    return "here" if stops_short(vehicle, since) else "elsewhere"


def stops_short(vehicle: SimulatedVehicle, since: Struck) -> bool:
    """Return whether a vehicle is no farther from where it answered than it must be to come to a halt.

    Its acceleration changes by its jerk: it speeds up until that is gone, and takes an S-curve to brake then;
    if it falls from a height h at a speed v, it goes v·√(2h/g) to the ground.
    """
    pilot = vehicle.autopilot
    (north, east, up), pace, gain = _then(vehicle, since)
    figures = pilot.body.figures
    seconds, fastest = gain / figures.jerk, pace + gain * gain / (2.0 * figures.jerk)
    room = seconds * (pace + gain * seconds / 3.0)
    room += fastest / 2.0 * (fastest / figures.acceleration + figures.acceleration / figures.jerk)
    if since.falls:
        room = pace * sqrt(2.0 * up / GRAVITY)
    return hypot(pilot.body.position[0] - north, pilot.body.position[1] - east) <= room + MARGIN


def _then(vehicle: SimulatedVehicle, since: Struck) -> tuple[tuple[float, float, float], float, float]:
    """Return where a vehicle was when it answered, its speed over the ground then, and how that grew."""
    track, at = vehicle.autopilot.track, since.time + (answered(vehicle, since) or 0.0)
    index = min(bisect_left(track, (at,)), len(track) - 1)
    if since.falls or index < 1:
        index = max(1, bisect_left(track, (since.time,)) - 1)
    first, before, (now, north, east, up) = track[max(0, index - 2)], track[index - 1], track[index]
    paces = [_pace(*pair) for pair in ((first, before), (before, track[index]))]
    return (north, east, up), paces[1], max(0.0, paces[1] - paces[0]) / max(1e-3, now - before[0])


def _pace(before: tuple[float, ...], after: tuple[float, ...]) -> float:
    return hypot(after[1] - before[1], after[2] - before[2]) / max(1e-3, after[0] - before[0])


WORDS = {
    "home": "landed at home",
    "meadow": "landed in the emergency area",
    "here": "landed where it was",
    "holds": "holds in the air",
    "elsewhere": "landed elsewhere",
    "": "still moves",
}


def story(vehicle: SimulatedVehicle, since: Struck) -> str:
    """Return what a vehicle did from then on, in words."""
    pilot = vehicle.autopilot
    modes = [
        f"{NAMES.get(mode, mode)} {max(0.0, time - since.time):.1f} s"
        for time, mode in pilot.modes[since.modes :]
    ]
    north, east, up = pilot.body.position
    found = ending(vehicle, since)
    where = "" if found == "home" else f" ({_short(north)} N, {_short(east)} E, {_short(up)} up)"
    return "; ".join([*modes[:6], f"{WORDS[found]}{where}"])


def _short(metres: float) -> str:
    return f"{metres:.1f}".replace("-0.0", "0.0") + " m"


def strayed(vehicle: SimulatedVehicle, since: Struck) -> float:
    """Return the metres, sideways, to which a vehicle has gone from where it was."""
    track = [place for time, *place in vehicle.autopilot.track if time > since.time]
    return max((hypot(n - since.place[0], e - since.place[1]) for n, e, _ in track), default=0.0)


def talked(vehicle: SimulatedVehicle, since: float) -> list[str]:
    """Return the names of what the vehicle was sent after a second of its own, heartbeats left out."""
    return [name for time, name in vehicle.received if time > since]
