"""Whether a vehicle is heard, and for how long one that is not is listened for."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mmrs_runtime.clock import Clock

if TYPE_CHECKING:
    from ..links.link import Link

HEARD_SECONDS, LEAST_HEARD_SECONDS = 3.0, 1.0
"""How old the last word of a vehicle that is heard may be, of the run and real."""

LISTEN_SECONDS, LEAST_LISTEN_SECONDS = 30.0, 2.0
"""How long a vehicle is listened for whose link is lost, of the run and real, when nobody else works."""


def is_heard(link: Link) -> bool:
    """Return whether a vehicle was heard lately."""
    return link.listening and link.silent_for() < lately(link.clock)


def lately(clock: Clock) -> float:
    """Return how many seconds ago a vehicle that is heard may have spoken."""
    return clock.patience(HEARD_SECONDS, LEAST_HEARD_SECONDS)


def listening(clock: Clock) -> float:
    """Return for how many seconds a vehicle is listened for whose link is lost."""
    return clock.patience(LISTEN_SECONDS, LEAST_LISTEN_SECONDS)
