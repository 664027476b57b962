"""The plug-in called mavlink: what plugs into the core, where that is installed."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from mmrs_core.contributions.commands import Command
from mmrs_core.hookspecs import hookimpl

if TYPE_CHECKING:
    from mmrs_core.contributions.targets import Target
    from mmrs_core.contributions.vehicles import VehicleFactory


@hookimpl
def mmrs_targets() -> Iterable[Target]:
    """Contribute controllers, and plans for ground stations."""
    from mmrs_mavlink.plugin.targets import TARGETS

    return TARGETS


@hookimpl
def mmrs_vehicles() -> Iterable[VehicleFactory]:
    """Contribute vehicles at the ends of MAVLink links."""
    from mmrs_mavlink.plugin.backend import MAVLINK
    from mmrs_mavlink.plugin.manual import ARDUSUB_MANUAL

    return (MAVLINK, ARDUSUB_MANUAL)


@hookimpl
def mmrs_commands() -> Iterable[Command]:
    """Contribute simulated vehicles at the ends of MAVLink links."""
    return (Command("sitl", "Start simulated MAVLink vehicles.", "mmrs_mavlink.commands.sitl:app"),)
