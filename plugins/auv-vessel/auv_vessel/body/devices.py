"""The devices of a simulated vehicle: each does what it is told, one action at a time, and says so."""

from __future__ import annotations

from dataclasses import dataclass

from auv_vessel.sheet import Sheet

ACTIVE, REACHED, FAILED = "ACTIVE", "REACHED", "FAILED"

_SECONDS, _SOON = 0.5, 1e-9


@dataclass(frozen=True, slots=True)
class Operation:
    """What a device was told to do.

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
