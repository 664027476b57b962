"""Faults that can be injected into a simulated vehicle."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager
from dataclasses import dataclass
from math import cos, isfinite, radians, sin

from mmrs_mavlink.sitl.autopilot import SimulatedAutopilot


class Faults:
    """The faults of one vehicle; methods may be called from any thread, and have taken effect on return.

    Attributes:
        link_down: whether the link to the controller is cut. ground_down: that to the ground station.
        send_down: whether nothing that it sends arrives.
        watched: whether it has a radio to a ground station.
    """

    def __init__(
        self, pilot: SimulatedAutopilot, lock: AbstractContextManager[object], *, watched: bool = False
    ) -> None:
        """Create without a fault; `lock` is held while the time of the autopilot advances."""
        self.link_down = self.ground_down = self.send_down = False
        self.watched = watched
        self.pilot = pilot
        self._lock = lock

    def begin(self, name: str, *values: str | float) -> None:
        """Inject a fault by its name in `FAULTS`.

        Raises:
            ValueError: there is no such fault, or it does not take these values.
        """
        fault = _fault(name)
        try:
            arguments = _converted(fault.values, [str(value) for value in values])
            with self._lock:
                fault.set(self, *arguments)
        except ValueError as error:
            raise ValueError(f"{' '.join((name, *map(str, values)))}: {error}") from error

    def end(self, name: str) -> None:
        """Clear a fault; a one-shot fault is left as it is.

        Raises:
            ValueError: there is no such fault.
        """
        fault = _fault(name)
        if fault.clear is not None:
            with self._lock:
                fault.clear(self)


@dataclass(frozen=True, slots=True)
class Fault:
    """A fault.

    Attributes:
        set: injects it with its values. clear: clears it; None: it is one-shot.
        values: defaults of its values; `REQUIRED`: there is none; ``...``: any number of texts.
    """

    set: Callable[..., None]
    clear: Callable[[Faults], None] | None = None
    values: tuple[object, ...] = ()


REQUIRED = float("nan")


def _shift(faults: Faults, metres: float, bearing: float) -> None:
    angle = radians(bearing)
    faults.pilot.body.shift_estimate(metres * cos(angle), metres * sin(angle))


def _restart(faults: Faults, armed: str) -> None:
    if armed not in ("", "armed"):
        raise ValueError(f"'{armed}' is not armed")
    faults.pilot.restart(armed == "armed")


def _change_mode(faults: Faults, mode: str) -> None:
    numbers = faults.pilot.numbers
    if mode not in numbers:
        raise ValueError(f"{mode}: unknown mode; this vehicle has {', '.join(numbers)}")
    faults.pilot.set_mode(numbers[mode])


def _change_battery(faults: Faults, level: float) -> None:
    if not 0.0 <= level <= 1.0:
        raise ValueError(f"{level:g} is not from 0 to 1")
    faults.pilot.battery.level = level


def _jump_clock(faults: Faults, seconds: float) -> None:
    faults.pilot.clock_error += seconds


def _ignore_commands(faults: Faults, *commands: str) -> None:
    if wrong := [each for each in commands if not (each.isdecimal() and len(each) < 10)]:
        raise ValueError(f"'{wrong[0]}' is not the number of a command")
    faults.pilot.silent = frozenset(map(int, commands))


def _fail_motor(faults: Faults) -> None:
    if not faults.pilot.flies:
        raise ValueError("the vehicle needs no motor to stay where it is")
    faults.pilot.motor_failed = True


def _cut_ground(faults: Faults) -> None:
    if not faults.watched:
        raise ValueError("the vehicle has no radio to a ground station")
    faults.ground_down = True


def _setter(name: str, value: object, *, pilots: bool = False) -> Callable[[Faults], None]:
    """Return a function that sets an attribute of the faults, or of the autopilot."""
    return lambda faults: setattr(faults.pilot if pilots else faults, name, value)


FAULTS: Mapping[str, Fault] = {
    "gps-lost": Fault(_setter("located", False, pilots=True), _setter("located", True, pilots=True)),
    "position-shift": Fault(_shift, lambda faults: _shift(faults, 0.0, 0.0), (40.0, 0.0)),
    "restart": Fault(_restart, values=("",)),
    "stick": Fault(_change_mode, values=("loiter",)),
    "obstacle": Fault(
        lambda faults, *place: setattr(faults.pilot, "obstacle", place),
        _setter("obstacle", None, pilots=True),
        (3.0, 0.0),
    ),
    "breach": Fault(
        _setter("forced_breach", True, pilots=True), _setter("forced_breach", False, pilots=True)
    ),
    "battery": Fault(_change_battery, values=(REQUIRED,)),
    "silent": Fault(_ignore_commands, _ignore_commands, (...,)),
    "link-down": Fault(_setter("link_down", True), _setter("link_down", False)),
    "dumb": Fault(_setter("send_down", True), _setter("send_down", False)),
    "ground-down": Fault(_cut_ground, _setter("ground_down", False)),
    "clock-jump": Fault(_jump_clock, values=(3600.0,)),
    "refuse-arming": Fault(
        lambda faults, *words: setattr(
            faults.pilot, "arming_fault", " ".join(words) or "Compass not calibrated"
        ),
        _setter("arming_fault", "", pilots=True),
        (...,),
    ),
    "camera-dead": Fault(
        lambda faults: setattr(faults.pilot.camera, "works", False),
        lambda faults: setattr(faults.pilot.camera, "works", True),
    ),
    "motor-failed": Fault(_fail_motor, _setter("motor_failed", False, pilots=True)),
    "wind": Fault(
        lambda faults, *wind: setattr(faults.pilot, "wind", wind),
        _setter("wind", (0.0, 0.0), pilots=True),
        (REQUIRED, 0.0),
    ),
}
"""All faults, by name."""


def _fault(name: str) -> Fault:
    if name not in FAULTS:
        raise ValueError(f"{name}: unknown fault; known are {', '.join(FAULTS)}")
    return FAULTS[name]


def _converted(defaults: tuple[object, ...], values: list[str]) -> list[object]:
    """Return the values of a fault, in the types of its defaults.

    Raises:
        ValueError: there are too few or too many, or one is not a number.
    """
    if ... in defaults:
        return list(values)
    if len(values) > len(defaults) or (REQUIRED in defaults[len(values) :]):
        raise ValueError(f"takes {len(defaults)} value{'s' if len(defaults) != 1 else ''}")
    given = [
        text if isinstance(kind, str) else _number(text) for text, kind in zip(values, defaults, strict=False)
    ]
    return [*given, *defaults[len(values) :]]


def _number(text: str) -> float:
    try:
        number = float(text)
    except ValueError:
        number = REQUIRED
    if not isfinite(number):
        raise ValueError(f"'{text}' is not a finite number")
    return number
