"""Who can still set which slot."""

from __future__ import annotations

from mmrs_core.behaviour.program import Program, SlotId


class Peers:
    """The robots that have a notify on each slot, and which of them make no further step.

    A robot that waits for a slot that only failed robots could have set has lost its peer.
    """

    def __init__(self, program: Program) -> None:
        self._setters: dict[SlotId, set[str]] = {}
        self._retired: dict[str, bool] = {}
        for robot in program.robots:
            for move in robot.moves:
                for action in (*move.before, *move.after):
                    for slot in action.sets if action.active else ():
                        self._setters.setdefault(slot, set()).add(robot.id)

    def retire(self, robot: str, *, failed: bool) -> None:
        """Note that a robot makes no further step."""
        self._retired[robot] = failed

    def lost(self, slot: SlotId) -> tuple[str, ...]:
        """Return the failed robots whose loss means that the slot is never set; empty otherwise."""
        setters = self._setters.get(slot, set()) - {slot[0]}
        if not all(robot in self._retired for robot in setters):
            return ()
        return tuple(sorted(robot for robot in setters if self._retired[robot]))
