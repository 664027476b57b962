"""Cameras that go on by themselves, and have to be told so again after a break."""

from __future__ import annotations

from collections.abc import Iterable

from mmrs_runtime.records.steps import StepRecord

from ..program import Operate, Robot
from ..vehicles.vehicle import Vehicle

STATES = {206: 206, 2500: 2500, 2501: 2500}
"""Commands after which a camera goes on by itself, and which of them concern the same."""


class Cameras:
    """Knows what each camera was told last that it goes on with by itself."""

    def __init__(self, robot: Robot, records: Iterable[StepRecord]) -> None:
        """Know what the steps of a robot's log tell."""
        self._last: dict[tuple[str, int], Operate] = {}
        moves = robot.executable.by_id
        for record in records:
            if record.label == "act":
                self.note(moves[record.move].action(record.detail))

    def note(self, action: object) -> None:
        """Take note of an action that was carried out."""
        if isinstance(action, Operate) and action.command in STATES:
            self._last[action.device, STATES[action.command]] = action

    def restore(self, vehicle: Vehicle) -> None:
        """Tell all cameras what they were told last.

        Raises:
            Fault: one does not accept it.
        """
        for action in self._last.values():
            vehicle.operate(action.command, action.params, confirmed=action.confirmed)
            for command, params in action.more:
                vehicle.operate(command, params)
