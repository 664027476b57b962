"""Notifies of one process's robots, from the first request to the owners until all have acknowledged."""

from __future__ import annotations

import json
import random
import threading
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from functools import partial
from math import isfinite

from ..owners.owners import Owners
from ..watching import Watching
from ..words import LARGEST, LONGEST_NAME, MOST_FINDS, REACH, CommandId, Find, SlotId
from .delivery import Delivery
from .errands import Errand
from .outbox import Outbox

FINDS_BYTES = 16_384
"""Of what was detected in one message."""


class Notifying:
    """Has slots set, whoever owns them."""

    def __init__(
        self,
        lock: threading.Condition,
        now: Callable[[], float],
        run: str,
        owners: Owners,
        watching: Watching,
        outbox: Outbox,
        latched: frozenset[SlotId],
        pump: Callable[[], None],
        chance: random.Random,
        *,
        alone: bool,
    ) -> None:
        """Set nothing yet.

        Args:
            lock: guards owners, watching and outbox.
            now: seconds of a clock that never goes back.
            run: identifier of the run, as robots of other processes know it.
            owners: of this process.
            watching: who has ended.
            outbox: takes what is to be sent.
            latched: slots that no robot of the mission ever resets.
            pump: sends what is due; called without the lock.
            chance: for pauses between tries.
            alone: whether there are no robots of other processes.
        """
        self._lock, self._now, self._run = lock, now, run
        self._owners, self._watching, self._outbox = owners, watching, outbox
        self._latched, self._pump, self._chance, self._alone = latched, pump, chance, alone

    def prepare(
        self, id: CommandId, slots: tuple[SlotId, ...], active: bool, finds: tuple[Find, ...]
    ) -> Delivery:
        """Ask the owners of slots for setting them; returns at once.

        Where there are robots of other processes, run and incarnation are those of this process. Of the
        finds, the last go with it, as many as a message can hold.
        """
        parts: dict[str, tuple[str, ...]] = {}
        for owner, slot in slots:
            parts[owner] = (*parts.get(owner, ()), slot)
        if not self._alone:
            id = replace(id, run=self._run, incarnation=self._owners.incarnation)
            self._take_part(id.sender)
        reach = LARGEST if self._alone else REACH
        latched = active and self._latched.issuperset(slots)
        least = partial(self._least, slots if latched else ())
        with self._lock:
            errand = Errand(id, parts, active, least, self._chance, reach, fitting(finds), latched=latched)
            for owner in parts:
                if self._watching.has_ended(owner) and owner not in self._owners:
                    errand.gone(owner)
            self._outbox.add(errand)
        if not latched:
            self._pump()
        return Delivery(errand, self._lock, partial(self._send, errand), partial(self._withdraw, errand))

    def _take_part(self, robot: str) -> None:
        with self._lock:
            try:
                self._owners.take_part(robot)
            except OSError:
                return  # whoever watches the journal has told; a robot that cannot keep this says so

    def _send(self, errand: Errand, lamport: int) -> None:
        """Have the owners of a notify apply it; they are told until all have acknowledged."""
        with self._lock:
            errand.send(lamport, self._now())
            self._owners.use(lamport)
        self._pump()

    def _withdraw(self, errand: Errand) -> None:
        """Give a notify up; its owners are told until they have answered."""
        with self._lock:
            if (notice := errand.withdraw()) is not None:
                self._outbox.add(notice)
        self._pump()

    def _least(self, slots: Iterable[SlotId]) -> int:
        return self._owners.latest(slots) + 1 if self._alone else self._owners.lamport + 1


def fitting(finds: Sequence[Find]) -> tuple[Find, ...]:
    """Return the last of what was detected, as much as a message can hold beside names of slots.

    Names that no reader would take, and places that are nowhere, are left out.
    """
    found: list[Find] = []
    size = 0
    for name, place in reversed(finds):
        where = place if place is not None and all(map(isfinite, place)) else None
        size += len(json.dumps([name, where]))
        if len(found) == MOST_FINDS or size > FINDS_BYTES:
            break
        if len(name) <= LONGEST_NAME:
            found.append((name, where))
    return tuple(reversed(found))
