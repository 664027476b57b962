"""Whether the vehicle at the end of a link is the robot's, before it receives any command that matters."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf
from pathlib import Path

from mmrs_runtime.faults import RefusedError
from mmrs_runtime.records.entries import entry_in

from ..links.link import Link
from ..profiles import GENERIC, modes
from ..program import Place, Robot
from ..services import parameters
from ..vehicles import preparation
from .footing import LANDED, aside
from .mavlink_vehicle import MavlinkVehicle

OURS = frozenset({modes.GUIDED, modes.AUTO, modes.HOLD, modes.LAND, modes.SURFACE})
"""Modes that programs use; a vehicle in the air in any other may have a pilot."""

THERE = 2.0
"""Metres from its place within which a vehicle stands there, whatever else is near: no position is better."""


def recognise(
    link: Link,
    vehicle: MavlinkVehicle,
    robot: Robot,
    tolerance: float,
    starts: Sequence[Place],
    *,
    under_way: bool,
    system: int,
) -> None:
    """Check that a vehicle is the robot's, and not under external control; it is only asked, not commanded.

    Args:
        link: to the vehicle.
        vehicle: at its end.
        robot: its program.
        tolerance: metres that it may be from where it is to stand.
        starts: where it may stand, the position where its sortie began first; the nearest counts.
        under_way: whether it may be armed, as where a run is resumed.
        system: that it had when the run began; 0: unknown.

    Raises:
        RefusedError: it is not, or it may be.
    """
    telemetry = vehicle.telemetry
    vehicle.reports.request()
    preparation.await_position(link, telemetry)
    preparation.hear_out(link)
    if system and link.system != system:
        raise RefusedError(f"the vehicle is system {link.system}, and the robot's was system {system}")
    vehicle.start = starts[0]
    if not telemetry.armed():
        vehicle.start = min(starts, key=lambda start: aside(start, telemetry.here()))
    preparation.check_identity(link, telemetry, tolerance, robot.home, vehicle.start, resumed=under_way)
    if tolerance < inf:
        refuse_neighbours(robot, vehicle.start, telemetry.here())
    if not telemetry.armed():
        return
    if not under_way:
        raise RefusedError("the vehicle is armed already: it is under external control")
    mode = vehicle.state().mode
    if mode not in OURS and telemetry.mode() not in _alone(link):
        raise RefusedError(
            f"the vehicle is armed, and it is in mode {mode}, by which it answers no lost link:"
            " a pilot may have it"
        )


def other_times(link: Link, robot: Robot) -> str:
    """Return that a robot's times were planned for another autopilot than its vehicle's; empty: not so.

    An autopilot that no profile knows has no times that could be planned.
    """
    found = link.profile.autopilot
    if found.number == GENERIC.number or found.name == robot.autopilot:
        return ""
    return (
        f"the vehicle's autopilot is {found.name}, and it was planned for {robot.autopilot} (warning: its"
        f" legs take other times than planned: set mavlink.autopilot = {found.name} in its robot type, and"
        " plan again)"
    )


def _alone(link: Link) -> frozenset[int]:
    """Return the modes in which a vehicle may be because its program was killed, as far as it says."""
    failsafe = link.profile.lost_link
    return failsafe.modes_by(parameters.read(link, failsafe.parameters))


def refuse_neighbours(robot: Robot, start: Place, here: Place) -> None:
    """Make sure that a vehicle does not stand where that of another robot belongs.

    Args:
        robot: its program.
        start: where it is to stand.
        here: where it stands.

    Raises:
        RefusedError: another robot's home is nearer than that.
    """
    away = aside(start, here)
    other, name = min(((aside(home, here), name) for name, home in robot.neighbours), default=(inf, ""))
    if away > THERE and other < away:
        own = "that of its program" if start == robot.home else LANDED
        raise RefusedError(
            f"the vehicle is {other:.0f} m from the home of {name!r} and {away:.0f} m from {own}: "
            "are system ids or links swapped?"
        )


def system_of(box: Path) -> int:
    """Return the MAVLink system of the vehicle of a robot's black box; 0 where it does not say."""
    for path in (*sorted(box.parent.glob(f"{box.stem}.*.ndjson")), box):
        for line in path.read_bytes().splitlines() if path.exists() else ():
            entry = entry_in(line)[0] if b'"start"' in line else None
            system = entry.content.get("system") if entry is not None and entry.kind == "start" else None
            if isinstance(system, int) and system:
                return system
    return 0


def firmware_of(link: Link) -> str | None:
    """Return a vehicle's reported firmware, such as ``ARDUPILOTMEGA``; None before its first message."""
    from pymavlink.dialects.v20 import ardupilotmega as mavlink

    beat = link.latest("HEARTBEAT")
    firmware = mavlink.enums["MAV_AUTOPILOT"].get(beat.autopilot) if beat is not None else None
    return firmware.name.removeprefix("MAV_AUTOPILOT_") if firmware is not None else None
