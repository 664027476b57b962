"""Whether the vehicle at the end of a link is the robot's, before it is told anything that matters."""

from __future__ import annotations

import json
from math import hypot, inf
from pathlib import Path

from ..faults import Refused
from ..links.link import Link
from ..places import offset
from ..program import Geographic, Place, Robot
from ..services import parameters
from ..vehicles import modes, preparation
from .mavlink_vehicle import MavlinkVehicle

OURS = frozenset({modes.GUIDED, modes.AUTO, modes.HOLD, modes.LAND, modes.SURFACE})
"""Modes that programs use; a vehicle in the air in any other may have a pilot."""

AT_HOME = 2.0
"""Metres from its home within which a vehicle stands there, whatever else is near: no position is better."""


def recognise(
    link: Link, vehicle: MavlinkVehicle, robot: Robot, tolerance: float, *, under_way: bool, system: int
) -> None:
    """Make sure that a vehicle is the robot's, and that nobody flies it; it is told nothing, only asked.

    Args:
        link: to the vehicle.
        vehicle: at its end.
        robot: its program.
        tolerance: metres that it may be from home.
        under_way: whether its motors may run, as where a run is resumed.
        system: that it had when the run began; 0: nobody knows.

    Raises:
        Refused: it is not, or somebody may.
    """
    telemetry = vehicle.telemetry
    preparation.ask_for_messages(link, geographic=isinstance(robot.home, Geographic))
    preparation.await_position(link, telemetry)
    preparation.hear_out(link)
    if system and link.system != system:
        raise Refused(f"the vehicle is system {link.system}, and the robot's was system {system}")
    preparation.check_identity(link, telemetry, robot.vehicle, robot.home, tolerance)
    if tolerance < inf:
        refuse_neighbours(robot, telemetry.here())
    if not telemetry.armed():
        return
    if not under_way:
        raise Refused("the vehicle's motors run already: somebody else has it")
    mode = vehicle.state().mode
    if mode not in OURS and telemetry.mode() not in _alone(link, robot.vehicle):
        raise Refused(
            f"the vehicle's motors run, and it is in mode {mode}, by which it answers no lost link:"
            " a pilot may have it"
        )


def _alone(link: Link, kind: str) -> frozenset[int]:
    """Return the modes in which a vehicle may be because its program was killed, as far as it says."""
    return modes.alone(link, kind, parameters.read(link, modes.decides_alone(link, kind)))


def refuse_neighbours(robot: Robot, here: Place) -> None:
    """Make sure that a vehicle does not stand where that of another robot belongs.

    Raises:
        Refused: another robot's home is nearer than the robot's own.
    """
    away = _away(robot.home, here)
    other, name = min(((_away(home, here), name) for name, home in robot.neighbours), default=(inf, ""))
    if away > AT_HOME and other < away:
        raise Refused(
            f"the vehicle is {other:.0f} m from the home of {name!r} and {away:.0f} m from that of its "
            "program: are system ids or links swapped?"
        )


def system_of(box: Path) -> int:
    """Return the MAVLink system of the vehicle of a robot's black box; 0 where it does not say."""
    for path in (*sorted(box.parent.glob(f"{box.stem}.*.ndjson")), box):
        for line in path.read_text("ascii", "replace").splitlines() if path.exists() else ():
            if '"start"' in line and (found := _system(line)):
                return found
    return 0


def _away(home: Place, here: Place) -> float:
    return hypot(*offset(home, here)[:2])


def _system(line: str) -> int:
    try:
        content = json.loads(line)
    except ValueError:
        return 0
    system = content.get("system") if isinstance(content, dict) and content.get("kind") == "start" else None
    return system if isinstance(system, int) else 0
