"""What a process tells others of robots: that they start, that they have ended, and who ended before."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from ..owners.members import Member, Recorded
from ..owners.owners import Owners
from ..watching import Watching
from ..words import Begin, CommandId, Ended, Leave, Request
from .errands import Message, Notice
from .outbox import Outbox

FAREWELL_SECONDS = 2.0
"""How long a robot that ends tries to tell those who are there."""

TIDINGS_SECONDS = 10.0
"""How long one who comes is told who has ended before, until it answers."""


class Announcing:
    """Puts news of robots into the outbox. Not thread-safe: whoever has it guards it."""

    def __init__(
        self,
        run: str,
        members: Mapping[str, Member],
        owners: Owners,
        watching: Watching,
        outbox: Outbox,
        now: Callable[[], float],
    ) -> None:
        """Speak for these robots of a process."""
        self._run, self._members = run, members
        self._owners, self._watching, self._outbox, self._now = owners, watching, outbox, now

    def introduce(self, robot: str, recorded: Recorded) -> Notice:
        """Tell all that a robot has to do with, itself included, that it starts, and what its log says."""
        id, requests = self.id_of(robot), dict[str, Request]()
        for owner in sorted(self._members[robot].contacts | {robot}):
            known = [(slot, *value) for (r, slot), value in recorded.notifies.items() if r == owner]
            requests[owner] = Begin(id, tuple(known))
        notice = _notice(robot, requests)
        self._outbox.add(notice)
        return notice

    def bid_farewell(self, robot: str) -> None:
        """Tell others that a robot has ended, for a while."""
        contacts = self._members[robot].contacts - self._watching.left.keys()
        there = {each for each in contacts if each in self._owners or self._watching.is_here(each)}
        if there != contacts:
            # Who comes later must be told by others, since this robot will be gone by then.
            there |= self._watching.here
        farewell = Leave(self.id_of(robot), self._owners.lamport)
        until = self._now() + FAREWELL_SECONDS
        self._outbox.bid_farewell(robot, _notice(robot, dict.fromkeys(there, farewell), until))

    def inform(self, robot: str) -> None:
        """Tell a robot that is there now who has ended before, for a while."""
        ended = {each: at for each, at in self._watching.ended().items() if each != robot}
        if ended:
            teller = next(iter(self._members))
            tidings = Ended(self.id_of(teller), tuple(sorted(ended.items())))
            self._outbox.add(_notice(teller, {robot: tidings}, self._now() + TIDINGS_SECONDS))

    def id_of(self, robot: str) -> CommandId:
        """Return what the words of a robot are known by that are no notifies."""
        return CommandId(self._run, robot, self._owners.incarnation, 0)


def _notice(sender: str, requests: Mapping[str, Request], until: float = float("inf")) -> Notice:
    return Notice({to: Message(sender, to, requests[to]) for to in sorted(requests)}, until=until)
