"""A rehearsal: simulated vehicles with their faults, until it ends."""

from __future__ import annotations

import queue
import signal
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import nullcontext
from types import FrameType

import typer

from mmrs_core.cli.interruption import INTERRUPTED
from mmrs_core.cli.output import say, tell
from mmrs_core.cli.typed import addressed, typed_lines
from mmrs_core.errors import InternalError
from mmrs_mavlink.commands.schedule import Schedule, ScheduledFault, scheduled
from mmrs_mavlink.sitl.autopilot import Autopilot
from mmrs_mavlink.sitl.faults import FAULTS, Faults
from mmrs_mavlink.sitl.hosting import Host
from mmrs_mavlink.sitl.summary import status_line, summary_line, summary_of
from mmrs_mavlink.sitl.vehicle import SimulatedVehicle

POLL_SECONDS = 0.1
STATUS_SECONDS = 10.0
QUIT = frozenset({"quit", "exit"})

Vehicles = Sequence[tuple[str, SimulatedVehicle]]


def fault_list() -> None:
    """Print the names of all faults."""
    for name, fault in FAULTS.items():
        say(f"{name}{'  (one-shot)' if fault.cleared_by is None else ''}")


class Rehearsal:
    """Simulated vehicles, their schedules of faults, and the lines that are typed."""

    def __init__(self, vehicles: Vehicles, faults: Sequence[str]) -> None:
        """Prepare these vehicles, and schedule these faults.

        Raises:
            typer.BadParameter: a fault is malformed, or no robot can have it.
        """
        self._vehicles = vehicles
        plan = [_scheduled(text, vehicles) for text in faults]
        self._schedules = {
            name: Schedule(vehicle, [fault for fault in plan if fault.robot in ("", name)])
            for name, vehicle in vehicles
        }
        self._modes = dict.fromkeys((name for name, _ in vehicles), "")
        self._stopped = False

    def run(self, seconds: float, started: Callable[[], None], *, quiet: bool = False) -> int:
        """Run the vehicles; return the exit code.

        Args:
            seconds: real seconds to run; 0: until interrupted.
            started: called once the vehicles run.
            quiet: whether to omit the summary.
        """
        host = Host([vehicle for _, vehicle in self._vehicles])
        lines = typed_lines()
        before = {number: signal.signal(number, self._stop) for number in (signal.SIGINT, signal.SIGTERM)}
        host.start()
        try:
            started()
            ended = self._watch(host, time.monotonic() + seconds if seconds else float("inf"), lines)
        finally:
            host.stop()
            for number, handler in before.items():
                signal.signal(number, handler)
            for _, vehicle in self._vehicles:
                vehicle.close()
        for name, vehicle in self._vehicles if not quiet else ():
            say(f"'{name}': {summary_line(vehicle)}")
        return 0 if ended else INTERRUPTED

    def summaries(self) -> dict[str, Mapping[str, object]]:
        """Return what each vehicle has done."""
        return {name: summary_of(vehicle) for name, vehicle in self._vehicles}

    def _stop(self, number: int, frame: FrameType | None) -> None:
        self._stopped = True

    def _watch(self, host: Host, until: float, lines: queue.SimpleQueue[str]) -> bool:
        """Return whether it ended on time or by a line; False: it was interrupted."""
        due = time.monotonic() + STATUS_SECONDS
        while not self._stopped:
            now = time.monotonic()
            if host.failure is not None:
                raise InternalError("the simulated vehicles fail") from host.failure
            if now >= until or self._execute(lines):
                return True
            for name, schedule in self._schedules.items():
                for event in schedule.advance():
                    tell(f"'{name}': {event}")
            if sys.stderr.isatty():
                self._print_modes()
                if now >= due:
                    due = now + STATUS_SECONDS
                    self._print_status()
            time.sleep(POLL_SECONDS)
        return False

    def _execute(self, lines: queue.SimpleQueue[str]) -> bool:
        """Execute the lines that were typed; return whether one ends the rehearsal."""
        while not lines.empty():
            line = lines.get().strip()
            if line in QUIT:
                return True
            if line in ("", "status"):
                self._print_status()
                continue
            try:
                tell(f"{', '.join(inject(line, self._vehicles))}: {line.partition(' ')[2]}")
            except ValueError as error:
                tell(str(error))
        return False

    def _print_modes(self) -> None:
        for name, vehicle in self._vehicles:
            pilot = vehicle.autopilot
            now = f"{pilot.mode_name.upper()} {'armed' if pilot.armed else 'disarmed'}"
            if now != self._modes[name]:
                self._modes[name] = now
                tell(f"{pilot.time:7.1f} s '{name}': {now}")

    def _print_status(self) -> None:
        for name, vehicle in self._vehicles:
            tell(f"{vehicle.autopilot.time:7.1f} s '{name}': {status_line(vehicle.autopilot)}")


def inject(line: str, vehicles: Vehicles) -> tuple[str, ...]:
    """Execute ``ROBOT FAULT [VALUE…]`` or ``ROBOT mend FAULT``, with ``all`` for every robot.

    Returns:
        The names of the robots.

    Raises:
        ValueError: the line is malformed, or there is no such robot or fault.
    """
    wanted, what, values = addressed(line, [name for name, _ in vehicles])
    for _, vehicle in [each for each in vehicles if each[0] in wanted]:
        if what == "mend" and len(values) == 1:
            vehicle.faults.end(values[0])
        else:
            vehicle.faults.begin(what, *values)
    return wanted


def _scheduled(text: str, vehicles: Vehicles) -> ScheduledFault:
    names = [name for name, _ in vehicles]
    try:
        fault = scheduled(text)
        if fault.robot and fault.robot not in names:
            raise ValueError(f"{text}: unknown robot '{fault.robot}'; known are {', '.join(names)}")
        for name, vehicle in vehicles:
            if fault.robot in ("", name):
                trial = Faults(
                    Autopilot(vehicle.autopilot.settings), nullcontext(), watched=vehicle.faults.watched
                )
                trial.begin(fault.name, *fault.values)
    except ValueError as error:
        raise typer.BadParameter(f"--fault {error}") from error
    return fault
