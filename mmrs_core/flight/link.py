"""A MAVLink link: one thread reads it and keeps the latest of everything; anybody may send."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, TypeVar

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from .clock import Clock
from .faults import LINK_LOST, Fault
from .ports import Port
from .signing import sign

Message = Any
Found = TypeVar("Found")
Observer = Callable[[Message, bool], None]
"""Is given every message and whether it goes out; called from whatever thread sends or reads."""

GROUND_SYSTEM = 255
GROUND_COMPONENT = 190
HEARTBEAT_SECONDS = 1.0
GLANCE_SECONDS = 0.2
TRIES = 5


class Link:
    """Talks to one vehicle.

    Attributes:
        guard: called again and again during every wait; raises what should end it.
        system, component: the vehicle's address; 0 until it was heard of.
        garbled: how many frames could not be read, or were not signed as they should be.
        trouble: what the port has last complained of; empty once the vehicle is heard again.
        tries: how often to send at most what is not answered.
    """

    def __init__(self, port: Port, clock: Clock, system: int = 0, key: bytes | None = None) -> None:
        """Listen to a vehicle.

        Args:
            port: open.
            clock: of the run.
            system: of the vehicle; 0 is whichever speaks first.
            key: to sign what is sent with; what comes must then be signed with it, too.
        """
        self.clock = clock
        self.guard: Callable[[], None] = lambda: None
        self.system = system
        self.component = 0
        self.garbled = 0
        self.trouble = ""
        self.tries = TRIES
        self._wanted = system
        self._port = port
        self._mav = mavlink.MAVLink(port, srcSystem=GROUND_SYSTEM, srcComponent=GROUND_COMPONENT)
        self._mav.robust_parsing = True
        if key is not None:
            sign(self._mav, key)
        self._sending = threading.Lock()
        self._changed = threading.Condition()
        self._latest: dict[str, tuple[Message, float]] = {}
        self._inboxes: list[tuple[frozenset[str], deque[Message]]] = []
        self._observers: tuple[Observer, ...] = ()
        self._heard: float | None = None
        self._beaten = float("-inf")
        self._open = True
        self._ended = False
        self._thread = threading.Thread(target=self._listen, name="mavlink reader", daemon=True)
        self._thread.start()

    def close(self) -> None:
        """Stop listening."""
        self._open = False
        self._thread.join()
        self._port.close()

    def observe(self, observer: Observer) -> None:
        """Have every message told from now on: what is sent, and what the vehicle says.

        An observer must neither raise nor wait: it runs in the thread that reads, or that sends.
        """
        self._observers = (*self._observers, observer)

    def send(self, message: Message) -> None:
        """Send one message; where the port does not take it, it is lost like any on a poor link."""
        for observer in self._observers:
            observer(message, True)
        with self._sending:
            try:
                self._mav.send(message)
            except OSError as error:
                self.trouble = error.strerror or str(error)

    def latest(self, kind: str) -> Message | None:
        """Return the last message of that name from the vehicle."""
        found = self._latest.get(kind)
        return found[0] if found else None

    def since(self, kind: str) -> float:
        """Return how long ago the last message of that name came, in seconds; inf if none did."""
        found = self._latest.get(kind)
        return self.clock.now() - found[1] if found else float("inf")

    def silent_for(self) -> float:
        """Return for how many seconds the vehicle has not been heard; 0 before it was first heard."""
        return 0.0 if self._heard is None else self.clock.now() - self._heard

    def wait(self, test: Callable[[], Found | None], seconds: float) -> Found | None:
        """Return what the test finds as soon as it finds something; None if time runs out.

        Raises:
            Fault: the port has ended, so that nothing will come any more; or what the guard raises.
        """
        until = self.clock.now() + seconds
        while True:
            if self._ended:
                raise Fault(LINK_LOST, self.trouble)
            self.guard()
            with self._changed:
                found = test()
                left = until - self.clock.now()
                if found or left <= 0:
                    return found or None
                self._changed.wait(min(self.clock.real(left), GLANCE_SECONDS))

    @contextmanager
    def inbox(self, *kinds: str) -> Iterator[deque[Message]]:
        """Collect every message of these names from now on."""
        entry = (frozenset(kinds), deque[Message]())
        with self._changed:
            self._inboxes.append(entry)
        try:
            yield entry[1]
        finally:
            with self._changed:
                self._inboxes.remove(entry)

    def _listen(self) -> None:
        while self._open:
            self._beat()
            try:
                data = self._port.read(min(self.clock.real(HEARTBEAT_SECONDS), GLANCE_SECONDS))
            except OSError as error:
                self._end(f"the link has broken: {error.strerror or error}")
                return
            for message in self._mav.parse_buffer(data) or ():
                self._keep(message)

    def _end(self, reason: str) -> None:
        with self._changed:
            self.trouble, self._ended = reason, True
            self._changed.notify_all()

    def _beat(self) -> None:
        if self.clock.now() - self._beaten >= HEARTBEAT_SECONDS:
            self._beaten = self.clock.now()
            self.send(
                mavlink.MAVLink_heartbeat_message(
                    mavlink.MAV_TYPE_GCS, mavlink.MAV_AUTOPILOT_INVALID, 0, 0, mavlink.MAV_STATE_ACTIVE, 3
                )
            )

    def _keep(self, message: Message) -> None:
        kind = message.get_type()
        if kind == "BAD_DATA":
            self.garbled += 1
            return
        if kind == "HEARTBEAT" and message.type != mavlink.MAV_TYPE_GCS and not self.component:
            self._meet(message)
        if message.get_srcSystem() != self.system or message.get_srcComponent() != self.component:
            return
        for observer in self._observers:
            observer(message, False)
        with self._changed:
            self._heard = self.clock.now()
            self.trouble = ""
            self._latest[kind] = (message, self._heard)
            for kinds, collected in self._inboxes:
                if kind in kinds:
                    collected.append(message)
            self._changed.notify_all()

    def _meet(self, heartbeat: Message) -> None:
        if self._wanted in (0, heartbeat.get_srcSystem()):
            self.system = heartbeat.get_srcSystem()
            self.component = heartbeat.get_srcComponent()
