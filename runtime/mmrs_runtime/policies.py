"""What both executions of policies agree on: words of responses, and what goes before what."""

from __future__ import annotations

from collections.abc import Mapping

from .faults import BATTERY_LOW, GROUND_LOST, LINK_LOST, POSITION_LOST, VEHICLE_RESTARTED

NOTHING = "NOTHING"
"""Response to a pilot: no policy answers that, the program lets go of the vehicle."""

UNDECLARED: Mapping[str, str] = {LINK_LOST: "RETURN", BATTERY_LOW: "RETURN", GROUND_LOST: "CONTINUE"}
"""What real robots do where no policy says anything; to anything else they hold."""

COMES_DOWN = frozenset({"RETURN", "EMERGENCY_AREA", "LAND", "SURFACE"})
"""Responses after which a battery can be changed."""

OVERTAKES = frozenset({POSITION_LOST, VEHICLE_RESTARTED, BATTERY_LOW, GROUND_LOST})
"""Events that are answered although the robot already responds to another."""

CAME_DOWN_AWAY = "came down for its battery where its sortie began, away from home"
"""What people are told of a robot that can go on from there, once its battery has been changed."""


def still_low(charge: float | None, reserve: float) -> str:
    """Return why a battery is not to be flown with; empty where it is, or nobody knows.

    Args:
        charge: part of it that is left; None where nobody knows.
        reserve: part with less than which it counts as low.
    """
    if charge is None or charge >= reserve:
        return ""
    return f"its battery is still at {charge:.0%}"
