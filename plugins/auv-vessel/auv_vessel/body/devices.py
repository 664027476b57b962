"""Equipment of a simulated vehicle: release of the drop weight, devices, drives outside the simulation."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf

from auv_vessel.body.hydrodynamics import GRAVITY
from auv_vessel.instruments import instruments_of
from auv_vessel.sheet import Sheet
from auv_vessel.wire.codec import Received

_PATIENCE, _DEEP, _SOON = 5.0, 0.5, 1e-9


def patience_of(sheet: Sheet) -> float:
    """Return seconds without a valid command after which the drop weight falls; 0: it never does."""
    return max(0.0, sheet.extra.get("deadman.time", _PATIENCE))


def pressure_of_depth(sheet: Sheet) -> float:
    """Return the absolute pressure, Pa, beyond which a vehicle counts as deep."""
    return instruments_of(sheet).pressure_air + sheet.water_density * GRAVITY * _DEEP


class Release:
    """What holds the drop weight.

    It is held by the supply of the drives: once they have had a valid command, and then none for
    ``deadman.time`` of `Sheet.extra` (seconds; default 5; 0: without limit) while deeper than half a
    metre, it lets go.

    Attributes:
        open: whether the weight is gone, which nothing undoes.
    """

    def __init__(self, sheet: Sheet) -> None:
        self.open = False
        self._patience = patience_of(sheet)
        self._commanded: float | None = None

    def command(self, now: float) -> None:
        """Take note that a drive had a valid command."""
        self._commanded = now

    def run(self, now: float, depth: float) -> None:
        """Let go if it is time to, seconds and metres."""
        if self._patience > 0.0 and self._commanded is not None and depth > _DEEP:
            self.open = self.open or now - self._commanded >= self._patience - _SOON


ACTIVE, REACHED, FAILED = "ACTIVE", "REACHED", "FAILED"

_SECONDS = 0.5


@dataclass(frozen=True, slots=True)
class Operation:
    """A command to a device.

    Attributes:
        time: when, seconds.
        device: its number on the bus.
        action, parameter, request: as commanded.
    """

    time: float
    device: int
    action: int
    parameter: float
    request: int


@dataclass(frozen=True, slots=True)
class Answer:
    """What is said of a request; state is `ACTIVE`, `REACHED` or `FAILED`."""

    device: int
    request: int
    state: str


class Devices:
    """All devices of a vehicle.

    `Sheet.extra` may say ``device<number>.seconds``, how long an action takes: half a second if it does not.

    Attributes:
        operations: what devices did, in order; a request that is repeated counts once.
    """

    def __init__(self, sheet: Sheet) -> None:
        self.operations: list[Operation] = []
        self._sheet = sheet
        self._ends: dict[int, tuple[Operation, float]] = {}
        self._active: set[int] = set()
        self._answers: list[Answer] = []

    def command(self, operation: Operation) -> None:
        """Begin what is commanded, unless it is what that device does or did last; answer in any case."""
        device, request = operation.device, operation.request
        if device >= len(self._sheet.devices):
            self._answers.append(Answer(device, request, FAILED))
            return
        last = self._ends.get(device)
        if last is None or last[0].request != request:
            ends = operation.time + self._sheet.extra.get(f"device{device}.seconds", _SECONDS)
            self._ends[device] = (operation, ends)
            self._active.add(device)
            self.operations.append(operation)
        self._answers.append(Answer(device, request, ACTIVE if device in self._active else REACHED))

    def answers(self, now: float) -> list[Answer]:
        """Return what there is to say by that time, and forget it."""
        for device in sorted(self._active):
            operation, ends = self._ends[device]
            if now >= ends - _SOON:
                self._active.discard(device)
                self._answers.append(Answer(device, operation.request, REACHED))
        said, self._answers = self._answers, []
        return said


HELD = 0.5
"""Seconds after the last status of a drive until its motor stops: motor controllers need set-points."""


class Outside:
    """What drives on the bus put out, as `ThrusterStatus` tells it."""

    def __init__(self, sheet: Sheet) -> None:
        """Start without thrust."""
        self._reported = [(-inf, 0.0)] * len(sheet.thrusters)

    def hear(self, number: int, status: Received, now: float) -> None:
        """Take what a drive says."""
        self._reported[number] = (now, float(status.values["Thrust"]))

    def thrusts(self, now: float) -> list[float]:
        """Return newtons of each thruster."""
        return [thrust if now - at < HELD else 0.0 for at, thrust in self._reported]
