"""The robots of one process, as the bus must know them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from ..words import SlotId
from .owner import Owned


@dataclass(frozen=True, slots=True)
class Recorded:
    """What the log of a robot says that is started again.

    Attributes:
        lamport: logical time of its last step.
        notifies: by slot, the value and logical time of its last notify of it.
    """

    lamport: int = 0
    notifies: Mapping[SlotId, tuple[bool, int]] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Member:
    """A robot of this process.

    Attributes:
        owned: its slots.
        targets: the robots whose slots it sets or resets.
        latched: of the slots that it sets, those that no robot of the mission ever resets.
    """

    owned: Owned
    targets: frozenset[str] = frozenset()
    latched: frozenset[SlotId] = frozenset()

    @property
    def contacts(self) -> frozenset[str]:
        """Return the robots that it has to do with."""
        senders = (*self.owned.setters.values(), *self.owned.resetters.values())
        return (self.targets | {robot for each in senders for robot in each}) - {self.owned.robot}
