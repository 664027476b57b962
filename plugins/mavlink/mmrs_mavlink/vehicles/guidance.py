"""How autopilots are steered, step by step: what differs between them, and ArduPilot's guidance."""

from __future__ import annotations

from math import degrees, inf
from typing import Protocol

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from ..links.link import Link, Message
from ..profiles import imported, modes
from ..program import Geographic, Place
from ..services.commands import command
from .telemetry import Telemetry

POSITION_AND_YAW = (
    mavlink.POSITION_TARGET_TYPEMASK_VX_IGNORE
    | mavlink.POSITION_TARGET_TYPEMASK_VY_IGNORE
    | mavlink.POSITION_TARGET_TYPEMASK_VZ_IGNORE
    | mavlink.POSITION_TARGET_TYPEMASK_AX_IGNORE
    | mavlink.POSITION_TARGET_TYPEMASK_AY_IGNORE
    | mavlink.POSITION_TARGET_TYPEMASK_AZ_IGNORE
    | mavlink.POSITION_TARGET_TYPEMASK_YAW_RATE_IGNORE
)


class Guidance(Protocol):
    """How an autopilot is steered; it is made from a link and its telemetry.

    Attributes:
        climbs_in: the mode that take-off is asked for in.
    """

    climbs_in: str

    def begin_guiding(self) -> None:
        """Get ready for GUIDED, before it is asked for."""
        ...

    def end_guiding(self) -> None:
        """Stop steering: another mode was entered, or the vehicle is under external control."""
        ...

    def aim(self, place: Place, yaw: float, speed: float | None, turn_rate: float = inf) -> None:
        """Command a position and a heading (radians clockwise from north).

        Args:
            place: where to.
            yaw: the heading.
            speed: metres per second; None: as fast as the vehicle can.
            turn_rate: radians per second, at most.
        """
        ...

    def has_settled(self, place: Place) -> bool | None:
        """Return whether the vehicle has settled at a place that it aims at; None: where it stands still.

        It is asked with each position.
        """
        ...

    def take_off(self, height: float) -> tuple[float, ...]:
        """Return the parameters of the command to climb to a height above home."""
        ...

    def climbing(self) -> tuple[int, ...]:
        """Return the numbers of the modes that a take-off may pass through."""
        ...

    def level(self, height: float) -> tuple[int, float]:
        """Return the frame in which it takes commands at places, and a height above home in it, metres."""
        ...

    def select(self, seq: int) -> None:
        """Continue the mission at the vehicle's item of that number."""
        ...

    def enable_fence(self) -> None:
        """Enable the vehicle's fence."""
        ...


class ArduPilotGuidance:
    """ArduPilot: one target at a time, heights count from home."""

    climbs_in = modes.GUIDED

    def __init__(self, link: Link, telemetry: Telemetry) -> None:
        """Steer the vehicle at a link."""
        self._link = link
        self._yaw: float | None = None

    def begin_guiding(self) -> None:
        """Forget the heading, as the vehicle does: targets may follow the change of mode."""
        self._yaw = None

    def end_guiding(self) -> None:
        """Return at once: a target that was sent is forgotten with the mode."""

    def aim(self, place: Place, yaw: float, speed: float | None, turn_rate: float = inf) -> None:
        """Send a target; the speed needs another command, and so does the heading of some vehicles.

        They turn by their own parameter.

        Raises:
            RefusedError: the vehicle does not take the heading.
        """
        frame = mavlink.MAV_FRAME_GLOBAL_RELATIVE_ALT_INT
        self._link.send(target(self._link, place, yaw, frame))
        if self._link.profile.heads_apart and yaw != self._yaw:
            command(self._link, mavlink.MAV_CMD_CONDITION_YAW, degrees(yaw) % 360.0)
            self._yaw = yaw

    def has_settled(self, place: Place) -> None:
        """Return None: it comes to a stop at its targets."""

    def take_off(self, height: float) -> tuple[float, ...]:
        """Return the parameters of NAV_TAKEOFF."""
        return (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, height)

    def climbing(self) -> tuple[int, ...]:
        """Return none: it stays in GUIDED."""
        return ()

    def level(self, height: float) -> tuple[int, float]:
        """Return the frame of heights above home, and the height itself."""
        return mavlink.MAV_FRAME_GLOBAL_RELATIVE_ALT, height

    def select(self, seq: int) -> None:
        """Send DO_SET_MISSION_CURRENT."""
        command(self._link, mavlink.MAV_CMD_DO_SET_MISSION_CURRENT, seq)

    def enable_fence(self) -> None:
        """Send DO_FENCE_ENABLE."""
        command(self._link, mavlink.MAV_CMD_DO_FENCE_ENABLE, 1)


def guidance_of(link: Link, telemetry: Telemetry) -> Guidance:
    """Return the guidance of the vehicle at a link, once its heartbeat has told what it is."""
    made: Guidance = imported(link.profile.autopilot.guidance)(link, telemetry)
    return made


def target(link: Link, place: Place, yaw: float, frame: int, sea_level: float = 0.0) -> Message:
    """Return a set-point of a position and a direction.

    Args:
        link: to the vehicle.
        place: where to.
        yaw: radians clockwise from north.
        frame: of the height of geographic places.
        sea_level: metres to add to their heights.
    """
    rest = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, yaw, 0.0)
    if isinstance(place, Geographic):
        return mavlink.MAVLink_set_position_target_global_int_message(
            0,
            link.system,
            link.component,
            frame,
            POSITION_AND_YAW,
            round(place.latitude * 1e7),
            round(place.longitude * 1e7),
            place.height + sea_level,
            *rest,
        )
    return mavlink.MAVLink_set_position_target_local_ned_message(
        0,
        link.system,
        link.component,
        mavlink.MAV_FRAME_LOCAL_NED,
        POSITION_AND_YAW,
        place.north,
        place.east,
        -place.height,
        *rest,
    )
