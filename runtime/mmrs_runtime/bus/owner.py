"""The owner of slots: the only one that changes them. It has no thread and no clock of its own.

A sender first has slots kept for it and learns after which logical time it may set them; then it
records its notify and sends it. While a slot is kept, it is neither passed nor set by others, so that
events on it happen in the order of the logs.

Keeping ends when the sender sends, aborts, or is lost. In the last case it is unknown whether it
recorded its notify. It may have done so at any time up to `REACH` beyond the granted time, so all
later events on the slot are later than that; and if it meant to reset the slot, the slot is
*in doubt* and counts as inactive until it is set again or the sender is back. Whatever the
sender recorded, the logs then still describe a possible history. A command that arrives after a later one is
answered and changes nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

from .journal import Journal, Line
from .messages import (
    REACH,
    Abort,
    Answer,
    Begin,
    CommandId,
    Commit,
    Find,
    Leave,
    Prepare,
    Request,
    SlotState,
    Unreadable,
    content_of,
    number_in,
    text_in,
    word_in,
)
from .slot import Kept, Latest, Slot, Starts
from .watching import LEASE_SECONDS

STRANGE = "not a word of this run and plan"

KEPT_SECONDS = 10.0
"""Seconds that a slot is kept for a silent sender; senders repeat requests sooner."""

LostAt = Callable[[str], float | None]


@dataclass(frozen=True, slots=True)
class Owned:
    """The slots of one robot.

    Attributes:
        setters: by slot, the robots that activate it. resetters: those that deactivate it.
    """

    robot: str
    slots: tuple[str, ...]
    setters: Mapping[str, tuple[str, ...]]
    resetters: Mapping[str, tuple[str, ...]]


class Owner:
    """Keeps the slots of one robot.

    Attributes:
        start: number of the last start in the journal; 0: there was none.
        lamport: the latest logical time of robots that announced their end to this one.
        used: whether the journal holds anything but starts.
        finds: by name, detections of the robots that notified this one.
    """

    def __init__(
        self,
        owned: Owned,
        run: str,
        journal: Journal,
        *,
        floor: int = 0,
        lost_at: LostAt = lambda sender: None,
        trusting: bool = False,
    ) -> None:
        """Restore from the journal.

        Args:
            owned: the slots.
            run: identifier of the run; journals and commands of other runs are refused.
            journal: what survives.
            floor: logical time after which everything happens now.
            lost_at: when slots are no longer kept for a sender that is out of reach; None: it is not.
            trusting: whether commands come from this process only, so that none is forged.

        Raises:
            OSError: the journal cannot be read.
            ValueError: the journal is damaged or belongs to another run.
        """
        self.robot = owned.robot
        self.start = self.lamport = 0
        self.used = False
        self.finds: dict[str, Find] = {}
        self._owned, self._run, self._journal, self._trusting = owned, run, journal, trusting
        self._lost_at = lost_at
        self._slots = {name: Slot(SlotState(lamport=floor)) for name in owned.slots}
        self._kept: set[str] = set()
        self._applied: set[CommandId] = set()
        self._latest, self._starts = Latest(), Starts()
        self._begun: dict[str, str] = {}
        self._left: dict[str, int] = {}
        for number, line in enumerate(journal.lines(), start=1):
            try:
                self._take_up(line)
            except Unreadable as error:
                raise ValueError(f"{journal}:{number}: damaged: {error}") from error
        for slot in self._slots.values():
            slot.pass_time(floor)

    @property
    def left(self) -> Mapping[str, int]:
        """Return the robots that told this one that they have ended, with the logical time of each."""
        return dict(self._left)

    def started(self, number: int) -> None:
        """Keep that this owner was started again."""
        self.start = number
        self._journal.keep({"started": number, "robot": self.robot, "run": self._run})

    def use(self) -> None:
        """Keep that the robot itself takes part."""
        if not self.used:
            self._journal.keep({"used": self.robot})
            self.used = True

    def prepare(self, asked: Prepare, now: float, *, here: bool = False) -> Answer:
        """Keep slots for a sender, and tell it the least logical time that it may use.

        Args:
            asked: what is asked for.
            now: seconds of any clock that never goes back.
            here: the sender lives in this process, so that it cannot be lost alone.
        """
        if why := self._fault(asked.id, asked.slots, asked.active):
            return Answer("refused", why=why)
        if self._latest.is_stale(asked.id, asked.round):
            return Answer("stale")
        slots = [self._slots[name] for name in asked.slots]
        for slot in slots:
            self._end_if_lost(slot, now)
        if not all(slot.may_be_kept_for(asked.id) for slot in slots):
            return Answer("busy")
        return self._keep_for(asked, slots, float("inf") if here else now)

    def commit(self, sent: Commit) -> Answer:
        """Set slots once, whatever else is asked for meanwhile; on the disk before this returns."""
        if why := self._fault(sent.id, sent.slots, sent.active):
            return Answer("refused", why=why)
        if sent.id not in self._applied:
            self._keep(sent)
            self._apply(sent)
        return Answer("applied")

    def abort(self, given_up: Abort) -> Answer:
        """Free what was kept for a command."""
        if why := self._fault(given_up.id, (), True):
            return Answer("refused", why=why)
        if any(slot.may_be_reset_by(given_up.id) for slot in self._slots.values()):
            self._keep(given_up)
        self._free(given_up)
        return Answer("done")

    def begin(self, begun: Begin) -> Answer:
        """Apply what a sender that starts had recorded, and free what was kept for it before."""
        why = self._fault(begun.id, (), True)
        for name, active, _ in begun.recorded:
            why = why or self._fault(begun.id, (name,), active)
        if why:
            return Answer("refused", why=why)
        if self._begun.get(begun.id.sender, "") < begun.id.incarnation:
            if begun.recorded or not self._starts.is_first(begun.id):
                self._keep(begun)
            self._apply_recorded(begun)
        return Answer("done")

    def leave(self, farewell: Leave) -> Answer:
        """Note that a robot has ended."""
        if farewell.id.sender not in self._left:
            self._keep(farewell)
            self._see_off(farewell)
        return Answer("done")

    def repeat(self, sent: Commit) -> None:
        """Set slots as a log says they were."""
        for name in sent.slots:
            self._slots[name].set(sent.active, (sent.lamport, sent.id.sender))

    def restore(self, active: Iterable[str], lamport: int) -> None:
        """Begin with these slots active, and with all that happens later than that logical time."""
        names = set(active)
        for name, slot in self._slots.items():
            state = SlotState(name in names or slot.state.active, slot.state.version, lamport)
            slot.state = replace(state, lamport=max(slot.state.lamport, lamport))

    def may_pass(self, names: Iterable[str], lamport: int, now: float) -> bool:
        """Return whether a wait for slots can be passed at that logical time."""
        slots = [self._slots[name] for name in names]
        for slot in slots:
            self._end_if_lost(slot, now)
        return all(slot.is_active and slot.kept is None and slot.state.lamport < lamport for slot in slots)

    def passed(self, names: Iterable[str], lamport: int) -> None:
        """Keep the logical time at which a wait for slots was passed."""
        for slot in map(self._slots.__getitem__, names):
            slot.pass_time(lamport)

    def state(self, name: str, now: float) -> SlotState:
        """Return the state of a slot; one in doubt is not active."""
        slot = self._slots[name]
        self._end_if_lost(slot, now)
        return replace(slot.state, active=slot.is_active) if slot.doubts else slot.state

    def lamport_of(self, name: str) -> int:
        """Return the logical time of the last thing that happened to a slot."""
        return self._slots[name].state.lamport

    def shown(self, now: float) -> dict[str, object]:
        """Return the state of all slots by name, as others see it."""
        states = {name: self.state(name, now) for name in self._slots}
        return {
            name: {"active": s.active, "version": s.version, "lamport": s.lamport, "writer": s.writer}
            for name, s in states.items()
        }

    def kept(self) -> dict[str, Kept]:
        """Return by slot for whom it is kept; takes time by how many are, not by how many there are."""
        found = {name: kept for name in self._kept if (kept := self._slots[name].kept) is not None}
        self._kept = set(found)
        return found

    def end_lost(self, now: float) -> bool:
        """Stop keeping slots for senders that are lost; return whether there were any."""
        before = self.kept()
        for name in before:
            self._end_if_lost(self._slots[name], now)
        return before != self.kept()

    def next_end(self) -> float | None:
        """Return when keeping a slot ends unless its sender sends again; None: nothing is kept."""
        return min(map(self._end_of, self.kept().values()), default=None)

    def _end_of(self, kept: Kept) -> float:
        """Return when keeping a slot ends; a sender that is received is in reach, noticed or not."""
        end, lost_at = kept.received + KEPT_SECONDS, self._lost_at(kept.id.sender)
        return end if lost_at is None else min(end, max(lost_at, kept.received + LEASE_SECONDS))

    def _fault(self, id: CommandId, names: Sequence[str], active: bool) -> str:
        """Return what is wrong with a command; empty if nothing is."""
        if id.run != self._run and not self._trusting:
            return STRANGE
        if not self._trusting and not self._starts.admits(id):
            return f"{id.sender!r} was started before in this run: resume it from its log"
        for name in names:
            if name not in self._slots:
                return f"{self.robot!r} has no slot {name!r}"
            allowed = self._owned.setters if active else self._owned.resetters
            if id.sender not in allowed.get(name, ()) and not self._trusting:
                return f"{id.sender!r} never {'sets' if active else 'resets'} slot {name!r} of {self.robot!r}"
        return ""

    def _keep_for(self, asked: Prepare, slots: Sequence[Slot], received: float) -> Answer:
        least = max(asked.lamport, *(slot.state.lamport + 1 for slot in slots))
        kept = Kept(asked.id, asked.round, asked.active, least + REACH, received)
        if not asked.active:
            self._keep(replace(asked, lamport=least))
        self._kept.update(asked.slots)
        for slot in slots:
            slot.keep(kept)
        self._open(asked)
        return Answer("granted", least)

    def _keep(self, word: Request) -> None:
        """Write an obeyed message to the journal, unless the slots end with this process."""
        if not self._trusting:
            self._journal.keep(content_of(word))

    def _apply(self, sent: Commit) -> None:
        self._applied.add(sent.id)
        self._settle(sent.id)
        self.finds.update({find[0]: find for find in sent.finds})
        for name in sent.slots:
            slot = self._slots[name]
            slot.free(sent.id)
            slot.set(sent.active, (sent.lamport, sent.id.sender))

    def _apply_recorded(self, begun: Begin) -> None:
        sender, incarnation = begun.id.sender, begun.id.incarnation
        self._begun[sender] = incarnation
        self._left.pop(sender, None)
        for name, active, lamport in begun.recorded:
            self._slots[name].set(active, (lamport, sender))
        for slot in self._slots.values():
            slot.free_older(begun.id)
        self._settle(CommandId(begun.id.run, sender, incarnation, 0))

    def _free(self, given_up: Abort) -> None:
        for slot in self._slots.values():
            slot.free(given_up.id, given_up.round)
        self._settle(given_up.id, given_up.round)

    def _open(self, asked: Prepare) -> None:
        self._starts.add(asked.id)
        self._latest.open(asked.id, asked.round)

    def _settle(self, id: CommandId, round: int = 0) -> None:
        self._starts.add(id)
        self._latest.settle(id, round, for_good=id in self._applied)

    def _see_off(self, farewell: Leave) -> None:
        self._left[farewell.id.sender] = farewell.lamport
        self.lamport = max(self.lamport, farewell.lamport)

    def _end_if_lost(self, slot: Slot, now: float) -> None:
        kept = slot.kept
        if kept is not None and now >= self._end_of(kept):
            slot.lose_sender()

    def _take_up(self, line: Line) -> None:
        """Apply a line of the journal as its message was applied."""
        if line.get("run", self._run) != self._run:
            raise ValueError(f"{self.robot!r}: slots were kept in run {line['run']!r}, not {self._run!r}")
        if "started" in line:
            self.start = number_in(line, "started")
            if (robot := text_in(line, "robot")) != self.robot:
                raise Unreadable(f"of robot {robot!r}, not {self.robot!r}")
        elif "again" not in line:
            self.used = True
            if "used" not in line:
                self._obey_again(word_in(line))

    def _obey_again(self, word: Request) -> None:
        if unknown := [name for name in _slots_in(word) if name not in self._slots]:
            raise Unreadable(f"{unknown[0]!r}: no slot of {self.robot!r}")
        match word:
            case Commit():
                self._apply(word)
            case Prepare():
                self._keep_again(word)
            case Abort():
                self._free(word)
            case Begin():
                self._apply_recorded(word)
            case Leave():
                self._see_off(word)
            case _:
                raise Unreadable("nothing that is kept")

    def _keep_again(self, asked: Prepare) -> None:
        """Keep slots as before; the sender has been silent since, so it is in doubt at once."""
        kept = Kept(asked.id, asked.round, asked.active, asked.lamport + REACH, float("-inf"))
        self._kept.update(asked.slots)
        for name in asked.slots:
            self._slots[name].kept = kept
        self._open(asked)


def _slots_in(word: Request) -> tuple[str, ...]:
    if isinstance(word, Begin):
        return tuple(name for name, _, _ in word.recorded)
    return word.slots if isinstance(word, Prepare | Commit) else ()
