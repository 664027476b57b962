"""What carries notifies between robots."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Protocol

from mmrs_core.behaviour.program import SlotId
from mmrs_runtime.bus.words import CommandId as CommandId
from mmrs_runtime.bus.words import Find as Find
from mmrs_runtime.bus.words import SlotState as SlotState


class Delivery(Protocol):
    """A notify on its way to the owners of its slots, in two steps.

    First every owner is asked: it keeps the slots for this sender and tells its logical time, so that
    the sender can record the notify after all that has happened to them. Then it is sent. Where no robot
    ever resets any of the slots, that order does not matter, and nothing is asked.
    """

    @property
    def lamport(self) -> int | None:
        """Return the least logical time that the notify may have; None until all who are asked answered."""
        ...

    @property
    def waiting(self) -> tuple[str, ...]:
        """Return the owners that have still to answer or, once it was sent, to acknowledge."""
        ...

    def send(self, lamport: int) -> None:
        """Have every owner apply it; called once, after the notify was recorded with that time.

        Sent again until all have acknowledged, whether or not anybody still waits for that.

        Raises:
            ValueError: if the time is less than `lamport`, or that is not known yet.
        """
        ...

    def withdraw(self) -> None:
        """Give it up: owners that were asked are free again; what was sent cannot be called back."""
        ...


class Bus(Protocol):
    """Carries notifies between robots. Only a slot's owner changes it; waits look at its state.

    A slot that is kept for a sender is neither passed nor set by others until that sender has sent
    or withdrawn its notify, or is lost.
    """

    def prepare(
        self, id: CommandId, slots: tuple[SlotId, ...], active: bool, finds: tuple[Find, ...] = ()
    ) -> Delivery:
        """Ask the owners of slots for setting them; returns at once.

        Owners that share a process answer, and apply what is sent, before the call returns, in one
        instant. A command is applied once, however often it arrives. With the notify goes what its sender
        knows to have been detected: owners know it before anybody sees the slots set.
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
        False where one is inactive, or kept for a sender, or something happened to it since that time.
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
        """Tell everybody that a robot of this process will set no more slots; idempotent."""
        ...

    def on_change(self, callback: Callable[[], None]) -> None:
        """Have a function called, from any thread, when something may have changed; it must not block."""
        ...
