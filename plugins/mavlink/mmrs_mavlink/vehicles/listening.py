"""The senders of heartbeats that a vehicle counts as its ground station.

An ArduPilot counts those of one system, or of a range of systems, and never misses a ground station that it
has not received: if the program is not among them, its failsafe never answers a lost link.
"""

from __future__ import annotations

from collections.abc import Mapping

from mmrs_runtime.faults import RefusedError

from ..links.link import Link
from ..links.ourselves import GROUND_SYSTEM
from ..services import parameters

NOT_TOLD = (
    "the vehicle does not tell whose heartbeats it counts ({}, {}): it may not notice when this program falls"
    " silent"
)


def check_listening(link: Link) -> str:
    """Check that a vehicle's failsafe acts when this program falls silent.

    Returns:
        What operators should know, where the vehicle does not report it; otherwise nothing.

    Raises:
        RefusedError: it does not count this program's heartbeats.
    """
    stations = link.profile.autopilot.stations
    if not any(stations):
        return ""
    name, systems = _counted(stations, parameters.read(link, stations))
    if not name:
        return NOT_TOLD.format(*stations)
    if GROUND_SYSTEM in systems:
        return ""
    raise RefusedError(
        f"response to a lost link: the vehicle counts no heartbeats but those of system {_shown(systems)}"
        f" ({name}), and would not notice when this program falls silent: set {name} to {GROUND_SYSTEM},"
        " and give ground stations other systems"
    )


def _counted(stations: tuple[str, str, str], told: Mapping[str, float]) -> tuple[str, range]:
    """Return the parameter that defines which systems count, and these; an empty name: unknown."""
    single, from_, to = stations
    name = next((each for each in (from_, single) if each in told), "")
    first = round(told.get(name, 0.0))
    last = round(told.get(to, 0.0)) if name == from_ else 0
    return name, range(first, max(first, last) + 1)


def _shown(systems: range) -> str:
    return f"{systems[0]}" if len(systems) == 1 else f"{systems[0]} to {systems[-1]}"
