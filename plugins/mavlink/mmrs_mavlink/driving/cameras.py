"""Cameras that continue on their own, and need their commands again after a break."""

from __future__ import annotations

from collections.abc import Iterable

from mmrs_runtime.records.steps import StepRecord

from ..profiles.needs import TRIGGER_DISTANCE, VIDEO_START_CAPTURE, VIDEO_STOP_CAPTURE
from ..program import Operate, Robot
from ..vehicles.vehicle import Vehicle

STATES = {
    TRIGGER_DISTANCE: TRIGGER_DISTANCE,
    VIDEO_START_CAPTURE: VIDEO_START_CAPTURE,
    VIDEO_STOP_CAPTURE: VIDEO_START_CAPTURE,
}
"""Commands after which a camera continues on its own, and which of them concern the same function."""


class Cameras:
    """Keeps the last continuous command of each camera."""

    def __init__(self, robot: Robot, records: Iterable[StepRecord]) -> None:
        """Create from the steps of a robot's log."""
        self._last: dict[tuple[str, int], Operate] = {}
        moves = robot.executable.by_id
        for record in records:
            if record.label == "act":
                self.note(moves[record.move].action(record.detail))

    def note(self, action: object) -> None:
        """Take note of an action that was carried out."""
        if isinstance(action, Operate) and action.command in STATES:
            self._last[action.device, STATES[action.command]] = action
            if action.command == TRIGGER_DISTANCE and action.params[0] == 0.0:
                del self._last[action.device, TRIGGER_DISTANCE]

    @property
    def work(self) -> bool:
        """Return whether one continues on its own."""
        return any(action.command != VIDEO_STOP_CAPTURE for action in self._last.values())

    def rest(self, vehicle: Vehicle) -> None:
        """Stop all triggers by distance, without waiting for answers: nothing may delay a response."""
        for _, function in self._last:
            if function == TRIGGER_DISTANCE:
                vehicle.ask(TRIGGER_DISTANCE, 0.0, 0.0, 0.0)

    def restore(self, vehicle: Vehicle) -> None:
        """Send all cameras their last continuous commands again.

        Raises:
            FaultError: one does not accept it.
        """
        for action in self._last.values():
            vehicle.operate(action.command, action.params, confirmed=action.confirmed)
            for command, params in action.more:
                vehicle.operate(command, params)
