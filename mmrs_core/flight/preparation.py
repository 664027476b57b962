"""What is set up on a vehicle before it moves: what it tells, what it does by itself, what it keeps."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from . import modes
from .commands import command
from .faults import Refused
from .link import Link
from .missions import FENCE, MISSION, RALLY, Item, upload, verify
from .telemetry import Telemetry

READY_SECONDS = 120.0
PARAMETER_SECONDS = 1.5
STREAMED = {
    "GLOBAL_POSITION_INT": 5.0,
    "LOCAL_POSITION_NED": 5.0,
    "EXTENDED_SYS_STATE": 2.0,
    "SYS_STATUS": 1.0,
    "MISSION_CURRENT": 5.0,
    "EKF_STATUS_REPORT": 1.0,
}
"""Messages that the program lives by, and how often they are asked for, hertz."""


def ask_for_messages(link: Link) -> None:
    """Ask for every message at its rate; a vehicle that refuses sends it as it likes, or does without."""
    for name, rate in STREAMED.items():
        number = getattr(mavlink, f"MAVLINK_MSG_ID_{name}")
        with suppress(Refused):
            command(link, mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, number, 1e6 / rate, tries=2)


def replace_all(link: Link, mission: Sequence[Item], fence: Sequence[Item], rally: Sequence[Item]) -> None:
    """Replace mission, fence and rally points, and read back what the vehicle has kept.

    Raises:
        Refused: something is not accepted, or read back differently.
    """
    for items, kind in ((mission, MISSION), (fence, FENCE), (rally, RALLY)):
        upload(link, items, kind)
        verify(link, items, kind)


def await_ready(link: Link, telemetry: Telemetry) -> None:
    """Wait until the vehicle knows where it is and its own checks pass.

    Raises:
        Refused: it does not get ready.
    """
    if not link.wait(telemetry.ready, READY_SECONDS):
        raise Refused("the vehicle does not become ready: no position, or its own checks fail")


def answer_lost_link(link: Link, kind: str, response: str) -> None:
    """Have the vehicle respond by itself when it no longer hears the ground.

    Raises:
        Refused: it cannot respond so, or does not say that it will.
    """
    values = modes.LINK_LOST[kind].get(response)
    if values is None:
        raise Refused(f"response to a lost link: a {kind} cannot do {response} by itself")
    for name, value in values.items():
        if not _set_parameter(link, name, value):
            raise Refused(f"response to a lost link: the vehicle does not confirm {name} = {value}")


def _set_parameter(link: Link, name: str, value: float) -> bool:
    with link.inbox("PARAM_VALUE") as inbox:
        for _ in range(link.tries):
            link.send(
                mavlink.MAVLink_param_set_message(
                    link.system, link.component, name.encode(), value, mavlink.MAV_PARAM_TYPE_REAL32
                )
            )
            if link.wait(
                lambda: any(m.param_id == name and m.param_value == value for m in inbox),
                link.clock.patience(PARAMETER_SECONDS),
            ):
                return True
    return False
