"""A port with one or several vehicles behind it: one thread reads it, all vehicles send through it."""

from __future__ import annotations

import threading
import time
from collections import Counter
from typing import Any, Protocol

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_runtime.clock import Clock
from mmrs_runtime.ports import Address, Port

from .ourselves import GROUND_COMPONENT, GROUND_SYSTEM
from .signing import Signed, Signer
from .stations import is_station

Message = Any

HEARTBEAT_SECONDS = 1.0
GLANCE_SECONDS = 0.2
SENDERS = 64
"""From how many addresses frames are put together at once; beyond, the oldest is forgotten."""

NO_VEHICLES = frozenset({6, 18, 26, 27, 30, 31, 32, 33, 34, 36, 37, 38, 39, 40, 41, 42})
"""MAV_TYPEs of ground stations and devices: some gimbals say that they had an autopilot, a generic one."""

FORGOTTEN_SECONDS = 60.0
"""Real seconds for which heartbeats still go to an address that has fallen silent, unless it was the last."""


class Ear(Protocol):
    """What listens to one vehicle of a radio."""

    system: int
    component: int

    @property
    def given_up(self) -> bool:
        """Return whether heartbeats to the vehicle are withheld."""
        ...

    def meets(self, heartbeat: Message) -> bool:
        """Return whether an autopilot's heartbeat is that of the vehicle that is waited for."""
        ...

    def hears(self, message: Message, sender: Address | None) -> None:
        """Take a message from the vehicle's system, or from the radio itself (RADIO_STATUS)."""
        ...

    def speaks_from(self, sender: Address | None) -> bool:
        """Return whether that is where the vehicle speaks from."""
        ...

    def hears_station(self, heartbeat: Message) -> None:
        """Take the heartbeat of a ground station."""
        ...

    def learns(self, reason: str) -> None:
        """Note that no more messages will come."""
        ...


class Radio:
    """Packs and parses for all vehicles behind a port.

    Attributes:
        dropped: how many frames were not used, by type and reason.
        received: the systems of all autopilots received.
        trouble: the port's last error; empty once messages arrive again.
    """

    def __init__(self, port: Port, clock: Clock, signer: Signer | None = None) -> None:
        """Read a port.

        Args:
            port: open; closed with the last of its vehicles.
            clock: of the run.
            signer: None: frames are not signed, and signatures are not looked at.
        """
        self.clock = clock
        self.dropped: Counter[str] = Counter()
        self.received: set[int] = set()
        self.trouble = ""
        self._port = port
        self._signer = signer
        self._packers: dict[int, Any] = {}
        self._parsers: dict[Address | None, Any] = {}
        self._sending = threading.Lock()
        self._ears: tuple[Ear, ...] = ()
        self._speakers: dict[Address | None, float] = {}
        self._beaten = float("-inf")
        self._open = True
        self._ended = ""
        self._thread = threading.Thread(target=self._listen, name="mavlink reader", daemon=True)
        self._thread.start()

    @property
    def listening(self) -> bool:
        """Return whether something may still come."""
        return self._open and self._thread.is_alive()

    def join(self, ear: Ear) -> None:
        """Start receiving from a vehicle.

        Raises:
            ValueError: that system is received already.
        """
        with self._sending:
            if ear.system and any(other.system == ear.system for other in self._ears):
                raise ValueError(f"system {ear.system} has two robots on one link")
            self._ears = (*self._ears, ear)
        if self._ended:
            ear.learns(self._ended)

    def leave(self, ear: Ear) -> None:
        """Listen to a vehicle no longer; the port is closed with the last."""
        with self._sending:
            self._ears = tuple(other for other in self._ears if other is not ear)
            last = not self._ears and self._open
            self._open = self._open and not last
        if last:
            if threading.current_thread() is not self._thread:
                self._thread.join()
            self._port.close()
            if self._signer is not None:
                self._signer.save(at_once=True)

    def send(self, message: Message, to: Address | None, system: int = GROUND_SYSTEM) -> None:
        """Send one message; if the port does not take it, it is lost as on a poor link.

        Args:
            message: to send.
            to: receiver; None: the peer at the other end.
            system: that it comes from.
        """
        with self._sending:
            data = self._packed(message, system)
            try:
                self._port.write(data, to)
            except OSError as error:
                self.trouble = error.strerror or str(error)

    def claimed(self, system: int) -> bool:
        """Return whether some robot has that vehicle."""
        return any(ear.system == system for ear in self._ears)

    def _parser(self, system: int = GROUND_SYSTEM) -> Any:
        if self._signer is not None:
            return Signed(self._signer, system, GROUND_COMPONENT)
        return mavlink.MAVLink(None, srcSystem=system, srcComponent=GROUND_COMPONENT)

    def _packed(self, message: Message, system: int) -> bytes:
        if (packer := self._packers.get(system)) is None:
            packer = self._packers[system] = self._parser(system)
        data = packer.packed(message) if self._signer is not None else bytes(message.pack(packer))
        packer.seq = (packer.seq + 1) % 256
        return data

    def _listen(self) -> None:
        try:
            while self._open:
                self._beat()
                data, sender = self._port.read(min(self.clock.real(HEARTBEAT_SECONDS), GLANCE_SECONDS))
                for message in self._parse(data, sender):
                    self._sort(message, sender)
                if self._signer is not None:
                    self._signer.save()
        except OSError as error:
            self._end(f"the link has broken: {error.strerror or error}")
        except Exception as error:
            self._end(f"the reader of the link fails: {error!r}")
            raise

    def _end(self, reason: str) -> None:
        self.trouble = self._ended = reason
        for ear in self._ears:
            ear.learns(reason)

    def _parse(self, data: bytes, sender: Address | None) -> list[Message]:
        if not data:
            return []
        if sender not in self._parsers:
            if len(self._parsers) >= SENDERS:
                del self._parsers[next(iter(self._parsers))]
            self._parsers[sender] = self._parser()
            self._parsers[sender].robust_parsing = True
        return self._parsers[sender].parse_buffer(data) or []

    def _sort(self, message: Message, sender: Address | None) -> None:
        kind = message.get_type()
        if kind == "BAD_DATA":
            self.dropped[_why_unread(message)] += 1
        elif kind.startswith("UNKNOWN"):
            self.dropped[f"message {kind.removeprefix('UNKNOWN_')}: unknown"] += 1
        elif kind == "RADIO_STATUS":
            for ear in self._ears:
                if ear.component:
                    ear.hears(message, sender)
        else:
            self._deliver(message, sender)

    def _deliver(self, message: Message, sender: Address | None) -> None:
        system = message.get_srcSystem()
        met, self._speakers[sender] = sender not in self._speakers, time.monotonic()
        self.trouble = ""
        if is_autopilot(message):
            self.received.add(system)
            self._introduce(message)
        if met:
            # Whoever has just come may answer a lost link, until it hears the first heartbeat.
            self.send(_heartbeat(), sender)
        if is_station(message) and not self._is_own(message) and not self.claimed(system):
            self._hear_station(message, sender)
            return
        for ear in self._ears:
            if ear.system == system and ear.component:
                ear.hears(message, sender)
                return
        if all(ear.component for ear in self._ears):
            # Before everybody has met their vehicle, nobody can say whose this is.
            self.dropped[f"{message.get_type()}: from system {system}, which is not a robot's"] += 1

    def _is_own(self, message: Message) -> bool:
        """Return whether a message says that a program of ours has sent it, as one that came back."""
        return (message.get_srcSystem(), message.get_srcComponent()) == (GROUND_SYSTEM, GROUND_COMPONENT)

    def _hear_station(self, heartbeat: Message, sender: Address | None) -> None:
        """Pass it on to those whose vehicles have forwarded it, or to all if it came directly."""
        for ear in [ear for ear in self._ears if ear.speaks_from(sender)] or self._ears:
            ear.hears_station(heartbeat)

    def _introduce(self, heartbeat: Message) -> None:
        system = heartbeat.get_srcSystem()
        if any(ear.system == system and ear.component for ear in self._ears):
            return
        for ear in self._ears:
            if not ear.component and ear.meets(heartbeat):
                return

    def _beat(self) -> None:
        if self.clock.now() - self._beaten < HEARTBEAT_SECONDS:
            return
        self._beaten = self.clock.now()
        now = time.monotonic()
        speakers = sorted(self._speakers.items(), key=lambda entry: entry[1])
        recent = [each for each in speakers if now - each[1] < FORGOTTEN_SECONDS]
        self._speakers = dict((recent or speakers[-1:])[-SENDERS:])
        for sender in self._speakers or (None,):
            if self._is_to_hear(sender):
                self.send(_heartbeat(), sender)

    def _is_to_hear(self, sender: Address | None) -> bool:
        """Return whether any known peer there is to receive heartbeats."""
        there = [ear for ear in self._ears if ear.speaks_from(sender)] or self._ears
        return not there or not all(ear.given_up for ear in there)


def is_autopilot(message: Message) -> bool:
    """Return whether a message is the heartbeat of an autopilot, not of a station, camera or gimbal."""
    return bool(
        message.get_type() == "HEARTBEAT"
        and message.type not in NO_VEHICLES
        and message.autopilot != mavlink.MAV_AUTOPILOT_INVALID
    )


def _heartbeat() -> Message:
    return mavlink.MAVLink_heartbeat_message(
        mavlink.MAV_TYPE_GCS, mavlink.MAV_AUTOPILOT_INVALID, 0, 0, mavlink.MAV_STATE_ACTIVE, 3
    )


def _why_unread(message: Message) -> str:
    reason = str(message.reason)
    return "not signed with the key" if "signature" in reason.lower() else "unreadable"
