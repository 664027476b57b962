"""What an owner of slots remembers: the lines of its journal, and what they tell."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Any

from ..reading import Unreadable, finds_in, flag_in, names_in, number_in, recorded_in, text_in
from ..words import Begin, CommandId, Commit, Prepare, Withdraw

Line = Mapping[str, Any]


def started_line(number: int, robot: str, run: str) -> Line:
    """Return that a robot was started, for so many times now."""
    return {"started": number, "robot": robot, "run": run}


def started_in(line: Line, robot: str) -> int:
    """Return how often a robot was started.

    Raises:
        Unreadable: it was another robot.
    """
    number = number_in(line, "started")
    if text_in(line, "robot") != robot:
        raise Unreadable(f"of robot {line['robot']!r}, not {robot!r}")
    return number


def used_line(robot: str) -> Line:
    """Return that a robot itself has taken part."""
    return {"used": robot}


def tells_of_more_than_starts(line: Line) -> bool:
    """Return whether a line tells of anything that others may know of."""
    return not {"started", "again"} & set(line)


def left_line(sender: str, lamport: int) -> Line:
    """Return that a robot has ended at that logical time."""
    return {"left": sender, "lamport": lamport}


def left_in(line: Line) -> tuple[str, int]:
    """Return which robot has ended, and at what logical time."""
    return text_in(line, "left"), number_in(line, "lamport")


def set_line(sent: Commit) -> Line:
    """Return that slots were set."""
    line = {"set": list(sent.slots), "active": sent.active, "lamport": sent.lamport}
    finds = {"finds": [list(each) for each in sent.finds]} if sent.finds else {}
    return {**line, **finds, **_shown(sent.id)}


def set_in(line: Line, slots: Collection[str]) -> Commit:
    """Return what set slots; `slots`: names that there are."""
    names, active = _names_in(line, "set", slots), flag_in(line, "active")
    return Commit(_id_in(line), names, active, number_in(line, "lamport"), finds_in(line))


def freed_line(given_up: Withdraw) -> Line:
    """Return that slots were freed which were to be reset."""
    return {"freed": given_up.round, **_shown(given_up.id)}


def freed_in(line: Line) -> Withdraw:
    """Return what freed slots."""
    return Withdraw(_id_in(line), number_in(line, "freed"))


def begun_line(begun: Begin) -> Line:
    """Return that a sender was started again, and what it had recorded."""
    return {"begun": [list(each) for each in begun.recorded], **_shown(begun.id)}


def begun_in(line: Line, slots: Collection[str]) -> Begin:
    """Return what a sender told when it was started again; `slots`: names that there are."""
    recorded = recorded_in(line, "begun")
    if not all(slot in slots for slot, _, _ in recorded):
        raise Unreadable("begun: a slot that is none")
    return Begin(_id_in(line), recorded)


def kept_line(asked: Prepare, most: int) -> Line:
    """Return that slots are kept for a reset, which may have logical times up to `most`."""
    return {"kept": list(asked.slots), "round": asked.round, "most": most, **_shown(asked.id)}


def kept_in(line: Line, slots: Collection[str]) -> tuple[Prepare, int]:
    """Return for what slots are kept, as far as it matters, and up to which logical time."""
    round, most = number_in(line, "round"), number_in(line, "most")
    return Prepare(_id_in(line), round, _names_in(line, "kept", slots), False, 0), most


def _names_in(line: Line, name: str, slots: Collection[str]) -> tuple[str, ...]:
    names = names_in(line, name)
    if not all(slot in slots for slot in names):
        raise Unreadable(f"{name}: a slot that is none")
    return names


def _shown(id: CommandId) -> dict[str, object]:
    return {"run": id.run, "sender": id.sender, "incarnation": id.incarnation, "sequence": id.sequence}


def _id_in(line: Line) -> CommandId:
    run, sender = text_in(line, "run"), text_in(line, "sender")
    return CommandId(run, sender, text_in(line, "incarnation"), number_in(line, "sequence"))
