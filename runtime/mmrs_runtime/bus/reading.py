"""Messages of the bus as text: each is one JSON object.

Everything that comes from outside is checked here, once: sizes are bounded, types are right.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from typing import Any

from .words import (
    LARGEST,
    LONGEST,
    LONGEST_NAME,
    MOST_FINDS,
    MOST_SLOTS,
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
    Withdraw,
)


class Unreadable(ValueError):  # noqa: N818  # said of a message, as in 'unreadable message'
    """A message that is none of ours."""


def written(message: Request | Answer) -> str:
    """Return a message as text."""
    if isinstance(message, Answer):
        return json.dumps(_brief(message))
    content = {name: getattr(message, name) for name in message.__slots__ if name != "id"}
    id = message.id
    who = {"run": id.run, "sender": id.sender, "incarnation": id.incarnation, "sequence": id.sequence}
    return json.dumps({"do": type(message).__name__.lower(), **who, **content})


def request_in(text: str | bytes) -> Request:
    """Return the request in a text.

    Raises:
        Unreadable: there is none; says what is wrong.
    """
    content = object_in(text)
    known = _READERS.get(text_in(content, "do"))
    if known is None:
        raise Unreadable("asks for something that nobody knows")
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
        _seconds_in(content, "time"),
        _seconds_in(content, "at"),
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
        Unreadable: it is missing and there is no usual one, or it is no text or too long.
    """
    found = content.get(name, usual)
    if not isinstance(found, str) or len(found) > LONGEST_NAME:
        raise Unreadable(f"{name}: no text of at most {LONGEST_NAME} characters")
    return found


def number_in(content: Mapping[str, Any], name: str, usual: int | None = None) -> int:
    """Return a whole number of an object, at least 0.

    Raises:
        Unreadable: it is missing and there is no usual one, or it is none.
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
    found = content.get(name)
    if not isinstance(found, list) or not 0 < len(found) <= MOST_SLOTS:
        raise Unreadable(f"{name}: no list of 1 to {MOST_SLOTS}")
    return tuple(dict.fromkeys(text_in({name: each}, name) for each in found))


def recorded_in(content: Mapping[str, Any], name: str) -> tuple[tuple[str, bool, int], ...]:
    """Return a list of slots with value and logical time.

    Raises:
        Unreadable: it is missing or none.
    """
    found = content.get(name)
    if not isinstance(found, list) or len(found) > MOST_SLOTS:
        raise Unreadable(f"{name}: no list of at most {MOST_SLOTS}")
    return tuple(_recorded(each) for each in found)


def finds_in(content: Mapping[str, Any]) -> tuple[Find, ...]:
    """Return what was detected, and where; nothing where an object does not say.

    Raises:
        Unreadable: it is no list of that.
    """
    found = content.get("finds", [])
    if not isinstance(found, list) or len(found) > MOST_FINDS:
        raise Unreadable(f"finds: no list of at most {MOST_FINDS}")
    return tuple(map(_find, found))


def _find(each: object) -> Find:
    if not isinstance(each, list) or len(each) != 2:
        raise Unreadable("finds: no lists of name and place")
    name, place = text_in({"finds": each[0]}, "finds"), each[1]
    if place is None:
        return name, None
    if not isinstance(place, list) or len(place) != 3:
        raise Unreadable("finds: no place of three numbers")
    east, north, up = (_real_in({"finds": number}, "finds") for number in place)
    return name, (east, north, up)


def _seconds_in(content: Mapping[str, Any], name: str) -> float:
    return _real_in(content, name, 0.0)


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
    return Begin(id, recorded_in(content, "recorded"))


def _recorded(each: object) -> tuple[str, bool, int]:
    if not isinstance(each, list) or len(each) != 3:
        raise Unreadable("recorded: no lists of slot, value and logical time")
    content = dict(zip(("slot", "active", "lamport"), each, strict=True))
    return text_in(content, "slot"), flag_in(content, "active"), number_in(content, "lamport")


def _ended(id: CommandId, content: Mapping[str, Any]) -> Request:
    found = content.get("robots")
    if not isinstance(found, list) or len(found) > MOST_SLOTS:
        raise Unreadable(f"robots: no list of at most {MOST_SLOTS}")
    return Ended(id, tuple(map(_one_ended, found)))


def _one_ended(each: object) -> tuple[str, int]:
    if not isinstance(each, list) or len(each) != 2:
        raise Unreadable("robots: no lists of robot and logical time")
    content = dict(zip(("robot", "lamport"), each, strict=True))
    return text_in(content, "robot"), number_in(content, "lamport")


def _brief(answer: Answer) -> dict[str, object]:
    usual = Answer(answer.what)
    told = {name: getattr(answer, name) for name in ("lamport", "why", "time", "at", "ready")}
    return {"is": answer.what, **{k: v for k, v in told.items() if v != getattr(usual, k)}}


_READERS: Mapping[str, Callable[[CommandId, Mapping[str, Any]], Request]] = {
    "prepare": _prepare,
    "commit": _commit,
    "withdraw": lambda id, content: Withdraw(id, number_in(content, "round")),
    "begin": _begin,
    "leave": lambda id, content: Leave(id, number_in(content, "lamport")),
    "ended": _ended,
    "meet": lambda id, content: Meet(id, number_in(content, "robots")),
}
