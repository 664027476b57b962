"""What befalls a simulated vehicle, in words that people type."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import isfinite
from queue import SimpleQueue
from typing import TypeAlias

from auv_vessel.body.sensing import SENSORS
from auv_vessel.body.vehicle import Vehicle
from auv_vessel.sheet import Sheet
from auv_vessel.wire.frame import Frame

FAULTS = "thruster-dead THRUSTER, frozen MESSAGE, silent MESSAGE, noisy MESSAGE FACTOR, leak, battery CHARGE"

Act: TypeAlias = Callable[[Vehicle], None]


class NoSuchFaultError(ValueError):
    """Words that name no fault of a vehicle."""


def befalling(sheet: Sheet, words: Sequence[str]) -> Act:
    """Return what some words do to a vehicle: one of `FAULTS`, or ``clear`` and a fault without its figure.

    A thruster is named by its identifier or its number on the bus.

    Raises:
        ValueError: they say nothing of that kind.
    """
    match words:
        case ["thruster-dead", _, *_]:
            number = _thruster(sheet, " ".join(words[1:]))
            return lambda vehicle: vehicle.faults.dead.add(number)
        case ["clear", "thruster-dead", _, *_]:
            number = _thruster(sheet, " ".join(words[2:]))
            return lambda vehicle: vehicle.faults.dead.discard(number)
        case ["frozen" | "silent" as what, name]:
            message = _message(name)
            return lambda vehicle: _instruments(vehicle, what).add(message)
        case ["clear", "frozen" | "silent" as what, name]:
            message = _message(name)
            return lambda vehicle: _instruments(vehicle, what).discard(message)
        case ["noisy", name, times]:
            message, amount = _message(name), _number(times, 1e6)
            return lambda vehicle: vehicle.faults.noisy.update({message: amount})
        case ["clear", "noisy", name]:
            message = _message(name)
            return lambda vehicle: _quieten(vehicle, message)
        case ["leak"] | ["clear", "leak"]:
            leak = len(words) == 1
            return lambda vehicle: _leak(vehicle, leak)
        case ["battery", part]:
            left = _number(part, 1.0)
            return lambda vehicle: _charge(vehicle, left * sheet.battery)
    said = " ".join(words)
    raise NoSuchFaultError(f"{said}: no such fault; known are {FAULTS}, and clear FAULT for all but the last")


class Befallen:
    """A simulated vehicle to which happens what is typed, at its next tick."""

    name = Vehicle.name
    period = Vehicle.period

    def __init__(
        self, sheet: Sheet, vehicle: Vehicle, lines: SimpleQueue[str], say: Callable[[str], None]
    ) -> None:
        """Host a vehicle; `say` receives errors of lines, and the answer to ``status``."""
        self._sheet, self._vehicle, self._lines, self._say = sheet, vehicle, lines, say

    def hear(self, frame: Frame, now: float) -> None:
        """Pass a frame to the vehicle."""
        self._vehicle.hear(frame, now)

    def tick(self, now: float) -> Sequence[Frame]:
        """Inject the faults that were typed, and advance the vehicle."""
        while not self._lines.empty():
            line = self._lines.get()
            try:
                self._obey(line.split())
            except ValueError as error:
                self._say(str(error))
        return self._vehicle.tick(now)

    def _obey(self, words: Sequence[str]) -> None:
        if list(words) == ["status"]:
            self._say(status_of(self._sheet, self._vehicle))
        elif words:
            befalling(self._sheet, words)(self._vehicle)


def status_of(sheet: Sheet, vehicle: Vehicle) -> str:
    """Return where a vehicle is, what its drives put out, all together, and what is wrong with it."""
    truth, faults = vehicle.truth, vehicle.faults
    wrong = [
        *(f"thruster {sheet.thrusters[number].id} dead" for number in sorted(faults.dead)),
        *(f"{name} frozen" for name in sorted(faults.frozen)),
        *(f"{name} silent" for name in sorted(faults.silent)),
        *(f"{name} noisy" for name in sorted(faults.noisy)),
        *(["leak"] if faults.leak else []),
        *(["drop weight gone"] if vehicle.released and sheet.drop_weight else []),
    ]
    place = f"{truth.north:.1f} m north, {truth.east:.1f} m east, {truth.depth:.1f} m down"
    charge = f"battery {vehicle.charge / sheet.battery:.0%}"
    thrust = f"thrust {sum(abs(drive.thrust) for drive in vehicle.drives):.1f} N"
    faulty = "".join(f"; {each}" for each in wrong)
    return f"{sheet.robot}: {truth.time:.1f} s, {place}, {thrust}, {charge}{faulty}"


def _thruster(sheet: Sheet, name: str) -> int:
    ids = [each.id for each in sheet.thrusters]
    name = name.strip("'\"")
    if name in ids:
        return ids.index(name)
    if name.isascii() and name.isdecimal() and len(name) < 10 and int(name) < len(ids):
        return int(name)
    raise ValueError(f"{name}: no such thruster; there are {', '.join(ids)}, by number 0 to {len(ids) - 1}")


def _message(name: str) -> str:
    if name not in SENSORS:
        raise ValueError(f"{name}: no instrument's message; there are {', '.join(SENSORS)}")
    return name


def _number(text: str, most: float) -> float:
    try:
        number = float(text)
    except ValueError:
        number = -1.0
    if not (isfinite(number) and 0.0 <= number <= most):
        raise ValueError(f"{text} is not a number from 0 to {most:g}")
    return number


def _instruments(vehicle: Vehicle, what: str) -> set[str]:
    return vehicle.faults.frozen if what == "frozen" else vehicle.faults.silent


def _quieten(vehicle: Vehicle, message: str) -> None:
    vehicle.faults.noisy.pop(message, None)


def _leak(vehicle: Vehicle, leak: bool) -> None:
    vehicle.faults.leak = leak


def _charge(vehicle: Vehicle, joules: float) -> None:
    vehicle.charge = joules
