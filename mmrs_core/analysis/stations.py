"""Where a robot reaches its home, or a relay from which a chain of relays leads there."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import dist

from mmrs_core.diagnostics import lengths
from mmrs_core.scene import Position
from mmrs_core.scene.relays import Relay


@dataclass(frozen=True, slots=True)
class Station:
    """A relay, or the control station at home, that a robot reaches in a ball about it.

    Attributes:
        name: of the relay; empty: home.
        centre: (east, north, up), metres.
        radius: metres, the smaller of both ranges less what the relay may be elsewhere.
    """

    name: str
    centre: Position
    radius: float

    @property
    def words(self) -> str:
        """Return what it is about."""
        return f"relay '{self.name}'" if self.name else "home"


def stations_of(
    home: Position, reach: float, relays: Sequence[Relay]
) -> tuple[list[Station], list[tuple[Relay, str]]]:
    """Return where a robot is in range, home first, and the relays without a chain to its home, with why."""
    chained = [Relay("", home, reach)]
    left = list(relays)
    for here in chained:
        reached = [each for each in left if _apart(here, each) <= min(here.range, each.range)]
        chained.extend(reached)
        left = [each for each in left if each not in reached]
    stations = [Station(each.name, each.position, min(reach, each.range) - each.spread) for each in chained]
    return stations, [(each, _severed(each, chained)) for each in left]


def _apart(one: Relay, two: Relay) -> float:
    """Return how far apart two relays may be, metres."""
    return dist(one.position, two.position) + one.spread + two.spread


def _severed(relay: Relay, chained: Sequence[Relay]) -> str:
    near = min(chained, key=lambda each: _apart(each, relay) - min(each.range, relay.range))
    away, allowed = lengths(_apart(near, relay), min(near.range, relay.range))
    words = Station(near.name, near.position, near.range).words
    return f"it is {away} from {words}, they reach each other within {allowed}"
