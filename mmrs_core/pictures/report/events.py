"""The events of a flight: faults, decisions, commands and vehicle warnings; and what robots measured."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping

from mmrs_core.pictures.figures import quantity
from mmrs_core.pictures.flights.fixes import Datum
from mmrs_core.pictures.flights.flight import Flown
from mmrs_core.pictures.flights.positions import GeoPosition
from mmrs_core.pictures.report.contents import Event, Measurement
from mmrs_core.scene import Position
from mmrs_runtime.policies import NOTHING
from mmrs_runtime.records.entries import Entry, number_of

MOST_TEXTS = 50
"""Warnings of one vehicle that a report lists."""
BY_PEOPLE = frozenset({"ORDERED", "STOPPED", "TAKEN_OVER"})
"""Ends of programs, among the faults of logs, that operators caused."""
_WARNINGS = frozenset({"EMERGENCY", "ALERT", "CRITICAL", "ERROR", "WARNING"})
_PATH = re.compile(r"(?<![\w./:])(?:~|\.{1,2})?/[^\s/'\":]+/[^\s'\":]*")
_DRIVE = re.compile(r"\b[A-Za-z]:\\[^\s'\":]*")
_SECRET = re.compile(r"(?<!\w)[0-9a-fA-F]{32,}+(?!\w)|(?<![\w+/-])[A-Za-z0-9+/_-]{40,}+={0,2}")


def events_of(flown: Flown) -> tuple[Event, ...]:
    """Return the events of one robot, by time."""
    return tuple(sorted(_events(flown), key=lambda event: event.time))


def readings_of(
    flown: Flown, datum: Datum, place_of: Callable[[Position], GeoPosition]
) -> Iterator[Measurement]:
    """Yield what a robot has measured and reported, in order."""
    for entry in flown.entries:
        if entry.kind in ("measured", "reported"):
            at = datum.position(entry.content.get("place"))
            at = at if at is not None else flown.track.at(entry.time)
            where = place_of(at) if at is not None else None
            name, content = _words(entry, "name"), _content(entry.content.get("content"))
            yield Measurement(flown.robot, entry.time, entry.kind, name, content, where)


def _events(flown: Flown) -> Iterator[Event]:
    for record in flown.records:
        if record.label == "fault":
            kind = "order" if record.detail.partition(":")[0] in BY_PEOPLE else "fault"
            yield Event(flown.robot, record.time, kind, record.detail, f"program ended at move {record.move}")
    logged = {record.detail.partition(":")[0] for record in flown.records if record.label == "fault"}
    for entry in flown.of_kind("decision"):
        what = _words(entry, "what")
        kind = "fault" if entry in flown.given_up and what not in logged else "decision"
        yield Event(flown.robot, entry.time, kind, what, _decided(entry))
    for entry in flown.of_kind("order"):
        yield Event(flown.robot, entry.time, "order", _ordered(entry), _confirmed(entry))
    for entry in flown.of_kind("injected"):
        state = f"injected: {_words(entry, 'state')}" if entry.content.get("state") else "injected"
        yield Event(flown.robot, entry.time, "injected", injected_by(entry), state)
    texts = [entry for entry in flown.of_kind("text") if str(entry.content.get("severity")) in _WARNINGS]
    for entry in texts[:MOST_TEXTS]:
        yield Event(flown.robot, entry.time, "text", _words(entry, "text"), _words(entry, "severity").lower())
    if len(texts) > MOST_TEXTS:
        more = f"{len(texts) - MOST_TEXTS} more warnings of the vehicle"
        yield Event(flown.robot, texts[MOST_TEXTS].time, "text", more, "omitted here")


def injected_by(entry: Entry) -> str:
    """Return which fault was injected."""
    return _words(entry, "fault") or _words(entry, "name") or "a fault"


def _decided(entry: Entry) -> str:
    why, response = _words(entry, "why"), _words(entry, "response")
    if response == NOTHING:
        return why or "no response"
    return f"{why}; response: {response}" if why else f"response: {response}"


def _ordered(entry: Entry) -> str:
    question = _words(entry, "question")
    return (
        f"{_words(entry, 'order')} '{question}': {_words(entry, 'says')}"
        if question
        else _words(entry, "order")
    )


def _confirmed(entry: Entry) -> str:
    confirmed, seconds = entry.content.get("confirmed"), number_of(entry.content.get("seconds"))
    after = f" after {quantity(seconds, 's')}" if seconds is not None else ""
    if isinstance(confirmed, bool) or confirmed is None:
        return f"confirmed{after}" if confirmed else "not confirmed"
    return f"{without_secrets(str(confirmed))}{after}"


def _words(entry: Entry, name: str) -> str:
    value = entry.content.get(name)
    return without_secrets(str(value)) if value is not None else ""


def _content(content: object) -> str:
    if isinstance(content, Mapping):
        return without_secrets(", ".join(f"{name} {_value(value)}" for name, value in content.items()))
    return without_secrets(_value(content))


def _value(value: object) -> str:
    number = number_of(value)
    return "unknown" if value is None else f"{number:g}" if number is not None else str(value)


def without_secrets(words: str) -> str:
    """Return words without folders of the machine, and without what looks like a key or token.

    >>> without_secrets("/home/ann/logs/a.jsonl: cannot be written")
    'a.jsonl: cannot be written'
    >>> without_secrets("key " + "0f" * 32)
    'key …'
    """
    for path in (_PATH, _DRIVE):
        words = path.sub(lambda found: re.split(r"[/\\]", found[0])[-1] or "…", words)
    return _SECRET.sub("…", words)
