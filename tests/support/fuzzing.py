"""Damages models by bytes, tags and values, and watches what reading them costs."""

import re
import signal
import tracemalloc
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from random import Random
from time import perf_counter
from types import FrameType

PIECES = (
    b"", b"<", b">", b'"', b"/", b"&", b"&lt;", b"&#0;", b"<!-- -->", b"<!--", b"<?x y?>", b"<!DOCTYPE x>",
    b"<![CDATA[x]]>", b"]]>", b"\x00", b"\xff", b"\xff\xfe", b"\xef\xbb\xbf", b"{", b"}", b"[", b"]", b",",
    b":", b"null", b"#", b"%2e%2e/", b'xsi:nil="true"', b'xsi:type="mission:Fork"', b'href="x.xmi#/"',
    b'href="context.xmi#//@areas.0"', b'xmi:id="a"', b'xmlns="urn:x"', b"<tasks/>", b"</tasks>", b"9" * 400,
)  # fmt: skip
VALUES = (
    "", " ", "NaN", "INF", "-INF", "1e999", "-1", "-0", "0", "1.", "0x1p3", "9" * 400, "true", "1", "yes",
    "//@tasks.0", "//@tasks.999999999999", "//@tasks.-1", "/", "//", "///", "#", "#/", "//@tasks[name='a']",
    "context.xmi#/", "../../../../etc/passwd#/", "file:///etc/passwd#/", "http://localhost:1/x.xmi#/",
    "platform:/resource/x/y.xmi#/", "\x85", "\u202e", "a\tb", "é" * 50, "%00", "%s%n{0}", "2026-02-30",
    "EPSG:0", "mission:Fork", "mission:Task", "nowhere:Thing", "ecore:EObject", "1 2 3", "//@team //@team",
)  # fmt: skip
_TAG = re.compile(rb"<[^<>]*>")
_LEAF = re.compile(rb"<[^<>]*/>")
_VALUE = re.compile(rb'"[^"<>]*"')
_NAME = re.compile(rb"[A-Za-z_][A-Za-z0-9_]*")
SLOWEST = 20.0
"""Seconds after which a reader counts as hanging; sound models of that size take milliseconds."""


class HangError(Exception):
    """A reader that did not end in time."""


def damaged(text: bytes, random: Random) -> bytes:
    """Return a text with one to four faults: in its bytes, its tags, or its values."""
    for _ in range(random.choice((1, 1, 1, 2, 4))):
        text = random.choice((_bytes, _tags, _tags, _values, _values, _values))(text, random)
    return text


def _bytes(text: bytes, random: Random) -> bytes:
    begin = random.randint(0, len(text))
    end = begin + random.choice((0, 1, 1, 3, 12, 200))
    match random.randrange(5):
        case 0:
            return text[:begin] + random.choice(PIECES) + text[end:]
        case 1:
            return text[:begin] + random.randbytes(random.choice((1, 2, 8))) + text[end:]
        case 2:
            return text[:begin]
        case 3:
            return text[:begin] + text[begin:end] * random.choice((2, 3, 50)) + text[end:]
        case _:
            other = random.randint(0, len(text))
            return text[:begin] + text[other : other + 60] + text[end:]


def _tags(text: bytes, random: Random) -> bytes:
    tags = list((_TAG if random.random() < 0.2 else _LEAF).finditer(text))
    if not tags:
        return _bytes(text, random)
    one, other = random.choice(tags), random.choice(tags)
    begin, end = one.span()
    match random.randrange(5):
        case 0:
            return text[:begin] + text[end:]
        case 1:
            return text[:end] + one[0] * random.choice((1, 30, 500)) + text[end:]
        case 2:
            return text[:begin] + other[0] + text[end:]
        case 3:
            names = _NAME.findall(other[0]) or [b"x"]
            return text[:begin] + _NAME.sub(random.choice(names), one[0], count=1) + text[end:]
        case _:
            name = random.choice(list(_NAME.finditer(one[0])) or [one])
            wrong = one[0][: name.start()] + (name[0][1:] or b"q") + one[0][name.end() :]
            return text[:begin] + wrong + text[end:]


def _values(text: bytes, random: Random) -> bytes:
    values = list(_VALUE.finditer(text))
    if not values:
        return _bytes(text, random)
    begin, end = random.choice(values).span()
    new = random.choice(values)[0] if random.random() < 0.3 else b'"%s"' % random.choice(VALUES).encode()
    return text[:begin] + new + text[end:]


@dataclass(frozen=True, slots=True)
class Way:
    """A way by which something from outside is read.

    Attributes:
        read: takes a damaged text and returns in what way it ended; anything it raises is a defect.
        texts: sound ones, to be damaged.
    """

    name: str
    read: Callable[[bytes, str], str]
    texts: tuple[tuple[str, bytes], ...]


@dataclass(slots=True)
class Tally:
    """What came of many cases of one way.

    Attributes:
        ends: how often each end was met. worst_factor: most bytes of memory for a byte of text, among texts
            of 10 kB and more. most_memory: bytes, of any text. slowest: seconds, where nothing was weighed.
        defects: what was raised, and for which case.
    """

    ends: dict[str, int] = field(default_factory=dict)
    worst_factor: float = 0.0
    most_memory: int = 0
    slowest: float = 0.0
    defects: list[str] = field(default_factory=list)


@contextmanager
def in_time(seconds: float = SLOWEST) -> Iterator[None]:
    """Raise HangError if what is inside does not end in time."""

    def ring(_: int, __: FrameType | None) -> None:
        raise HangError(f"no end after {seconds} s")

    before = signal.signal(signal.SIGALRM, ring)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


def fuzz(ways: Iterable[Way], cases: int, seed: int, weigh_every: int = 20) -> dict[str, Tally]:
    """Read so many damaged texts by each way in turn.

    Args:
        seed: the same one gives the same texts.
        weigh_every: one text of so many is read with its memory measured, which is slow.
    """
    ways = tuple(ways)
    tallies = {way.name: Tally() for way in ways}
    for way in ways:  # first readings fill caches that later ones use
        for name, text in way.texts:
            way.read(text, name)
    for case in range(cases):
        random = Random(f"{seed}/{case}")
        way = ways[case % len(ways)]
        name, text = random.choice(way.texts)
        weigh = case // len(ways) % weigh_every == 0
        _judge(way, name, damaged(text, random), tallies[way.name], weigh=weigh, case=case)
    return tallies


def _judge(way: Way, name: str, text: bytes, tally: Tally, *, weigh: bool, case: int) -> None:
    begun = perf_counter()
    try:
        with in_time():
            end, memory = _weighed(way, text, name) if weigh else (way.read(text, name), 0)
    except Exception as defect:
        end, memory = f"DEFECT {type(defect).__name__}", 0
        tally.defects.append(f"case {case} ({name}): {defect!r}")
    tally.ends[end] = tally.ends.get(end, 0) + 1
    if not weigh:
        tally.slowest = max(tally.slowest, perf_counter() - begun)
    tally.most_memory = max(tally.most_memory, memory)
    if len(text) >= 10_000:
        tally.worst_factor = max(tally.worst_factor, memory / len(text))


def _weighed(way: Way, text: bytes, name: str) -> tuple[str, int]:
    tracemalloc.start()
    try:
        end = way.read(text, name)
        return end, tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


def sound_texts(folder: Path, pattern: str, largest: int = 40_000) -> tuple[tuple[str, bytes], ...]:
    """Return the files below a folder with their paths, those that are no larger than so many bytes."""
    files = (file for file in sorted(folder.rglob(pattern)) if file.stat().st_size <= largest)
    return tuple((str(file), file.read_bytes()) for file in files)
