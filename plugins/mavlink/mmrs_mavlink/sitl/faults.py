"""Faults that can be injected into a simulated vehicle."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager
from dataclasses import dataclass
from inspect import signature
from math import cos, isfinite, nan, radians, sin

from mmrs_mavlink.sitl.autopilot import SimulatedAutopilot
from mmrs_mavlink.sitl.body import wind_of


class Faults:
    """The faults of one vehicle; methods may be called from any thread, and have taken effect on return.

    Attributes:
        link_down: whether the link to the controller is cut. ground_down: that to the ground station.
        send_down: whether nothing that it sends arrives.
        answer_delay: delay of every answer to an upload, seconds.
        watched: whether it has a radio to a ground station.
    """

    def __init__(
        self, pilot: SimulatedAutopilot, lock: AbstractContextManager[object], *, watched: bool = False
    ) -> None:
        """Create without a fault; `lock` is held while the time of the autopilot advances."""
        self.link_down = self.ground_down = self.send_down = False
        self.answer_delay = 0.0
        self.watched = watched
        self.pilot = pilot
        self._lock = lock

    def begin(self, name: str, *values: str | float) -> None:
        """Inject a fault by its name in `FAULTS`.

        Raises:
            ValueError: there is no such fault, or it does not take these values.
        """
        begin = _fault(name).begin
        try:
            arguments = _converted(begin, [str(value) for value in values])
            with self._lock:
                begin(self, *arguments)
        except ValueError as error:
            raise ValueError(f"{' '.join((name, *map(str, values)))}: {error}") from error

    def end(self, name: str) -> None:
        """Clear a fault; a one-shot fault is left as it is.

        Raises:
            ValueError: there is no such fault.
        """
        fault = _fault(name)
        if fault.cleared_by is not None:
            with self._lock:
                fault.begin(self, **fault.cleared_by)


@dataclass(frozen=True, slots=True)
class Fault:
    """A fault.

    Attributes:
        begin: injects it; its positional parameters after the first are the values of the fault.
        cleared_by: arguments with which `begin` clears it; None: it is one-shot.
    """

    begin: Callable[..., None]
    cleared_by: Mapping[str, object] | None = None


def _lose_position(faults: Faults, *, lost: bool = True) -> None:
    faults.pilot.located = not lost


def _shift_position(faults: Faults, metres: float = 40.0, bearing: float = 0.0) -> None:
    angle = radians(bearing)
    faults.pilot.body.shift_estimate(metres * cos(angle), metres * sin(angle))


def _restart(faults: Faults, armed: str = "") -> None:
    if armed not in ("", "armed"):
        raise ValueError(f"'{armed}' is not armed")
    faults.pilot.restart(armed == "armed")


def _change_mode(faults: Faults, mode: str = "loiter") -> None:
    numbers = faults.pilot.numbers
    if mode not in numbers:
        raise ValueError(f"{mode}: unknown mode; this vehicle has {', '.join(numbers)}")
    faults.pilot.set_mode(numbers[mode])


def _meet_obstacle(faults: Faults, metres: float = 3.0, bearing: float = 0.0, *, gone: bool = False) -> None:
    faults.pilot.obstacle = None if gone else (_not_negative(metres), bearing)


def _breach_fence(faults: Faults, *, outside: bool = True) -> None:
    faults.pilot.forced_breach = outside


def _change_battery(faults: Faults, level: float) -> None:
    if not 0.0 <= level <= 1.0:
        raise ValueError(f"{level:g} is not from 0 to 1")
    faults.pilot.battery.change(level)


def _ignore_commands(faults: Faults, *commands: int) -> None:
    faults.pilot.silent = frozenset(commands)


def _cut_link(faults: Faults, *, down: bool = True) -> None:
    faults.link_down = down


def _stop_sending(faults: Faults, *, down: bool = True) -> None:
    faults.send_down = down


def _cut_ground(faults: Faults, *, down: bool = True) -> None:
    if not faults.watched:
        raise ValueError("the vehicle has no radio to a ground station")
    faults.ground_down = down


def _jump_clock(faults: Faults, seconds: float = 3600.0) -> None:
    faults.pilot.clock_error += seconds


def _refuse_arming(faults: Faults, *words: str, passes: bool = False) -> None:
    faults.pilot.arming_fault = "" if passes else " ".join(words) or "Compass not calibrated"


def _slow_uploads(faults: Faults, seconds: float = 3.0) -> None:
    faults.answer_delay = _not_negative(seconds)


def _break_camera(faults: Faults, *, works: bool = False) -> None:
    faults.pilot.camera.works = works


def _change_wind(faults: Faults, speed: float, bearing: float = 0.0) -> None:
    faults.pilot.body.wind = wind_of(_not_negative(speed), bearing)


FAULTS: Mapping[str, Fault] = {
    "gps-lost": Fault(_lose_position, {"lost": False}),
    "position-shift": Fault(_shift_position, {"metres": 0.0}),
    "restart": Fault(_restart),
    "stick": Fault(_change_mode),
    "obstacle": Fault(_meet_obstacle, {"gone": True}),
    "breach": Fault(_breach_fence, {"outside": False}),
    "battery": Fault(_change_battery),
    "silent": Fault(_ignore_commands, {}),
    "link-down": Fault(_cut_link, {"down": False}),
    "dumb": Fault(_stop_sending, {"down": False}),
    "ground-down": Fault(_cut_ground, {"down": False}),
    "clock-jump": Fault(_jump_clock),
    "refuse-arming": Fault(_refuse_arming, {"passes": True}),
    "slow-upload": Fault(_slow_uploads, {"seconds": 0.0}),
    "camera-dead": Fault(_break_camera, {"works": True}),
    "wind": Fault(_change_wind, {"speed": 0.0}),
}
"""All faults, by name."""


def _fault(name: str) -> Fault:
    if name not in FAULTS:
        raise ValueError(f"{name}: unknown fault; known are {', '.join(FAULTS)}")
    return FAULTS[name]


def _converted(begin: Callable[..., None], values: list[str]) -> list[object]:
    """Return the values of a fault in the types of its parameters.

    Raises:
        ValueError: there are too few or too many, or one is not of its type.
    """
    wanted = signature(begin)
    try:
        bound = wanted.bind(None, *values).arguments
    except TypeError:
        named = [each for each in wanted.parameters.values() if each.kind is not each.KEYWORD_ONLY][1:]
        usage = [each.name + ("" if each.default is each.empty else " (optional)") for each in named]
        raise ValueError(f"takes {' and '.join(usage) or 'no value'}") from None
    found: list[object] = []
    for name, given in list(bound.items())[1:]:
        convert = _CONVERSIONS[wanted.parameters[name].annotation]
        found += map(convert, [given] if isinstance(given, str) else given)
    return found


def _number(text: str) -> float:
    try:
        number = float(text)
    except ValueError:
        number = nan
    if not isfinite(number):
        raise ValueError(f"'{text}' is not a finite number")
    return number


def _command(text: str) -> int:
    if not text.isdecimal() or len(text) > 9:
        raise ValueError(f"'{text}' is not the number of a command")
    return int(text)


def _not_negative(number: float) -> float:
    if number < 0.0:
        raise ValueError(f"{number:g} is negative")
    return number


_CONVERSIONS: Mapping[str, Callable[[str], object]] = {"str": str, "float": _number, "int": _command}
"""Conversions of values, by annotation of the parameter."""
