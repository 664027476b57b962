"""Keeps simulated vehicles going: who they are, what befalls them, what is told of them."""

from __future__ import annotations

import queue
import signal
import sys
import time
from collections.abc import Sequence
from contextlib import nullcontext
from types import FrameType

import typer

from mmrs_core.cli.interruption import INTERRUPTED
from mmrs_core.cli.output import say, tell
from mmrs_core.cli.typed import typed_lines
from mmrs_core.errors import InternalError
from mmrs_mavlink.commands.schedule import Planned, Schedule, order, planned
from mmrs_mavlink.sitl.autopilot import Autopilot
from mmrs_mavlink.sitl.faults import ENDS, FAULTS, Faults
from mmrs_mavlink.sitl.hosting import Host
from mmrs_mavlink.sitl.vehicle import SimulatedVehicle
from mmrs_mavlink.sitl.words import Deeds, deeds_of, state_of, summary

LOOK_SECONDS = 0.1
TELL_SECONDS = 10.0
QUIT = frozenset({"quit", "exit"})


def fault_list() -> None:
    """Print the names of all faults."""
    for name in FAULTS:
        say(f"{name}{'' if name in ENDS else '  (happens once)'}")


class Rehearsal:
    """Vehicles under way, until they are no longer wanted."""

    def __init__(self, vehicles: Sequence[tuple[str, SimulatedVehicle]], faults: Sequence[str]) -> None:
        """Be ready with these vehicles, to which these faults will happen.

        Raises:
            typer.BadParameter: a fault is none, or befalls nobody.
        """
        self._vehicles = vehicles
        plan = [_planned(text, vehicles) for text in faults]
        self._schedules = {
            name: Schedule(vehicle, [fault for fault in plan if fault.robot in ("", name)])
            for name, vehicle in vehicles
        }
        self._modes = dict.fromkeys((name for name, _ in vehicles), "")
        self._stopped = False

    def run(self, seconds: float, *, quiet: bool = False) -> int:
        """Keep them going; return the exit code.

        Args:
            seconds: real ones until the end; 0: until somebody ends it.
            quiet: whether to leave the summary away.
        """
        host = Host([vehicle for _, vehicle in self._vehicles])
        lines = typed_lines()
        before = {number: signal.signal(number, self._stop) for number in (signal.SIGINT, signal.SIGTERM)}
        host.start()
        try:
            ended = self._watch(host, time.monotonic() + seconds if seconds else float("inf"), lines)
        finally:
            host.stop()
            for number, handler in before.items():
                signal.signal(number, handler)
            for _, vehicle in self._vehicles:
                vehicle.close()
        for name, vehicle in self._vehicles if not quiet else ():
            say(f"'{name}': {summary(deeds_of(vehicle))}")
        return 0 if ended else INTERRUPTED

    def deeds(self) -> dict[str, Deeds]:
        """Return what each vehicle did."""
        return {name: deeds_of(vehicle) for name, vehicle in self._vehicles}

    def _stop(self, number: int, frame: FrameType | None) -> None:
        self._stopped = True

    def _watch(self, host: Host, until: float, lines: queue.SimpleQueue[str]) -> bool:
        """Return whether it ended by itself, or by a line; False: it was interrupted."""
        due = time.monotonic() + TELL_SECONDS
        while not self._stopped:
            now = time.monotonic()
            if host.failure is not None:
                raise InternalError("the simulated vehicles fail") from host.failure
            if now >= until or self._obey(lines):
                return True
            for name, schedule in self._schedules.items():
                for event in schedule.go_on():
                    tell(f"'{name}': {event}")
            if sys.stderr.isatty():
                self._tell_modes()
                if now >= due:
                    due = now + TELL_SECONDS
                    self._tell_states()
            time.sleep(LOOK_SECONDS)
        return False

    def _obey(self, lines: queue.SimpleQueue[str]) -> bool:
        while not lines.empty():
            line = lines.get().strip()
            if line in QUIT:
                return True
            if line in ("", "status"):
                self._tell_states()
                continue
            try:
                tell(f"{', '.join(order(line, self._vehicles))}: {line.partition(' ')[2]}")
            except ValueError as error:
                tell(str(error))
        return False

    def _tell_modes(self) -> None:
        for name, vehicle in self._vehicles:
            pilot = vehicle.autopilot
            now = f"{pilot.mode_name.upper()} {'armed' if pilot.armed else 'disarmed'}"
            if now != self._modes[name]:
                self._modes[name] = now
                tell(f"{pilot.time:7.1f} s '{name}': {now}")

    def _tell_states(self) -> None:
        for name, vehicle in self._vehicles:
            tell(f"{vehicle.autopilot.time:7.1f} s '{name}': {state_of(vehicle.autopilot)}")


def _planned(text: str, vehicles: Sequence[tuple[str, SimulatedVehicle]]) -> Planned:
    names = [name for name, _ in vehicles]
    try:
        fault = planned(text)
        if fault.robot and fault.robot not in names:
            raise ValueError(f"{text}: no robot '{fault.robot}'; there are {', '.join(names)}")
        for name, vehicle in vehicles:
            if fault.robot in ("", name):
                _try_out(fault, vehicle)
    except ValueError as error:
        raise typer.BadParameter(f"--fault {error}") from error
    return fault


def _try_out(fault: Planned, vehicle: SimulatedVehicle) -> None:
    """Do nothing if a vehicle like this can have the fault.

    Raises:
        ValueError: it does not take its values.
    """
    like = Autopilot(vehicle.autopilot.settings)
    watched = len(vehicle.radios) > 1
    Faults(like, nullcontext(), watched=watched).begin(fault.name, *fault.values)
