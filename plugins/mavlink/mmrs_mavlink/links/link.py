"""A link to one vehicle: what it says, waits for more of it, and what is sent to it."""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Callable, Iterator, Mapping
from contextlib import AbstractContextManager
from math import inf
from typing import Any, TypeVar

from mmrs_runtime.clock import Clock
from mmrs_runtime.faults import LINK_LOST, FaultError
from mmrs_runtime.ports import Address, Port

from ..profiles import ARDUCOPTER, VehicleProfile, on_autopilot
from .identity import LATE_MILLISECONDS, Identity
from .messages import Messages
from .radio import GLANCE_SECONDS, Radio, is_autopilot
from .retries import Retries
from .roaming import Roaming
from .signing import Signer
from .stations import Stations

Message = Any
Found = TypeVar("Found")
Observer = Callable[[Message, bool], None]
"""Is given every message and whether it goes out; called from whatever thread sends or reads."""

FORSAKEN_SECONDS = 600.0
"""Silence after which a vehicle counts as lost, where no policy has decided before."""

LEAST_SECONDS = 0.5
"""Real seconds for an answer at least, unless less was asked for."""

GAP_SECONDS, LEAST_GAP_SECONDS = 2.0, 0.5
"""Silence of the vehicle, of the run and real, during which ground stations could not be received."""

TELL_BOOT = frozenset({"GLOBAL_POSITION_INT", "LOCAL_POSITION_NED", "SYSTEM_TIME", "ATTITUDE"})


def nobody() -> None:
    """Watch over nothing."""


class Link:
    """Communicates with one vehicle.

    Attributes:
        guard: called repeatedly during every wait; raises what should end it.
        system, component: the vehicle's address; 0 before its first message.
        retries: how often, and how long apart, to send what is not answered.
        stations: ground stations received over the link.
    """

    def __init__(
        self,
        port: Port | Radio,
        clock: Clock,
        system: int = 0,
        key: bytes | None = None,
        retries: Retries | None = None,
    ) -> None:
        """Listen to a vehicle.

        Args:
            port: open, for this vehicle alone; or a radio, which robots may share.
            clock: of the run.
            system: of the vehicle; 0 is whichever speaks first that no other robot has.
            key: to sign with on a port of its own; what comes must then be signed with it, too.
            retries: None: as published.

        Raises:
            ValueError: another robot has that vehicle.
        """
        radio = port if isinstance(port, Radio) else Radio(port, clock, Signer(key) if key else None)
        self.clock = clock
        self.guard: Callable[[], None] = nobody
        self.system = system
        self.component = 0
        self.retries = retries or Retries()
        self.stations = Stations()
        self._radio = radio
        self._wanted = system
        late = max(LATE_MILLISECONDS, 1000.0 * self.clock.speedup)
        self._identity, self._roaming = Identity(late), Roaming(late)
        self._changed = threading.Condition()
        self._messages = Messages(self._changed, clock)
        self._observers: tuple[Observer, ...] = ()
        self._given_up = -inf
        self._received: float | None = None
        self._ended = ""
        self._expected: VehicleProfile = ARDUCOPTER
        self._found: tuple[int, VehicleProfile] | None = None
        radio.join(self)

    def close(self) -> None:
        """Stop listening."""
        self._radio.leave(self)

    def expect(self, profile: VehicleProfile) -> None:
        """Expect a vehicle of the class of a profile, with whatever autopilot its heartbeats report."""
        self._expected, self._found = profile, None

    @property
    def profile(self) -> VehicleProfile:
        """Return the profile of the vehicle: that of its class with the autopilot that it reports."""
        beat, found = self.latest("HEARTBEAT"), self._found
        if beat is None:
            return self._expected
        if found is None or found[0] != beat.autopilot:
            found = self._found = (beat.autopilot, on_autopilot(self._expected, beat.autopilot))
        return found[1]

    @property
    def listening(self) -> bool:
        """Return whether something may still come."""
        return self._radio.listening

    @property
    def trouble(self) -> str:
        """Return the port's last error; empty once messages arrive again."""
        return self._radio.trouble

    @property
    def dropped(self) -> Mapping[str, int]:
        """Return how many frames on the radio were not used, by type and reason."""
        return dict(self._radio.dropped)

    @property
    def garbled(self) -> int:
        """Return how many frames could not be read, or were not signed as they should be."""
        return sum(self._radio.dropped[reason] for reason in ("unreadable", "not signed with the key"))

    @property
    def patience(self) -> float:
        """Return the seconds of the run to wait for an answer: networks do not speed up with simulators."""
        return self.clock.patience(self.retries.answer, min(LEAST_SECONDS, self.retries.answer))

    @property
    def starts(self) -> int:
        """Return how often the vehicle was seen to restart."""
        return self._identity.starts

    @property
    def named(self) -> bool:
        """Return whether it was said which system is meant, and not the first that speaks."""
        return bool(self._wanted)

    def doubt(self) -> str:
        """Return why this may not be the robot's vehicle; empty if it is, as far as is known."""
        twin = self._roaming.twin or self._identity.twin
        if twin:
            return f"there are two vehicles with system id {self.system}: {twin}"
        others = sorted(
            each for each in self._radio.received - {self.system} if not self._radio.claimed(each)
        )
        if not self._wanted and others:
            shown = " and ".join(map(str, sorted([self.system, *others])))
            return f"vehicles with the system ids {shown} on this link: name one, as URL@{self.system}"
        return ""

    def strangers(self) -> str:
        """Return the systems on the radio other than the vehicle; empty if there are none."""
        shown = ", ".join(map(str, sorted(self._radio.received)))
        return f"received system {shown}, and not {self._wanted}" if shown and self._wanted else ""

    @property
    def given_up(self) -> bool:
        """Return whether heartbeats are withheld, so that the vehicle's failsafe acts."""
        return self.clock.now() < self._given_up

    def give_up(self, seconds: float) -> None:
        """Send a silent vehicle no heartbeats for some time: it may still receive them.

        They continue as soon as its messages arrive again, and later anyway: it may have lost the address.
        """
        self._given_up = self.clock.now() + seconds

    def observe(self, observer: Observer) -> None:
        """Call an observer with every message from now on, sent or received.

        An observer must neither raise nor wait: it runs in the thread that reads, or that sends.
        """
        self._observers = (*self._observers, observer)

    def send(self, message: Message) -> None:
        """Send one message; where the port does not take it, it is lost like any on a poor link."""
        for observer in self._observers:
            observer(message, True)
        self._radio.send(message, self._roaming.sender)

    def speak(self, message: Message) -> None:
        """Broadcast one message as a component of the vehicle, as its onboard computer does."""
        for observer in self._observers:
            observer(message, True)
        self._radio.send(message, self._roaming.sender, self.system)

    def latest(self, kind: str) -> Message | None:
        """Return the last message of that name from the vehicle."""
        return self._messages.latest(kind)

    def since(self, kind: str) -> float:
        """Return how long ago the last message of that name came, in seconds; inf if none did."""
        return self._messages.since(kind)

    def order(self, kind: str) -> int:
        """Return which of the vehicle's frames the last message of that name was; -1 before one came.

        Of two messages the one with the larger number was sent later, whichever has come first.
        """
        return self._messages.order(kind)

    def silent_for(self) -> float:
        """Return the seconds since the vehicle's last message; 0 before the first."""
        return 0.0 if self._received is None else self.clock.now() - self._received

    def unheard(self) -> bool:
        """Return whether the vehicle is silent while a guard watches, which says when it is lost."""
        return self._watched() and self.silent_for() >= self.patience

    def silent_since(self, begun: float) -> bool:
        """Return whether the vehicle has said nothing since then, while a guard watches the link."""
        return self._watched() and (self._received is not None and self._received < begun)

    def attempts(self, most: int | None = None) -> Iterator[int]:
        """Yield the number of attempts, as long as another one may be made.

        An attempt counts if the vehicle was received since. A silent vehicle is not
        one that does not answer: whatever watches the link decides when it is lost, by the policy's seconds.

        Args:
            most: attempts that count; None: the link's default.
        """
        most = self.retries.tries if most is None else most
        sent = counted = 0
        while counted < most:
            begun = self.clock.now()
            yield sent
            sent, counted = sent + 1, counted + (not self.silent_since(begun))

    def wait(
        self, test: Callable[[], Found | None], seconds: float, *, while_received: bool = False
    ) -> Found | None:
        """Return the result of the test as soon as it has one; None if time runs out.

        Time that the guard takes, as for an order to hold, does not count.

        Args:
            test: asked again after every message.
            seconds: of the run.
            while_received: whether time in which the vehicle is silent does not count either, since a guard
                decides when it is lost.

        Raises:
            FaultError: the port has ended, so that no message will come any more; or what the guard raises.
        """
        before = self.clock.now()
        until = before + seconds
        while True:
            if self._ended:
                raise FaultError(LINK_LOST, self._ended)
            asked = self.clock.now()
            if while_received and self.unheard():
                until += asked - before
            self.guard()
            before = self.clock.now()
            until += before - asked
            with self._changed:
                found = test()
                left = until - self.clock.now()
                if found or left <= 0:
                    return found or None
                self._changed.wait(min(self.clock.real(left), GLANCE_SECONDS))

    def wake(self) -> None:
        """Make a wait ask its guard and its test again at once."""
        with self._changed:
            self._changed.notify_all()

    def _watched(self) -> bool:
        """Return whether another party decides when the link is lost."""
        return self.guard is not nobody and self.silent_for() < FORSAKEN_SECONDS

    def inbox(self, *kinds: str, component: int | None = None) -> AbstractContextManager[deque[Message]]:
        """Collect every message of these names from now on.

        Args:
            kinds: names of messages.
            component: of the vehicle's system that must have sent them; None: the autopilot.
        """
        return self._messages.inbox(frozenset(kinds), self.component if component is None else component)

    def trail(self, kind: str) -> AbstractContextManager[deque[Message]]:
        """Collect every message of that name that is news, from now on, in the order they were sent in."""
        return self._messages.trail(kind)

    def meets(self, heartbeat: Message) -> bool:
        """Return whether an autopilot's heartbeat is that of the vehicle; it is the link's from then on."""
        system = heartbeat.get_srcSystem()
        if self._wanted not in (0, system) or (not self._wanted and self._radio.claimed(system)):
            return False
        with self._changed:
            self.system, self.component = system, heartbeat.get_srcComponent()
            self._messages.put(heartbeat)
            self._changed.notify_all()
        return True

    def hears(self, message: Message, sender: Address | None) -> None:
        """Take a message from the vehicle's system, or from the radio itself (RADIO_STATUS)."""
        own = (message.get_srcSystem(), message.get_srcComponent()) == (self.system, self.component)
        if own and not self._is_own(message, sender):
            self._radio.dropped[f"{message.get_type()}: from a second system {self.system}"] += 1
            return
        if own and message.get_type() == "HEARTBEAT" and not is_autopilot(message):
            self._radio.dropped["HEARTBEAT: with the vehicle's ids, and no autopilot's"] += 1
            return
        for observer in self._observers:
            observer(message, False)
        with self._changed:
            self._keep(message, own=own)
            self._changed.notify_all()

    def speaks_from(self, sender: Address | None) -> bool:
        """Return whether that is where the vehicle speaks from."""
        return bool(self.component) and sender == self._roaming.sender

    def hears_station(self, heartbeat: Message) -> None:
        """Take the heartbeat of a ground station."""
        self.stations.hear(heartbeat, self.clock.now())

    def learns(self, reason: str) -> None:
        """Note that no more messages will come."""
        with self._changed:
            self._ended = reason
            self._changed.notify_all()

    def _is_own(self, message: Message, sender: Address | None) -> bool:
        """Return whether a message with the vehicle's ids comes from the vehicle."""
        real, now = time.monotonic(), self.clock.now()
        return self._roaming.accepts(message, sender, real, now, heartbeat=is_autopilot(message))

    def _keep(self, message: Message, *, own: bool) -> None:
        if own:
            if self.silent_for() > self.clock.patience(GAP_SECONDS, LEAST_GAP_SECONDS):
                self.stations.pass_over(self.silent_for())
            self._received = self.clock.now()
            self._given_up = -inf
            if message.get_type() in TELL_BOOT:
                self._identity.booted(message.time_boot_ms)
        self._messages.take(message, own=own)
