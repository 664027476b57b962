"""How robots are, as people read it: a line for each, in columns."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

Reply = Mapping[str, object]
"""What a robot says to ``status``, as JSON has it."""

HOUR = 3600
LARGEST = 1e12


def lines_of(replies: Sequence[Reply]) -> Iterator[str]:
    """Yield a line for each robot, and what it asks, or has reported last, below it.

    >>> badger = {"robot": "Badger", "phase": "works", "move": "m1", "step": "begin", "time": 65.4}
    >>> kestrel = {"robot": "Kestrel", "phase": "waits for its vehicle"}
    >>> for line in lines_of([badger, kestrel]):
    ...     print(line)
    'Badger'   works                  'm1' since 1:05
    'Kestrel'  waits for its vehicle
    """
    rows = [_cells(reply) for reply in replies]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    shown = [column for column, width in enumerate(widths) if width]
    for reply, row in zip(replies, rows, strict=True):
        yield "  ".join(f"{row[column]:<{widths[column]}}" for column in shown).rstrip()
        yield from _below(reply)


def is_standing(reply: Reply) -> bool:
    """Return whether whatever is to be a figure in a reply is one, or null where nothing is known of it.

    >>> is_standing({"phase": "works", "speed": None}), is_standing({"phase": "works", "speed": "fast"})
    (True, False)
    """
    place = reply.get("place")
    if isinstance(place, Mapping):
        needed = ("latitude", "longitude") if "latitude" in place else ("north", "east")
        if not all(name in place and is_figure(place[name]) for name in (*needed, "height")):
            return False
    return all(is_figure(reply.get(name)) for name in ("time", "energy", "speed"))


def is_figure(value: object) -> bool:
    """Return whether this is a number that people can read, or null."""
    if value is None:
        return True
    return isinstance(value, int | float) and not isinstance(value, bool) and abs(value) < LARGEST


def _cells(reply: Reply) -> tuple[str, ...]:
    return (
        repr(reply["robot"]),
        ": ".join(str(reply[name]) for name in ("phase", "response") if reply.get(name)),
        _move(reply),
        _vehicle(reply),
        _battery(reply),
        _place(reply.get("place")),
        f"{_number(reply['speed']):.1f} m/s" if reply.get("speed") is not None else "",
    )


def _move(reply: Reply) -> str:
    move, step = reply.get("move"), reply.get("step")
    if not move:
        return ""
    if step is None:
        return f"at {move!r}"
    when = _clock(_number(reply.get("time") or 0.0))
    if step in ("begin", "end"):
        return f"{move!r} {'since' if step == 'begin' else 'done at'} {when}"
    return f"at {move!r}, {step} {when}"


def _vehicle(reply: Reply) -> str:
    said = [str(reply["mode"])] if reply.get("mode") else []
    if "armed" in reply:
        said.append("armed" if reply["armed"] else "disarmed")
    return ", ".join(said)


def _battery(reply: Reply) -> str:
    if "energy" not in reply:
        return ""
    energy = reply["energy"]
    return "battery unknown" if energy is None else f"battery {_number(energy):.0%}"


def _place(place: object) -> str:
    """Return a place as a robot tells it: degrees, or metres from its home; and metres above that."""
    if not isinstance(place, Mapping) or None in place.values():
        return ""
    height = f"{_number(place['height']):.1f} m up"
    if "latitude" in place:
        return f"{_number(place['latitude']):.6f}, {_number(place['longitude']):.6f}, {height}"
    return f"{_number(place['north']):.1f} m north, {_number(place['east']):.1f} m east, {height}"


def _below(reply: Reply) -> Iterator[str]:
    if asks := reply.get("asks"):
        yield f"  asks {asks!r}: order 'answer' with --question {asks!r} and --says yes or no"
    reported = reply.get("reported")
    if isinstance(reported, Mapping):
        content = reported.get("content")
        pairs = content.items() if isinstance(content, Mapping) else ()
        named = f" {reported['name']!r}" if reported.get("name") else ""
        yield f"  has reported{named}: {', '.join(f'{key} {value}' for key, value in pairs)}".rstrip(": ")


def _number(value: object) -> float:
    return float(str(value))


def _clock(seconds: float) -> str:
    minutes, rest = divmod(round(seconds), 60)
    return f"{minutes}:{rest:02}" if seconds < HOUR else f"{minutes // 60}:{minutes % 60:02}:{rest:02}"
