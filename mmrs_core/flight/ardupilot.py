"""An ArduPilot vehicle at the end of a MAVLink link, in the words of a robot's program."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from . import modes, preparation, safeguards
from .commands import command
from .faults import NO_PROGRESS, Fault, Refused
from .helm import MODE_SECONDS, Helm
from .link import Link
from .missions import Item
from .program import Geographic, Look, Place
from .steering import PATIENCE_FACTOR, PATIENCE_SECONDS, STILL, Steering
from .telemetry import Telemetry
from .vehicle import State

FORCE_DISARM = 21_196
VALUE_SECONDS = 10.0


class MavlinkVehicle:
    """An ArduPilot vehicle, stepped in GUIDED and run in AUTO."""

    def __init__(
        self,
        link: Link,
        kind: str,
        home: Place,
        *,
        acceptance: float = 0.5,
        home_tolerance: float = 20.0,
        tell: Callable[[str], None] = lambda line: None,
    ) -> None:
        """Drive the vehicle at the end of a link.

        Args:
            link: open.
            kind: ``copter``, ``sub`` or ``rover``.
            home: of the robot, as its program says.
            acceptance: metres from a place at which it counts as reached.
            home_tolerance: metres that the vehicle may be from home at the beginning.
            tell: is given what people should know, as what the vehicle does by itself.
        """
        self._tell = tell
        self._link = link
        self._telemetry = Telemetry(link, home)
        self._helm = Helm(link, self._telemetry, kind)
        self._steering = Steering(link, self._telemetry, self._helm, acceptance)
        self._kind = kind
        self._home = home
        self._acceptance = acceptance
        self._home_tolerance = home_tolerance

    def prepare(self, fence: Sequence[Item], rally: Sequence[Item], mission: Sequence[Item]) -> None:
        """Upload what there is to upload, and wait until the vehicle is ready to move.

        Raises:
            Refused: something is not accepted or read back differently, the vehicle is not where the
                program begins, or it does not become ready.
        """
        geographic = isinstance(self._home, Geographic)
        preparation.ask_for_messages(self._link, geographic=geographic)
        preparation.await_position(self._link, self._telemetry)
        preparation.check_identity(self._link, self._telemetry, self._kind, self._home, self._home_tolerance)
        if geographic:
            preparation.replace_all(self._link, mission, fence, rally)
        for line in safeguards.report(self._link, self._kind):
            self._tell(line)
        preparation.await_ready(self._link, self._telemetry)
        if fence:
            command(self._link, mavlink.MAV_CMD_DO_FENCE_ENABLE, 1)

    def answer_lost_link(self, response: str) -> None:
        """Have the vehicle respond by itself when it no longer hears the ground.

        Raises:
            Refused: it cannot respond so, or does not say that it will.
        """
        preparation.answer_lost_link(self._link, self._kind, response)

    def answer_breach(self, response: str) -> None:
        """Have the vehicle respond by itself when it breaks its fence.

        Raises:
            Refused: it cannot respond so, or does not say that it will.
        """
        preparation.answer_breach(self._link, self._kind, response)

    @property
    def telemetry(self) -> Telemetry:
        """Return what the vehicle tells about itself."""
        return self._telemetry

    def take_off(self, height: float) -> None:
        """Climb to a height above home.

        Raises:
            Refused: the vehicle does not arm or take off. Fault: it does not get there.
        """
        self._helm.leave_ground(height)
        limit = PATIENCE_SECONDS + PATIENCE_FACTOR * height
        self._helm.until(
            lambda: abs(self._telemetry.here().height - height) <= self._acceptance, limit, "to take off"
        )

    def land(self) -> None:
        """Descend and stop the motors.

        Raises:
            Fault: it does not come to the ground.
        """
        self._helm.enter(modes.LAND)
        limit = PATIENCE_SECONDS + PATIENCE_FACTOR * 2.0 * max(0.0, self._telemetry.here().height)
        self._helm.until(lambda: not self._telemetry.armed(), limit, "to land")
        self._helm.let_go()

    def go_to(self, place: Place, speed: float | None, look: Look | None, through: bool) -> None:
        """Go straight to a place.

        Raises:
            Fault: it does not get there.
        """
        self._steering.go_to(place, speed, look, through)

    def turn(self, look: Look) -> None:
        """Turn until a device points at something; a device with a gimbal turns by itself."""
        self._steering.turn(look)

    def fly(self, first: int, last: int, reached: Callable[[int], None]) -> None:
        """Fly items of the uploaded mission; the one after `last` must make the vehicle wait.

        Raises:
            Fault: no item was reached for too long.
        """
        self._helm.arm()
        command(self._link, mavlink.MAV_CMD_DO_SET_MISSION_CURRENT, first)
        if not self._link.wait(
            lambda: self._telemetry.item() == first, self._link.clock.patience(MODE_SECONDS)
        ):
            raise Refused(f"the vehicle does not go to item {first} of its mission")
        self._helm.enter(modes.AUTO)
        done = first - 1
        while done < last:
            now = self._await_item_after(done + 1)
            for seq in range(done + 1, now):
                reached(seq)
            done = now - 1
        self._helm.enter(modes.GUIDED)
        self._steering.stay()

    def rest(self, seconds: float) -> None:
        """Stay for so many seconds."""
        until = self._link.clock.now() + seconds
        self._link.wait(lambda: self._link.clock.now() >= until, seconds)
        self._helm.check()

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
                lambda: next((m for m in inbox if m.name == value), None),
                self._link.clock.patience(VALUE_SECONDS),
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
        self._helm.enter(modes.HOLD)
        if not self._link.wait(lambda: self._telemetry.speed() <= STILL, PATIENCE_SECONDS):
            raise Refused("the vehicle does not come to a halt")
        return True

    def surface(self) -> None:
        """Come up to the water surface."""
        self._helm.enter(modes.SURFACE if self._helm.has(modes.SURFACE) else modes.HOLD)
        self._helm.until(
            lambda: self._telemetry.here().height > -self._acceptance, 10 * PATIENCE_SECONDS, "to surface"
        )

    def disarm(self) -> None:
        """Switch off propulsion, whatever happens then."""
        command(self._link, mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 0, FORCE_DISARM)

    def finish(self) -> None:
        """End the mission: a vehicle that does not fly is disarmed, one that does is not."""
        if self._telemetry.armed() and (self._kind != "copter" or self._telemetry.grounded()):
            self._helm.disarm()

    def running_low(self, reserve: float) -> bool:
        """Return whether the motors run and less than that part of the energy is left."""
        left = self._telemetry.energy()
        return left is not None and left < reserve and self._telemetry.armed()

    def state(self) -> State:
        """Return what is known now."""
        mode, armed = self._helm.mode(), self._telemetry.armed()
        return replace(self._telemetry.state(), mode=mode, armed=armed)

    def _await_item_after(self, seq: int) -> int:
        def behind() -> int | None:
            return self._telemetry.item() if self._telemetry.item() > seq else None

        found = self._link.wait(behind, 10 * PATIENCE_SECONDS)
        self._helm.check()
        if found is None:
            raise Fault(NO_PROGRESS, f"item {seq} of the mission was not reached")
        return found
