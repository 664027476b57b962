"""The owners of one process: all slots that are kept here, and the logical time of its robots."""

from __future__ import annotations

import json
import uuid
from collections.abc import Callable, Iterable, Mapping, Sequence

from ..watching import Watching
from ..words import Answer, Begin, CommandId, Commit, Find, Prepare, SlotId, SlotState, Withdraw
from .journal import Journal
from .members import Member, Recorded
from .owner import Owner


class Owners:
    """Finds the owner of each slot of this process. Not thread-safe: whoever has it guards it.

    Attributes:
        incarnation: of the robots of this process; differs, and grows, each time that they are started.
        lamport: the latest logical time that this process knows of.
    """

    def __init__(
        self,
        members: Sequence[Member],
        run: str,
        journals: Callable[[str], Journal],
        recorded: Mapping[str, Recorded],
        watching: Watching,
        *,
        trusting: bool,
    ) -> None:
        """Take up what journals and logs say.

        Args:
            members: the robots of this process.
            run: identifier of the run.
            journals: what survives, by robot.
            recorded: by robot, what the logs say of those that are started again.
            watching: who is there and who has ended; those who have told these robots so are added.
            trusting: whether this process is alone, so that nobody forges commands or loses what it keeps.

        Raises:
            OSError: a journal cannot be read or written.
            ValueError: a journal is damaged, or holds another run or an earlier start of a robot that
                is not started again.
        """
        self._owners = {
            member.owned.robot: Owner(
                member.owned,
                run,
                journals(member.owned.robot),
                floor=recorded.get(member.owned.robot, Recorded()).lamport,
                lost=watching.lost_for_long,
                trusting=trusting,
            )
            for member in members
        }
        self._keepers = {robot: owner for robot, owner in self._owners.items() if owner.kept()}
        logged = (each.lamport for each in recorded.values())
        self.lamport = max((*logged, *(owner.lamport for owner in self._owners.values())), default=0)
        self._watching, self._alone = watching, trusting
        for owner in self._owners.values():
            watching.left.update(owner.left)
        self._number = self._next_start(recorded)
        self.incarnation = f"{self._number:08d}-{uuid.uuid4().hex[:8]}"

    def __contains__(self, robot: str) -> bool:
        """Return whether a robot is one of this process."""
        return robot in self._owners

    def answer(
        self, robot: str, request: Prepare | Commit | Withdraw | Begin, now: float, *, here: bool
    ) -> Answer:
        """Return what the owner answers; `here`: the sender is of this process."""
        owner = self._owners[robot]
        if isinstance(request, Prepare):
            self._keepers[robot] = owner
            return owner.prepare(request, now, here=here)
        if isinstance(request, Commit):
            answer = owner.commit(request)
            if answer.what == "applied":
                self.use(request.lamport)
            return answer
        if isinstance(request, Withdraw):
            return owner.withdraw(request)
        return owner.begin(request)

    def see_off(self, robot: str, sender: str, lamport: int) -> Answer:
        """Have a robot of this process know that another has ended at that logical time."""
        self.use(lamport)
        return self._owners[robot].leave(sender, lamport)

    def state(self, slot: SlotId, now: float) -> SlotState:
        """Return the state of a slot.

        Raises:
            KeyError: it belongs to no robot of this process.
        """
        return self._owners[slot[0]].state(slot[1], now)

    def latest(self, slots: Iterable[SlotId]) -> int:
        """Return the logical time of the last thing that happened to any of these slots; 0: to none."""
        return max((self._owners[owner].lamport_of(slot) for owner, slot in slots), default=0)

    def finds(self, robot: str) -> tuple[Find, ...]:
        """Return what those that notified a robot of this process had detected."""
        return tuple(self._owners[robot].finds.values())

    def shown(self, robot: str, now: float) -> str:
        """Return the state of a robot's slots as a JSON object."""
        return json.dumps(self._owners[robot].shown(now))

    def passed(self, slots: Iterable[SlotId], lamport: int, now: float) -> bool:
        """Return whether a wait is passed at that logical time, and if so keep the time."""
        parts: dict[str, list[str]] = {}
        for owner, slot in slots:
            parts.setdefault(owner, []).append(slot)
        if not all(self._owners[id].may_pass(names, lamport, now) for id, names in parts.items()):
            return False
        for id, names in parts.items():
            self._owners[id].passed(names, lamport)
        self.use(lamport)
        return True

    def end_lost(self, now: float) -> bool:
        """Stop keeping slots for senders that are lost; return whether there were any."""
        ended = any([owner.end_lost(now) for owner in self._keepers.values()])
        self._keepers = {robot: owner for robot, owner in self._keepers.items() if owner.kept()}
        return ended

    def next_end(self) -> float:
        """Return when keeping a slot ends unless its sender is heard of; inf: nothing is kept."""
        ends = (owner.next_end(self._watching.long_lost_at) for owner in self._keepers.values())
        return min((end for end in ends if end is not None), default=float("inf"))

    def use(self, lamport: int) -> None:
        """Take note of a logical time."""
        self.lamport = max(self.lamport, lamport)

    def repeat(self, id: CommandId, slots: Iterable[SlotId], active: bool, lamport: int) -> None:
        """Set slots as a log says they were, whoever may set them."""
        self.use(lamport)
        for owner, slot in slots:
            self._owners[owner].repeat(Commit(id, (slot,), active, lamport))

    def restore(self, active: Iterable[SlotId], lamport: int) -> None:
        """Begin with these slots active and at that logical time; others' slots are left alone."""
        self.use(lamport)
        given = tuple(active)
        for robot, owner in self._owners.items():
            owner.restore([slot for owned_by, slot in given if owned_by == robot], lamport)

    def begin(self) -> None:
        """Keep that the robots of this process have been started once more.

        Raises:
            OSError: it cannot be kept.
        """
        for owner in () if self._alone else self._owners.values():
            owner.started(self._number)

    def take_part(self, robot: str) -> None:
        """Keep that a robot of this process does something that others will know of.

        Raises:
            OSError: it cannot be kept.
        """
        if not self._alone and robot in self._owners:
            self._owners[robot].use()

    def _next_start(self, recorded: Mapping[str, Recorded]) -> int:
        for robot, owner in self._owners.items():
            if owner.start and owner.used and robot not in recorded:
                raise ValueError(f"{robot!r}: its slots were kept by an earlier start; resume it")
        return 1 + max((owner.start for owner in self._owners.values()), default=0)
