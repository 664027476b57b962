"""Shunting: how a vehicle that steers like a car turns to a place before it sets out.

An ArduPilot Rover neither turns on the spot nor reverses on its own. Where its target is within its turning
circle, or abreast of it, it creeps around that for minutes, or stands beside it (measured with ArduRover
4.7-dev: 0.7 to 2.8 m beside, and up to 4.7 m off the leg). So where its target is near, it is turned to that
first, by arcs forwards and backwards, each as narrow as it can, within its turning radius (Reeds and Shepp,
"Optimal paths for a car that goes both forwards and backwards", 1990: curves of the sort C|C|C). The leg is
straight then, and was measured to end within 0.2 m of its target.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import hypot, inf, radians, sin

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_runtime.controllers.geodesy import bearing, offset, turn
from mmrs_runtime.faults import NO_PROGRESS, FaultError

from ..links.link import Link, Message
from ..profiles.pacing import ASIDE_DEGREES, SHUNTS_FOR, SHUNTS_WITHIN
from ..program import Place
from .mode_control import ModeControl
from .telemetry import Telemetry

FACING_DEGREES = 5.0
"""How exactly it is turned."""

SHARE_OF_ROOM = 0.5
"""Part of the turning radius from where it stood at which an arc ends: it rolls on while it brakes."""

LEAST_ARC = 0.15
"""Metres that an arc leads away again from where it stood, before it may end for that."""

PACE = 0.4
"""Metres per second at which it shunts."""

MOST_ARCS = 24
ARC_SECONDS = 20.0
RESEND_SECONDS = 1.0
"""A Rover stops where it is not commanded a speed again within 3 s."""

HALTED = 0.05
"""Metres per second up to which it has halted, as between two arcs."""

HALT_SECONDS = 6.0

SPEED_AND_TURN_RATE = (
    mavlink.POSITION_TARGET_TYPEMASK_X_IGNORE
    | mavlink.POSITION_TARGET_TYPEMASK_Y_IGNORE
    | mavlink.POSITION_TARGET_TYPEMASK_Z_IGNORE
    | mavlink.POSITION_TARGET_TYPEMASK_AX_IGNORE
    | mavlink.POSITION_TARGET_TYPEMASK_AY_IGNORE
    | mavlink.POSITION_TARGET_TYPEMASK_AZ_IGNORE
    | mavlink.POSITION_TARGET_TYPEMASK_YAW_IGNORE
)


@dataclass(frozen=True, slots=True)
class Shunting:
    """Turns a vehicle that steers like a car.

    Attributes:
        link: to the vehicle.
        telemetry: of the vehicle.
        mode_control: of the vehicle.
        radius: of its narrowest curve, metres; 0: it turns on its own.
    """

    link: Link
    telemetry: Telemetry
    mode_control: ModeControl
    radius: float

    def face(self, place: Place, near: float, speed: float) -> bool:
        """Turn a vehicle that stands to a place, unless it gets there without: by one curve, or on its own.

        Args:
            place: that it is to drive to.
            near: metres from it within which it need not look there.
            speed: metres per second at which it is to drive.

        Returns:
            Whether it has turned.

        Raises:
            FaultError: it does not turn so far.
        """
        if not self.radius or self.telemetry.speed() > self.link.profile.still:
            return False
        if abs(self._aside(place)) <= ASIDE_DEGREES or self._from(place) > self._near(place, speed):
            return False
        begun, forwards = self.telemetry.here(), 1.0
        for _ in range(MOST_ARCS):
            if self._from(place) <= near or abs(self._aside(place)) <= FACING_DEGREES:
                return True
            self._drive_arc(place, begun, forwards)
            forwards = -forwards
        raise FaultError(NO_PROGRESS, f"still looks {abs(self._aside(place)):.0f}° past {place}")

    def _drive_arc(self, place: Place, begun: Place, forwards: float) -> None:
        """Drive until the vehicle looks at its target, or would leave its room; then halt."""
        side = 1.0 if self._aside(place) > 0.0 else -1.0
        nearest = self._from(begun)

        def ends() -> bool:
            nonlocal nearest
            away = self._from(begun)
            nearest = min(nearest, away)
            leaves = away >= SHARE_OF_ROOM * self.radius and away >= nearest + LEAST_ARC
            return leaves or side * self._aside(place) <= FACING_DEGREES / 2.0

        self._command(forwards * PACE, side * PACE / self.radius, ends, ARC_SECONDS)
        self._command(0.0, 0.0, lambda: self.telemetry.speed() <= HALTED, HALT_SECONDS)

    def _command(self, speed: float, rate: float, ends: Callable[[], bool], seconds: float) -> None:
        """Command a speed and a turn rate, metres and radians per second, until something is so.

        A vehicle whose positions do not arrive is not commanded again, so that it stops.
        """
        until, seen = self.link.clock.now() + seconds, -inf
        while self.link.clock.now() < until:
            if self.telemetry.time() > seen:
                seen = self.telemetry.time()
                self.link.send(_speed_and_turn_rate(self.link, speed, rate))
            if self.link.wait(ends, RESEND_SECONDS):
                return
            self.mode_control.check()

    def _near(self, place: Place, speed: float) -> float:
        """Return how far away, in metres, the vehicle gets to such a place by one curve and straight on."""
        abreast = max(SHUNTS_WITHIN * self.radius, SHUNTS_FOR * speed)
        return abreast * sin(radians(min(90.0, abs(self._aside(place)))))

    def _from(self, place: Place) -> float:
        return hypot(*offset(place, self.telemetry.here())[:2])

    def _aside(self, place: Place) -> float:
        """Return by how many degrees its target is right of where the vehicle looks; negative: left of it."""
        heading = self.telemetry.heading()
        return 0.0 if heading is None else turn(heading, bearing(self.telemetry.here(), place))


def _speed_and_turn_rate(link: Link, speed: float, rate: float) -> Message:
    nothing = (0.0,) * 3
    return mavlink.MAVLink_set_position_target_local_ned_message(
        0,
        link.system,
        link.component,
        mavlink.MAV_FRAME_BODY_NED,
        SPEED_AND_TURN_RATE,
        *nothing,
        speed,
        0.0,
        0.0,
        *nothing,
        0.0,
        rate,
    )
