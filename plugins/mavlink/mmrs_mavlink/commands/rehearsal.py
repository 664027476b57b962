"""A rehearsal: simulated vehicles with their faults, until it ends."""

from __future__ import annotations

import queue
import signal
import time
from collections.abc import Callable, Mapping, Sequence
from itertools import pairwise
from math import dist, hypot
from types import FrameType

import typer

from mmrs_core.cli.interruption import INTERRUPTED
from mmrs_core.cli.output import say, tell
from mmrs_core.cli.typed import typed_lines
from mmrs_core.errors import InternalError
from mmrs_mavlink.commands.schedule import Schedule, Vehicles, checked, inject
from mmrs_mavlink.sitl.vehicle import Host, SimulatedVehicle

POLL_SECONDS = 0.1
QUIT = "quit"


class Rehearsal:
    """Simulated vehicles, their schedules of faults, and the lines that are typed."""

    def __init__(self, vehicles: Vehicles, faults: Sequence[str]) -> None:
        """Prepare these vehicles, and schedule these faults.

        Raises:
            typer.BadParameter: a fault is malformed, or no robot can have it.
        """
        self._vehicles = vehicles
        try:
            plan = [checked(text, vehicles) for text in faults]
        except ValueError as error:
            self._close()
            raise typer.BadParameter(f"--fault {error}") from error
        self._schedules = {
            name: Schedule(vehicle, [fault for fault in plan if fault.robot in ("", name)])
            for name, vehicle in vehicles
        }
        self._stopped = False

    def run(self, seconds: float, started: Callable[[], None]) -> int:
        """Run the vehicles; return the exit code.

        Args:
            seconds: real seconds to run; 0: until interrupted.
            started: called once the vehicles run.
        """
        host = Host([vehicle for _, vehicle in self._vehicles])
        lines = typed_lines()
        before = {number: signal.signal(number, self._stop) for number in (signal.SIGINT, signal.SIGTERM)}
        host.start()
        try:
            started()
            return self._watch(host, time.monotonic() + seconds if seconds else float("inf"), lines)
        finally:
            host.stop()
            for number, handler in before.items():
                signal.signal(number, handler)
            self._close()

    def summaries(self) -> dict[str, Mapping[str, object]]:
        """Return what each vehicle has done."""
        return {name: summary_of(vehicle) for name, vehicle in self._vehicles}

    def print_summaries(self) -> None:
        """Print what each vehicle has done."""
        for name, done in self.summaries().items():
            say(
                f"'{name}': {done['flown']:.1f} s in motion, {done['metres']:.1f} m,"
                f" {done['photos']} photos, {done['battery']:.0%} battery remaining,"
                f" {'still armed' if done['armed'] else 'disarmed'} {done['from_home']:.1f} m from home"
            )

    def _close(self) -> None:
        for _, vehicle in self._vehicles:
            vehicle.close()

    def _stop(self, number: int, frame: FrameType | None) -> None:
        self._stopped = True

    def _watch(self, host: Host, until: float, lines: queue.SimpleQueue[str]) -> int:
        """Inject faults until the end; return the exit code."""
        while not self._stopped:
            if host.failure is not None:
                raise InternalError("the simulated vehicles fail") from host.failure
            if time.monotonic() >= until or self._execute(lines):
                return 0
            for name, schedule in self._schedules.items():
                for event in schedule.advance():
                    tell(f"'{name}': {event}")
            time.sleep(POLL_SECONDS)
        return INTERRUPTED

    def _execute(self, lines: queue.SimpleQueue[str]) -> bool:
        """Execute the lines that were typed; return whether one ends the rehearsal."""
        while not lines.empty():
            line = lines.get().strip()
            if line == QUIT:
                return True
            try:
                tell(f"{', '.join(inject(line, self._vehicles))}: {line.partition(' ')[2]}")
            except ValueError as error:
                tell(str(error))
        return False


def summary_of(vehicle: SimulatedVehicle) -> Mapping[str, object]:
    """Return what a vehicle has done: metres, seconds, fractions."""
    pilot = vehicle.autopilot
    steps = [(a, b) for a, b in pairwise(pilot.track) if b[0] - a[0] < 1.0]
    names = {number: name.upper() for name, number in pilot.numbers.items()}
    return {
        "flown": round(sum(b[0] - a[0] for a, b in steps), 1),
        "metres": round(sum(dist(a[1:], b[1:]) for a, b in steps), 1),
        "photos": len(pilot.camera.photos),
        "battery": round(pilot.battery.level, 3),
        "armed": pilot.armed,
        "from_home": round(hypot(*pilot.body.place[:2]), 1),
        "sent": vehicle.radio.sent,
        "modes": [names.get(number, str(number)) for _, number in pilot.modes],
        "texts": [text for _, _, text in pilot.said],
    }
