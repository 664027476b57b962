"""Slots: variables of robots that other robots set and their owners wait for.

Waits look at the state of slots, never at events, so that a notification that comes before its wait
is not lost. All robots of one process share one order of events, which the logs keep as ``lamport``.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Protocol

from mmrs_runtime.bus import (
    Carrier,
    CommandId,
    Delivery,
    FileJournal,
    Member,
    Node,
    NoJournal,
    Owned,
    Recorded,
)
from mmrs_runtime.bus.watching import SETTLING_SECONDS
from mmrs_runtime.faults import PEER_LOST, Fault
from mmrs_runtime.records.steps import StepRecord

from .program import Action, Notify, Robot

Record = Callable[[int], None]
Guard = Callable[[tuple[str, ...]], None]

GLANCE_SECONDS = 0.05


class Slots(Protocol):
    """What a robot needs of slots."""

    def tick(self) -> int:
        """Return the next logical time of this robot's process."""
        ...

    def notify(
        self,
        sender: str,
        slots: Iterable[tuple[str, str]],
        active: bool,
        record: Record,
        guard: Guard,
        detected: Iterable[str] = (),
    ) -> None:
        """Have slots set: ask their owners, record the notification, send it; return when all have it.

        With it go the names of what the sender, and those that notified it, have detected.

        `guard` is called again and again until then, with the owners that have not answered; it raises
        what should end the attempt. What was recorded is sent all the same, as long as this process lives.
        """
        ...

    def take(self, robot: str, names: Iterable[str], record: Record) -> bool:
        """Record that the robot goes on if all its slots of these names are active; say whether."""
        ...

    def active(self, robot: str, names: Iterable[str]) -> bool:
        """Return whether all of a robot's slots of these names are active now."""
        ...

    def found(self, robot: str) -> frozenset[str]:
        """Return the names of what those that notified a robot had detected."""
        ...

    def await_change(self, seconds: float) -> None:
        """Wait until a slot may have changed, but no longer than so many real seconds."""
        ...

    def lost(self, robots: Iterable[str]) -> str | None:
        """Return one of these robots that will set no more slots, if there is one."""
        ...

    def unseen(self, robots: Iterable[str]) -> tuple[str, ...]:
        """Return those of these robots that have never been here: not come yet, or gone before."""
        ...

    def trouble(self, robot: str) -> str:
        """Return why the slots of a robot cannot be kept now; empty: they can."""
        ...

    def leave(self, robot: str) -> None:
        """Tell that a robot has ended, well or by a fault: it never comes back.

        A robot whose program is only suspended does not leave: it is out of reach when the process ends.
        """
        ...

    def restore(self, active: Iterable[tuple[str, str]], lamport: int) -> None:
        """Begin with these slots active and at that logical time; before any robot starts."""
        ...


class BusSlots:
    """The slots of this process's robots, and those of others over the bus.

    Attributes:
        node: this process's end of the bus.
    """

    def __init__(self, node: Node, run: str) -> None:
        """Use an end of the bus; `run` is the identifier of the run."""
        self.node = node
        self._run = run
        self._numbers = itertools.count(1)

    def tick(self) -> int:
        """Return the next logical time of this process."""
        return self.node.tick()

    def notify(
        self,
        sender: str,
        slots: Iterable[tuple[str, str]],
        active: bool,
        record: Record,
        guard: Guard,
        detected: Iterable[str] = (),
    ) -> None:
        """Ask the owners, record the notification, send it; return when all have it."""
        id = CommandId(self._run, sender, self.node.incarnation, next(self._numbers))
        told = {find[0]: find for find in self.node.finds(sender)}
        finds = {**{name: (name, None) for name in sorted(detected)}, **told}
        delivery = self.node.prepare(id, tuple(slots), active, tuple(finds.values()))
        try:
            lamport = self.node.tick(self._granted(delivery, guard))
            record(lamport)
        except BaseException:
            delivery.withdraw()
            raise
        delivery.send(lamport)
        while delivery.waiting:
            self._wait(delivery, guard)

    def take(self, robot: str, names: Iterable[str], record: Record) -> bool:
        """Record that the robot goes on if all its slots of these names are active; say whether."""
        slots = [(robot, name) for name in names]
        states = [self.node.state(slot) for slot in slots]
        if not all(state.active for state in states):
            return False
        lamport = self.node.tick(1 + max((state.lamport for state in states), default=0))
        if not self.node.passed(slots, lamport):
            return False
        record(lamport)
        return True

    def active(self, robot: str, names: Iterable[str]) -> bool:
        """Return whether all of a robot's slots of these names are active now."""
        return all(self.node.state((robot, name)).active for name in names)

    def found(self, robot: str) -> frozenset[str]:
        """Return the names of what those that notified a robot had detected."""
        return frozenset(name for name, _ in self.node.finds(robot))

    def await_change(self, seconds: float) -> None:
        """Wait until something changes, but no longer than so many real seconds."""
        self.node.await_change(seconds)

    def lost(self, robots: Iterable[str]) -> str | None:
        """Return one of these robots that has ended or cannot be reached any more, if there is one."""
        return next(iter(self.node.lost(robots)), None)

    def unseen(self, robots: Iterable[str]) -> tuple[str, ...]:
        """Return those of these robots that have never been here: not come yet, or gone before."""
        return self.node.unseen(robots)

    def trouble(self, robot: str) -> str:
        """Return why the slots of a robot cannot be kept now; empty: they can."""
        return self.node.trouble(robot)

    def leave(self, robot: str) -> None:
        """Tell everybody that a robot has ended."""
        self.node.leave(robot)

    def restore(self, active: Iterable[tuple[str, str]], lamport: int) -> None:
        """Begin with these slots active and at that logical time."""
        self.node.restore(active, lamport)

    def close(self) -> None:
        """Leave the bus."""
        self.node.close()

    def _granted(self, delivery: Delivery, guard: Guard) -> int:
        while (lamport := delivery.lamport) is None:
            self._wait(delivery, guard)
        return lamport

    def _wait(self, delivery: Delivery, guard: Guard) -> None:
        for owner, why in delivery.refusals.items():
            raise Fault(PEER_LOST, f"{owner!r} refuses a notification: {why}")
        if delivery.lamport is None or delivery.waiting:
            self.node.await_change(GLANCE_SECONDS)
            guard(delivery.waiting)


class LocalSlots(BusSlots):
    """The slots of all robots of a process that needs no others."""

    def __init__(self, robots: Sequence[Robot], run: str = "run-0") -> None:
        """Begin with every slot inactive."""
        super().__init__(Node([member_of(robot) for robot in robots], run), run)


def shared_slots(
    robots: Sequence[Robot],
    run: str,
    folder: Path,
    carrier: Carrier,
    recorded: Mapping[str, Recorded] | None = None,
) -> BusSlots:
    """Return the slots of this process's robots, shared with other processes.

    Args:
        robots: of this process.
        run: identifier of the run; notifications of other runs are not heard.
        folder: for what must survive this process.
        carrier: to the other processes.
        recorded: by robot, what the logs say of those that are started again; see `recorded_of`.

    Raises:
        Unwelcome: another process runs one of these robots.
        OSError: the folder cannot be written, or the carrier cannot begin.
        ValueError: the folder holds slots of another run, or of an earlier start of a robot that is not
            started again.
    """
    folder.mkdir(parents=True, exist_ok=True)
    paths = {robot.id: folder / f"{Path(robot.log).stem}.slots.ndjson" for robot in robots}
    node = Node(
        [member_of(robot) for robot in robots],
        run,
        plan=robots[0].plan,
        team=team_of(robots),
        carrier=carrier,
        journals=lambda robot: FileJournal(paths[robot]) if robot in paths else NoJournal(),
        recorded=recorded,
        settle=SETTLING_SECONDS,
    )
    return BusSlots(node, run)


def member_of(robot: Robot) -> Member:
    """Return what the bus must know of a robot."""
    sets = {slot for action in _actions(robot) if isinstance(action, Notify) for slot in action.slots}
    owned = Owned(robot.id, robot.slots, dict(robot.senders), dict(robot.resets))
    return Member(owned, frozenset(owner for owner, _ in sets), frozenset(sets - {*robot.volatile}))


def strangers_of(robots: Sequence[Robot]) -> tuple[str, ...]:
    """Return the robots of other processes that these robots wait for or notify, by name."""
    members = [member_of(robot) for robot in robots]
    return tuple(sorted({each for member in members for each in member.contacts} - {r.id for r in robots}))


def team_of(robots: Sequence[Robot]) -> tuple[str, ...]:
    """Return all robots of the mission that these robots are of, by name."""
    return tuple(sorted({robot.id for robot in robots} | {*robots[0].fleet} | {*strangers_of(robots)}))


def recorded_of(robot: Robot, records: Iterable[StepRecord]) -> Recorded:
    """Return what the bus must know of a robot that is started again.

    Args:
        robot: the robot.
        records: the steps of its log, oldest first.
    """
    lamport, notifies = 0, {}
    for record in records:
        lamport = record.lamport
        if record.label == "ntf":
            action = robot.step(record.move).action(record.detail)
            assert isinstance(action, Notify)
            notifies.update({slot: (action.active, lamport) for slot in action.slots})
    return Recorded(lamport, notifies)


def _actions(robot: Robot) -> Iterable[Action]:
    return (action for step in robot.steps for action in (*step.before, *step.after))
