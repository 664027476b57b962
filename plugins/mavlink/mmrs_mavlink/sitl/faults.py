"""Faults that can be injected into a simulated vehicle."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager
from dataclasses import dataclass
from math import cos, isfinite, radians, sin

from mmrs_mavlink.sitl.autopilot import SimulatedAutopilot
from mmrs_mavlink.sitl.radio import CONTROLLER, STATION


class Faults:
    """The faults of one vehicle; methods may be called from any thread, and have taken effect on return."""

    def __init__(self, pilot: SimulatedAutopilot, lock: AbstractContextManager[object]) -> None:
        """Create without a fault; `lock` is held while the time of the autopilot advances."""
        self._pilot, self._lock = pilot, lock

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
                fault.set(self._pilot, *map(fault.read, values), *missing)
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
                fault.clear(self._pilot)


def _number(value: str | float) -> float:
    try:
        number = float(value)
    except ValueError:
        number = float("nan")
    if not isfinite(number):
        raise ValueError(f"'{value}' is not a finite number")
    return number


@dataclass(frozen=True, slots=True)
class Fault:
    """A fault.

    Attributes:
        set: injects it with its values. clear: clears it; None: it is one-shot.
        values: defaults of its values; None: there is none. read: reads a given value.
    """

    set: Callable[..., None]
    clear: Callable[[SimulatedAutopilot], None] | None = None
    values: tuple[object, ...] = ()
    read: Callable[[str | float], object] = _number


def fault_named(name: str) -> Fault:
    """Return a fault by its name.

    Raises:
        ValueError: there is no such fault.
    """
    if name not in FAULTS:
        raise ValueError(f"{name}: unknown fault; known are {', '.join(FAULTS)}")
    return FAULTS[name]


def _shift(pilot: SimulatedAutopilot, metres: float, bearing: float) -> None:
    pilot.shift = (metres * cos(radians(bearing)), metres * sin(radians(bearing)))


def _change_mode(pilot: SimulatedAutopilot, mode: str) -> None:
    if mode not in pilot.numbers:
        raise ValueError(f"{mode}: unknown mode; this vehicle has {', '.join(pilot.numbers)}")
    pilot.set_mode(pilot.numbers[mode])


def _change_battery(pilot: SimulatedAutopilot, level: float) -> None:
    if not 0.0 <= level <= 1.0:
        raise ValueError(f"{level:g} is not from 0 to 1")
    pilot.battery.level = level


def _fail_motor(pilot: SimulatedAutopilot) -> None:
    if not pilot.flies:
        raise ValueError("the vehicle needs no motor to stay where it is")
    pilot.motor_failed = True


def _cut(pilot: SimulatedAutopilot, link: int) -> None:
    if link == STATION and pilot.settings.ground is None:
        raise ValueError("the vehicle has no link to a ground station")
    pilot.cut.add(link)


def _attribute(name: str) -> Callable[..., None]:
    """Return a function that sets an attribute to the value or the values of a fault."""
    return lambda pilot, *values: setattr(pilot, name, values if len(values) > 1 else values[0])


def _setting(name: str, value: object) -> Callable[[SimulatedAutopilot], None]:
    """Return a function that sets an attribute."""
    return lambda pilot: setattr(pilot, name, value)


FAULTS: Mapping[str, Fault] = {
    "gps-lost": Fault(_setting("located", False), _setting("located", True)),
    "position-shift": Fault(_shift, lambda pilot: _shift(pilot, 0.0, 0.0), (40.0, 0.0)),
    "restart": Fault(lambda pilot: pilot.restart()),
    "stick": Fault(_change_mode, values=("loiter",), read=str),
    "obstacle": Fault(_attribute("obstacle"), _setting("obstacle", None), (3.0,)),
    "breach": Fault(_setting("forced_breach", True), _setting("forced_breach", False)),
    "battery": Fault(_change_battery, values=(None,)),
    "silent": Fault(
        lambda pilot, command: pilot.silent.add(int(command)), lambda pilot: pilot.silent.clear(), (None,)
    ),
    "link-down": Fault(lambda pilot: _cut(pilot, CONTROLLER), lambda pilot: pilot.cut.discard(CONTROLLER)),
    "ground-down": Fault(lambda pilot: _cut(pilot, STATION), lambda pilot: pilot.cut.discard(STATION)),
    "motor-failed": Fault(_fail_motor, _setting("motor_failed", False)),
    "wind": Fault(_attribute("wind"), _setting("wind", (0.0, 0.0)), (None, 0.0)),
}
"""All faults, by name."""
