"""Faults that were asked for beforehand, or by a line of text while vehicles are out."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from mmrs_core.cli.typed import EVERYBODY, addressed
from mmrs_mavlink.sitl.faults import ENDS, FAULTS
from mmrs_mavlink.sitl.vehicle import SimulatedVehicle

_PATTERN = re.compile(
    r"(?:(?P<robot>.+?):)?(?P<name>[a-z-]+)(?:=(?P<values>[^@]+))?"
    r"(?:@(?P<begin>[0-9.]+)(?:\+(?P<lasts>[0-9.]+))?)?"
)
_LONGEST = 1000
"""Characters of a fault; robots' names may hold its signs, so that a longer text would take long to read."""


@dataclass(frozen=True, slots=True)
class Planned:
    """A fault to come.

    Attributes:
        robot: whom it befalls; empty: everybody.
        name: one of `FAULTS`. values: what it takes.
        begin: seconds of the vehicle's time after it was first armed.
        lasts: seconds; None: until somebody mends it.
    """

    robot: str
    name: str
    values: tuple[str, ...]
    begin: float = 0.0
    lasts: float | None = None

    def __str__(self) -> str:
        """Return it as it is written."""
        values = f"={','.join(self.values)}" if self.values else ""
        lasts = "" if self.lasts is None else f"+{self.lasts:g}"
        return f"{self.robot or EVERYBODY}:{self.name}{values}@{self.begin:g}{lasts}"


def planned(text: str) -> Planned:
    """Return a fault as people write it, such as ``Drone1:gps-lost@60+20`` or ``battery=0.2@30``.

    >>> planned("Drone1:obstacle=3,90@60+20")
    Planned(robot='Drone1', name='obstacle', values=('3', '90'), begin=60.0, lasts=20.0)

    Raises:
        ValueError: it is not written so, or there is no such fault.
    """
    if len(text) > _LONGEST:
        raise ValueError(f"{text[:40]}…: is longer than {_LONGEST} characters")
    found = _PATTERN.fullmatch(text.strip())
    if found is None:
        raise ValueError(f"{text}: is not [ROBOT:]FAULT[=VALUE,…][@SECONDS[+SECONDS]]")
    if found["name"] not in FAULTS:
        raise ValueError(f"{text}: no such fault; there are {', '.join(FAULTS)}")
    if found["lasts"] and found["name"] not in ENDS:
        raise ValueError(f"{text}: {found['name']} happens once and cannot last")
    values = tuple(found["values"].split(",")) if found["values"] else ()
    robot = "" if found["robot"] in (None, EVERYBODY) else found["robot"]
    lasts = float(found["lasts"]) if found["lasts"] else None
    return Planned(robot, found["name"], values, float(found["begin"] or 0.0), lasts)


class Schedule:
    """Begins and ends the faults of one vehicle when they are due."""

    def __init__(self, vehicle: SimulatedVehicle, faults: Iterable[Planned]) -> None:
        """Wait for the vehicle to be armed."""
        self._vehicle = vehicle
        self._waiting = list(faults)
        self._ending: list[tuple[float, Planned]] = []
        self._zero: float | None = None

    def go_on(self) -> tuple[str, ...]:
        """Do what is due now; return what happened, in words.

        Raises:
            ValueError: a fault does not take its values.
        """
        pilot = self._vehicle.autopilot
        if self._zero is None and pilot.armed:
            self._zero = pilot.time
        if self._zero is None:
            return ()
        happened: list[str] = []
        for fault in [each for each in self._waiting if pilot.time >= self._start(each)]:
            self._waiting.remove(fault)
            self._vehicle.faults.begin(fault.name, *fault.values)
            happened.append(f"{' '.join((fault.name, *fault.values))} begins")
            if fault.lasts is not None:
                self._ending.append((pilot.time + fault.lasts, fault))
        for due, fault in [each for each in self._ending if pilot.time >= each[0]]:
            self._ending.remove((due, fault))
            self._vehicle.faults.end(fault.name)
            happened.append(f"{fault.name} ends")
        return tuple(happened)

    def _start(self, fault: Planned) -> float:
        return (self._zero or 0.0) + fault.begin


def order(text: str, vehicles: Sequence[tuple[str, SimulatedVehicle]]) -> tuple[str, ...]:
    """Do what a line says, at once: ``ROBOT FAULT [VALUE…]`` or ``ROBOT mend FAULT``; all: every robot.

    Returns:
        Names of the robots.

    Raises:
        ValueError: it does not say so, or there is no such robot or fault.
    """
    wanted, what, values = addressed(text, [name for name, _ in vehicles])
    for _, vehicle in [each for each in vehicles if each[0] in wanted]:
        if what == "mend" and len(values) == 1:
            vehicle.faults.end(values[0])
        else:
            vehicle.faults.begin(what, *values)
    return wanted
