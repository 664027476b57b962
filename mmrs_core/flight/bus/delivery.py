"""A notify on its way, as whoever sends it sees it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from .errands import Errand, Phase

if TYPE_CHECKING:
    from .node import Node


@dataclass(frozen=True, slots=True)
class Delivery:
    """A notify on its way; see `mmrs_core.contributions.buses.Delivery`."""

    node: Node
    errand: Errand

    @property
    def lamport(self) -> int | None:
        """Return the least logical time that the notify may have; None until all have answered."""
        with self.node.lock:
            granted = self.errand.phase in (Phase.GRANTED, Phase.SENDING, Phase.DONE)
            return self.errand.lamport if granted else None

    @property
    def waiting(self) -> tuple[str, ...]:
        """Return the owners that have still to answer or, once it was sent, to acknowledge."""
        with self.node.lock:
            return self.errand.waiting

    @property
    def is_over(self) -> bool:
        """Return whether nothing is left to be done for it."""
        with self.node.lock:
            return self.errand.is_over

    @property
    def refusals(self) -> Mapping[str, str]:
        """Return why owners will never do it; empty where all is well."""
        with self.node.lock:
            return dict(self.errand.refusals)

    def send(self, lamport: int) -> None:
        """Have every owner apply it, after it was recorded with that logical time.

        Raises:
            ValueError: that time was not granted.
        """
        with self.node.lock:
            self.errand.send(lamport, self.node.now())
            self.node.use(lamport)
        self.node.pump()

    def withdraw(self) -> None:
        """Give it up; what was sent goes on until all have acknowledged."""
        self.node.withdraw(self.errand)
