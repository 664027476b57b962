"""A vehicle's own home: the reference of its heights, and the target of its own return.

Autopilots take the position where they arm for home, unless a home was set since they were switched on.
"""

from __future__ import annotations

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_runtime.controllers.geodesy import distance
from mmrs_runtime.faults import RefusedError

from ..links.link import Link, Message
from ..program import Geographic, Place
from ..services.commands import ask, command_at
from .footing import ELSEWHERE, aside
from .telemetry import Telemetry

SAME = 1.0
"""Metres within which two homes are one."""


def keep_home(link: Link, telemetry: Telemetry, home: Geographic, start: Place) -> str:
    """Keep the home of the program as the home of a vehicle that takes off elsewhere.

    A vehicle that still has its home keeps it; one that was switched on since receives it again, at the
    height from which the ground where it stands is as high as before.

    Args:
        link: to the vehicle, which stands on the ground.
        telemetry: of the vehicle.
        home: of its program.
        start: where it stands, with the height of the ground above home.

    Returns:
        What operators should know.

    Raises:
        RefusedError: the vehicle does not take it, or does not confirm that it has.
    """
    takes_off = f"takes off {aside(home, start):.0f} m from its home"
    try:
        kept = _own_home(link)
        if kept is None or aside(home, kept) > ELSEWHERE:
            kept = _level_with(telemetry, home, start)
        command_at(link, mavlink.MAV_CMD_DO_SET_HOME, kept, mavlink.MAV_FRAME_GLOBAL)
        _await(link, telemetry, kept)
    except RefusedError as error:
        raise RefusedError(
            f"it {takes_off}, and the vehicle does not keep that for its own ({error}), so that its own"
            " return would lead elsewhere: bring it home, and begin again"
        ) from error
    return f"{takes_off}, which the vehicle keeps for its own: {kept.latitude:.6f}, {kept.longitude:.6f}"


def _own_home(link: Link, wanted: Geographic | None = None) -> Geographic | None:
    """Return the vehicle's own home, its height above the sea; None where it does not tell it.

    Args:
        link: to the vehicle.
        wanted: the home that it is to tell; None: any.
    """
    with link.inbox("HOME_POSITION") as inbox:

        def reported() -> Geographic | None:
            homes = map(_place_of, tuple(inbox))
            return next((each for each in homes if wanted is None or distance(each, wanted) <= SAME), None)

        for _ in link.attempts():
            ask(link, mavlink.MAV_CMD_REQUEST_MESSAGE, mavlink.MAVLINK_MSG_ID_HOME_POSITION)
            if (found := link.wait(reported, link.patience)) is not None:
                return found
    return None


def _place_of(message: Message) -> Geographic:
    return Geographic(message.latitude * 1e-7, message.longitude * 1e-7, message.altitude * 1e-3)


def _level_with(telemetry: Telemetry, home: Geographic, start: Place) -> Geographic:
    """Return home with that height above the sea from which on the ground here is as high as before."""
    level = telemetry.sea_level()
    if level is None:
        raise RefusedError("the vehicle has not reported its height above sea level")
    return Geographic(home.latitude, home.longitude, level + telemetry.here().height - start.height)


def _await(link: Link, telemetry: Telemetry, home: Geographic) -> None:
    """Wait until the vehicle says that a place is its home, and counts its heights from there.

    Raises:
        RefusedError: it does not.
    """
    if _own_home(link, home) is None:
        raise RefusedError("the vehicle does not confirm it")

    def counts() -> bool:
        level = telemetry.sea_level()
        return level is not None and abs(level - home.height) <= SAME

    if not link.wait(counts, link.patience):
        raise RefusedError("the heights that the vehicle tells count from elsewhere")
