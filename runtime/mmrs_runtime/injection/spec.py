"""The words of ``--inject``: what they mean, and which of them make no sense."""

from __future__ import annotations

import os
import re
import signal
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import inf

PARTS = ("loss", "duplicate", "corrupt", "bus-loss", "bus-duplicate")
CUTS = ("cut", "cut-in", "cut-out")
OF_LINK = ("loss", "duplicate", "corrupt", "delay", *CUTS)
OF_VEHICLE = ("gps-lost",)
OF_STATIONS = ("ground-cut",)
OF_BUS = ("bus-loss", "bus-duplicate", "bus-delay", "bus-cut")
OF_PROCESS = ("freeze", "disk-full", "clock-jump")
TIMED = (*CUTS, "bus-cut", *OF_VEHICLE, *OF_STATIONS, *OF_PROCESS)
NAMES = (*OF_LINK, *OF_BUS, *OF_VEHICLE, *OF_STATIONS, *OF_PROCESS)

HELP = (
    "faults to inject, separated by commas; ROBOT:FAULT for one robot. Fractions of packets: loss=0.15,"
    " duplicate=0.05, corrupt=0.01. Latency in seconds, plus or minus: delay=0.2~0.1. FAULT@60+20 begins 60 s"
    " after the start and lasts 20 s: cut (no packets; cut-in, cut-out: one direction), ground-cut (no"
    " packets from ground stations), freeze (the controller stops), disk-full, gps-lost (simulated"
    " vehicles only);"
    " clock-jump@60+3600 sets the clock forward by 3600 s. Between robots: bus-loss=0.1, bus-duplicate=0.1,"
    " bus-delay=0.5, bus-cut@60+20. Random seed: seed=7. Repeatable"
)

CENTURY = 3_155_760_000
"""Seconds that a clock may jump at most."""

_NUMBER = r"\d+(?:\.\d+)?"
_FAULT = re.compile(rf"([a-z-]+)(?:=({_NUMBER})(?:~({_NUMBER}))?|@({_NUMBER})(?:([+-])({_NUMBER}))?)")


@dataclass(frozen=True, slots=True)
class Injection:
    """One injected fault.

    Attributes:
        text: as given.
        robot: whose; empty: every robot's.
        name: one of `NAMES`.
        amount: fraction of all pieces, seconds of delay, or seconds that the clock jumps.
        spread: seconds that a delay may differ.
        begins, ends: seconds of the run; `ends` inf: never.
    """

    text: str
    robot: str
    name: str
    amount: float = 0.0
    spread: float = 0.0
    begins: float = 0.0
    ends: float = inf

    def acts(self, time: float) -> bool:
        """Return whether the fault is there at that second of the run."""
        return self.begins <= time < self.ends


@dataclass(frozen=True, slots=True)
class Injections:
    """All faults that were asked for.

    Attributes:
        seed: of everything that is left to chance.
    """

    seed: int = 0
    faults: tuple[Injection, ...] = ()

    def of_link(self, robots: Collection[str]) -> tuple[Injection, ...]:
        """Return what happens to the link that these robots share."""
        return tuple(f for f in self.faults if f.name in OF_LINK and (not f.robot or f.robot in robots))

    def of_bus(self) -> Injections:
        """Return what happens to the bus only."""
        return Injections(self.seed, tuple(f for f in self.faults if f.name in OF_BUS))

    def of_stations(self) -> tuple[Injection, ...]:
        """Return what happens to the hearing of ground stations."""
        return tuple(f for f in self.faults if f.name in OF_STATIONS)

    def timed(self) -> tuple[Injection, ...]:
        """Return what begins at a second of the run, earliest first."""
        return tuple(sorted((f for f in self.faults if f.name in TIMED), key=lambda fault: fault.begins))


def injections(
    texts: Sequence[str], urls: Mapping[str, str], *, dry: bool = False, alone: bool = False
) -> Injections:
    """Return the faults that ``--inject`` asks for.

    Args:
        texts: each one or several faults, with commas between them.
        urls: of the links, by robot.
        dry: whether there are no vehicles.
        alone: whether there are no robots in other processes.

    Raises:
        ValueError: a fault is not understood, or makes no sense.
    """
    faults: list[Injection] = []
    seed = 0
    for text in texts:
        for robot, word in _words(text, urls):
            if not robot and word.startswith("seed="):
                seed = _seed(word)
            else:
                faults.append(_fault(robot, word))
    for fault in faults:
        _check(fault, faults, urls, dry)
        if alone and fault.name in OF_BUS:
            raise ValueError(f"{fault.text}: robots of one process use no bus; it needs --bus")
    return Injections(seed, tuple(faults))


def _words(text: str, robots: Collection[str]) -> Iterator[tuple[str, str]]:
    """Yield (robot, fault); names of robots may hold commas and colons."""
    rest, comma = text, ","
    while comma:
        robot = next((r for r in sorted(robots, key=len, reverse=True) if rest.startswith(f"{r}:")), "")
        word, comma, rest = rest[len(robot) + bool(robot) :].partition(",")
        yield robot, word.strip()


def _seed(word: str) -> int:
    if not word[5:].isdecimal() or len(word) > 100:
        raise ValueError(f"{word}: is not seed=NUMBER")
    return int(word[5:])


def _fault(robot: str, word: str) -> Injection:
    stranger, colon, rest = word.rpartition(":")
    if colon:
        raise ValueError(f"{word}: unknown robot {stranger!r}")
    name = re.split("[=@]", rest)[0]
    if name not in NAMES:
        raise ValueError(f"{word!r}: is not a fault; there are {', '.join(NAMES)} and seed")
    found = _FAULT.fullmatch(rest)
    if found is None or (name in TIMED) != (found[4] is not None):
        usage = (
            f"{name}@SECOND+SECONDS" if name in TIMED else f"{name}={0.2 if name.endswith('delay') else 0.15}"
        )
        raise ValueError(f"{word!r}: say {usage}")
    _, amount, spread, begins, sign, last = found.groups()
    text = f"{robot}:{word}" if robot else word
    if name not in TIMED:
        return Injection(text, robot, name, float(amount), float(spread or 0.0))
    begin = float(begins)
    if name == "clock-jump":
        return Injection(text, robot, name, float(f"{sign or '+'}{last or 0}"), begins=begin)
    if sign == "-":
        raise ValueError(f"{word}: ends before it begins")
    return Injection(text, robot, name, begins=begin, ends=begin + float(last) if last else inf)


def _check(fault: Injection, all: Sequence[Injection], urls: Mapping[str, str], dry: bool) -> None:
    """Raise ValueError where a fault makes no sense."""
    if fault.name in PARTS and not fault.amount <= 1.0:
        raise ValueError(f"{fault.text}: is a part of all, so at most 1")
    if fault.spread and (not fault.name.endswith("delay") or fault.spread > fault.amount):
        raise ValueError(f"{fault.text}: only a delay differs, and by no more than itself")
    if fault.name not in TIMED and sum(f.name == fault.name and f.robot == fault.robot for f in all) > 1:
        raise ValueError(f"{fault.text}: is asked for twice")
    if dry and fault.name in (*OF_LINK, *OF_VEHICLE, *OF_STATIONS):
        raise ValueError(f"{fault.text}: a dry run has no link and no vehicle")
    if fault.name in (*OF_PROCESS, *OF_BUS) and fault.robot:
        raise ValueError(f"{fault.text}: concerns all robots of the process; say it without a robot")
    if fault.name == "freeze" and fault.ends == inf:
        raise ValueError(f"{fault.text}: say for how many seconds, or nothing would ever thaw it")
    if fault.name == "clock-jump" and not fault.amount:
        raise ValueError(f"{fault.text}: say by how many seconds, such as clock-jump@60+3600")
    if fault.name == "clock-jump" and abs(fault.amount) > CENTURY:
        raise ValueError(f"{fault.text}: no calendar reaches so far; at most {CENTURY} seconds, a century")
    if fault.name == "freeze" and not hasattr(signal, "SIGSTOP"):
        raise ValueError(f"{fault.text}: this system cannot stop and continue processes")
    if fault.name == "disk-full" and os.name != "posix":
        raise ValueError(f"{fault.text}: this system cannot limit the size of files")
    if fault.robot and fault.name in OF_LINK:
        others = [robot for robot, url in urls.items() if url == urls[fault.robot] and robot != fault.robot]
        if others:
            raise ValueError(
                f"{fault.text}: the link is that of {', '.join(map(ascii, others))}, too;"
                " say it without a robot"
            )
