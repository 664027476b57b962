"""Faults of a rehearsal: on the schedule that ``--fault`` gives, and by lines that are typed."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from contextlib import nullcontext
from dataclasses import dataclass
from math import inf

from mmrs_core.cli.typed import ALL_ROBOTS, addressed
from mmrs_mavlink.sitl.autopilot import SimulatedAutopilot
from mmrs_mavlink.sitl.faults import Faults, fault_named
from mmrs_mavlink.sitl.vehicle import SimulatedVehicle

Vehicles = Sequence[tuple[str, SimulatedVehicle]]

_PATTERN = re.compile(
    r"(?:(?P<robot>.{1,100}?):)?(?P<name>[a-z-]+)(?:=(?P<values>[^@]+))?"
    r"(?:@(?P<begin>[0-9.]+)(?:\+(?P<lasts>[0-9.]+))?)?"
)


@dataclass(frozen=True, slots=True)
class ScheduledFault:
    """A fault on the schedule.

    Attributes:
        robot: empty: every robot.
        name: in `FAULTS`. values: of it.
        begin: seconds of the vehicle's time after it was first armed.
        lasts: seconds; None: until it is cleared.
    """

    robot: str
    name: str
    values: tuple[str, ...]
    begin: float = 0.0
    lasts: float | None = None


def scheduled(text: str) -> ScheduledFault:
    """Return a fault from a text such as ``Drone1:gps-lost@60+20`` or ``battery=0.2@30``.

    >>> scheduled("Drone1:obstacle=3,90@60+20")
    ScheduledFault(robot='Drone1', name='obstacle', values=('3', '90'), begin=60.0, lasts=20.0)

    Raises:
        ValueError: the text is malformed, or there is no such fault.
    """
    found = _PATTERN.fullmatch(text.strip())
    if found is None:
        raise ValueError(f"{text[:40]}: not [ROBOT:]FAULT[=VALUE,…][@SECONDS[+SECONDS]]")
    if found["lasts"] and fault_named(found["name"]).clear is None:
        raise ValueError(f"{text}: {found['name']} is one-shot and cannot last")
    fault_named(found["name"])
    values = tuple(found["values"].split(",")) if found["values"] else ()
    robot = "" if found["robot"] in (None, ALL_ROBOTS) else found["robot"]
    lasts = float(found["lasts"]) if found["lasts"] else None
    return ScheduledFault(robot, found["name"], values, float(found["begin"] or 0.0), lasts)


def checked(text: str, vehicles: Vehicles) -> ScheduledFault:
    """Return a fault from a text, after a trial that its robots can have it.

    Raises:
        ValueError: the text is malformed, or a robot cannot have the fault.
    """
    fault, names = scheduled(text), [name for name, _ in vehicles]
    if fault.robot and fault.robot not in names:
        raise ValueError(f"{text}: unknown robot '{fault.robot}'; known are {', '.join(names)}")
    for name, vehicle in vehicles:
        if fault.robot in ("", name):
            pilot = SimulatedAutopilot(vehicle.autopilot.settings)
            Faults(pilot, nullcontext(), watched=vehicle.faults.watched).begin(fault.name, *fault.values)
    return fault


def inject(line: str, vehicles: Vehicles) -> tuple[str, ...]:
    """Execute ``ROBOT FAULT [VALUE…]`` or ``ROBOT clear FAULT``, with ``all`` for every robot.

    Returns:
        The names of the robots.

    Raises:
        ValueError: the line is malformed, or there is no such robot or fault.
    """
    wanted, what, values = addressed(line, [name for name, _ in vehicles])
    for _, vehicle in [each for each in vehicles if each[0] in wanted]:
        if what == "clear" and len(values) == 1:
            vehicle.faults.end(values[0])
        else:
            vehicle.faults.begin(what, *values)
    return wanted


class Schedule:
    """Injects and clears the faults of one vehicle on time."""

    def __init__(self, vehicle: SimulatedVehicle, faults: Iterable[ScheduledFault]) -> None:
        self._vehicle, self._zero = vehicle, inf
        self._due: list[tuple[float, str, tuple[str, ...] | None]] = []
        for each in faults:
            self._due.append((each.begin, each.name, each.values))
            if each.lasts is not None:
                self._due.append((each.begin + each.lasts, each.name, None))

    def advance(self) -> tuple[str, ...]:
        """Inject and clear what is due; return what has happened, in words."""
        pilot, happened = self._vehicle.autopilot, list[str]()
        if self._zero == inf and pilot.armed:
            self._zero = pilot.time
        for due in [each for each in self._due if pilot.time - self._zero >= each[0]]:
            self._due.remove(due)
            _, name, values = due
            if values is None:
                self._vehicle.faults.end(name)
            else:
                self._vehicle.faults.begin(name, *values)
            happened.append(f"{' '.join((name, *(values or ())))} {'ends' if values is None else 'begins'}")
        return tuple(happened)
