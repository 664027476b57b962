"""The backend mavlink: drives a robot of a behaviour over a MAVLink link, in real time."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from mmrs_core.behaviour.program import Action
from mmrs_core.contributions.vehicles import VehicleFactory, VehicleInput
from mmrs_core.errors import UsageError
from mmrs_core.scene import RobotType
from mmrs_mavlink.plugin.backend.options import link_options
from mmrs_runtime.vehicle import Vehicle


def _connect(given: VehicleInput) -> Vehicle:
    """Return a robot at the end of its link, which is first listened to when the robot gets ready."""
    link_options(given.options)
    if given.live is None:
        raise UsageError("backend 'mavlink': drives robots in real time; 'mmrs run' does that")
    from mmrs_mavlink.plugin.backend.connection import connect

    return connect(given, given.live)


def _check(options: Mapping[str, Mapping[str, str]], links: Mapping[str, str]) -> Iterable[str]:
    from mmrs_mavlink.plugin.backend.checking import faults_of

    return faults_of(options, links)


def _takes_photo(action: Action, type: RobotType) -> bool | None:
    from mmrs_mavlink.plugin.wiring import takes_photo

    return takes_photo(action, type)


MAVLINK = VehicleFactory(
    "mavlink",
    "ArduPilot and PX4 vehicles over MAVLink 2: serial, UDP or TCP, in real time",
    _connect,
    check=_check,
    default=True,
    signs=True,
    takes_photo=_takes_photo,
)
