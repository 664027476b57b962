"""Carries out the actions of a robot's moves."""

from __future__ import annotations

from mmrs_runtime.faults import DEVICE_SILENT, Fault, Unanswered
from mmrs_runtime.policies import VALUE_SECONDS
from mmrs_runtime.screen import words_of

from ..desk import Desk
from ..program import Action, Measure, NoEffect, Notify, Operate, Report, Robot
from ..vehicles.vehicle import Vehicle
from .journal import Journal
from .waits import Waits


class Doing:
    """Has devices do something, tells people, and notifies other robots."""

    def __init__(self, robot: Robot, vehicle: Vehicle, desk: Desk, journal: Journal, waits: Waits) -> None:
        """Do nothing yet."""
        self._robot = robot
        self._vehicle = vehicle
        self._desk = desk
        self._journal = journal
        self._waits = waits

    def act(self, action: Action, detail: str) -> None:
        """Carry out an action, and log it.

        Args:
            action: of the move that the robot is at.
            detail: where it stands there, as logs say it.

        Raises:
            Fault: it cannot be done, and policies say that this ends the program.
        """
        if isinstance(action, Notify):
            self._notify(action, detail)
            return
        begun = self._waits.now()
        while not self._done(action, begun):
            continue
        self._journal.write("act", detail)

    def operate(self, action: Operate) -> None:
        """Have a device do something, without a line in the log.

        Raises:
            Fault: it cannot be done.
        """
        self._vehicle.operate(action.command, action.params, confirmed=action.confirmed)
        for command, params in action.more:
            self._vehicle.operate(command, params)

    def _done(self, action: Action, begun: float) -> bool:
        """Try to carry out an action; return whether there is nothing more to try."""
        try:
            self._do(action)
        except Unanswered as error:
            borne = self._waits.patience(DEVICE_SILENT)
            if not isinstance(action, Measure) and self._waits.now() - begun < borne:
                return False
            self._waits.raise_unless_carried_on(Fault(DEVICE_SILENT, f"{_device(action)}{error}"))
        return True

    def _do(self, action: Action) -> None:
        if isinstance(action, Operate):
            self.operate(action)
            self._vehicle.rest(action.seconds)
        elif isinstance(action, Measure):
            silence = self._waits.patience(DEVICE_SILENT, {DEVICE_SILENT: VALUE_SECONDS})
            found = self._vehicle.measure(action.value, silence)
            self._vehicle.rest(action.seconds)
            self._journal.record("measured", action.value, {"device": action.device, "result": found})
        elif isinstance(action, Report):
            self._desk.say(words_of(f"{self._robot.id!r}: reported", action.name, dict(action.pairs)))
            self._vehicle.tell_ground(words_of(self._robot.id, action.name, dict(action.pairs)))
            self._journal.record("reported", action.name, dict(action.pairs))
        elif isinstance(action, NoEffect):
            self._desk.say(f"{self._robot.id!r} has no way to do {action.name!r}: {action.why}")

    def _notify(self, action: Notify, detail: str) -> None:
        sign = "+" if action.active else "-"
        slots = sign + " ".join(f"{robot}.{slot}" for robot, slot in action.slots)
        self._desk.slots.notify(
            self._robot.id,
            action.slots,
            action.active,
            lambda lamport: self._journal.write("ntf", detail, slots, lamport),
            self._waits.delivery(),
            self._vehicle.state().detected,
        )


def _device(action: Action) -> str:
    """Return the device of an action as the beginning of a sentence; empty where it has none."""
    return f"{action.device}: " if isinstance(action, Operate | Measure) else ""
