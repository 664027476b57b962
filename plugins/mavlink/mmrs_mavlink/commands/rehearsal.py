"""A rehearsal: simulated vehicles, and their faults by the schedule of ``--fault`` and by typed lines."""

from __future__ import annotations

import re
import signal
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import nullcontext
from dataclasses import dataclass
from itertools import pairwise
from math import dist, hypot, inf

import typer

from mmrs_core.cli.interruption import INTERRUPTED
from mmrs_core.cli.output import say, tell
from mmrs_core.cli.typed import ALL_ROBOTS, obeyed, typed_lines
from mmrs_core.errors import InternalError
from mmrs_mavlink.commands.fleet import Members
from mmrs_mavlink.sitl.autopilot import SimulatedAutopilot
from mmrs_mavlink.sitl.faults import Faults, fault_named
from mmrs_mavlink.sitl.vehicle import Host, SimulatedVehicle

POLL_SECONDS = 0.1

_PATTERN = re.compile(
    r"(?:(?P<robot>.{1,100}?):)?(?P<name>[a-z-]+)(?:=(?P<values>[^@]+))?"
    r"(?:@(?P<begin>[0-9]+(?:\.[0-9]*)?)(?:\+(?P<lasts>[0-9]+(?:\.[0-9]*)?))?)?"
)


@dataclass(frozen=True, slots=True)
class ScheduledFault:
    """A fault on the schedule.

    Attributes:
        robot: empty: every robot.
        name: in `FAULTS`. values: of it.
        begin: seconds of the vehicle's time after it was first armed; -inf: at once.
        lasts: seconds; inf: until it is cleared.
    """

    robot: str
    name: str
    values: tuple[str, ...]
    begin: float = -inf
    lasts: float = inf


def scheduled(text: str) -> ScheduledFault:
    """Return a fault from a text such as ``Drone1:gps-lost@60+20`` or ``battery=0.2@30``.

    >>> scheduled("Drone1:obstacle=3@60+20")
    ScheduledFault(robot='Drone1', name='obstacle', values=('3',), begin=60.0, lasts=20.0)

    Raises:
        ValueError: the text is malformed, or there is no such fault.
    """
    found = _PATTERN.fullmatch(text.strip())
    if found is None:
        raise ValueError(f"{text[:40]}: not [ROBOT:]FAULT[=VALUE,…][@SECONDS[+SECONDS]]")
    if fault_named(found["name"]).clear is None and found["lasts"]:
        raise ValueError(f"{text}: {found['name']} is one-shot and cannot last")
    values = tuple(found["values"].split(",")) if found["values"] else ()
    robot = "" if found["robot"] in (None, ALL_ROBOTS) else found["robot"]
    return ScheduledFault(
        robot, found["name"], values, float(found["begin"] or -inf), float(found["lasts"] or inf)
    )


def checked(text: str, members: Members) -> ScheduledFault:
    """Return a fault from a text, after a trial that its robots can have it.

    Raises:
        typer.BadParameter: the text is malformed, or a robot cannot have the fault.
    """
    try:
        fault = scheduled(text)
        if fault.robot and fault.robot not in members:
            raise ValueError(f"{text}: unknown robot '{fault.robot}'; known are {', '.join(members)}")
        for name, settings in members.items():
            if fault.robot in ("", name):
                Faults(SimulatedAutopilot(settings), nullcontext()).begin(fault.name, *fault.values)
    except ValueError as error:
        raise typer.BadParameter(f"--fault {error}") from error
    return fault


def obey(vehicle: SimulatedVehicle, words: tuple[str, ...]) -> None:
    """Execute ``FAULT [VALUE…]`` or ``clear FAULT``.

    Raises:
        ValueError: there is no such fault, or it does not take these values.
    """
    if words[0] == "clear" and len(words) > 1:
        vehicle.faults.end(words[1])
    else:
        vehicle.faults.begin(*words)


class Schedule:
    """Injects and clears the faults of one vehicle on time."""

    def __init__(self, vehicle: SimulatedVehicle, faults: Iterable[ScheduledFault]) -> None:
        self._vehicle, self._due = vehicle, list[tuple[float, str, tuple[str, ...] | None]]()
        for each in faults:
            self._due.append((each.begin, each.name, each.values))
            self._due.append((each.begin + each.lasts, each.name, None))

    def advance(self) -> tuple[str, ...]:
        """Inject and clear what is due; return what has happened, in words."""
        pilot, happened = self._vehicle.autopilot, list[str]()
        since_arming = pilot.time - pilot.track[0][0] if pilot.track else -inf
        for due in [each for each in self._due if since_arming >= each[0]]:
            self._due.remove(due)
            _, name, values = due
            if values is None:
                self._vehicle.faults.end(name)
                happened.append(f"{name} ends")
            else:
                self._vehicle.faults.begin(name, *values)
                happened.append(f"{' '.join((name, *values))} begins")
        return tuple(happened)


def rehearse(
    vehicles: Mapping[str, SimulatedVehicle],
    faults: Sequence[ScheduledFault],
    seconds: float,
    started: Callable[[], None],
) -> int:
    """Run vehicles with their faults, and with those that are typed; return the exit code.

    Args:
        vehicles: by robot.
        faults: their schedule.
        seconds: real seconds to run; 0: until interrupted.
        started: called once the vehicles run.
    """
    host, lines = Host(list(vehicles.values())), typed_lines()
    schedules = {
        name: Schedule(vehicle, [fault for fault in faults if fault.robot in ("", name)])
        for name, vehicle in vehicles.items()
    }
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.default_int_handler)
    host.start()
    try:
        started()
        until = time.monotonic() + (seconds or inf)
        while time.monotonic() < until:
            if host.failure is not None:
                raise InternalError("the simulated vehicles fail") from host.failure
            if obeyed(lines, list(vehicles), lambda robot, words: obey(vehicles[robot], words)):
                break
            for name, schedule in schedules.items():
                for event in schedule.advance():
                    tell(f"'{name}': {event}")
            time.sleep(POLL_SECONDS)
    except KeyboardInterrupt:
        return INTERRUPTED
    finally:
        host.stop()
        for vehicle in vehicles.values():
            vehicle.close()
    return 0


def print_summaries(summaries: Mapping[str, Mapping[str, object]]) -> None:
    """Print what vehicles have done, by robot."""
    for name, done in summaries.items():
        say(
            f"'{name}': {done['flown']:.1f} s in motion, {done['metres']:.1f} m,"
            f" {done['photos']} photos, {done['battery']:.0%} battery remaining,"
            f" {'still armed' if done['armed'] else 'disarmed'} {done['from_home']:.1f} m from home"
        )


def summary_of(vehicle: SimulatedVehicle) -> Mapping[str, object]:
    """Return what a vehicle has done: metres, seconds, fractions."""
    pilot = vehicle.autopilot
    steps = [(a, b) for a, b in pairwise(pilot.track) if b[0] - a[0] < 1.0]
    return {
        "flown": round(sum(b[0] - a[0] for a, b in steps), 1),
        "metres": round(sum(dist(a[1:], b[1:]) for a, b in steps), 1),
        "photos": len(pilot.photos),
        "battery": round(pilot.battery.level, 3),
        "armed": pilot.armed,
        "from_home": round(hypot(*pilot.body.position[:2]), 1),
        "sent": vehicle.radio.sent,
    }
