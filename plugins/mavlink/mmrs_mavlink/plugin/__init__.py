"""The plug-in called mavlink: what plugs into the core, where that is installed."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from mmrs_core.hookspecs import hookimpl

if TYPE_CHECKING:
    from mmrs_core.contributions.backends import BackendFactory
    from mmrs_core.contributions.targets import Target


@hookimpl
def mmrs_targets() -> Iterable[Target]:
    """Contribute controllers, and plans for ground stations."""
    from mmrs_mavlink.plugin.targets import TARGETS

    return TARGETS


@hookimpl
def mmrs_backends() -> Iterable[BackendFactory]:
    """Contribute vehicles at the ends of MAVLink links."""
    from mmrs_mavlink.plugin.backend import MAVLINK

    return (MAVLINK,)
