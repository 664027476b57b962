"""The bus within one process: the slots of all robots, set by acknowledged commands."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from mmrs_core.behaviour.program import Program, SlotId
from mmrs_core.contributions.execution import CommandId, SlotState
from mmrs_core.errors import InternalError


class InProcessBus:
    """Keeps the slots of all robots of a program and applies each command once, atomically.

    Slots live as long as the process that all robots share. A run that is resumed replays its logs,
    in which every notify stands before it was delivered.
    """

    def __init__(self, program: Program) -> None:
        self._slots = {(robot.id, slot): SlotState() for robot in program.robots for slot in robot.slots}
        self._applied: set[CommandId] = set()
        self._left: set[str] = set()
        self._callbacks: list[Callable[[], None]] = []

    def prepare(self, id: CommandId, slots: tuple[SlotId, ...], active: bool) -> LocalDelivery:
        """Return a delivery that every owner has answered already.

        Raises:
            InternalError: if a slot is one that no robot has.
        """
        least = max((self.state(slot).lamport for slot in slots), default=0) + 1
        return LocalDelivery(self, id, slots, active, least)

    def apply(self, id: CommandId, slots: Iterable[SlotId], active: bool, lamport: int) -> None:
        """Apply a command unless it was applied already."""
        if id in self._applied:
            return
        self._applied.add(id)
        for slot in slots:
            state = self.state(slot)
            self._slots[slot] = SlotState(active, state.version + 1, max(state.lamport, lamport), id.sender)
        self._changed()

    def state(self, slot: SlotId) -> SlotState:
        """Return the state of a slot.

        Raises:
            InternalError: if no robot has it.
        """
        found = self._slots.get(slot)
        if found is None:
            raise InternalError(f"{slot[0]}.{slot[1]}: no such slot in the program")
        return found

    def passed(self, slots: Iterable[SlotId], lamport: int) -> bool:
        """Return whether a wait for these slots is passed at that logical time, and keep it if so."""
        states = {slot: self.state(slot) for slot in slots}
        if not all(state.active and state.lamport < lamport for state in states.values()):
            return False
        for slot, state in states.items():
            self._slots[slot] = SlotState(state.active, state.version, lamport, state.writer)
        return True

    def lost(self, robots: Iterable[str]) -> tuple[str, ...]:
        """Return those of these robots that will set no more slots."""
        return tuple(robot for robot in robots if robot in self._left)

    def leave(self, robot: str) -> None:
        """Note that a robot will set no more slots."""
        if robot not in self._left:
            self._left.add(robot)
            self._changed()

    def on_change(self, callback: Callable[[], None]) -> None:
        """Have a function called when something has changed."""
        self._callbacks.append(callback)

    def _changed(self) -> None:
        for callback in self._callbacks:
            callback()


@dataclass(frozen=True, slots=True)
class LocalDelivery:
    """A notify whose owners all live in this process; they have answered, and acknowledge at once."""

    bus: InProcessBus
    id: CommandId
    slots: tuple[SlotId, ...]
    active: bool
    lamport: int

    @property
    def waiting(self) -> tuple[str, ...]:
        """Return nobody."""
        return ()

    def send(self, lamport: int) -> None:
        """Set the slots.

        Raises:
            ValueError: if the logical time is not after all that has happened to them.
        """
        if lamport < self.lamport:
            raise ValueError(f"logical time {lamport}: less than {self.lamport}")
        self.bus.apply(self.id, self.slots, self.active, lamport)

    def withdraw(self) -> None:
        """Do nothing: no slot is kept."""
