"""Faults that can be injected into a simulated vehicle."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager
from dataclasses import dataclass
from math import cos, isfinite, radians, sin

from mmrs_mavlink.sitl.autopilot import SimulatedAutopilot

CONTROLLER, STATION = 0, 1
"""Numbers of the links of a vehicle."""


class Faults:
    """The faults of one vehicle; methods may be called from any thread, and have taken effect on return.

    Attributes:
        cut: links that are cut: `CONTROLLER` or `STATION`.
        watched: whether it has a link to a ground station.
    """

    def __init__(
        self, pilot: SimulatedAutopilot, lock: AbstractContextManager[object], *, watched: bool = False
    ) -> None:
        """Create without a fault; `lock` is held while the time of the autopilot advances."""
        self.cut: set[int] = set()
        self.watched = watched
        self.pilot = pilot
        self._lock = lock

    def begin(self, name: str, *values: str | float) -> None:
        """Inject a fault by its name in `FAULTS`.

        Raises:
            ValueError: there is no such fault, or it does not take these values.
        """
        fault = fault_named(name)
        missing = fault.values[len(values) :]
        try:
            if len(values) > len(fault.values) or None in missing:
                raise ValueError(f"takes {len(fault.values)} value{'s' * (len(fault.values) != 1)}")
            with self._lock:
                fault.set(self, *values, *missing)
        except ValueError as error:
            raise ValueError(f"{' '.join((name, *map(str, values)))}: {error}") from error

    def end(self, name: str) -> None:
        """Clear a fault; a one-shot fault is left as it is.

        Raises:
            ValueError: there is no such fault.
        """
        fault = fault_named(name)
        if fault.clear is not None:
            with self._lock:
                fault.clear(self)


@dataclass(frozen=True, slots=True)
class Fault:
    """A fault.

    Attributes:
        set: injects it with its values. clear: clears it; None: it is one-shot.
        values: defaults of its values; None: there is none.
    """

    set: Callable[..., None]
    clear: Callable[[Faults], None] | None = None
    values: tuple[object, ...] = ()


def fault_named(name: str) -> Fault:
    """Return a fault by its name.

    Raises:
        ValueError: there is no such fault.
    """
    if name not in FAULTS:
        raise ValueError(f"{name}: unknown fault; known are {', '.join(FAULTS)}")
    return FAULTS[name]


def _number(value: str | float) -> float:
    try:
        number = float(value)
    except ValueError:
        number = float("nan")
    if not isfinite(number):
        raise ValueError(f"'{value}' is not a finite number")
    return number


def _shift(faults: Faults, metres: str | float, bearing: str | float) -> None:
    angle, error = radians(_number(bearing)), _number(metres)
    faults.pilot.body.shift_estimate(error * cos(angle), error * sin(angle))


def _restart(faults: Faults, armed: str) -> None:
    if armed not in ("", "armed"):
        raise ValueError(f"'{armed}' is not armed")
    faults.pilot.restart(armed == "armed")


def _change_mode(faults: Faults, mode: str) -> None:
    numbers = faults.pilot.numbers
    if mode not in numbers:
        raise ValueError(f"{mode}: unknown mode; this vehicle has {', '.join(numbers)}")
    faults.pilot.set_mode(numbers[mode])


def _change_battery(faults: Faults, value: str | float) -> None:
    level = _number(value)
    if not 0.0 <= level <= 1.0:
        raise ValueError(f"{level:g} is not from 0 to 1")
    faults.pilot.battery.level = level


def _silence(faults: Faults, command: str | float) -> None:
    faults.pilot.silent = frozenset({int(_number(command))})


def _fail_motor(faults: Faults) -> None:
    if not faults.pilot.flies:
        raise ValueError("the vehicle needs no motor to stay where it is")
    faults.pilot.motor_failed = True


def _cut_ground(faults: Faults) -> None:
    if not faults.watched:
        raise ValueError("the vehicle has no link to a ground station")
    faults.cut.add(STATION)


def _placed(name: str) -> Callable[..., None]:
    """Return a function that sets an attribute of the autopilot to two numbers."""
    return lambda faults, *values: setattr(faults.pilot, name, tuple(map(_number, values)))


def _setter(name: str, value: object) -> Callable[[Faults], None]:
    """Return a function that sets an attribute of the autopilot."""
    return lambda faults: setattr(faults.pilot, name, value)


def _switch(name: str, value: bool = True) -> Fault:
    return Fault(_setter(name, value), _setter(name, not value))


FAULTS: Mapping[str, Fault] = {
    "gps-lost": _switch("located", False),
    "position-shift": Fault(_shift, lambda faults: _shift(faults, 0.0, 0.0), (40.0, 0.0)),
    "restart": Fault(_restart, values=("",)),
    "stick": Fault(_change_mode, values=("loiter",)),
    "obstacle": Fault(_placed("obstacle"), _setter("obstacle", None), (3.0, 0.0)),
    "breach": _switch("forced_breach"),
    "battery": Fault(_change_battery, values=(None,)),
    "silent": Fault(_silence, _setter("silent", frozenset()), (None,)),
    "link-down": Fault(
        lambda faults: faults.cut.add(CONTROLLER), lambda faults: faults.cut.discard(CONTROLLER)
    ),
    "ground-down": Fault(_cut_ground, lambda faults: faults.cut.discard(STATION)),
    "motor-failed": Fault(_fail_motor, _setter("motor_failed", False)),
    "wind": Fault(_placed("wind"), _setter("wind", (0.0, 0.0)), (None, 0.0)),
}
"""All faults, by name."""
