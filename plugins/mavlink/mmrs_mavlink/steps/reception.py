"""Whether a vehicle is received, and how long to wait for one that is silent."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mmrs_runtime.clock import Clock

if TYPE_CHECKING:
    from ..links.link import Link

HEARD_SECONDS, LEAST_HEARD_SECONDS = 3.0, 1.0
"""Largest age of the last message of a reachable vehicle, of the run and real."""

LISTEN_SECONDS, LEAST_LISTEN_SECONDS = 30.0, 2.0
"""How long to wait for a vehicle whose link is lost, of the run and real, when no other robot works."""


def is_received(link: Link) -> bool:
    """Return whether a vehicle was received lately."""
    return link.listening and link.silent_for() < lately(link.clock)


def lately(clock: Clock) -> float:
    """Return the largest age in seconds of a reachable vehicle's last message."""
    return clock.patience(HEARD_SECONDS, LEAST_HEARD_SECONDS)


def listening(clock: Clock) -> float:
    """Return for how many seconds a vehicle is listened for whose link is lost."""
    return clock.patience(LISTEN_SECONDS, LEAST_LISTEN_SECONDS)
