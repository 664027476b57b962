"""A connection of one node to a bus, over any interface that python-can has."""

from __future__ import annotations

import select
import socket
import sys
import threading
import time
from collections import Counter, deque
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from auv_vessel.wire.frame import Frame

if TYPE_CHECKING:
    from can import BusABC, Message

HOST, PORT, CHANNEL = "127.0.0.1", 29536, "can0"
MOST_WAITING = 4096
"""Frames that wait for a node that does not take them; the oldest go first."""

ECHOING = frozenset({"cantact", "gs_usb"})
"""Interfaces of adapters that one process holds, and that give back what it sends, marked as such.

Elsewhere a frame that was not received from outside may be another process's: Linux marks all frames of this
computer in that way. Own frames are not asked for, so none comes.
"""

ASKED = frozenset({"neovi"})
"""Interfaces that give back what they send unless they are asked not to."""

UNTOLD = frozenset({"udp_multicast"})
"""Interfaces that give back what they send, indistinguishable from what others send."""

ERRORS = {
    "overrun": "frames that were not taken in time",
    "refused": "frames that the interface did not take",
    "remote": "remote frames",
    "error": "error frames",
    "long": "frames longer than those of classic CAN",
    "echo": "own frames that the adapter gave back",
    "receiving": "readings that failed",
}
"""What may not go well at a port, by sort."""

_POLL, _TRIES = 0.1, 5
_SEND = 1.0
"""Seconds for which a hub may take nothing."""


class PortError(OSError):
    """There is no bus, or there is none any more."""


def complain(text: str) -> None:
    """Write a line to standard error."""
    print(text, file=sys.stderr, flush=True)


class Port:
    """A connection to a bus; a thread of its own reads from it.

    Attributes:
        errors: what did not go well: how often, by sort of `ERRORS`.
    """

    def __init__(
        self,
        bus: BusABC,
        most_waiting: int = MOST_WAITING,
        *,
        echoes: bool = False,
        say: Callable[[str], None] = complain,
    ) -> None:
        """Begin to read; the port closes the bus when it is closed.

        Args:
            echoes: whether what the interface says was not received is what this port itself has sent.
            say: receives each sort of error when it first happens, and all when the port is closed.
        """
        self._echoes, self._say = echoes, say
        self.errors: Counter[str] = Counter()
        self._bus = bus
        self._frames: deque[Frame] = deque(maxlen=most_waiting)
        self._changed = threading.Condition()
        self._gone, self._reported = "", False
        self._reader = threading.Thread(target=self._read, name="can-reader", daemon=True)
        self._reader.start()

    def send(self, frame: Frame) -> None:
        """Put a frame on the bus; one that the interface does not take now is counted, not kept.

        Raises:
            PortError: the bus is gone.
            ValueError: the frame is none of classic CAN; python-can would cut its identifier.
        """
        from can import CanError, Message

        if frame.id >> (29 if frame.extended else 11) or len(frame.data) > 8:
            raise ValueError(f"no frame of classic CAN: {frame}")
        self._check()
        message = Message(arbitration_id=frame.id, data=frame.data, is_extended_id=frame.extended)
        try:
            self._bus.send(message)
        except CanError:
            self._count("refused")
        except OSError as error:
            self._leave(f"cannot be written to: {error}")
            self._check()

    def receive(self, timeout: float) -> Frame | None:
        """Return the next frame, or None if there was none for `seconds`.

        Raises:
            PortError: the bus is gone, and all that came from it was returned.
        """
        with self._changed:
            if not self._frames:
                if timeout > 0.0:
                    self._changed.wait_for(lambda: self._frames or self._gone, timeout)
                if not self._frames:
                    self._check()
                    return None
            return self._frames.popleft()

    def close(self) -> None:
        """Leave the bus; idempotent."""
        self._leave("was closed")
        if self._reader is not threading.current_thread():
            self._reader.join()
        counts = ", ".join(f"{count} {sort}" for sort, count in sorted(self.errors.items()))
        if counts and not self._reported:
            self._reported = True
            self._say(f"errors of the bus: {counts}")

    def __enter__(self) -> Port:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _check(self) -> None:
        if self._gone:
            raise PortError(f"{self._bus.channel_info} {self._gone}")

    def _leave(self, why: str) -> None:
        with self._changed:
            self._gone = self._gone or why
            self._changed.notify_all()

    def _count(self, sort: str) -> None:
        self.errors[sort] += 1
        if self.errors[sort] == 1:
            self._say(f"errors of the bus: {ERRORS[sort]}")

    def _read(self) -> None:
        try:
            while not self._gone:
                self._take()
        finally:
            self._bus.shutdown()

    def _take(self) -> None:
        from can import CanError

        try:
            message = self._bus.recv(_POLL)
        except (CanError, OSError, ValueError):
            self._count("receiving")
            if _ended(self._bus):
                self._leave("has ended the connection")
            else:
                time.sleep(_POLL)
            return
        if message is None:
            if _ended(self._bus):
                self._leave("has ended the connection")
        elif self._echoes and not message.is_rx:
            self._count("echo")
        elif (odd := _oddity(message)) is not None:
            self._count(odd)
        else:
            self._keep(Frame(message.arbitration_id, bytes(message.data), message.is_extended_id))

    def _keep(self, frame: Frame) -> None:
        with self._changed:
            full = len(self._frames) == self._frames.maxlen
            self._frames.append(frame)
            self._changed.notify()
        if full:
            self._count("overrun")


def open_port(
    interface: str,
    channel: str = CHANNEL,
    *,
    bit_rate: int | None = None,
    patience: float = 5.0,
    most_waiting: int = MOST_WAITING,
    say: Callable[[str], None] = complain,
    **options: Any,
) -> Port:
    """Connect to a bus.

    Args:
        interface: as python-can calls it: ``virtual`` (within this process), ``socketcand`` (a hub),
            ``socketcan``, or that of a vendor's adapter.
        channel: of that interface; for ``socketcand`` also ``CHANNEL@HOST:PORT``.
        bit_rate: bits per second, for adapters that need it.
        patience: seconds to wait for a hub that is not there yet.
        say: receives errors of the bus, as in `Port`.
        options: of python-can's interface, such as ``host`` and ``port`` for ``socketcand``.

    Raises:
        PortError: there is no such bus.
        ValueError: there is no such interface, it gives back frames of its own, or a channel of a hub is
            misspelt.
    """
    if interface in UNTOLD or options.get("receive_own_messages"):
        raise ValueError(
            f"interface {interface!r} would give a node its own frames as if another had sent them"
        )
    if interface == "socketcand":
        return Port(_bus_of_hub(channel, patience, options), most_waiting, say=say)
    if bit_rate is not None:
        options["bitrate"] = bit_rate
    if interface in ASKED:
        options["receive_own_messages"] = False
    return Port(_bus(interface, channel, options), most_waiting, echoes=interface in ECHOING, say=say)


def _bus(interface: str, channel: str, options: dict[str, Any]) -> BusABC:
    from can import Bus, CanError, CanInterfaceNotImplementedError

    try:
        return Bus(interface=interface, channel=channel, **options)
    except CanInterfaceNotImplementedError as error:
        raise ValueError(f"interface {interface!r}: {error}") from error
    except (CanError, OSError, ImportError) as error:
        raise PortError(f"{interface} {channel}: {error}") from error


def _bus_of_hub(channel: str, patience: float, options: dict[str, Any]) -> BusABC:
    """Return a connection to a hub.

    python-can's client takes the hub's answer and frames that follow at once for one answer, and gives
    up: it is then replaced.
    """
    from can import CanError

    name, host, port = _address(channel, options.pop("host", HOST), options.pop("port", PORT))
    options.setdefault("tcp_tune", True)
    _await_hub(host, port, patience)
    for left in reversed(range(_TRIES)):
        try:
            bus = _bus("socketcand", name, {"host": host, "port": port, **options})
            _limit(bus)
            return bus
        except PortError as error:
            if not left or not isinstance(error.__cause__, CanError):
                raise
    raise AssertionError("unreachable")


def _address(channel: str, host: str, port: int) -> tuple[str, str, int]:
    name, at, rest = channel.partition("@")
    if not at:
        return name, host, port
    host, colon, number = rest.rpartition(":")
    if not colon or not host or not number.isdecimal() or len(number) > 9:
        raise ValueError(f"channel {channel!r}: expected CHANNEL@HOST:PORT")
    return name, host, int(number)


def _await_hub(host: str, port: int, patience: float) -> None:
    until = time.monotonic() + patience
    while True:
        try:
            socket.create_connection((host, port), timeout=max(patience, 0.1)).close()
            return
        except OSError as error:
            if time.monotonic() >= until:
                raise PortError(f"no hub at {host}:{port}: {error.strerror or error}") from error
            time.sleep(0.05)


def _limit(bus: BusABC) -> None:
    """Let a connection to a hub that takes nothing for `_SEND` seconds fail, rather than hold up a node."""
    connection = _connection(bus)
    if connection is not None:
        connection.settimeout(_SEND)
        if hasattr(socket, "TCP_USER_TIMEOUT"):
            connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_USER_TIMEOUT, int(_SEND * 1000))


def _connection(bus: BusABC) -> socket.socket | None:
    """Return the socket of python-can's client of a hub, which it keeps to itself."""
    found = getattr(bus, "_SocketCanDaemonBus__socket", None)
    return found if isinstance(found, socket.socket) else None


def _ended(bus: BusABC) -> bool:
    """Return whether a hub has ended the connection, which python-can's client does not tell."""
    connection = _connection(bus)
    if connection is None:
        return False
    try:
        readable, _, _ = select.select([connection], [], [], 0.0)
        return bool(readable) and connection.recv(1, socket.MSG_PEEK) == b""
    except (OSError, ValueError):
        return True


def _oddity(message: Message) -> str | None:
    """Return what a message is if it is not a data frame of classic CAN."""
    if message.is_error_frame:
        return "error"
    if message.is_remote_frame:
        return "remote"
    return "long" if message.is_fd or len(message.data) > 8 else None
