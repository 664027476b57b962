"""Machines on one machine: network namespaces, joined by a switch that loses, delays and doubles frames.

It needs root, ``ip`` and ``/dev/net/tun``. Each machine has an address and a monotonic clock of its own.
"""

import fcntl
import heapq
import os
import random
import select
import struct
import subprocess
import threading
import time
from dataclasses import dataclass
from itertools import count
from shutil import which

_MAKE = 0x400454CA
_TAP = 0x0002 | 0x1000
_LONGEST = 65_536
_CLOCK_STEP = 5_000


def why_not() -> str:
    """Return why there can be no machines here; empty: there can."""
    if os.geteuid() != 0:
        return "network namespaces need root"
    if which("ip") is None or which("unshare") is None:
        return "network namespaces need ip and unshare"
    if not os.access("/dev/net/tun", os.W_OK):
        return "the switch needs /dev/net/tun"
    tried = subprocess.run(["unshare", "--net", "--time", "true"], capture_output=True)
    return "" if tried.returncode == 0 else "no network namespaces can be made here"


@dataclass(frozen=True, slots=True)
class Way:
    """What happens to frames on their way from one machine to another.

    Attributes:
        delay, jitter: seconds; frames overtake each other. loss, doubled: shares of the frames.
        rate: bytes a second; 0: no limit. backlog: seconds of it that wait; more is lost.
    """

    delay: float = 0.0
    jitter: float = 0.0
    loss: float = 0.0
    doubled: float = 0.0
    rate: float = 0.0
    backlog: float = 2.0


class Machines:
    """Machines 0, 1, … with addresses 10.77.0.1, 10.77.0.2, …; to be closed."""

    def __init__(self, size: int, seed: int = 0) -> None:
        """Make them, all joined."""
        self._chance = random.Random(seed)
        self._mark = f"mm{os.getpid()}"
        self._ways: dict[tuple[int, int], Way | None] = {}
        self._busy_until: dict[tuple[int, int], float] = {}
        self._due: list[tuple[float, int, int, bytes]] = []
        self._number = count()
        self._places: dict[bytes, int] = {}
        self._over = threading.Event()
        self._taps = [self._machine(number) for number in range(size)]
        self._thread = threading.Thread(target=self._switch, daemon=True)
        self._thread.start()

    def name(self, number: int) -> str:
        """Return the name of a machine's network namespace."""
        return f"{self._mark}-{number}"

    def address(self, number: int) -> str:
        """Return the address that a machine has at first."""
        return f"10.77.0.{number + 1}"

    def way(self, way: Way | None, *machines: int) -> None:
        """Have frames from, to and between machines go this way; None: not at all."""
        for one in machines:
            for other in range(len(self._taps)):
                self._ways[one, other] = self._ways[other, one] = way

    def split(self, *islands: tuple[int, ...]) -> None:
        """Have only machines of one island reach each other."""
        island = {number: each for each, island in enumerate(islands) for number in island}
        for one, mine in island.items():
            for other, others in island.items():
                self._ways[one, other] = Way() if mine == others else None

    def heal(self) -> None:
        """Join all machines again, with nothing in the way."""
        self._ways.clear()

    def command(self, number: int, *words: str) -> list[str]:
        """Return the command line that has a machine do something."""
        offset = str(_CLOCK_STEP * (number + 1))
        own = ["unshare", "--time", "--monotonic", offset, "--boottime", offset, "--"]
        return ["ip", "netns", "exec", self.name(number), *own, *words]

    def link(self, number: int, *words: str) -> None:
        """Change the interface of a machine, as ``ip link set dev lan`` does."""
        _ip("-n", self.name(number), "link", "set", "dev", "lan", *words)

    def move(self, number: int, address: str) -> None:
        """Give a machine another address, and none besides."""
        _ip("-n", self.name(number), "address", "flush", "dev", "lan")
        _ip("-n", self.name(number), "address", "add", f"{address}/24", "dev", "lan")

    def kill(self, number: int) -> None:
        """End all processes of a machine as a power cut does."""
        found = subprocess.run(["ip", "netns", "pids", self.name(number)], capture_output=True, text=True)
        for pid in found.stdout.split():
            try:
                os.kill(int(pid), 9)
            except ProcessLookupError:
                continue

    def close(self) -> None:
        """End all processes of all machines, and the machines."""
        self._over.set()
        self._thread.join()
        for number, tap in enumerate(self._taps):
            self.kill(number)
            os.close(tap)
            _ip("netns", "delete", self.name(number))

    def _machine(self, number: int) -> int:
        name, link = self.name(number), f"{self._mark}.{number}"
        _ip("netns", "add", name)
        tap = os.open("/dev/net/tun", os.O_RDWR | os.O_NONBLOCK)
        fcntl.ioctl(tap, _MAKE, struct.pack("16sH22x", link.encode(), _TAP))
        _ip("link", "set", "dev", link, "netns", name)
        _ip("-n", name, "link", "set", "dev", link, "name", "lan")
        _ip("-n", name, "address", "add", f"{self.address(number)}/24", "dev", "lan")
        for each in ("lo", "lan"):
            _ip("-n", name, "link", "set", "dev", each, "up")
        # Multicast needs somewhere to go.
        _ip("-n", name, "route", "add", "default", "dev", "lan")
        return tap

    def _switch(self) -> None:
        poll = select.poll()
        for tap in self._taps:
            poll.register(tap, select.POLLIN)
        ports = {tap: number for number, tap in enumerate(self._taps)}
        while not self._over.is_set():
            left = self._due[0][0] - time.monotonic() if self._due else 0.05
            for tap, _ in poll.poll(max(0.0, min(left, 0.05)) * 1e3):
                self._take(ports[tap], tap)
            self._deliver()

    def _take(self, source: int, tap: int) -> None:
        try:
            frame = os.read(tap, _LONGEST)
        except OSError:
            return  # its interface is down
        self._places[frame[6:12]] = source
        known = self._places.get(frame[:6])
        others = [known] if known is not None else range(len(self._taps))
        for target in others:
            if target != source:
                self._send(source, target, frame)

    def _send(self, source: int, target: int, frame: bytes) -> None:
        way = self._ways.get((source, target), Way())
        if way is None:
            return
        for _ in range(2 if self._chance.random() < way.doubled else 1):
            if self._chance.random() < way.loss:
                continue
            now = time.monotonic()
            sent = now
            if way.rate:
                sent = max(now, self._busy_until.get((source, target), now)) + len(frame) / way.rate
                if sent > now + way.backlog:
                    continue
                self._busy_until[source, target] = sent
            at = sent + way.delay + self._chance.uniform(0.0, way.jitter)
            heapq.heappush(self._due, (at, next(self._number), target, frame))

    def _deliver(self) -> None:
        while self._due and self._due[0][0] <= time.monotonic():
            _, _, target, frame = heapq.heappop(self._due)
            try:
                os.write(self._taps[target], frame)
            except OSError:
                continue  # its interface is down, or its queue is full


def _ip(*words: str) -> None:
    subprocess.run(["ip", *words], check=True)
