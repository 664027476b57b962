"""Who can still set which slot."""

from __future__ import annotations

from collections.abc import Collection

from mmrs_core.behaviour.program import Program, SlotId
from mmrs_core.contributions.buses import Bus


class Peers:
    """The robots that have a notify on each slot, and which of them make no further step.

    A robot that waits for a slot that only failed robots could have set has lost its peer. Of robots in
    other processes the bus knows whether they are still there.
    """

    def __init__(self, program: Program, here: Collection[str], bus: Bus) -> None:
        """Know the robots of this process, and ask the bus for the others."""
        self._here, self._bus = frozenset(here), bus
        self._setters: dict[SlotId, set[str]] = {}
        self._retired: dict[str, bool] = {}
        for robot in program.robots:
            for move in robot.moves:
                for action in (*move.before, *move.after):
                    for slot in action.sets if action.active else ():
                        self._setters.setdefault(slot, set()).add(robot.id)

    def retire(self, robot: str, *, failed: bool) -> None:
        """Note that a robot of this process makes no further step."""
        self._retired[robot] = failed

    def lost(self, slot: SlotId) -> tuple[str, ...]:
        """Return the failed robots whose loss means that the slot is never set; empty otherwise."""
        setters = self._setters.get(slot, set()) - {slot[0]}
        gone = {robot for robot in setters & self._here if robot in self._retired}
        away = set(self._bus.lost(sorted(setters - self._here)))
        if gone | away != setters:
            return ()
        return tuple(sorted(away | {robot for robot in gone if self._retired[robot]}))
