"""What robots say to the owners of slots, what these answer, and how it is written: one JSON object each.

Everything that comes from outside is checked here, once: sizes are bounded, types are right.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from hashlib import sha256
from typing import Any, TypeAlias

SlotId: TypeAlias = tuple[str, str]

Find: TypeAlias = "tuple[str, tuple[float, float, float] | None]"
"""Detections with their positions: metres east, north and up of the mission's origin; None: unknown."""

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
        lamport: logical time of its last event.
        writer: robot that set it last; empty if none has.
    """

    active: bool = False
    version: int = 0
    lamport: int = 0
    writer: str = ""


@dataclass(frozen=True, slots=True)
class Prepare:
    """Asks an owner to keep slots for a sender, and for the time after which it may set them.

    Attributes:
        round: grows each time that the same command is prepared again.
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
class Abort:
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
    """Informs an owner that a robot has ended, so that it neither sets nor needs slots any more.

    Attributes:
        lamport: the latest logical time of the robot; a later setter of its slots is later than that.
    """

    id: CommandId
    lamport: int


@dataclass(frozen=True, slots=True)
class Ended:
    """Informs a newly present robot of those that have ended, as far as the sender knows.

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


Request: TypeAlias = Prepare | Commit | Abort | Begin | Leave | Ended | Meet


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


class Unreadable(ValueError):  # noqa: N818  # said of a message, as in 'unreadable message'
    """A message that is none of ours."""


def digest(name: str) -> str:
    """Return a name as keys hold it: nothing of it can be read as a part of a key."""
    return sha256(name.encode("utf-8", "surrogatepass")).hexdigest()[:24]


def written(message: Request | Answer) -> str:
    """Return a message as text."""
    return json.dumps(_brief(message) if isinstance(message, Answer) else content_of(message))


def content_of(message: Request) -> dict[str, object]:
    """Return a request as the object that is written of it."""
    content = {name: getattr(message, name) for name in message.__slots__ if name != "id"}
    id = message.id
    who = {"run": id.run, "sender": id.sender, "incarnation": id.incarnation, "sequence": id.sequence}
    return {"do": type(message).__name__.lower(), **who, **content}


def request_in(text: str | bytes) -> Request:
    """Return the request in a text.

    Raises:
        Unreadable: there is none; names the problem.
    """
    return word_in(object_in(text))


def word_in(content: Mapping[str, Any]) -> Request:
    """Return the request in an object.

    Raises:
        Unreadable: there is none; names the problem.
    """
    known = _READERS.get(text_in(content, "do"))
    if known is None:
        raise Unreadable("asks for something unknown")
    id = CommandId(
        text_in(content, "run"),
        text_in(content, "sender"),
        text_in(content, "incarnation"),
        number_in(content, "sequence"),
    )
    return known(id, content)


def answer_in(text: str | bytes) -> Answer:
    """Return the answer in a text.

    Raises:
        Unreadable: there is none.
    """
    content = object_in(text)
    return Answer(
        text_in(content, "is"),
        number_in(content, "lamport", 0),
        text_in(content, "why", ""),
        _real_in(content, "time", 0.0),
        _real_in(content, "at", 0.0),
        names_in(content, "ready") if "ready" in content else (),
    )


def object_in(text: str | bytes) -> Mapping[str, Any]:
    """Return the JSON object in a text.

    Raises:
        Unreadable: there is none, or it is too long.
    """
    if len(text) > LONGEST:
        raise Unreadable(f"{len(text)} bytes: longer than any message")
    try:
        content = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise Unreadable(f"no JSON: {error}") from error
    if not isinstance(content, dict):
        raise Unreadable(f"{type(content).__name__}: not an object")
    return content


def text_in(content: Mapping[str, Any], name: str, usual: str | None = None) -> str:
    """Return a text of an object.

    Raises:
        Unreadable: it is missing without a default, not a text, or too long.
    """
    found = content.get(name, usual)
    if not isinstance(found, str) or len(found) > LONGEST_NAME:
        raise Unreadable(f"{name}: no text of at most {LONGEST_NAME} characters")
    return found


def number_in(content: Mapping[str, Any], name: str, usual: int | None = None) -> int:
    """Return a whole number of an object, at least 0.

    Raises:
        Unreadable: it is missing without a default, or not such a number.
    """
    found = content.get(name, usual)
    if not isinstance(found, int) or isinstance(found, bool) or not 0 <= found <= LARGEST:
        raise Unreadable(f"{name}: no whole number from 0 to {LARGEST}")
    return found


def flag_in(content: Mapping[str, Any], name: str) -> bool:
    """Return a truth value of an object.

    Raises:
        Unreadable: it is missing or none.
    """
    found = content.get(name)
    if not isinstance(found, bool):
        raise Unreadable(f"{name}: neither true nor false")
    return found


def names_in(content: Mapping[str, Any], name: str) -> tuple[str, ...]:
    """Return a list of texts of an object, each once and at least one.

    Raises:
        Unreadable: it is missing or none.
    """
    found = _list_in(content, name)
    if not found:
        raise Unreadable(f"{name}: no list of 1 to {MOST_SLOTS}")
    return tuple(dict.fromkeys(text_in({name: each}, name) for each in found))


def finds_in(content: Mapping[str, Any], most: int = MOST_FINDS) -> tuple[Find, ...]:
    """Return detections with their positions; none where the object has none.

    Raises:
        Unreadable: it is not a list within the allowed length.
    """
    return tuple(map(_find, _list_in({"finds": [], **content}, "finds", most)))


def _list_in(content: Mapping[str, Any], name: str, most: int = MOST_SLOTS) -> list[Any]:
    found = content.get(name)
    if not isinstance(found, list) or len(found) > most:
        raise Unreadable(f"{name}: no list of at most {most}")
    return found


def _row(name: str, each: object, *parts: str) -> Mapping[str, Any]:
    """Return by name the parts of a list within a list."""
    if not isinstance(each, list) or len(each) != len(parts):
        raise Unreadable(f"{name}: no lists of {', '.join(parts)}")
    return dict(zip(parts, each, strict=True))


def _find(each: object) -> Find:
    row = _row("finds", each, "name", "place")
    name, place = text_in({"finds": row["name"]}, "finds"), row["place"]
    if place is None:
        return name, None
    axes = _row("finds", place, "east", "north", "up").values()
    east, north, up = (_real_in({"finds": number}, "finds") for number in axes)
    return name, (east, north, up)


def _real_in(content: Mapping[str, Any], name: str, usual: float | None = None) -> float:
    found = content.get(name, usual)
    if not isinstance(found, int | float) or isinstance(found, bool) or not abs(found) < LARGEST:
        raise Unreadable(f"{name}: no number")
    return float(found)


def _prepare(id: CommandId, content: Mapping[str, Any]) -> Request:
    slots, active = names_in(content, "slots"), flag_in(content, "active")
    return Prepare(id, number_in(content, "round"), slots, active, number_in(content, "lamport"))


def _commit(id: CommandId, content: Mapping[str, Any]) -> Request:
    slots, active = names_in(content, "slots"), flag_in(content, "active")
    return Commit(id, slots, active, number_in(content, "lamport"), finds_in(content))


def _begin(id: CommandId, content: Mapping[str, Any]) -> Request:
    rows = [_row("recorded", each, "slot", "active", "lamport") for each in _list_in(content, "recorded")]
    return Begin(
        id, tuple((text_in(row, "slot"), flag_in(row, "active"), number_in(row, "lamport")) for row in rows)
    )


def _ended(id: CommandId, content: Mapping[str, Any]) -> Request:
    rows = [_row("robots", each, "robot", "lamport") for each in _list_in(content, "robots")]
    return Ended(id, tuple((text_in(row, "robot"), number_in(row, "lamport")) for row in rows))


def _brief(answer: Answer) -> dict[str, object]:
    usual = Answer(answer.what)
    reported = {name: getattr(answer, name) for name in ("lamport", "why", "time", "at", "ready")}
    return {"is": answer.what, **{k: v for k, v in reported.items() if v != getattr(usual, k)}}


_READERS: Mapping[str, Callable[[CommandId, Mapping[str, Any]], Request]] = {
    "prepare": _prepare,
    "commit": _commit,
    "abort": lambda id, content: Abort(id, number_in(content, "round")),
    "begin": _begin,
    "leave": lambda id, content: Leave(id, number_in(content, "lamport")),
    "ended": _ended,
    "meet": lambda id, content: Meet(id, number_in(content, "robots")),
}
