"""The bus within one process: the slots of all robots, set by acknowledged commands."""

from __future__ import annotations

from collections.abc import Iterable

from mmrs_core.behaviour.program import Program, SlotId
from mmrs_core.contributions.execution import SlotCommand, SlotState
from mmrs_core.errors import InternalError


class InProcessBus:
    """Keeps the slots of all robots of a program and applies each command once, atomically.

    Slots live as long as the process that all robots share. A run that is resumed replays its logs,
    in which every notify stands before it was delivered.
    """

    def __init__(self, program: Program) -> None:
        self._slots = {(robot.id, slot): SlotState() for robot in program.robots for slot in robot.slots}
        self._applied: dict[tuple[str, str, str], int] = {}

    def notify(self, command: SlotCommand) -> None:
        """Apply a command unless it was applied already.

        A sender's sequence grows: it goes on only when a command was acknowledged, so that one that
        is not newer than the last has been applied.

        Raises:
            InternalError: if the command names a slot that no robot has.
        """
        id = command.id
        sender = (id.run, id.sender, id.incarnation)
        if id.sequence <= self._applied.get(sender, -1):
            return
        after = {slot: self._after(command, slot) for slot in command.slots}
        self._slots.update(after)
        self._applied[sender] = id.sequence

    def state(self, slot: SlotId) -> SlotState:
        """Return the state of a slot."""
        found = self._slots.get(slot)
        if found is None:
            raise InternalError(f"{slot[0]}.{slot[1]}: no such slot in the program")
        return found

    def passed(self, slots: Iterable[SlotId], lamport: int) -> None:
        """Record that a wait for these slots was passed at that logical time."""
        for slot in slots:
            state = self.state(slot)
            self._slots[slot] = SlotState(
                state.active, state.version, max(state.lamport, lamport), state.writer
            )

    def _after(self, command: SlotCommand, slot: SlotId) -> SlotState:
        state = self.state(slot)
        lamport = max(state.lamport, command.lamport)
        return SlotState(command.active, state.version + 1, lamport, command.id.sender)
