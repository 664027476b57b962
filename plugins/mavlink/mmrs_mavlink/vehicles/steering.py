"""Going to places and turning to them, step by step in GUIDED."""

from __future__ import annotations

from math import atan2, degrees, hypot, inf, nan, radians

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_runtime.controllers.geodesy import bearing, distance, offset, turn
from mmrs_runtime.faults import NO_PROGRESS, FaultError

from ..links.link import Link
from ..program import Local, Look, Object, Place
from ..services.commands import command
from .mode_control import ModeControl
from .pointing import look_ahead, look_at_place
from .shunting import HALTED, Shunting
from .telemetry import Telemetry

PATIENCE_FACTOR = 4.0
PATIENCE_SECONDS = 60.0
CLOSE_DEGREES = 5.0
ABREAST_METRES = 0.1
"""How near a place must be that is gone through: chains of short legs around a corner would add up more."""


ADVANCE_SPEED = 0.05
"""Metres per second by which a vehicle that has a target approaches it at least."""

ADVANCE_PART = 0.9
"""Metres by which it comes nearer with every metre covered, at least: up to 25 degrees beside the line."""

CREEPING, LEAST_CREEPING = 0.3, 0.02
"""Metres per second up to which one that steers like a car may come nearer at any angle, and by which it does
so at least: it turns to a target beside it the more slowly the nearer that is."""


class Advance:
    """Whether a vehicle approaches a target: one that does not may never have received it."""

    def __init__(self, telemetry: Telemetry, place: Place) -> None:
        """Judge by what is reported from now on whether it comes nearer to a place."""
        self._telemetry, self._place = telemetry, place
        self._here, self._since = telemetry.here(), telemetry.time()

    def ceased(self, seconds: float, *, steers: bool = False) -> bool:
        """Return whether it has not come nearer since the last judgement.

        One whose positions do not arrive is not judged.

        Args:
            seconds: between two judgements, of which half must lie between the positions that are compared.
            steers: whether it steers like a car.
        """
        here, now = self._telemetry.here(), self._telemetry.time()
        if now - self._since < seconds / 2.0:
            return False
        nearer = distance(self._here, self._place) - distance(here, self._place)
        covered, passed = distance(self._here, here), now - self._since
        least = max(ADVANCE_SPEED * passed, ADVANCE_PART * covered)
        if steers and covered <= CREEPING * passed:
            least = LEAST_CREEPING * passed
        self._here, self._since = here, now
        return nearer < least


class Steering:
    """Steers a vehicle by position targets.

    A target is sent once, and again where the vehicle evidently does not go there, since it may be lost: an
    ArduSub plans its path from rest with each target that it receives, and goes at a third of its speed if it
    receives one a second (``AC_WPNav::set_wp_destination_NEU_cm``). ArduSub reports no target
    (POSITION_TARGET_GLOBAL_INT), so its motion is what shows that it has one. Streams of set-points continue.
    """

    def __init__(
        self,
        link: Link,
        telemetry: Telemetry,
        mode_control: ModeControl,
        acceptance: float,
        turning_radius: float = 0.0,
        turn_rate: float | None = None,
    ) -> None:
        """Steer a vehicle by its profile.

        Args:
            link: to the vehicle.
            telemetry: of the vehicle.
            mode_control: of the vehicle.
            acceptance: metres from a place at which it counts as reached.
            turning_radius: of its narrowest curve, metres; 0: it turns on its own.
            turn_rate: its type's largest, degrees per second; None where unknown.
        """
        self._link = link
        self._telemetry = telemetry
        self._mode_control = mode_control
        self._acceptance = acceptance
        self._turn_rate = inf if turn_rate is None else radians(turn_rate)
        self._shunting = Shunting(link, telemetry, mode_control, turning_radius)
        self._yaw: float | None = None
        self._speed: float | None = None

    def go_to(self, place: Place, speed: float | None, look: Look | None, through: bool) -> None:
        """Go straight to a place; `through`: without a stop there.

        One that steers like a car and stands there already stays: to a target that it has passed, a Rover
        drives round by several metres. One that has come to a stop beside its target turns to it once more.

        Raises:
            FaultError: it does not get there.
        """
        self._mode_control.arm()
        self._speed = speed
        self._point(look)
        if self._shunting.radius and self._arrived(place, None):
            self._unpoint(look)
            return
        self._shunting.face(place, self._acceptance, speed or 0.0)
        begun = self._telemetry.here()
        way = distance(begun, place)
        limit = self._link.clock.now() + PATIENCE_SECONDS + PATIENCE_FACTOR * way / max(0.2, speed or 1.0)
        resend = self._link.profile.timing.resend
        advance, lost = Advance(self._telemetry, place), False
        self._mode_control.pace_next(speed)
        self._steer(place, look)
        while True:
            self._mode_control.pace(speed, again=lost)
            if look is not None and isinstance(look.at, Local):
                self._point(look)
            if self._link.wait(lambda: self._arrived(place, begun if through else None), resend):
                break
            self._mode_control.check()
            limit += resend if self._link.unheard() else 0.0
            if self._link.clock.now() > limit:
                raise FaultError(
                    NO_PROGRESS, f"still {distance(self._telemetry.here(), place):.1f} m from {place}"
                )
            lost = advance.ceased(resend, steers=self._shunting.radius > 0.0)
            stands = self._telemetry.speed() <= HALTED
            if lost and stands and self._shunting.face(place, self._acceptance, speed or 0.0):
                advance = Advance(self._telemetry, place)
            if lost or self._must_turn(look):
                self._steer(place, look)
        self._unpoint(look)

    def turn(self, look: Look) -> None:
        """Turn until a device points at a target; a device with a gimbal turns on its own.

        Raises:
            FaultError: it does not turn so far.
        """
        self._mode_control.arm()
        if look.gimbal:
            self._point(look)
            return
        here = self._telemetry.here()
        wanted = self._yaw = _yaw(here, look)
        until = self._link.clock.now() + self._link.clock.patience(PATIENCE_SECONDS, 2.0)
        resend = self._link.profile.timing.resend
        while not self._faces(wanted):
            if self._link.clock.now() > until:
                raise FaultError(NO_PROGRESS, "the vehicle takes too long to turn")
            self._send_target(here, wanted)
            self._link.wait(lambda: self._faces(wanted), resend)
            until += resend if self._link.unheard() else 0.0
            self._mode_control.check()

    def stay(self, place: Place | None = None) -> None:
        """Stay at a place, None: where the vehicle is, and look where it looks."""
        self._send_target(self._telemetry.here() if place is None else place, self._heading())

    def _point(self, look: Look | None) -> None:
        if look is None or not look.gimbal:
            return
        if isinstance(look.at, Local):
            self._aim_gimbal(look, look.at)
        else:
            look_at_place(self._link, self._mode_control.guidance, look)

    def _aim_gimbal(self, look: Look, at: Local) -> None:
        """Turn a gimbal to a place near home: regions of interest are places on the Earth."""
        here = self._telemetry.here()
        north, east, up = offset(here, at)
        pitch, yaw = degrees(atan2(up, hypot(north, east))), (bearing(here, at) - look.angle) % 360.0
        locked = mavlink.GIMBAL_MANAGER_FLAGS_YAW_LOCK
        command(
            self._link,
            mavlink.MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW,
            pitch,
            yaw,
            nan,
            nan,
            locked,
            0,
            look.device,
        )

    def _unpoint(self, look: Look | None) -> None:
        if look is not None and look.gimbal:
            look_ahead(self._link, look)

    def _steer(self, place: Place, look: Look | None) -> None:
        here = self._telemetry.here()
        if look is not None and not look.gimbal:
            self._yaw = _yaw(here, look)
        elif hypot(*offset(here, place)[:2]) > 1.0:
            self._yaw = bearing(here, place)
        self._send_target(place, self._heading() if self._yaw is None else self._yaw)

    def _must_turn(self, look: Look | None) -> bool:
        """Return whether a device without a gimbal points elsewhere by now than at its target."""
        if look is None or look.gimbal or self._yaw is None:
            return False
        return abs(turn(self._yaw, _yaw(self._telemetry.here(), look))) >= CLOSE_DEGREES

    def _send_target(self, place: Place, yaw: float) -> None:
        self._mode_control.guidance.aim(place, radians(yaw), self._speed, self._turn_rate)

    def _arrived(self, place: Place, begun: Place | None) -> bool:
        """Return whether the vehicle is there, and still; or, on a leg to be gone through, abreast of it."""
        here = self._telemetry.here()
        away = distance(here, place)
        if (settled := self._mode_control.guidance.has_settled(place)) is not None:
            return settled
        if away > self._acceptance:
            return False
        if self._telemetry.speed() <= self._link.profile.still:
            return True
        return begun is not None and (away <= ABREAST_METRES or _is_past(begun, here, place))

    def _faces(self, wanted: float) -> bool:
        return abs(turn(self._heading(), wanted)) < CLOSE_DEGREES

    def _heading(self) -> float:
        reported = self._telemetry.heading()
        return (self._yaw or 0.0) if reported is None else reported


def _is_past(begun: Place, here: Place, place: Place) -> bool:
    """Return whether a vehicle on a leg from `begun` is abreast of its end, or has passed it."""
    leg, left = offset(begun, place), offset(here, place)
    return sum(p * q for p, q in zip(leg, left, strict=True)) <= 0.0


def _yaw(here: Place, look: Look) -> float:
    if isinstance(look.at, Object):
        raise ValueError(f"{look.at} has not been found yet")
    return (bearing(here, look.at) - look.angle - look.mount) % 360.0
