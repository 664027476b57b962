"""The robots of one process as others address them: which messages are admitted, and who answers them.

Every message of another process passes `Admission` before any of it is obeyed, kept or answered: it must be
of this run and plan, by a robot of it, at a possible time. A refusal reveals nothing of the
run to a sender that is not part of it; the operator here is informed.
"""

from __future__ import annotations

import json
import uuid
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field

from .journal import Journal
from .messages import (
    REACH,
    Abort,
    Answer,
    Begin,
    CommandId,
    Commit,
    Ended,
    Find,
    Leave,
    Meet,
    Prepare,
    Request,
    SlotId,
    SlotState,
    Unreadable,
    request_in,
)
from .owner import STRANGE, Owned, Owner
from .threads import Net
from .watching import Roster, Watching

AHEAD = REACH << 12
"""How far the logical time of a word may be ahead of all that this process knows.

A robot counts its steps, fewer than `REACH` between two words of it, and leaps by `REACH` for each sender
that it loses. It loses one in a lease of 1.5 s at most, so 4096 leaps are an hour and a half of being out of
reach of this process while others come and go. The largest number that can be written is a million times as
far: one forged word cannot use up all times.
"""

LATE = "its logical time is further ahead than that of any robot can be"


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


class Owners:
    """Holds the owner of each slot of this process. Not thread-safe, except `admitted`: its holder guards it.

    Attributes:
        admission: judges messages of other processes.
        incarnation: of the robots of this process; differs, and grows, with each start.
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
        now: Callable[[], float],
        net: Net,
        team: Collection[str],
        ended: Callable[[str], None],
        trusting: bool,
    ) -> None:
        """Restore from journals and logs.

        Args:
            members: the robots of this process.
            run: identifier of the run.
            journals: what survives, by robot.
            recorded: by robot, the logs of those that are started again.
            watching: robots present and robots that have ended; ends announced to these robots are added.
            now: seconds of a monotonic clock.
            net: reports refusals and failures to the operator.
            team: all robots of the mission; none: the carrier alone knows them.
            ended: called with each robot that has ended according to another, which need not answer any more.
            trusting: whether this process is alone, so that no command is forged and no journal lost.

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
                lost_at=watching.long_lost_at,
                trusting=trusting,
            )
            for member in members
        }
        self._keepers = {robot: owner for robot, owner in self._owners.items() if owner.kept()}
        logged = (each.lamport for each in recorded.values())
        self.lamport = max((*logged, *(owner.lamport for owner in self._owners.values())), default=0)
        self._watching, self._alone = watching, trusting
        self._now, self._net, self._ended, self._roster = now, net, ended, Roster(now)
        self.admission = Admission(run, team, lambda: self.lamport, net.tell)
        for owner in self._owners.values():
            watching.left.update(owner.left)
        self._number = self._next_start(recorded)
        self.incarnation = f"{self._number:08d}-{uuid.uuid4().hex[:8]}"

    def __contains__(self, robot: str) -> bool:
        """Return whether a robot is one of this process."""
        return robot in self._owners

    def admitted(self, owner: str, sender: str, text: str) -> Request | Answer:
        """Return the request that a robot of another process makes in a text, or why it is refused."""
        try:
            found = request_in(text)
        except Unreadable as error:
            return Answer("refused", why=f"not a request: {error}")
        if found.id.sender != sender:
            return Answer("refused", why=f"{sender!r} cannot speak for {found.id.sender!r}")
        if (refusal := self.admission.refusal(found)) is not None:
            return refusal
        if owner not in self or sender in self:
            return Answer("refused", why=f"{owner!r} is not to be asked here")
        return found

    def answer(self, robot: str, request: Request, *, here: bool = False) -> Answer | None:
        """Return what a robot answers; None: nothing as long as it cannot keep it, and it is asked again.

        Args:
            robot: of this process.
            request: to it.
            here: the sender is of this process, too.
        """
        try:
            return self._answer(self._owners[robot], request, here=here)
        except OSError:
            return None  # whoever watches the journal has told
        except Exception as error:
            self._net.tell(f"{robot!r} cannot answer {request}: {error!r}")
            return Answer("refused", why=f"{robot!r} cannot answer: {error!r}")

    def _answer(self, owner: Owner, request: Request, *, here: bool) -> Answer:
        match request:
            case Commit():
                answer = owner.commit(request)
                if answer.what == "applied":
                    self.use(request.lamport)
                return answer
            case Prepare():
                self._keepers[owner.robot] = owner
                return owner.prepare(request, self._now(), here=here)
            case Abort():
                return owner.abort(request)
            case Begin():
                answer = owner.begin(request)
                if answer.what != "refused":
                    self._watching.left.pop(request.id.sender, None)
                return answer
            case Leave():
                return self._see_off(owner, request)
            case Ended():
                return self._learn(request)
            case Meet():
                return self._roster.answer(request, self._watching.is_gone)

    def _see_off(self, owner: Owner, farewell: Leave) -> Answer:
        sender = farewell.id.sender
        # First the time: a notify that needs no answer any more must be later than all the robot did.
        self.use(farewell.lamport)
        # It has ended, also where that cannot be kept: then it is told again as long as it is there.
        self._watching.left[sender] = farewell.lamport
        if sender not in self:
            self._ended(sender)
        return owner.leave(farewell)

    def _learn(self, tidings: Ended) -> Answer:
        for robot, lamport in tidings.robots:
            if robot not in self and self._watching.hear_say(robot, lamport):
                self.use(lamport)
                self._ended(robot)
        return Answer("done")

    def state(self, slot: SlotId) -> SlotState:
        """Return the state of a slot.

        Raises:
            KeyError: it belongs to no robot of this process.
        """
        return self._owners[slot[0]].state(slot[1], self._now())

    def latest(self, slots: Iterable[SlotId]) -> int:
        """Return the logical time of the last thing that happened to any of these slots; 0: to none."""
        return max((self._owners[owner].lamport_of(slot) for owner, slot in slots), default=0)

    def finds(self, robot: str) -> tuple[Find, ...]:
        """Return what those that notified a robot of this process had detected."""
        return tuple(self._owners[robot].finds.values())

    def shown(self, robot: str) -> str:
        """Return the state of a robot's slots as a JSON object."""
        return json.dumps(self._owners[robot].shown(self._now()))

    def passed(self, slots: Iterable[SlotId], lamport: int) -> bool:
        """Return whether a wait is passed at that logical time, and if so keep the time."""
        now = self._now()
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
        """Return when keeping a slot ends unless its sender sends again; inf: nothing is kept."""
        ends = (owner.next_end() for owner in self._keepers.values())
        return min((end for end in ends if end is not None), default=float("inf"))

    def use(self, lamport: int) -> None:
        """Take note of a logical time."""
        self.lamport = max(self.lamport, lamport)

    def repeat(self, id: CommandId, slots: Iterable[SlotId], active: bool, lamport: int) -> None:
        """Set slots to their state in a log, whatever robots may set them."""
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


class Admission:
    """Judges words by run, sender and logical times; changes nothing."""

    def __init__(
        self, run: str, team: Collection[str], lamport: Callable[[], int], tell: Callable[[str], None]
    ) -> None:
        """Admit messages of a run.

        Args:
            run: identifier of the run and the plan.
            team: all robots of the mission; none: the carrier alone knows them.
            lamport: returns the latest logical time that this process knows of.
            tell: reports refusals to the operator.
        """
        self._run, self._team, self._lamport, self._tell = run, frozenset(team), lamport, tell

    def refusal(self, word: Request) -> Answer | None:
        """Return what a word is refused with; None: it is to be answered."""
        sender = word.id.sender
        if word.id.run != self._run:
            self._tell(f"a word of {sender!r} is refused: it is of run {word.id.run!r}, not {self._run!r}")
            return Answer("refused", why=STRANGE)
        if strangers := [each for each in (sender, *_robots_in(word)) if not self._knows(each)]:
            self._tell(f"a word of {sender!r} is refused: no robot of the mission: {strangers[0]!r}")
            return Answer("refused", why=STRANGE)
        return self._late(sender, max(_times_in(word), default=0))

    def believes(self, owner: str, answer: Answer) -> bool:
        """Return whether an answer can be one to a word of this process."""
        return self._late(owner, answer.lamport) is None

    def _knows(self, robot: str) -> bool:
        return not self._team or robot in self._team

    def _late(self, robot: str, lamport: int) -> Answer | None:
        if lamport <= self._lamport() + AHEAD:
            return None
        self._tell(f"a word of {robot!r} is refused: {LATE}")
        return Answer("refused", why=LATE)


def _robots_in(word: Request) -> tuple[str, ...]:
    return tuple(robot for robot, _ in word.robots) if isinstance(word, Ended) else ()


def _times_in(word: Request) -> tuple[int, ...]:
    match word:
        case Prepare() | Commit() | Leave():
            return (word.lamport,)
        case Begin():
            return tuple(lamport for _, _, lamport in word.recorded)
        case Ended():
            return tuple(lamport for _, lamport in word.robots)
        case _:
            return ()
