"""An ArduPilot vehicle at the end of a MAVLink link, in the words of a robot's program."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from math import hypot, radians

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from . import modes
from .commands import command
from .faults import NO_PROGRESS, TAKEN_OVER, Fault, Refused
from .link import Link, Message
from .missions import FENCE, MISSION, RALLY, Item, upload, verify
from .places import bearing, distance, offset
from .program import Geographic, Look, Object, Place
from .telemetry import Telemetry
from .vehicle import State

READY_SECONDS = 120.0
MODE_SECONDS = 5.0
TAKE_OFF_TRIES = 3
AFRESH_SECONDS = 3.0
"""After which at least one new heartbeat should have come, even over a poor link."""
RESEND_SECONDS = 1.0
PATIENCE_FACTOR = 4.0
PATIENCE_SECONDS = 60.0
STILL = 0.3
CLOSE_DEGREES = 5.0
FORCE_DISARM = 21_196
STREAMED = {
    "GLOBAL_POSITION_INT": 5.0,
    "LOCAL_POSITION_NED": 5.0,
    "EXTENDED_SYS_STATE": 2.0,
    "SYS_STATUS": 1.0,
    "MISSION_CURRENT": 5.0,
    "EKF_STATUS_REPORT": 1.0,
}


class MavlinkVehicle:
    """An ArduPilot vehicle, stepped in GUIDED and run in AUTO.

    Modes are believed when heartbeats show them, never by acknowledgement alone. A mode that
    nobody here asked for means that a pilot has taken over: the program then ends and leaves the
    vehicle alone.
    """

    def __init__(
        self, link: Link, kind: str, home: Place, *, acceptance: float = 0.5, home_tolerance: float = 20.0
    ) -> None:
        """Drive the vehicle at the end of a link.

        Args:
            link: open.
            kind: ``copter``, ``sub`` or ``rover``.
            home: of the robot, as its program says.
            acceptance: metres from a place at which it counts as reached.
            home_tolerance: metres that the vehicle may be from home at the beginning.
        """
        self._link = link
        self._telemetry = Telemetry(link, home)
        self._kind = kind
        self._home = home
        self._acceptance = acceptance
        self._home_tolerance = home_tolerance
        self._mode: str | None = None
        self._speed: float | None = None
        self._yaw = 0.0

    def prepare(self, fence: Sequence[Item], rally: Sequence[Item], mission: Sequence[Item]) -> None:
        """Upload what there is to upload, and wait until the vehicle is ready to move.

        Raises:
            Refused: something is not accepted or read back differently, the vehicle is not where the
                program begins, or it does not become ready.
        """
        for name, rate in STREAMED.items():
            self._stream(name, rate)
        if isinstance(self._home, Geographic):
            for items, kind in ((mission, MISSION), (fence, FENCE), (rally, RALLY)):
                self._replace(items, kind)
        self._await_ready()
        away = hypot(*offset(self._home, self._telemetry.here())[:2])
        if away > self._home_tolerance:
            raise Refused(f"the vehicle is {away:.0f} m from the home of its program")
        if fence:
            command(self._link, mavlink.MAV_CMD_DO_FENCE_ENABLE, 1)

    def answer_lost_link(self, response: str) -> str | None:
        """Have the vehicle respond by itself when it no longer hears the ground.

        Returns:
            What could not be set, or None.
        """
        value = modes.LINK_LOST_VALUE[self._kind].get(response)
        name = modes.LINK_LOST_PARAMETER[self._kind]
        if value is None:
            return f"{name} has no value for {response}"
        if self._set_parameter(name, value):
            return None
        return f"{name} was not taken over by the vehicle"

    def take_off(self, height: float) -> None:
        """Climb to a height above home.

        Raises:
            Refused: the vehicle does not arm or take off. Fault: it does not get there.
        """
        self._leave_ground(height)
        limit = PATIENCE_SECONDS + PATIENCE_FACTOR * height
        self._until(
            lambda: abs(self._telemetry.here().height - height) <= self._acceptance, limit, "to take off"
        )

    def land(self) -> None:
        """Descend and stop the motors.

        Raises:
            Fault: it does not come to the ground.
        """
        self._set_mode(modes.LAND)
        limit = PATIENCE_SECONDS + PATIENCE_FACTOR * 2.0 * max(0.0, self._telemetry.here().height)
        self._until(lambda: not self._telemetry.armed(), limit, "to land")
        self._mode = None

    def go_to(self, place: Place, speed: float | None, look: Look | None, through: bool) -> None:
        """Go straight to a place.

        Raises:
            Fault: it does not get there.
        """
        self._arm()
        self._pace(speed)
        self._point(look)
        way = distance(self._telemetry.here(), place)
        limit = self._link.clock.now() + PATIENCE_SECONDS + PATIENCE_FACTOR * way / max(0.2, speed or 1.0)
        while True:
            self._steer(place, look)
            if self._link.wait(lambda: self._arrived(place, through), RESEND_SECONDS):
                break
            self._check_mode()
            if self._link.clock.now() > limit:
                raise Fault(
                    NO_PROGRESS, f"still {distance(self._telemetry.here(), place):.1f} m from {place}"
                )
        self._unpoint(look)

    def turn(self, look: Look) -> None:
        """Turn until a device points at something; a device with a gimbal turns by itself."""
        self._arm()
        if look.gimbal:
            self._point(look)
            return
        here = self._telemetry.here()
        wanted = self._yaw = _yaw(here, look)
        until = self._link.clock.now() + self._link.clock.patience(PATIENCE_SECONDS, 2.0)
        while not self._faces(wanted):
            if self._link.clock.now() > until:
                raise Fault(NO_PROGRESS, "the vehicle takes too long to turn")
            self._send_target(here, wanted)
            self._link.wait(lambda: self._faces(wanted), RESEND_SECONDS)
            self._check_mode()

    def fly(self, first: int, last: int, reached: Callable[[int], None]) -> None:
        """Fly items of the uploaded mission; the one after `last` must make the vehicle wait.

        Raises:
            Fault: no item was reached for too long.
        """
        self._arm()
        command(self._link, mavlink.MAV_CMD_DO_SET_MISSION_CURRENT, first)
        if not self._link.wait(
            lambda: self._telemetry.item() == first, self._link.clock.patience(MODE_SECONDS)
        ):
            raise Refused(f"the vehicle does not go to item {first} of its mission")
        self._set_mode(modes.AUTO)
        done = first - 1
        while done < last:
            now = self._await_item_after(done + 1)
            for seq in range(done + 1, now):
                reached(seq)
            done = now - 1
        self._set_mode(modes.GUIDED)
        self._send_target(self._telemetry.here(), self._yaw)

    def rest(self, seconds: float) -> None:
        """Stay for so many seconds."""
        until = self._link.clock.now() + seconds
        self._link.wait(lambda: self._link.clock.now() >= until, seconds)
        self._check_mode()

    def operate(self, number: int, params: tuple[float, ...]) -> None:
        """Have a device do something.

        Raises:
            Refused: the vehicle does not do it, or does not answer.
        """
        command(self._link, number, *params)

    def measure(self, value: str) -> float:
        """Return the next value published under that name.

        Raises:
            Refused: none comes.
        """
        with self._link.inbox("NAMED_VALUE_FLOAT") as inbox:
            found = self._link.wait(
                lambda: next((m for m in inbox if m.name == value), None), self._link.clock.patience(10.0)
            )
        if found is None:
            raise Refused(f"{value}: no such value comes from the vehicle")
        return float(found.value)

    def hold(self) -> bool:
        """Halt and stay, and return when the vehicle does; on the ground, disarm.

        Returns:
            Whether it is still armed, so that somebody must watch it.

        Raises:
            Refused: it does not halt.
        """
        if not self._telemetry.armed():
            return False
        if self._telemetry.grounded():
            command(self._link, mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 0)
            return False
        self._set_mode(modes.HOLD)
        if not self._link.wait(lambda: self._telemetry.speed() <= STILL, PATIENCE_SECONDS):
            raise Refused("the vehicle does not come to a halt")
        return True

    def surface(self) -> None:
        """Come up to the water surface."""
        self._set_mode(modes.SURFACE if modes.SURFACE in modes.MODES[self._kind] else modes.HOLD)
        self._until(
            lambda: self._telemetry.here().height > -self._acceptance, 10 * PATIENCE_SECONDS, "to surface"
        )

    def disarm(self) -> None:
        """Switch off propulsion, whatever happens then."""
        command(self._link, mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 0, FORCE_DISARM)

    def finish(self) -> None:
        """End the mission: a vehicle that does not fly is disarmed, one that does is not."""
        if self._telemetry.armed() and (self._kind != "copter" or self._telemetry.grounded()):
            command(self._link, mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 0)
            self._until(lambda: not self._telemetry.armed(), MODE_SECONDS, "to disarm")

    def running_low(self, reserve: float) -> bool:
        """Return whether the motors run and less than that part of the energy is left."""
        left = self._telemetry.energy()
        return left is not None and left < reserve and self._telemetry.armed()

    def state(self) -> State:
        """Return what is known now."""
        return self._telemetry.state()

    def _replace(self, items: Sequence[Item], kind: int) -> None:
        upload(self._link, items, kind)
        verify(self._link, items, kind)

    def _stream(self, name: str, rate: float) -> None:
        """Ask for a message at a rate; a vehicle that refuses sends it as it likes, or does without."""
        number = getattr(mavlink, f"MAVLINK_MSG_ID_{name}")
        with suppress(Refused):
            command(self._link, mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, number, 1e6 / rate, tries=2)

    def _await_ready(self) -> None:
        if not self._link.wait(self._telemetry.ready, READY_SECONDS):
            raise Refused("the vehicle does not become ready: no position, or its own checks fail")

    def _set_parameter(self, name: str, value: float) -> bool:
        link = self._link
        with link.inbox("PARAM_VALUE") as inbox:
            for _ in range(3):
                link.send(
                    mavlink.MAVLink_param_set_message(
                        link.system, link.component, name.encode(), value, mavlink.MAV_PARAM_TYPE_REAL32
                    )
                )
                if link.wait(
                    lambda: any(m.param_id == name and m.param_value == value for m in inbox),
                    link.clock.patience(1.5),
                ):
                    return True
        return False

    def _arm(self) -> None:
        if self._mode != modes.GUIDED:
            self._set_mode(modes.GUIDED)
        if not self._telemetry.armed():
            command(self._link, mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 1)
            self._until(self._telemetry.armed, MODE_SECONDS, "to arm")

    def _leave_ground(self, height: float) -> None:
        """Arm and take off, again where the vehicle has disarmed itself in between."""
        for attempt in range(TAKE_OFF_TRIES):
            self._arm()
            try:
                command(self._link, mavlink.MAV_CMD_NAV_TAKEOFF, 0, 0, 0, 0, 0, 0, height)
                return
            except Refused:
                if attempt + 1 == TAKE_OFF_TRIES:
                    raise
                self._link.wait(lambda: None, AFRESH_SECONDS)

    def _set_mode(self, mode: str) -> None:
        number = modes.MODES[self._kind][mode]
        for _ in range(3):
            command(self._link, mavlink.MAV_CMD_DO_SET_MODE, 1, number)
            if self._link.wait(
                lambda: self._telemetry.mode() == number, self._link.clock.patience(MODE_SECONDS)
            ):
                self._mode, self._speed = mode, None
                return
        raise Refused(f"the vehicle does not go into mode {mode}")

    def _check_mode(self) -> None:
        if self._mode is None or self._telemetry.mode() == modes.MODES[self._kind][self._mode]:
            return
        if self._link.since("HEARTBEAT") < self._link.clock.patience(3.0):
            raise Fault(TAKEN_OVER, f"the vehicle left mode {self._mode}: somebody else has taken over")

    def _until(self, test: Callable[[], bool], seconds: float, doing: str) -> None:
        if not self._link.wait(test, self._link.clock.patience(seconds, 2.0)):
            raise Fault(NO_PROGRESS, f"the vehicle takes too long {doing}")

    def _pace(self, speed: float | None) -> None:
        if speed is not None and speed != self._speed:
            command(self._link, mavlink.MAV_CMD_DO_CHANGE_SPEED, 1, speed, -1)
            self._speed = speed

    def _point(self, look: Look | None) -> None:
        if look is not None and look.gimbal and isinstance(look.at, Geographic):
            at = look.at
            command(
                self._link,
                mavlink.MAV_CMD_DO_SET_ROI_LOCATION,
                0,
                0,
                0,
                0,
                at.latitude,
                at.longitude,
                at.height,
            )

    def _unpoint(self, look: Look | None) -> None:
        if look is not None and look.gimbal:
            command(self._link, mavlink.MAV_CMD_DO_SET_ROI_NONE)

    def _steer(self, place: Place, look: Look | None) -> None:
        here = self._telemetry.here()
        if look is not None and not look.gimbal:
            self._yaw = _yaw(here, look)
        elif hypot(*offset(here, place)[:2]) > 1.0:
            self._yaw = bearing(here, place)
        self._send_target(place, self._yaw)

    def _send_target(self, place: Place, yaw: float) -> None:
        self._link.send(_target(self._link, place, radians(yaw)))

    def _arrived(self, place: Place, through: bool) -> bool:
        near = distance(self._telemetry.here(), place) <= self._acceptance
        return near and (through or self._telemetry.speed() <= STILL)

    def _faces(self, wanted: float) -> bool:
        return abs((self._heading() - wanted + 180.0) % 360.0 - 180.0) < CLOSE_DEGREES

    def _heading(self) -> float:
        told = self._telemetry.heading()
        return self._yaw if told is None else told

    def _await_item_after(self, seq: int) -> int:
        def behind() -> int | None:
            return self._telemetry.item() if self._telemetry.item() > seq else None

        found = self._link.wait(behind, 10 * PATIENCE_SECONDS)
        self._check_mode()
        if found is None:
            raise Fault(NO_PROGRESS, f"item {seq} of the mission was not reached")
        return found


def _yaw(here: Place, look: Look) -> float:
    if isinstance(look.at, Object):
        raise ValueError(f"{look.at} has not been found yet")
    return (bearing(here, look.at) - look.angle - look.mount) % 360.0


def _target(link: Link, place: Place, yaw: float) -> Message:
    ignored = (
        mavlink.POSITION_TARGET_TYPEMASK_VX_IGNORE
        | mavlink.POSITION_TARGET_TYPEMASK_VY_IGNORE
        | mavlink.POSITION_TARGET_TYPEMASK_VZ_IGNORE
        | mavlink.POSITION_TARGET_TYPEMASK_AX_IGNORE
        | mavlink.POSITION_TARGET_TYPEMASK_AY_IGNORE
        | mavlink.POSITION_TARGET_TYPEMASK_AZ_IGNORE
        | mavlink.POSITION_TARGET_TYPEMASK_YAW_RATE_IGNORE
    )
    rest = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, yaw, 0.0)
    if isinstance(place, Geographic):
        return mavlink.MAVLink_set_position_target_global_int_message(
            0,
            link.system,
            link.component,
            mavlink.MAV_FRAME_GLOBAL_RELATIVE_ALT_INT,
            ignored,
            round(place.latitude * 1e7),
            round(place.longitude * 1e7),
            place.height,
            *rest,
        )
    return mavlink.MAVLink_set_position_target_local_ned_message(
        0,
        link.system,
        link.component,
        mavlink.MAV_FRAME_LOCAL_NED,
        ignored,
        place.north,
        place.east,
        -place.height,
        *rest,
    )
