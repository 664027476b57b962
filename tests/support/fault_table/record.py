"""What a vehicle did, by its own record: how it ended, how fast it answered, in words."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import hypot

from shapely import Point, Polygon

from fault_table.project import MEADOW, OUT, TOUR
from mmrs_core.sitl import SimulatedVehicle
from mmrs_core.sitl.autopilot import Autopilot

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
STOPPING_METRES = 20.0

Moment = Callable[[Autopilot], bool]


def _near(place: tuple[float, float, float]) -> Moment:
    return lambda pilot: pilot.armed and pilot.body.distance_to(place) < 1.0 and pilot.body.pace < STILL


MOMENTS: Mapping[str, Moment] = {
    "before the start": lambda pilot: not pilot.armed and pilot.uptime > 0.0,
    "climbing": lambda pilot: pilot.armed and 3.0 < pilot.body.position[2] < 8.0,
    "on a leg (GUIDED)": lambda pilot: (
        pilot.armed and pilot.mode == 4 and 8.0 < pilot.body.position[0] < 22.0
    ),
    "at its place": _near(OUT),
    "landing at home": lambda pilot: (
        pilot.mode == 9 and 3.0 < pilot.body.position[2] < 9.0 and hypot(*pilot.body.position[:2]) < NEAR_HOME
    ),
    "waiting": _near(OUT),
    "on a mission (AUTO)": lambda pilot: pilot.mode == 3 and pilot.body.distance_to(TOUR[1]) < 6.0,
    "charging": lambda pilot: (
        not pilot.armed
        and any(number == 22 for _, number, _ in pilot.history)
        and pilot.body.position[2] < 0.1
    ),
}


@dataclass(frozen=True, slots=True)
class Struck:
    """When and where a vehicle was when something went wrong: seconds, metres from home.

    Attributes:
        modes, commands: how many changes of mode and commands it had had by then.
    """

    time: float
    place: tuple[float, float, float]
    modes: int
    commands: int


def struck(vehicle: SimulatedVehicle) -> Struck:
    """Return where a vehicle is now."""
    pilot = vehicle.autopilot
    return Struck(pilot.time, pilot.body.position, len(pilot.modes), len(pilot.history))


def answered(vehicle: SimulatedVehicle, since: Struck) -> float | None:
    """Return the seconds until the vehicle first did something else: a new mode, a command, a set-point."""
    pilot = vehicle.autopilot
    times = [time for time, _ in pilot.modes[since.modes :]]
    times += [time for time, *_ in pilot.history[since.commands :]]
    return max(0.0, min(times) - since.time) if times else None


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
    aside = hypot(north - since.place[0], east - since.place[1])
    return "here" if aside < STOPPING_METRES else "elsewhere"


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
        f"{NAMES.get(mode, mode)} after {max(0.0, time - since.time):.1f} s"
        for time, mode in pilot.modes[since.modes :]
    ]
    north, east, up = pilot.body.position
    end = WORDS[ending(vehicle, since)]
    return "; ".join([*modes[:6], f"{end} ({north:.1f} m north, {east:.1f} m east, {up:.1f} m up)"])


def strayed(vehicle: SimulatedVehicle, since: Struck) -> float:
    """Return the metres, sideways, to which a vehicle has gone from where it was."""
    track = [place for time, *place in vehicle.autopilot.track if time > since.time]
    return max((hypot(n - since.place[0], e - since.place[1]) for n, e, _ in track), default=0.0)


def talked(vehicle: SimulatedVehicle, since: float) -> list[str]:
    """Return the names of what the vehicle was sent after a second of its own, heartbeats left out."""
    return [name for time, name in vehicle.received if time > since]
