"""The owner of slots: the only one that changes them. It has no thread and no clock of its own.

A sender first has slots kept for it and is told after which logical time it may set them; then it
records its notify and sends it. While a slot is kept, it is neither passed nor set by others, so that
what happens to it happens in the order in which the logs say so.

Keeping ends when the sender sends, withdraws, or is lost. In the last case nobody knows whether it
recorded its notify. It may have done so at any time up to `REACH` beyond what it was told, so all
that happens to the slot afterwards is later than that; and if it meant to reset the slot, the slot is
*in doubt* and counts as inactive until somebody sets it again or the sender is back. Whatever the
sender recorded, the logs then still tell a possible story. A command that arrives after a later one is
answered and changes nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from .journal import Journal
from .reading import Unreadable, flag_in, names_in, number_in, recorded_in, text_in
from .words import REACH, Answer, Begin, CommandId, Commit, Prepare, SlotState, Withdraw

KEPT_SECONDS = 10.0
"""How long a slot is kept for a sender from which nothing is heard; senders repeat themselves sooner."""

Stamp = tuple[int, str]
Lost = Callable[[str, float], bool]


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


@dataclass(frozen=True, slots=True)
class _Kept:
    """For whom a slot is kept; `most` is the latest logical time that its notify may have."""

    id: CommandId
    round: int
    active: bool
    most: int
    heard: float


@dataclass(slots=True)
class _Slot:
    """A slot; `stamp` is that of the last command applied, `doubts` those that may have been recorded."""

    state: SlotState
    stamp: Stamp = (0, "")
    kept: _Kept | None = None
    doubts: dict[CommandId, int] = field(default_factory=dict)


class Owner:
    """Keeps the slots of one robot.

    Attributes:
        start: number of the last start that the journal tells of; 0: there was none.
        lamport: the latest logical time of robots that told this one that they have ended.
        used: whether the journal tells of anything but starts.
    """

    def __init__(
        self,
        owned: Owned,
        run: str,
        journal: Journal,
        *,
        floor: int = 0,
        lost: Lost | None = None,
        trusting: bool = False,
    ) -> None:
        """Take up what the journal says.

        Args:
            owned: the slots.
            run: identifier of the run; journals and commands of other runs are refused.
            journal: what survives.
            floor: logical time after which everything happens now.
            lost: whether a sender has been lost for long enough at a time; None: nobody is.
            trusting: whether commands come from this process only, so that nobody forges them.

        Raises:
            OSError: the journal cannot be read.
            ValueError: the journal is damaged or belongs to another run.
        """
        self.robot = owned.robot
        self.start = self.lamport = 0
        self.used = False
        self._owned, self._run, self._journal, self._trusting = owned, run, journal, trusting
        self._lost = lost or (lambda sender, now: False)
        self._slots = {name: _Slot(SlotState(lamport=floor)) for name in owned.slots}
        self._applied: set[CommandId] = set()
        self._latest: dict[str, tuple[str, int, int, bool]] = {}
        self._begun: dict[str, str] = {}
        self._left: set[str] = set()
        for number, line in enumerate(journal.lines(), start=1):
            try:
                self._take_up(line)
            except Unreadable as error:
                raise ValueError(f"{journal}:{number}: damaged: {error}") from error
        for slot in self._slots.values():
            slot.state = replace(slot.state, lamport=max(slot.state.lamport, floor))

    @property
    def left(self) -> frozenset[str]:
        """Return the robots that told this one that they have ended."""
        return frozenset(self._left)

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
        place = (asked.id.incarnation, asked.id.sequence, asked.round)
        latest = self._latest.get(asked.id.sender)
        if latest is not None and (place < latest[:3] or (place == latest[:3] and not latest[3])):
            return Answer("stale")
        slots = [self._slots[name] for name in asked.slots]
        for slot in slots:
            self._end_if_lost(slot, now)
        if any(slot.kept is not None and not _follows(asked.id, slot.kept.id) for slot in slots):
            return Answer("busy")
        return self._keep_for(asked, slots, float("inf") if here else now)

    def commit(self, sent: Commit) -> Answer:
        """Set slots once, whatever else is asked for meanwhile; on the disk before this returns."""
        if why := self._fault(sent.id, sent.slots, sent.active):
            return Answer("refused", why=why)
        if sent.id not in self._applied:
            id = sent.id
            line = {"set": list(sent.slots), "active": sent.active, "lamport": sent.lamport, **_shown(id)}
            self._journal.keep(line)
            self._apply(sent)
        return Answer("applied")

    def withdraw(self, given_up: Withdraw) -> Answer:
        """Free what was kept for a command."""
        id = given_up.id
        resets = any(_is_reset(slot, id) for slot in self._slots.values())
        if resets:
            self._journal.keep({"freed": given_up.round, **_shown(id)})
        self._free(id, given_up.round)
        return Answer("done")

    def begin(self, begun: Begin) -> Answer:
        """Apply what a restarted sender had recorded, and free what was kept for it before."""
        for name, active, _ in begun.recorded:
            if why := self._fault(begun.id, (name,), active):
                return Answer("refused", why=why)
        if self._begun.get(begun.id.sender, "") < begun.id.incarnation:
            recorded = [list(each) for each in begun.recorded]
            self._journal.keep({"begun": recorded, **_shown(begun.id)})
            self._apply_recorded(begun)
        return Answer("done")

    def leave(self, sender: str, lamport: int) -> Answer:
        """Note that a robot has ended at that logical time."""
        if sender not in self._left:
            self._journal.keep({"left": sender, "lamport": lamport})
            self._see_off(sender, lamport)
        return Answer("done")

    def repeat(self, sent: Commit) -> None:
        """Set slots as a log says they were."""
        for name in sent.slots:
            _set(self._slots[name], sent.active, (sent.lamport, sent.id.sender))

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
        return all(_is_active(slot) and slot.kept is None and slot.state.lamport < lamport for slot in slots)

    def passed(self, names: Iterable[str], lamport: int) -> None:
        """Keep the logical time at which a wait for slots was passed."""
        for slot in map(self._slots.__getitem__, names):
            slot.state = replace(slot.state, lamport=max(slot.state.lamport, lamport))

    def state(self, name: str, now: float) -> SlotState:
        """Return the state of a slot; one in doubt is not active."""
        slot = self._slots[name]
        self._end_if_lost(slot, now)
        return replace(slot.state, active=_is_active(slot))

    def shown(self, now: float) -> dict[str, object]:
        """Return the state of all slots by name, as others see it."""
        states = {name: self.state(name, now) for name in self._slots}
        return {
            name: {"active": s.active, "version": s.version, "lamport": s.lamport, "writer": s.writer}
            for name, s in states.items()
        }

    def end_lost(self, now: float) -> bool:
        """Stop keeping slots for senders that are lost; return whether there were any."""
        before = [slot.kept for slot in self._slots.values()]
        for slot in self._slots.values():
            self._end_if_lost(slot, now)
        return before != [slot.kept for slot in self._slots.values()]

    def next_end(self, lost_at: Callable[[str], float | None]) -> float | None:
        """Return when keeping a slot ends unless its sender is heard of; None: nothing is kept.

        Args:
            lost_at: when a sender counts as lost; None: it does not.
        """
        kept = [slot.kept for slot in self._slots.values() if slot.kept is not None]
        ends = [each.heard + KEPT_SECONDS for each in kept]
        ends += [at for each in kept if (at := lost_at(each.id.sender)) is not None]
        return min(ends, default=None)

    def _fault(self, id: CommandId, names: Sequence[str], active: bool) -> str:
        """Return what is wrong with a command; empty if nothing is."""
        if id.run != self._run and not self._trusting:
            return f"run {id.run!a}: this is run {self._run!a}"
        for name in names:
            if name not in self._slots:
                return f"{self.robot!a} has no slot {name!a}"
            allowed = self._owned.setters if active else self._owned.resetters
            if id.sender not in allowed.get(name, ()) and not self._trusting:
                return f"{id.sender!a} never {'sets' if active else 'resets'} slot {name!a} of {self.robot!a}"
        return ""

    def _keep_for(self, asked: Prepare, slots: Sequence[_Slot], heard: float) -> Answer:
        least = max(asked.lamport, *(slot.state.lamport + 1 for slot in slots))
        place = (asked.id.incarnation, asked.id.sequence, asked.round)
        if not asked.active:
            line = {"kept": list(asked.slots), "round": asked.round, "most": least + REACH}
            self._journal.keep({**line, **_shown(asked.id)})
        for slot in slots:
            if slot.kept is not None and slot.kept.id != asked.id:
                _end(slot)
            slot.kept = _Kept(asked.id, asked.round, asked.active, least + REACH, heard)
        self._latest[asked.id.sender] = (*place, True)
        return Answer("granted", least)

    def _apply(self, sent: Commit) -> None:
        self._applied.add(sent.id)
        self._close(sent.id, 0)
        for name in sent.slots:
            slot = self._slots[name]
            if slot.kept is not None and slot.kept.id == sent.id:
                slot.kept = None
            slot.doubts.pop(sent.id, None)
            _set(slot, sent.active, (sent.lamport, sent.id.sender))

    def _apply_recorded(self, begun: Begin) -> None:
        sender, incarnation = begun.id.sender, begun.id.incarnation
        self._begun[sender] = incarnation
        self._left.discard(sender)
        for name, active, lamport in begun.recorded:
            _set(self._slots[name], active, (lamport, sender))
        for slot in self._slots.values():
            if slot.kept is not None and _is_older(slot.kept.id, begun.id):
                slot.kept = None
            slot.doubts = {id: most for id, most in slot.doubts.items() if not _is_older(id, begun.id)}
        self._close(CommandId(begun.id.run, sender, incarnation, 0), 0)

    def _free(self, id: CommandId, round: int) -> None:
        for slot in self._slots.values():
            if slot.kept is not None and slot.kept.id == id and slot.kept.round <= round:
                slot.kept = None
            slot.doubts.pop(id, None)
        self._close(id, round)

    def _close(self, id: CommandId, round: int) -> None:
        """Have a late request for what has been settled found stale."""
        place = (id.incarnation, id.sequence, round)
        latest = self._latest.get(id.sender)
        if latest is None or place >= latest[:3]:
            self._latest[id.sender] = (*place, False)
        elif latest[:2] == place[:2] and id in self._applied:
            self._latest[id.sender] = (*latest[:3], False)

    def _see_off(self, sender: str, lamport: int) -> None:
        self._left.add(sender)
        self.lamport = max(self.lamport, lamport)

    def _end_if_lost(self, slot: _Slot, now: float) -> None:
        kept = slot.kept
        if kept is not None and (now - kept.heard > KEPT_SECONDS or self._lost(kept.id.sender, now)):
            _end(slot)

    def _take_up(self, line: Mapping[str, Any]) -> None:
        """Go through a line of the journal as through what it tells of."""
        if line.get("run", self._run) != self._run:
            raise ValueError(f"{self.robot!a}: slots were kept in run {line['run']!a}, not {self._run!a}")
        self.used = self.used or not {"started", "again"} & set(line)
        if "started" in line:
            self.start = number_in(line, "started")
            self._expect(
                text_in(line, "robot") == self.robot, f"of robot {line['robot']!a}, not {self.robot!a}"
            )
        elif "left" in line:
            self._see_off(text_in(line, "left"), number_in(line, "lamport"))
        elif "set" in line:
            slots, active = self._slots_in(line, "set"), flag_in(line, "active")
            self._apply(Commit(_id(line), slots, active, number_in(line, "lamport")))
        elif "freed" in line:
            self._free(_id(line), number_in(line, "freed"))
        elif "begun" in line:
            recorded = recorded_in(line, "begun")
            self._expect(all(slot in self._slots for slot, _, _ in recorded), "begun: a slot that is none")
            self._apply_recorded(Begin(_id(line), recorded))
        elif "kept" in line:
            self._keep_again(_id(line), line)

    def _slots_in(self, line: Mapping[str, Any], name: str) -> tuple[str, ...]:
        slots = names_in(line, name)
        self._expect(all(slot in self._slots for slot in slots), f"{name}: a slot that is none")
        return slots

    def _expect(self, holds: bool, why: str) -> None:
        if not holds:
            raise Unreadable(why)

    def _keep_again(self, id: CommandId, line: Mapping[str, Any]) -> None:
        """Keep slots as before; nothing was heard of the sender since, so it is in doubt at once."""
        round, most = number_in(line, "round"), number_in(line, "most")
        for name in self._slots_in(line, "kept"):
            self._slots[name].kept = _Kept(id, round, False, most, float("-inf"))
        self._latest[id.sender] = (id.incarnation, id.sequence, round, True)


def _follows(id: CommandId, before: CommandId) -> bool:
    """Return whether a command may take over what is kept for another: it is the same, or its heir."""
    return id == before or _is_older(before, id)


def _is_older(id: CommandId, than: CommandId) -> bool:
    """Return whether a command is of the same sender before it was started again."""
    return id.sender == than.sender and id.incarnation < than.incarnation


def _is_active(slot: _Slot) -> bool:
    return slot.state.active and not slot.doubts


def _is_reset(slot: _Slot, id: CommandId) -> bool:
    return id in slot.doubts or (slot.kept is not None and slot.kept.id == id and not slot.kept.active)


def _end(slot: _Slot) -> None:
    """Stop keeping a slot for a sender of which nobody knows what it has recorded."""
    kept = slot.kept
    if kept is None:
        return
    slot.kept = None
    slot.state = replace(slot.state, lamport=max(slot.state.lamport, kept.most))
    if not kept.active:
        slot.doubts[kept.id] = kept.most


def _set(slot: _Slot, active: bool, stamp: Stamp) -> None:
    """Set a slot unless a later command has."""
    lamport = max(slot.state.lamport, stamp[0])
    if stamp <= slot.stamp:
        slot.state = replace(slot.state, lamport=lamport)
        return
    slot.stamp = stamp
    slot.state = SlotState(active, slot.state.version + 1, lamport, stamp[1])
    slot.doubts = {id: most for id, most in slot.doubts.items() if most >= stamp[0]}


def _shown(id: CommandId) -> dict[str, object]:
    return {"run": id.run, "sender": id.sender, "incarnation": id.incarnation, "sequence": id.sequence}


def _id(line: Mapping[str, Any]) -> CommandId:
    run, sender = text_in(line, "run"), text_in(line, "sender")
    return CommandId(run, sender, text_in(line, "incarnation"), number_in(line, "sequence"))
