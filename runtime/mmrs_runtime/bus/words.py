"""What robots say to the owners of slots, and what these answer."""

from __future__ import annotations

from dataclasses import dataclass
from hashlib import sha256
from typing import TypeAlias

SlotId: TypeAlias = tuple[str, str]

Find: TypeAlias = "tuple[str, tuple[float, float, float] | None]"
"""What was detected, and where: metres east, north and up of the mission's origin; None: nobody knows."""

LONGEST = 65_536
"""Bytes of the longest message; a longer one is refused unread."""

LONGEST_NAME = 1_000
MOST_SLOTS = 1_000
MOST_FINDS = 100
LARGEST = 1 << 52
"""The largest number: JSON readers of other languages know no whole numbers beyond."""

REACH = 1 << 20
"""How far beyond the time that an owner answered a notify may be recorded."""


@dataclass(frozen=True, slots=True)
class CommandId:
    """What makes a notify recognisable however often it arrives.

    Attributes:
        run: identifier of the run. sender: the notifying robot. incarnation: grows as text each
            time that the sender is resumed; behind a ``-``, what tells starts apart that know nothing of each
            other. sequence: counted by the sender, never used twice.
    """

    run: str
    sender: str
    incarnation: str
    sequence: int


@dataclass(frozen=True, slots=True)
class SlotState:
    """The state of a slot.

    Attributes:
        version: how many commands its owner has applied to it.
        lamport: logical time of the last thing that happened to it.
        writer: who set it last; empty if nobody has.
    """

    active: bool = False
    version: int = 0
    lamport: int = 0
    writer: str = ""


@dataclass(frozen=True, slots=True)
class Prepare:
    """Asks an owner to keep slots for a sender, and for the time after which it may set them.

    Attributes:
        round: grows each time that the same command is prepared anew.
        slots: names of slots of the owner.
        active: the value that they will be set to.
        lamport: the least logical time that the sender can use.
    """

    id: CommandId
    round: int
    slots: tuple[str, ...]
    active: bool
    lamport: int


@dataclass(frozen=True, slots=True)
class Commit:
    """Has an owner set slots; whole in itself, since the owner may have been restarted meanwhile.

    Attributes:
        finds: what the sender, or those that notified it, had detected by then.
    """

    id: CommandId
    slots: tuple[str, ...]
    active: bool
    lamport: int
    finds: tuple[Find, ...] = ()


@dataclass(frozen=True, slots=True)
class Withdraw:
    """Frees what was kept for a command up to a round."""

    id: CommandId
    round: int


@dataclass(frozen=True, slots=True)
class Begin:
    """Tells an owner that a sender was started again, and what it has in its log.

    Attributes:
        id: with the new incarnation; sequence 0.
        recorded: by slot, the value and logical time of the sender's last notify of it.
    """

    id: CommandId
    recorded: tuple[tuple[str, bool, int], ...]


@dataclass(frozen=True, slots=True)
class Leave:
    """Tells an owner that a robot has ended, so that it neither sets nor needs slots any more.

    Attributes:
        lamport: the latest logical time of the robot; whoever sets its slots all the same does so later.
    """

    id: CommandId
    lamport: int


@dataclass(frozen=True, slots=True)
class Ended:
    """Tells a robot that was not there which others have ended, as the sender has been told.

    Attributes:
        robots: each with its latest logical time.
    """

    id: CommandId
    robots: tuple[tuple[str, int], ...]


@dataclass(frozen=True, slots=True)
class Meet:
    """Asks when all begin, and what the time is; `robots` is how many begin together, 0: not with me."""

    id: CommandId
    robots: int


Request: TypeAlias = Prepare | Commit | Withdraw | Begin | Leave | Ended | Meet


@dataclass(frozen=True, slots=True)
class Answer:
    """What an owner says.

    Attributes:
        what: ``granted``, ``busy``, ``stale``, ``applied``, ``done``, ``refused``, ``wait`` or ``begin``.
        lamport: of a grant: the least logical time that the notify may have.
        why: of a refusal.
        time: of a meeting: the answerer's clock, seconds. at: when all begin by that clock.
        ready: of a meeting: the robots that are ready.
    """

    what: str
    lamport: int = 0
    why: str = ""
    time: float = 0.0
    at: float = 0.0
    ready: tuple[str, ...] = ()


def digest(name: str) -> str:
    """Return a name as keys hold it: nothing of it can be read as a part of a key."""
    return sha256(name.encode("utf-8", "surrogatepass")).hexdigest()[:24]
