"""Hands on what comes by one of a vehicle's radios to the others, by the rules of ArduPilot's routing.

They are those of ``MAVLink_routing``, as its source has them: heartbeats go to every other radio but those
by which the same system and component was heard already; all else goes where its target was heard, and
broadcasts to wherever somebody was heard.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from mmrs_mavlink.sitl.radio import COMPONENT, Radio

Message = Any

NEVER = frozenset({"RADIO", "RADIO_STATUS"})
"""What a radio says of itself."""

EVERYBODY = 0


class Router:
    """Speaks and listens by all radios of a vehicle."""

    def __init__(self, system: int, *radios: Radio) -> None:
        """Hand on between the radios of a system; nobody was heard yet."""
        self.radios = radios
        self._own = (system, COMPONENT)
        self._routes: dict[tuple[int, int], set[Radio]] = {}

    @property
    def late(self) -> bool:
        """Return whether something is on its way that has not been heard yet."""
        return any(radio.late for radio in self.radios)

    def close(self) -> None:
        """Fall silent."""
        for radio in self.radios:
            radio.close()

    def send(self, message: Message) -> None:
        """Send a message by the radio where its target was heard; without any, by all."""
        for radio in self._towards(*_target(message)) or self.radios:
            radio.send(message)

    def flush(self) -> None:
        """Send what was held back long enough."""
        for radio in self.radios:
            radio.flush()

    def receive(self) -> Iterator[Message]:
        """Yield what has come, whomever it is for, and hand it on."""
        for radio in self.radios:
            for message in radio.receive():
                source = (message.get_srcSystem(), message.get_srcComponent())
                if source == self._own:
                    continue
                self._routes.setdefault(source, set()).add(radio)
                for other in self._further(message, source) - {radio}:
                    other.relay(bytes(message.get_msgbuf()))
                yield message

    def _further(self, message: Message, source: tuple[int, int]) -> set[Radio]:
        """Return the radios by which a message goes on."""
        if message.get_type() in NEVER:
            return set()
        if message.get_type() == "HEARTBEAT":
            return set(self.radios) - self._routes[source]
        system, component = _target(message)
        if system == EVERYBODY:
            return set().union(*self._routes.values())
        return set() if (system, component) == self._own else self._towards(system, component)

    def _towards(self, system: int, component: int) -> set[Radio]:
        """Return the radios by which a target was heard."""
        found = [
            radios
            for (its, part), radios in self._routes.items()
            if its == system and (component in (EVERYBODY, part) or system != self._own[0])
        ]
        return set().union(*found)


def _target(message: Message) -> tuple[int, int]:
    return getattr(message, "target_system", EVERYBODY), getattr(message, "target_component", EVERYBODY)
