"""Robots that do not get ready: nothing begins then, and logs and black boxes say why."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping

from ..faults import LINK_LOST, PEER_LOST
from ..policies import NOTHING
from ..vehicle import Fault, Vehicle


class NotReadyError(Exception):  # the word that people read
    """Robots do not get ready; says why of each. Attributes: `faults` by robot."""

    def __init__(self, faults: Mapping[str, Fault]) -> None:
        lines = (f"robot '{id}': does not get ready: {reason_of(found)}" for id, found in faults.items())
        super().__init__("; ".join(lines))
        self.faults = faults

    @property
    def link_lost(self) -> bool:
        """Return whether the link to one of them was lost."""
        return any(found.which == LINK_LOST for found in self.faults.values())


def reason_of(found: Fault) -> str:
    """Return in words why a robot does not get ready."""
    return found.reason or found.which


def record(
    robots: Mapping[str, Vehicle], faults: Mapping[str, Fault], fail: Callable[[str, str], None]
) -> None:
    """Record in logs which programs have ended, and in black boxes why none begins.

    A vehicle that never sent a message may be there the next time: no log records that its program has ended.

    Args:
        robots: all that were to begin.
        faults: by robot that does not get ready.
        fail: logs that a robot's program has ended, by which fault.
    """
    for id, found in faults.items():
        robot = robots[id]
        note(robot, found.which, reason_of(found))
        if found.which != LINK_LOST or robot.told():
            fail(id, found.which)
    missing = ", ".join(f"'{id}'" for id in faults)
    note_alone((robot for id, robot in robots.items() if id not in faults), f"{missing} did not get ready")


def note_alone(robots: Iterable[Vehicle], why: str) -> None:
    """Record in black boxes that robots have not begun, since others are not ready."""
    for robot in robots:
        note(robot, PEER_LOST, f"has not begun: {why}")


def note(robot: Vehicle, what: str, why: str) -> None:
    """Record in a robot's black box why it receives no command."""
    robot.note("decision", {"what": what, "why": why, "response": NOTHING})
