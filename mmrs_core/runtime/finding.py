"""What robots have detected, as it goes from one to the other with notifies."""

from __future__ import annotations

from mmrs_core.contributions.abilities import Learning
from mmrs_core.contributions.backends import Backend
from mmrs_core.contributions.buses import Bus, Find
from mmrs_core.errors import LinkLostError


def finds_of(robot: str, backend: Backend, bus: Bus, now: float) -> tuple[Find, ...]:
    """Return what a robot, and those that notified it, have detected; its own last.

    What a robot that cannot be reached has detected itself is left out.
    """
    found = {find[0]: find for find in bus.finds(robot)}
    try:
        state = backend.state(now)
    except LinkLostError:
        return tuple(found.values())
    for name in sorted(state.detected):
        place = state.places.get(name)
        if place is not None or name not in found:
            found.pop(name, None)
            found[name] = (name, place)
    return tuple(found.values())


def names_told(robot: str, bus: Bus) -> frozenset[str]:
    """Return the names of what those that notified a robot had detected."""
    return frozenset(name for name, _ in bus.finds(robot))


def teach(robot: str, backend: Backend, bus: Bus) -> None:
    """Have a backend know where those that notified its robot have detected things."""
    if isinstance(backend, Learning):
        backend.learn({name: place for name, place in bus.finds(robot) if place is not None})
