"""A bus for several processes of one machine: a hub that speaks the socketcand protocol.

It passes every frame on to all others on its channel, in the order in which it comes. Unlike CAN it knows
no arbitration, no bit rate, no acknowledgement, no error frame and no bus-off; frames do not collide, and
none is sent again. Loss, delay and corruption are configured.
"""

from __future__ import annotations

import asyncio
import ipaddress
import socket
import time
from collections import Counter, deque
from collections.abc import Callable
from dataclasses import dataclass
from random import Random

from auv_vessel.wire.frame import Frame
from auv_vessel.wire.socketcand import CHANNEL, ECHO, HI, OK, error_word, frame_of, frame_word, words_of

MOST_CLIENTS, MOST_BEHIND, MOST_WRONG, MOST_DELAYED = 256, 262_144, 100, 100_000
"""Clients; bytes that wait for a client that does not read, after which it misses frames; words that a client
may send wrongly before it is disconnected; frames in transit at a time."""

MOST_RATE, _BURST = 8_000, 80
"""Words read from a client in a second, about the frames that a CAN of 1 Mbit/s carries, and at once.

A client that sends more is read no faster: it alone has to wait.
"""

GREETING_SECONDS = 5.0
"""Seconds from a client's connection to ``rawmode``: one that never joins the bus takes no room."""

_SYSTEM_BUFFER = 65_536
"""Bytes that the system buffers for a client besides: a slow one receives nothing older than need be."""

_HOLD = 0.03
"""Seconds between the answer to ``rawmode`` and the first frame: python-can's client reads them as one."""

Log = Callable[[float, str, Frame], None]


@dataclass(frozen=True, slots=True)
class Troubles:
    """Faults of frames in transit, the same for all receivers.

    Attributes:
        loss: fraction of frames to drop.
        delay: latency of each frame, seconds; they stay in order.
        corruption: part of the frames with data in which one to three bits are wrong.
    """

    loss: float = 0.0
    delay: float = 0.0
    corruption: float = 0.0

    def __post_init__(self) -> None:
        for what in ("loss", "corruption"):
            if not 0.0 <= getattr(self, what) <= 1.0:
                raise ValueError(f"{what} {getattr(self, what)!r} is not 0 to 1")
        if not 0.0 <= self.delay <= 60.0:
            raise ValueError(f"delay {self.delay!r} is not 0 to 60 s")


class Hub:
    """A hub; its methods are called from its event loop.

    Attributes:
        troubles: may be changed at any time.
        greeting_seconds: that a client has to open a channel and to ask for ``rawmode``.
        counts: ``frames``, ``lost``, ``corrupted``, ``missed`` (by clients that read too slowly),
            ``overdue`` (more were on their way than there is room for), ``slowed`` (times that a client had
            to wait), ``wrong`` (words), ``refused`` (clients), ``clients``.
    """

    def __init__(
        self,
        troubles: Troubles | None = None,
        seed: int = 0,
        log: Log | None = None,
        spared: Callable[[Frame], bool] = lambda frame: False,
        *,
        greeting_seconds: float = GREETING_SECONDS,
    ) -> None:
        """Prepare; nothing listens yet. Frames that are `spared` pass at once, whatever the troubles."""
        self.greeting_seconds = greeting_seconds
        self.troubles = troubles or Troubles()
        self.counts: Counter[str] = Counter()
        self._random = Random(seed)
        self._log, self._spared = log, spared
        self._clients: set[_Client] = set()
        self._delayed: deque[tuple[float, _Client, str, Frame]] = deque()
        self._server: asyncio.Server | None = None

    async def start(self, host: str = "127.0.0.1", port: int = 0) -> int:
        """Listen; return the port, which the system chooses for 0.

        Raises:
            OSError: the port is taken, or there is no such address.
        """
        loop = asyncio.get_running_loop()
        self._server = await loop.create_server(lambda: _Client(self), host, port, backlog=MOST_CLIENTS)
        number: int = self._server.sockets[0].getsockname()[1]
        return number

    async def stop(self) -> None:
        """Send all clients away and listen no more."""
        if self._server is not None:
            self._server.close()
        for client in tuple(self._clients):
            client.leave()
        if self._server is not None:
            await self._server.wait_closed()

    @property
    def clients(self) -> int:
        """How many are connected."""
        return len(self._clients)

    def join(self, client: _Client) -> bool:
        """Take a client; return whether there is room for it."""
        if len(self._clients) >= MOST_CLIENTS:
            self.counts["refused"] += 1
            return False
        self._clients.add(client)
        self.counts["clients"] += 1
        return True

    def leave(self, client: _Client) -> None:
        """Forget a client; its frames in transit remain."""
        self._clients.discard(client)

    def take(self, sender: _Client, frame: Frame) -> None:
        """Pass a frame on to the others on the sender's channel, with its troubles."""
        self.counts["frames"] += 1
        if self._spared(frame):
            self._deliver(sender, sender.channel, frame)
            return
        if self._random.random() < self.troubles.loss:
            self.counts["lost"] += 1
            return
        if frame.data and self._random.random() < self.troubles.corruption:
            self.counts["corrupted"] += 1
            frame = corrupted(frame, self._random)
        if not self.troubles.delay and not self._delayed:
            self._deliver(sender, sender.channel, frame)
        elif len(self._delayed) >= MOST_DELAYED:
            self.counts["overdue"] += 1
        else:
            self._put_off(sender, frame)

    def _put_off(self, sender: _Client, frame: Frame) -> None:
        loop = asyncio.get_running_loop()
        last = self._delayed[-1][0] if self._delayed else 0.0
        due = max(loop.time() + self.troubles.delay, last)
        self._delayed.append((due, sender, sender.channel, frame))
        if len(self._delayed) == 1:
            loop.call_at(due, self._deliver_due)

    def _deliver_due(self) -> None:
        loop = asyncio.get_running_loop()
        while self._delayed and self._delayed[0][0] <= loop.time():
            _, sender, channel, frame = self._delayed.popleft()
            self._deliver(sender, channel, frame)
        if self._delayed:
            loop.call_at(self._delayed[0][0], self._deliver_due)

    def _deliver(self, sender: _Client, channel: str, frame: Frame) -> None:
        now = time.time()
        if self._log is not None:
            self._log(now, channel, frame)
        word = frame_word(frame, now)
        for client in self._clients:
            if client is not sender and client.channel == channel and not client.tell(word):
                self.counts["missed"] += 1


class _Client(asyncio.Protocol):
    """A connection to a hub.

    Attributes:
        channel: the client's; empty until it has opened one.
    """

    def __init__(self, hub: Hub) -> None:
        self.channel = ""
        self._hub = hub
        self._transport: asyncio.Transport | None = None
        self._buffer = bytearray()
        self._words: deque[list[str]] = deque()
        self._allowed, self._since = float(_BURST), 0.0
        self._waits = False
        self._held: bytearray | None = None
        self._raw = False
        self._greeting: asyncio.TimerHandle | None = None
        self._wrong = 0

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        assert isinstance(transport, asyncio.Transport)
        self._transport = transport
        connection = transport.get_extra_info("socket")
        connection.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, _SYSTEM_BUFFER)
        if self._hub.join(self):
            transport.write(HI)
            late = self._dismiss_unless_raw
            self._greeting = asyncio.get_running_loop().call_later(self._hub.greeting_seconds, late)
        else:
            self._refuse(f"there are {MOST_CLIENTS} clients")
            self.leave()

    def connection_lost(self, exc: Exception | None) -> None:
        self._transport = None
        if self._greeting is not None:
            self._greeting.cancel()
        self._hub.leave(self)

    def _dismiss_unless_raw(self) -> None:
        if not self._raw:
            self._refuse(f"no channel and rawmode within {self._hub.greeting_seconds:g} s")
            self.leave()

    def data_received(self, data: bytes) -> None:
        self._buffer += data
        try:
            self._words += words_of(self._buffer)
        except ValueError as error:
            self._refuse(str(error))
            self.leave()
            return
        if not self._waits:
            self._hear_some()

    def _hear_some(self) -> None:
        """Read as many words as the client may send now; keep it waiting with the others."""
        loop = asyncio.get_running_loop()
        self._allowed = min(float(_BURST), self._allowed + (loop.time() - self._since) * MOST_RATE)
        self._since = loop.time()
        self._waits = False
        while self._words and self._allowed >= 1.0:
            if self._transport is None or self._transport.is_closing():
                return
            self._allowed -= 1.0
            self._hear(self._words.popleft())
        if self._transport is None or self._transport.is_closing():
            return
        if self._words:
            self._waits = True
            self._hub.counts["slowed"] += 1
            self._transport.pause_reading()
            loop.call_later(_BURST / MOST_RATE, self._hear_some)
        else:
            self._transport.resume_reading()

    def tell(self, word: bytes) -> bool:
        """Send a frame to the client, if it reads; return False if it must miss it."""
        if not self._raw or self._transport is None or self._transport.is_closing():
            return True
        behind = self._transport.get_write_buffer_size() + len(self._held or b"")
        if behind > MOST_BEHIND:
            return False
        if self._held is None:
            self._transport.write(word)
        else:
            self._held += word
        return True

    def leave(self) -> None:
        """End the connection at once; what was not read yet is let go if the client reads nothing."""
        if self._transport is None:
            return
        if self._transport.get_write_buffer_size():
            self._transport.abort()
        else:
            self._transport.close()

    def _hear(self, parts: list[str]) -> None:
        match parts:
            case ["send", _, _, *_] if self._raw:
                try:
                    frame = frame_of(parts[1:])
                except ValueError as error:
                    self._refuse(str(error))
                else:
                    self._hub.take(self, frame)
            case ["open", name] if not self.channel and CHANNEL.fullmatch(name):
                self.channel = name
                self._answer(OK)
            case ["rawmode"] if self.channel and not self._raw:
                self._answer(OK)
                self._raw, self._held = True, bytearray()
                asyncio.get_running_loop().call_later(_HOLD, self._let_go)
            case ["echo"]:
                self._answer(ECHO)
            case _:
                self._refuse("unknown command, or not now")

    def _let_go(self) -> None:
        held, self._held = self._held, None
        if self._transport is not None and held:
            self._transport.write(held)

    def _answer(self, word: bytes) -> None:
        if self._transport is not None and self._transport.get_write_buffer_size() <= MOST_BEHIND:
            self._transport.write(word)

    def _refuse(self, why: str) -> None:
        self._hub.counts["wrong"] += 1
        self._wrong += 1
        self._answer(error_word(why, time.time()))
        if self._wrong >= MOST_WRONG:
            self.leave()


def corrupted(frame: Frame, random: Random) -> Frame:
    """Return a frame with one to three bits of its data wrong."""
    number = int.from_bytes(frame.data, "little")
    for bit in random.sample(range(8 * len(frame.data)), random.randint(1, 3)):
        number ^= 1 << bit
    return Frame(frame.id, number.to_bytes(len(frame.data), "little"), frame.extended)


def is_loopback(host: str) -> bool:
    """Return whether only this machine reaches an address."""
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return host == "localhost"


def log_line(now: float, channel: str, frame: Frame) -> str:
    """Return a line of a log as can-utils' candump writes it, which python-can reads."""
    id = f"{frame.id:08X}" if frame.extended else f"{frame.id:03X}"
    return f"({now:.6f}) {channel} {id}#{frame.data.hex().upper()}\n"
