"""Slots: variables of robots that other robots set and their owners wait for.

Waits look at the state of slots, never at events, so that a notify that comes before its wait is not lost.
Where all robots of a program are in one process, `LocalSlots` is all there is; `mmrs_runtime.bus` keeps the
slots of robots in several processes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import Protocol

from .bus.messages import CommandId, Find, SlotState
from .program import Program, SlotId
from .vehicle import VehicleState


class Delivery(Protocol):
    """A notify in progress to the owners of its slots."""

    @property
    def lamport(self) -> int | None:
        """Return the least logical time that the notify may have; None as long as owners must be asked."""
        ...

    @property
    def waiting(self) -> tuple[str, ...]:
        """Return the owners that have still to answer or, once it was sent, to acknowledge."""
        ...

    def send(self, lamport: int) -> None:
        """Let every owner apply it; called once, after the notify was recorded with that time.

        It is resent until all have acknowledged, whether or not its sender still waits for that.

        Raises:
            ValueError: if the time is less than `lamport`, or that is not known yet.
        """
        ...

    def abort(self) -> None:
        """Give it up: owners that were asked are free again; what was sent cannot be called back."""
        ...


class Slots(Protocol):
    """Carries notifies between robots. Only a slot's owner changes it; waits look at its state.

    A slot that is kept for a sender is neither passed nor set by others until that sender has sent
    or aborted its notify, or is lost.
    """

    def prepare(
        self, id: CommandId, slots: tuple[SlotId, ...], active: bool, finds: tuple[Find, ...] = ()
    ) -> Delivery:
        """Begin a notify; returns at once.

        Owners that share a process answer, and apply what is sent, before the call returns, in one
        instant. A command is applied once, however often it arrives. With the notify go its sender's known
        detections: owners know them before the slots are seen set.
        """
        ...

    def finds(self, robot: str) -> tuple[Find, ...]:
        """Return what those that notified a robot of this process had detected."""
        ...

    def state(self, slot: SlotId) -> SlotState:
        """Return the state of a slot, as far as it is known here; one's own is always known."""
        ...

    def passed(self, slots: Iterable[SlotId], lamport: int) -> bool:
        """Return whether a wait for these own slots is passed at that time, and if so keep the time.

        To be called before the step is recorded: notifies of these slots are then ordered after it.
        False where one is inactive, or kept for a sender, or changed since that time.
        """
        ...

    def lost(self, robots: Iterable[str]) -> tuple[str, ...]:
        """Return those of these robots that will set no more slots or cannot be reached."""
        ...

    def unseen(self, robots: Iterable[str]) -> tuple[str, ...]:
        """Return those of these robots that have never been here: not come yet, or gone before."""
        ...

    def trouble(self, robot: str) -> str:
        """Return why what others tell a robot of this process cannot be kept now; empty: it can."""
        ...

    def leave(self, robot: str) -> None:
        """Announce that a robot of this process will set no more slots; idempotent."""
        ...

    def on_change(self, callback: Callable[[], None]) -> None:
        """Call a function, from any thread, when something may have changed; it must not block."""
        ...


def with_own(reported: Iterable[Find], state: VehicleState) -> tuple[Find, ...]:
    """Return what those that notified a robot have detected, and then what it has detected itself."""
    found = {find[0]: find for find in reported}
    for name in sorted(state.detected):
        place = state.places.get(name)
        if place is not None or name not in found:
            found.pop(name, None)
            found[name] = (name, place)
    return tuple(found.values())


@dataclass(slots=True)
class _Slot:
    state: SlotState = field(default_factory=SlotState)
    stamp: tuple[int, str] = (0, "")


class LocalSlots:
    """The slots of all robots of a program, within one process, in one thread."""

    def __init__(self, program: Program) -> None:
        """Begin with every slot inactive."""
        self._slots = {(robot.id, name): _Slot() for robot in program.robots for name in robot.slots}
        self._finds: dict[str, dict[str, Find]] = {robot.id: {} for robot in program.robots}
        self._left: set[str] = set()

    def prepare(
        self, id: CommandId, slots: tuple[SlotId, ...], active: bool, finds: tuple[Find, ...] = ()
    ) -> Delivery:
        """Begin a notify.

        Raises:
            KeyError: a slot is one that no robot has.
        """
        least = 1 + max(self._slots[slot].state.lamport for slot in slots)
        return _Sending(self, id.sender, slots, active, finds, least)

    def apply(
        self, sender: str, slots: Iterable[SlotId], active: bool, lamport: int, finds: Iterable[Find] = ()
    ) -> None:
        """Set slots as a notify says that was recorded with that logical time, unless a later one has."""
        for id in slots:
            slot = self._slots[id]
            self._finds[id[0]].update((find[0], find) for find in finds)
            before = slot.state
            latest = max(before.lamport, lamport)
            if (lamport, sender) > slot.stamp:
                slot.stamp = (lamport, sender)
                slot.state = SlotState(active, before.version + 1, latest, sender)

    def finds(self, robot: str) -> tuple[Find, ...]:
        """Return what those that notified a robot had detected."""
        return tuple(self._finds[robot].values())

    def state(self, slot: SlotId) -> SlotState:
        """Return the state of a slot.

        Raises:
            KeyError: no robot has it.
        """
        return self._slots[slot].state

    def passed(self, slots: Iterable[SlotId], lamport: int) -> bool:
        """Return whether a wait for slots is passed at that logical time, and if so keep the time."""
        awaited = [self._slots[slot] for slot in slots]
        if not all(slot.state.active and slot.state.lamport < lamport for slot in awaited):
            return False
        for slot in awaited:
            state = slot.state
            slot.state = SlotState(state.active, state.version, lamport, state.writer)
        return True

    def lost(self, robots: Iterable[str]) -> tuple[str, ...]:
        """Return those of these robots that have ended."""
        return tuple(robot for robot in robots if robot in self._left)

    def unseen(self, robots: Iterable[str]) -> tuple[str, ...]:
        """Return none: all robots are here."""
        return ()

    def trouble(self, robot: str) -> str:
        """Return nothing: nothing is kept that could be lost."""
        return ""

    def leave(self, robot: str) -> None:
        """Mark a robot as one that sets no more slots."""
        self._left.add(robot)

    def on_change(self, callback: Callable[[], None]) -> None:
        """Ignore a callback: these slots have no other source of changes."""

    def close(self) -> None:
        """Return at once: there are no other processes."""


class _Sending:
    """A notify within one process: no owner has to be asked, and all acknowledge at once."""

    waiting: tuple[str, ...] = ()

    def __init__(
        self,
        slots: LocalSlots,
        sender: str,
        sets: tuple[SlotId, ...],
        active: bool,
        finds: tuple[Find, ...],
        lamport: int,
    ) -> None:
        self.lamport: int | None = lamport
        self._slots, self._sender, self._sets, self._active, self._finds = slots, sender, sets, active, finds

    def send(self, lamport: int) -> None:
        if self.lamport is None or lamport < self.lamport:
            raise ValueError(f"logical time {lamport}: less than {self.lamport}")
        self._slots.apply(self._sender, self._sets, self._active, lamport, self._finds)

    def abort(self) -> None:
        pass
